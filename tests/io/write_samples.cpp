// SPDX-License-Identifier: BSD-3-Clause
// Writes samples for independent_readers.py: write_samples FOLDER, and for each file what is in it to stdout.
#include "io/specimens.h"
#include "slabhull/io/files.h"

#include <fmt/format.h>
#include <tuple>
#include <utility>

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
        slabhull::io::write_medit(folder / fmt::format("grid{}.mesh", dimension), grid.columns());
        slabhull::io::write_medit(folder / fmt::format("grid{}_4d.mesh", dimension), grid.columns(),
                                  {.four_dimensional = true});
        slabhull::io::write_mfem(folder / fmt::format("grid{}.mfem", dimension), grid.columns());
        slabhull::io::write_avro(folder / fmt::format("grid{}.avro", dimension), grid.columns());
        slabhull::io::AtomicFile legacy{folder / fmt::format("grid{}.vtk", dimension)};
        slabhull::io::write_vtk(legacy, grid.columns());
        legacy.commit();
        if (dimension > 1) {
            slabhull::io::write_tetgen(folder / fmt::format("grid{}", dimension), grid.columns());
        }
    }
    const specimens::Grid surface{2, 110}; // that of grid2.vtu
    for (const char* name : {"grid2.stl", "grid2.off", "grid2.obj", "grid2.ply"}) {
        slabhull::io::write_surface(folder / name, surface.columns());
    }
    return 0;
}
