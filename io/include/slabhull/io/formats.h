// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/atomic_file.h"
#include "slabhull/io/files.h"
#include "slabhull/io/soup.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slabhull::io {

/// How a file shall be written; what is empty is as the format does it by default.
struct WriteOptions {
    std::string encoding; ///< one of Offers::encodings
    std::string version;  ///< one of Offers::versions
    bool four_dimensional = false;
    std::size_t pieces = 0; ///< files, where Offers::pieces; 0: not cut
};

/// Where the rows of an array are.
enum class Over { points, cells, field };

/// What a format can hold beside points and the cells of one dimension.
struct Holds {
    int least_dimension = 1; ///< of the cells
    int most_dimension = 3;
    int least_lower = 4;      ///< of simplices of lower dimensions beside them; 4: none ...
    bool only_facets = false; ///< ... and only those one dimension lower
    bool groups = false;      ///< numbered groups of cells ...
    bool group_names = true;  ///< ... with names ...
    bool no_group = true;     ///< ... which some cells may not be in
    bool point_data = false;
    bool cell_data = false;
    bool field_data = false;
    bool wide_integers = true; ///< whole numbers above 2^53
    bool components = true;    ///< any number of them in an array, else 1, and 3 and 9 of reals
    bool tags = false;         ///< data that name cells do so by element tags, which count from 1
    bool doubles = true;       ///< as coordinates; else single precision
    bool shared_points = true; ///< else each cell has points of its own, which are joined when read

    /// Whether an array of numbers is kept, for formats of which the flags above do not tell.
    using Keeps = bool (*)(const Soup& soup, Over over, const DataArray& array, const WriteOptions& options);
    Keeps keeps = nullptr;
};

/// The ways in which a format can be written, of each list the default first.
struct Offers {
    std::vector<std::string_view> encodings{};
    std::vector<std::string_view> versions{};
    bool four_dimensional = false; ///< a dialect for points of space-time
    bool pieces = false;           ///< several files, for readers that work in parallel ...
    bool plain_pieces = false;     ///< ... only in the default encoding and version
};

/// A file format: how it is called, read and written.
struct Format {
    using Read = Soup (*)(const std::filesystem::path& path);
    /// Opens the file, and those that belong to it, for the caller to commit.
    using Write = void (*)(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh,
                           const WriteOptions& options);

    std::string_view name;                    ///< as users type it: "msh"
    std::string_view title;                   ///< as messages call it: "MSH"
    std::vector<std::string_view> extensions; ///< in lower case, with the dot
    std::vector<std::string_view> marks;      ///< one of them starts a file; <this stands soon after
    Read read = nullptr;                      ///< nullptr: not read
    Write write = nullptr;                    ///< nullptr: not written
    Holds holds{};                            ///< where it is written
    Offers offers{};
};

/// All formats, in the order in which extensions are looked up.
std::span<const Format> formats();
/// The format that goes by that name or, failing that, by that extension (in any case); nullptr: none.
const Format* format_named(std::string_view name);
const Format* format_of_extension(const std::filesystem::path& path);
/// The format that is read and of which the file's first bytes are; nullptr: none. Throws InputError.
const Format* format_of_content(const std::filesystem::path& path);

/// Throws UsageError unless the format is written so. `prefix` stands before the options' names ("encoding",
/// "version", "four-dimensional") in messages: "--".
void require_offered(const Format& format, const WriteOptions& options, const std::string& prefix);

/// The same for the writers themselves.
VtuEncoding vtu_encoding(const WriteOptions& options);
MshOptions msh_options(const WriteOptions& options);

/// What a soup has that the format cannot hold, each in a few words: "point data t, vertex_id".
std::vector<std::string> losses(const Format& format, const Soup& soup, const WriteOptions& options = {});
/// Whether the format has a place for an array.
bool keeps(const Format& format, const Soup& soup, Over over, const DataArray& array,
           const WriteOptions& options = {});
/// What no writer keeps of a soup, as all number anew, from 0 or 1: numbers of points and cells that count
/// otherwise, geometric entities of which there are more than groups.
std::vector<std::string> lost_numbers(const Soup& soup);

} // namespace slabhull::io
