// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/atomic_file.h"
#include "slabhull/io/files.h"
#include "slabhull/io/piece.h"
#include "slabhull/io/soup.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slabhull::io {

/// How to write a file. Empty members mean the format's default.
struct WriteOptions {
    std::string encoding; ///< one of WriteVariants::encodings
    std::string version;  ///< one of WriteVariants::versions
    bool four_dimensional = false;
    std::size_t pieces = 0; ///< number of files, if WriteVariants::pieces; 0: one file
};

/// What the rows of a data array belong to; `field`: the whole mesh.
enum class ArrayAssociation { points, cells, field };

/// What a format can store besides points and the cells of one dimension.
struct FormatFeatures {
    int min_dimension = 1; ///< of the cells
    int max_dimension = 3;
    std::optional<int> min_lower_dimension{}; ///< of simplices beside the cells; none: cells only
    bool only_facets = false;                 ///< lower simplices only of the dimension below
    bool groups = false;                      ///< numbered groups of cells
    bool group_names = true;
    bool ungrouped_cells = true; ///< a cell may be in no group
    bool point_data = false;
    bool cell_data = false;
    bool field_data = false;
    bool wide_integers = true;    ///< integers above 2^53
    bool any_components = true;   ///< else 1 per array; reals also 3 and 9
    bool one_based_tags = false;  ///< arrays of cell numbers hold element tags, which count from 1
    bool double_precision = true; ///< of coordinates
    bool shared_points = true;    ///< else each cell repeats its points; a reader joins equal ones

    /// Whether an array of numbers is stored, for formats where the flags above do not suffice.
    using StoresArray = bool (*)(const Soup& soup, ArrayAssociation association, const DataArray& array,
                                 const WriteOptions& options);
    StoresArray stores_array = nullptr;
};

/// The variants in which a format can be written; the first of each list is the default.
struct WriteVariants {
    std::vector<std::string_view> encodings{};
    std::vector<std::string_view> versions{};
    bool four_dimensional = false;    ///< a dialect for points of space-time
    bool pieces = false;              ///< several files, for parallel readers
    bool pieces_default_only = false; ///< pieces only in the default encoding and version
};

/// Reads a file, with options if the format has some.
class FormatReader {
public:
    using Plain = Soup (*)(const std::filesystem::path& path);
    using WithOptions = Soup (*)(const std::filesystem::path& path, const ReadOptions& options);
    FormatReader() = default;
    FormatReader(Plain plain, WithOptions with_options = nullptr)
        : plain_{plain}, with_options_{with_options} {}

    Soup operator()(const std::filesystem::path& path, const ReadOptions& options = {}) const {
        return with_options_ != nullptr ? with_options_(path, options) : plain_(path);
    }

    explicit operator bool() const { return plain_ != nullptr || with_options_ != nullptr; }

private:
    Plain plain_ = nullptr;
    WithOptions with_options_ = nullptr;
};

/// A file format: its names, its reader and its writer.
struct Format {
    /// Opens the file, and the files that belong to it, for the caller to commit.
    using Write = void (*)(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh,
                           const WriteOptions& options);

    std::string_view name;                    ///< as users type it: "msh"
    std::string_view title;                   ///< as messages call it: "MSH"
    std::vector<std::string_view> extensions; ///< in lower case, with the dot
    std::vector<std::string_view> signatures; ///< a file starts with one of them; <this is near the start
    FormatReader read{};                      ///< throws FormatLeftOut unless `built`
    Write write = nullptr;                    ///< throws FormatLeftOut unless `built`
    /// Opens the files of one piece of a mesh that is written in pieces: the bytes that `write` gives them.
    using WritePiece = void (*)(AtomicFiles& files, const std::filesystem::path& path,
                                const PieceColumns& piece, const WriteOptions& options);
    WritePiece write_piece = nullptr; ///< where WriteVariants::pieces
    FormatFeatures features{};
    WriteVariants variants{};
    bool built = true; ///< false: left out of this build by SLABHULL_FORMATS
};

/// The formats of this build, in the order in which extensions are looked up.
std::span<const Format> formats();
/// The formats that this build was configured without.
std::span<const Format> formats_left_out();

/// The format with a name or else an extension (in upper or lower case), whether or not this build has it;
/// nullptr: none.
const Format* format_named(std::string_view name);
const Format* format_of_extension(const std::filesystem::path& path);
/// Reads a file in a format. What is wrong with a file that is empty, or looks like one of another format,
/// says so, too. Throws InputError.
Soup read_as(const Format& format, const std::filesystem::path& path, const ReadOptions& options = {});
/// The format whose signature the file starts with; nullptr: none. Throws InputError.
const Format* format_of_content(const std::filesystem::path& path);

/// Throws FormatLeftOut unless this build has the format.
void require_built(const Format& format);

/// Throws UsageError unless the format can be written with these options. `prefix` stands before the options'
/// names ("encoding", "version", "four-dimensional") in messages: "--".
void require_supported(const Format& format, const WriteOptions& options, const std::string& prefix);

/// The options in the terms of the VTU and MSH writers.
VtuEncoding vtu_encoding(const WriteOptions& options);
MshOptions msh_options(const WriteOptions& options);

/// The parts of a soup that the format cannot store, each in a few words: "point data t, vertex_id".
std::vector<std::string> losses(const Format& format, const Soup& soup, const WriteOptions& options = {});
/// Whether the format stores an array.
bool stores(const Format& format, const Soup& soup, ArrayAssociation association, const DataArray& array,
            const WriteOptions& options = {});
/// The parts of a soup that no writer stores, as all of them number points and cells anew from 0 or 1: other
/// numbers of points and cells, and geometric entities if there are more of them than groups.
std::vector<std::string> lost_numbers(const Soup& soup);

} // namespace slabhull::io
