// SPDX-License-Identifier: BSD-3-Clause
// Writes samples for independent_readers.py: write_samples FOLDER, and for each file what is in it to stdout.
#include "io/specimens.h"
#include "slabhull/io/files.h"

#include <fmt/format.h>

int main(int argument_count, char** arguments) {
    if (argument_count != 2) {
        return 2;
    }
    const std::filesystem::path folder{arguments[1]};
    std::filesystem::create_directories(folder);
    for (const int dimension : {1, 2, 3}) {
        const specimens::Grid grid{dimension, 7};
        slabhull::io::write_vtu(folder / fmt::format("grid{}.vtu", dimension), grid.columns());
        slabhull::io::write_msh(folder / fmt::format("grid{}.msh", dimension), grid.columns());
        slabhull::io::AtomicFile legacy{folder / fmt::format("grid{}.vtk", dimension)};
        slabhull::io::write_vtk(legacy, grid.columns());
        legacy.commit();
        if (dimension > 1) {
            slabhull::io::write_tetgen(folder / fmt::format("grid{}", dimension), grid.columns());
        }
    }
    return 0;
}
