// SPDX-License-Identifier: BSD-3-Clause
// Writes samples for independent_readers.py: write_samples FOLDER, and for each file what is in it to stdout.
#include "io/specimens.h"
#include "slabhull/io/files.h"
#include "slabhull/io/formats.h"

#include <fmt/format.h>
#include <tuple>
#include <utility>

namespace {

bool is_built(const char* format) {
    return slabhull::io::format_named(format)->built;
}

/// In the formats that a build may leave out.
void write_optional_formats(const std::filesystem::path& folder, int dimension,
                            const slabhull::io::MeshColumns& mesh) {
    const auto named = [&](const char* ending) {
        return folder / fmt::format("grid{}{}", dimension, ending);
    };
    if (is_built("medit")) {
        slabhull::io::write_medit(named(".mesh"), mesh);
        slabhull::io::write_medit(named("_4d.mesh"), mesh, {.four_dimensional = true});
    }
    if (is_built("mfem")) {
        slabhull::io::write_mfem(named(".mfem"), mesh);
    }
    if (is_built("avro")) {
        slabhull::io::write_avro(named(".avro"), mesh);
    }
    if (is_built("vtk")) {
        slabhull::io::AtomicFile legacy{named(".vtk")};
        slabhull::io::write_vtk(legacy, mesh);
        legacy.commit();
    }
    if (is_built("tetgen") && dimension > 1) {
        slabhull::io::write_tetgen(named(""), mesh);
    }
}

} // namespace

int main(int argument_count, char** arguments) {
    if (argument_count != 2) {
        return 2;
    }
    const std::filesystem::path folder{arguments[1]};
    std::filesystem::create_directories(folder);
    for (const int dimension : {1, 2, 3}) {
        const specimens::Grid grid{dimension, dimension == 2 ? 110 : 7}; // 2: several packed blocks
        slabhull::io::write_vtu(folder / fmt::format("grid{}.vtu", dimension), grid.columns());
        using slabhull::io::VtuEncoding;
        for (const auto& [name, encoding] : {std::pair{"zlib", VtuEncoding::zlib},
                                             {"lz4", VtuEncoding::lz4},
                                             {"ascii", VtuEncoding::ascii}}) {
            const auto path = folder / fmt::format("grid{}_{}.vtu", dimension, name);
            slabhull::io::write_vtu(path, grid.columns(), encoding);
        }
        using slabhull::io::MshVersion;
        for (const auto& [name, version, ascii] : {std::tuple{"", MshVersion::v4_1, false},
                                                   {"_ascii", MshVersion::v4_1, true},
                                                   {"_22", MshVersion::v2_2, false},
                                                   {"_22_ascii", MshVersion::v2_2, true}}) {
            slabhull::io::write_msh(folder / fmt::format("grid{}{}.msh", dimension, name), grid.columns(),
                                    {.version = version, .ascii = ascii});
        }
        write_optional_formats(folder, dimension, grid.columns());
    }
    const specimens::Grid surface{2, 110}; // that of grid2.vtu
    for (const char* name : {"grid2.stl", "grid2.off", "grid2.obj", "grid2.ply"}) {
        slabhull::io::write_surface(folder / name, surface.columns());
    }
    return 0;
}
