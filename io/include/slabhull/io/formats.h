// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/atomic_file.h"
#include "slabhull/io/soup.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slabhull::io {

/// What a format can hold beside points and the cells of one dimension.
struct Holds {
    int least_dimension = 1; ///< of the cells
    int most_dimension = 3;
    bool lower_simplices = false; ///< simplices of several dimensions
    bool groups = false;          ///< numbered and named groups of cells
    bool point_data = false;
    bool cell_data = false;
    bool field_data = false;
    bool wide_integers = true; ///< whole numbers above 2^53
    bool tags = false;         ///< data that name cells do so by element tags, which count from 1
};

/// A file format: how it is called, read and written.
struct Format {
    using Read = Soup (*)(const std::filesystem::path& path);
    using Write = void (*)(AtomicFile& file, const MeshColumns& mesh);
    using WritePieces = void (*)(const std::filesystem::path& path, const MeshColumns& mesh,
                                 std::size_t pieces);

    std::string_view name;                    ///< as users type it: "msh"
    std::string_view title;                   ///< as messages call it: "MSH"
    std::vector<std::string_view> extensions; ///< in lower case, with the dot
    Read read = nullptr;                      ///< nullptr: not read
    Write write = nullptr;                    ///< nullptr: not written
    Holds holds = {};                         ///< where it is written
    WritePieces write_pieces = nullptr;       ///< in pieces, for parallel readers; nullptr: not so
};

/// All formats, in the order in which extensions are looked up.
std::span<const Format> formats();
/// The format that goes by that name or, failing that, by that extension (in any case); nullptr: none.
const Format* format_named(std::string_view name);
const Format* format_of_extension(const std::filesystem::path& path);

/// What a soup has that the format cannot hold, each in a few words: "point data t, vertex_id".
std::vector<std::string> losses(const Format& format, const Soup& soup);
/// What no writer keeps of a soup, as all number anew, from 0 or 1: numbers of points and cells that count
/// otherwise, geometric entities of which there are more than groups.
std::vector<std::string> lost_numbers(const Soup& soup);

} // namespace slabhull::io
