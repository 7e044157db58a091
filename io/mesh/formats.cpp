// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/formats.h"

#include "io/files/file_cursor.h"
#include "io/mesh/content_advice.h"
#include "io/mesh/left_out.h"
#include "io/mesh/readers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>

namespace slabhull::io {

namespace {

Soup read_stl(const std::filesystem::path& path) {
    return read_surface_as(path, ".stl");
}
Soup read_off(const std::filesystem::path& path) {
    return read_surface_as(path, ".off");
}
Soup read_obj(const std::filesystem::path& path) {
    return read_surface_as(path, ".obj");
}
Soup read_ply(const std::filesystem::path& path) {
    return read_surface_as(path, ".ply");
}

/// Adapts a writer of one file that has no options.
template<void (*write)(AtomicFile&, const MeshColumns&)>
void write_plain(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh,
                 const WriteOptions&) {
    write(files.open(path), mesh);
}

void write_vtu_as(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh,
                  const WriteOptions& options) {
    write_vtu(files.open(path), mesh, vtu_encoding(options));
}

void write_msh_as(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh,
                  const WriteOptions& options) {
    if (options.pieces > 0) {
        write_msh_pieces(files, path, mesh, options.pieces, msh_options(options));
    } else {
        write_msh(files.open(path), mesh, msh_options(options));
    }
}

void write_msh_piece_as(AtomicFiles& files, const std::filesystem::path& path, const PieceColumns& piece,
                        const WriteOptions& options) {
    write_msh_piece(files, path, piece, msh_options(options));
}

void write_pvtu_piece_as(AtomicFiles& files, const std::filesystem::path& path, const PieceColumns& piece,
                         const WriteOptions& options) {
    write_pvtu_piece(files, path, piece, vtu_encoding(options));
}

void write_pvtu_as(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh,
                   const WriteOptions& options) {
    write_pvtu(files, path, mesh, std::max<std::size_t>(1, options.pieces), vtu_encoding(options));
}

void write_tetgen_as(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh,
                     const WriteOptions&) {
    write_tetgen(files, path, mesh);
}

void write_xdmf_as(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh,
                   const WriteOptions&) {
    write_xdmf(files, path, mesh);
}

void write_medit_as(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh,
                    const WriteOptions& options) {
    write_medit(files.open(path), mesh, {.four_dimensional = options.four_dimensional});
}

// --- which arrays a format stores

bool are_reals(const DataArray& array, const char* name, int components = 1) {
    return array.name == name && array.components == components &&
           std::holds_alternative<Array<double>>(array.values);
}

bool are_integers(const DataArray& array, const char* name) {
    return array.name == name && array.components == 1 && std::holds_alternative<IntegerList>(array.values);
}

bool medit_stores(const Soup&, ArrayAssociation association, const DataArray& array,
                  const WriteOptions& options) {
    return association == ArrayAssociation::points &&
           (are_integers(array, "medit:ref") || (options.four_dimensional && are_reals(array, "t")));
}

bool avro_stores(const Soup& soup, ArrayAssociation association, const DataArray& array,
                 const WriteOptions&) {
    return association == ArrayAssociation::points && soup.top_dimension() == 3 && are_reals(array, "t");
}

bool tetgen_stores(const Soup& soup, ArrayAssociation association, const DataArray& array,
                   const WriteOptions&) {
    const bool triangles = soup.top_dimension() == 2;
    switch (association) {
    case ArrayAssociation::points:
        return true;
    case ArrayAssociation::cells:
        return !triangles || are_integers(array, "marker");
    default:
        return triangles && (are_reals(array, "holes", 3) || are_reals(array, "regions", 5));
    }
}

// --- the table

constexpr FormatFeatures vtu_features{.point_data = true, .cell_data = true, .field_data = true};
constexpr FormatFeatures msh_features{.min_lower_dimension = 0,
                                      .groups = true,
                                      .point_data = true,
                                      .cell_data = true,
                                      .wide_integers = false,
                                      .any_components = false,
                                      .one_based_tags = true};
constexpr FormatFeatures tetgen_features{.min_dimension = 2,
                                         .min_lower_dimension = 2,
                                         .groups = true,
                                         .group_names = false,
                                         .stores_array = tetgen_stores};
constexpr FormatFeatures medit_features{
    .min_lower_dimension = 1, .groups = true, .group_names = false, .stores_array = medit_stores};
constexpr FormatFeatures mfem_features{.min_lower_dimension = 0,
                                       .only_facets = true,
                                       .groups = true,
                                       .group_names = false,
                                       .ungrouped_cells = false};
constexpr FormatFeatures avro_features{.stores_array = avro_stores};
constexpr FormatFeatures surface_features{.min_dimension = 2, .max_dimension = 2};
constexpr FormatFeatures stl_features{
    .min_dimension = 2, .max_dimension = 2, .double_precision = false, .shared_points = false};

const WriteVariants msh_variants{.encodings = {"binary", "ascii"},
                                 .versions = {"4.1", "2.2"},
                                 .pieces = true,
                                 .pieces_default_only = true};
const WriteVariants vtu_variants{.encodings = {"raw", "zlib", "lz4", "ascii"}};
const WriteVariants pvtu_variants{.encodings = vtu_variants.encodings, .pieces = true};

/// Built formats first, then those left out; each part in the order in which extensions are looked up.
struct FormatTable {
    std::vector<Format> all;
    std::size_t built = 0;
};

FormatTable make_table() {
    FormatTable table;
    table.all = {
        {.name = "msh",
         .title = "MSH",
         .extensions = {".msh"},
         .signatures = {"$MeshFormat", "$Comments"},
         .read = {read_msh, read_msh},
         .write = write_msh_as,
         .write_piece = write_msh_piece_as,
         .features = msh_features,
         .variants = msh_variants},
        {.name = "vtu",
         .title = "VTU",
         .extensions = {".vtu"},
         .signatures = {"<VTKFile"},
         .read = {read_vtu, read_vtu},
         .write = write_vtu_as,
         .features = vtu_features,
         .variants = vtu_variants},
        {.name = "pvtu",
         .title = "partitioned VTU",
         .extensions = {".pvtu"},
         .signatures = {},
         .read = {read_pvtu, read_pvtu},
         .write = write_pvtu_as,
         .write_piece = write_pvtu_piece_as,
         .features = vtu_features,
         .variants = pvtu_variants},
        {.name = "vtk",
         .title = "legacy VTK",
         .extensions = {".vtk"},
         .signatures = {"# vtk DataFile"},
         .read = {read_vtk, read_vtk},
         .write = write_plain<write_vtk>,
         .features = vtu_features,
         .built = SLABHULL_FORMAT_VTK},
        {.name = "xdmf",
         .title = "XDMF",
         .extensions = {".xdmf", ".xmf"},
         .signatures = {},
         .read = {read_xdmf, read_xdmf},
         .write = write_xdmf_as,
         .features = vtu_features,
         .built = SLABHULL_FORMAT_XDMF},
        {.name = "tetgen",
         .title = "TetGen",
         .extensions = {".node", ".ele", ".face", ".poly", ".smesh"},
         .signatures = {},
         .read = {read_tetgen, read_tetgen},
         .write = write_tetgen_as,
         .features = tetgen_features,
         .built = SLABHULL_FORMAT_TETGEN},
        {.name = "medit",
         .title = "Medit",
         .extensions = {".mesh"},
         .signatures = {"MeshVersionFormatted"},
         .read = {read_medit, read_medit},
         .write = write_medit_as,
         .features = medit_features,
         .variants = {.four_dimensional = true},
         .built = SLABHULL_FORMAT_MEDIT},
        {.name = "mfem",
         .title = "MFEM",
         .extensions = {".mfem"},
         .signatures = {"MFEM mesh"},
         .read = read_mfem,
         .write = write_plain<write_mfem>,
         .features = mfem_features,
         .built = SLABHULL_FORMAT_MFEM},
        {.name = "avro",
         .title = "avro",
         .extensions = {".avro"},
         .signatures = {},
         .read = read_avro,
         .write = write_plain<write_avro>,
         .features = avro_features,
         .built = SLABHULL_FORMAT_AVRO},
        {.name = "stl",
         .title = "STL",
         .extensions = {".stl"},
         .signatures = {},
         .read = read_stl,
         .write = write_plain<write_stl>,
         .features = stl_features},
        {.name = "off",
         .title = "OFF",
         .extensions = {".off"},
         .signatures = {"OFF"},
         .read = read_off,
         .write = write_plain<write_off>,
         .features = surface_features},
        {.name = "obj",
         .title = "OBJ",
         .extensions = {".obj"},
         .signatures = {},
         .read = read_obj,
         .write = write_plain<write_obj>,
         .features = surface_features},
        {.name = "ply",
         .title = "PLY",
         .extensions = {".ply"},
         .signatures = {"ply"},
         .read = read_ply,
         .write = write_plain<write_ply>,
         .features = surface_features},
    };
    const auto left_out = std::stable_partition(table.all.begin(), table.all.end(),
                                                [](const Format& format) { return format.built; });
    table.built = static_cast<std::size_t>(left_out - table.all.begin());
    return table;
}

const FormatTable& table() {
    static const FormatTable made = make_table();
    return made;
}

/// The first format of the table that satisfies the condition, built or not.
template<class Condition>
const Format* find_format(const Condition& condition) {
    const std::vector<Format>& all = table().all;
    const auto found = std::find_if(all.begin(), all.end(), condition);
    return found == all.end() ? nullptr : &*found;
}

} // namespace

std::span<const Format> formats() {
    return std::span{table().all}.first(table().built);
}

std::span<const Format> formats_left_out() {
    return std::span{table().all}.subspan(table().built);
}

const Format* format_named(std::string_view name) {
    return find_format([&](const Format& format) { return format.name == name; });
}

const Format* format_of_extension(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    return find_format([&](const Format& format) {
        return std::find(format.extensions.begin(), format.extensions.end(), extension) !=
               format.extensions.end();
    });
}

const Format* format_of_content(const std::filesystem::path& path) {
    constexpr std::size_t examined = 4096;
    std::string start(examined, '\0');
    std::ifstream file{path, std::ios::binary};
    file.read(start.data(), static_cast<std::streamsize>(examined));
    start.resize(static_cast<std::size_t>(file.gcount()));
    if (start.empty()) {
        read_bytes(path); // reports a file that cannot be read at all
    }
    const std::size_t first = std::min(start.find_first_not_of(" \t\r\n"), start.size());
    const auto matches = [&](std::string_view signature) {
        return signature.front() == '<' ? start.find(signature) != std::string::npos
                                        : start.compare(first, signature.size(), signature) == 0;
    };
    return find_format([&](const Format& format) {
        return std::any_of(format.signatures.begin(), format.signatures.end(), matches);
    });
}

void require_built(const Format& format) {
    if (!format.built) {
        refuse_left_out(format.title, format.name);
    }
}

void require_supported(const Format& format, const WriteOptions& options, const std::string& prefix) {
    const auto require_one = [&](const char* name, const std::string& wanted,
                                 const std::vector<std::string_view>& possible) {
        if (wanted.empty() || std::find(possible.begin(), possible.end(), wanted) != possible.end()) {
            return;
        }
        throw UsageError{possible.empty()
                             ? fmt::format("{}{}: {} is written in one way only", prefix, name, format.title)
                             : fmt::format("{}{}: {} is written as {}, not as \"{}\"", prefix, name,
                                           format.title, fmt::join(possible, ", "), wanted)};
    };
    require_one("encoding", options.encoding, format.variants.encodings);
    require_one("version", options.version, format.variants.versions);
    if (options.pieces > 0 && !format.variants.pieces) {
        throw UsageError{
            fmt::format("{}pieces: {} is not written in pieces; .pvtu and MSH are", prefix, format.title)};
    }
    const auto is_default = [](const std::string& wanted, const std::vector<std::string_view>& possible) {
        return wanted.empty() || wanted == possible.front();
    };
    const WriteVariants& variants = format.variants;
    if (options.pieces > 0 && variants.pieces_default_only &&
        !(is_default(options.encoding, variants.encodings) &&
          is_default(options.version, variants.versions))) {
        throw UsageError{fmt::format("{}pieces: {} in pieces is version {}, {}", prefix, format.title,
                                     variants.versions.front(), variants.encodings.front())};
    }
    if (options.four_dimensional && !format.variants.four_dimensional) {
        throw UsageError{fmt::format("{}four-dimensional: {} has no such dialect; Medit (.mesh) has one",
                                     prefix, format.title)};
    }
}

namespace {

std::string extensions_of_all() {
    std::string all;
    for (const Format& format : formats()) {
        all += fmt::format("{}{}", all.empty() ? "" : " ", fmt::join(format.extensions, " "));
    }
    return all;
}

/// Whether a file of text lacks the first words of its format, which STL, OBJ and TetGen's files need not
/// have.
bool begins_like_no(std::string_view format, const std::filesystem::path& path) {
    constexpr std::size_t examined = 80;
    const Format* named = format_named(format);
    std::array<char, examined> start{};
    std::ifstream file{path, std::ios::binary};
    file.read(start.data(), examined);
    const auto* end = start.begin() + file.gcount();
    const bool text = std::all_of(
        start.cbegin(), end, [](unsigned char c) { return std::isprint(c) != 0 || std::isspace(c) != 0; });
    return text && start.front() != '#' && named != nullptr && !named->signatures.empty() && format != "stl";
}

} // namespace

std::string content_advice(const std::filesystem::path& path, std::string_view format) {
    std::error_code unreadable;
    if (!std::filesystem::is_regular_file(path, unreadable)) {
        return "";
    }
    if (std::filesystem::file_size(path, unreadable) == 0) {
        return "; the file is empty: write it again";
    }
    const Format* content = format_of_content(path);
    if (content == nullptr) {
        return begins_like_no(format, path) ? "; it begins like no file that is read: export it anew" : "";
    }
    if (content->name == format) {
        return "";
    }
    const bool family = content->extensions.front() == ".vtu" && format == "pvtu"; // one signature for both
    return family ? ""
                  : fmt::format(
                        "; its content looks like {}: name it {}, or export it anew", content->title,
                        std::filesystem::path{path}.replace_extension(content->extensions.front()).string());
}

Soup read_as(const Format& format, const std::filesystem::path& path, const ReadOptions& options) {
    try {
        return format.read(path, options);
    } catch (const InputError& error) {
        const std::string advice = content_advice(path, format.name);
        if (advice.empty() || std::string_view{error.what()}.ends_with(advice)) { // surfaces' readers add it
            throw;
        }
        throw InputError(error.what() + advice, error.entities);
    }
}

Soup read_mesh(const std::filesystem::path& path) {
    return read_mesh(path, ReadOptions{});
}

Soup read_mesh(const std::filesystem::path& path, const ReadOptions& options) {
    const Format* format = format_of_extension(path);
    if (format == nullptr) {
        format = format_of_content(path);
    }
    if (format == nullptr) {
        throw InputError(
            fmt::format("{}: neither the name nor the content is that of a mesh file that is read; mesh CAD "
                        "models first, and export one of {}",
                        path.string(), extensions_of_all()));
    }
    return read_as(*format, path, options);
}

VtuEncoding vtu_encoding(const WriteOptions& options) {
    const auto is = [&](std::string_view encoding) { return options.encoding == encoding; };
    return is("zlib")    ? VtuEncoding::zlib
           : is("lz4")   ? VtuEncoding::lz4
           : is("ascii") ? VtuEncoding::ascii
                         : VtuEncoding::raw;
}

MshOptions msh_options(const WriteOptions& options) {
    return {.version = options.version == "2.2" ? MshVersion::v2_2 : MshVersion::v4_1,
            .ascii = options.encoding == "ascii"};
}

} // namespace slabhull::io
