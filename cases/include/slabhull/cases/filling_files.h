// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/atomic_file.h"
#include "slabhull/io/space_time_files.h"
#include "slabhull/slab/check_filling.h"
#include "slabhull/topology/filling.h"

#include <filesystem>
#include <string>

namespace slabhull {

/// The formats of fillings: "mfem", "getfem", "h5", and for D = 2 "vtu" and "msh".
/// Returns the format that `name` says or, where it is empty, that of the extension of `path`. Throws
/// UsageError naming those that there are for the dimension.
std::string filling_format(const std::filesystem::path& path, const std::string& name, int dimension);

struct FillingFileOptions {
    int pentatope_code = io::usual_pentatope_code; ///< of MFEM files in four dimensions
};

/// Writes a filling, its attributes as docs/formats.md says. Opens one file, the caller's to commit.
template<int D>
void write_filling(io::AtomicFiles& files, const std::filesystem::path& path, const Filling<D>& filling,
                   const std::string& format, const FillingFileOptions& options = {});

/// A filling as a file has it; what the file has not is empty.
template<int D>
struct FillingArrays {
    Array<Point<D + 1>> points;
    Array<Simplex<D + 1>> cells;
    Array<Simplex<D>> facets;
    Array<std::int64_t> facet_attribute;
    Array<Neighbors<D + 1>> neighbors;

    FillingColumns<D> columns() const;
};

/// Needs: a soup of dimension D + 1. Empties it.
template<int D>
FillingArrays<D> filling_of_soup(io::SpaceTimeSoup& soup);

/// A whole filling, to be written again. What the file has not is made anew: neighbours and the boundary's
/// facets by adjacency, which are in order of their vertices then; attributes by time, 1 and 2 for facets at
/// the first and last instant, 3 for others; ids and tracks are -1. Needs: positive simplices, paired where
/// they meet. Throws GeometryError for facets in three simplices, or in two on the same side. Empties the
/// soup.
template<int D>
Filling<D> filling_to_write(io::SpaceTimeSoup& soup);

} // namespace slabhull
