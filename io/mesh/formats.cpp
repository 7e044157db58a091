// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/formats.h"

#include "io/files/file_cursor.h"
#include "slabhull/io/files.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <set>

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

/// A writer of one file in one way.
template<void (*write)(AtomicFile&, const MeshColumns&)>
void alone(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh,
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

// --- what is kept of arrays

bool is_text(const DataArray& array) {
    return std::holds_alternative<std::vector<std::string>>(array.values);
}

bool are_reals(const DataArray& array, const char* name, int components = 1) {
    return array.name == name && array.components == components &&
           std::holds_alternative<Array<double>>(array.values);
}

bool are_integers(const DataArray& array, const char* name) {
    return array.name == name && array.components == 1 &&
           std::holds_alternative<Array<std::int64_t>>(array.values);
}

bool medit_keeps(const Soup&, Over over, const DataArray& array, const WriteOptions& options) {
    return over == Over::points &&
           (are_integers(array, "medit:ref") || (options.four_dimensional && are_reals(array, "t")));
}

bool avro_keeps(const Soup& soup, Over over, const DataArray& array, const WriteOptions&) {
    return over == Over::points && soup.top_dimension() == 3 && are_reals(array, "t");
}

bool tetgen_keeps(const Soup& soup, Over over, const DataArray& array, const WriteOptions&) {
    const bool triangles = soup.top_dimension() == 2;
    switch (over) {
    case Over::points:
        return true;
    case Over::cells:
        return !triangles || are_integers(array, "marker");
    default:
        return triangles && (are_reals(array, "holes", 3) || are_reals(array, "regions", 5));
    }
}

// --- the table

constexpr Holds vtu_holds{.point_data = true, .cell_data = true, .field_data = true};
constexpr Holds msh_holds{.least_lower = 0,
                          .groups = true,
                          .point_data = true,
                          .cell_data = true,
                          .wide_integers = false,
                          .components = false,
                          .tags = true};
constexpr Holds tetgen_holds{
    .least_dimension = 2, .least_lower = 2, .groups = true, .group_names = false, .keeps = tetgen_keeps};
constexpr Holds medit_holds{.least_lower = 1, .groups = true, .group_names = false, .keeps = medit_keeps};
constexpr Holds mfem_holds{
    .least_lower = 0, .only_facets = true, .groups = true, .group_names = false, .no_group = false};
constexpr Holds avro_holds{.keeps = avro_keeps};
constexpr Holds surface_holds{.least_dimension = 2, .most_dimension = 2};
constexpr Holds stl_holds{
    .least_dimension = 2, .most_dimension = 2, .doubles = false, .shared_points = false};

const std::vector<std::string_view> no_mark;
const Offers msh_offers{
    .encodings = {"binary", "ascii"}, .versions = {"4.1", "2.2"}, .pieces = true, .plain_pieces = true};
const Offers vtu_offers{.encodings = {"raw", "zlib", "lz4", "ascii"}};
const Offers pvtu_offers{.encodings = vtu_offers.encodings, .pieces = true};
const Offers medit_offers{.four_dimensional = true};

/// A line for each format; one without a writer says nothing of what it holds.
const std::vector<Format>& table() {
    // clang-format off: a table
    static const std::vector<Format> all{
        {"msh", "MSH", {".msh"}, {"$MeshFormat", "$Comments"}, read_msh, write_msh_as, msh_holds, msh_offers},
        {"vtu", "VTU", {".vtu"}, {"<VTKFile"}, read_vtu, write_vtu_as, vtu_holds, vtu_offers},
        {"pvtu", "partitioned VTU", {".pvtu"}, no_mark, read_pvtu, write_pvtu_as, vtu_holds, pvtu_offers},
        {"vtk", "legacy VTK", {".vtk"}, {"# vtk DataFile"}, read_vtk, alone<write_vtk>, vtu_holds},
        {"xdmf", "XDMF", {".xdmf", ".xmf"}, no_mark, read_xdmf, write_xdmf_as, vtu_holds},
        {"tetgen",
         "TetGen",
         {".node", ".ele", ".face", ".poly", ".smesh"},
         no_mark,
         read_tetgen,
         write_tetgen_as,
         tetgen_holds},
        {"medit",
         "Medit",
         {".mesh"},
         {"MeshVersionFormatted"},
         read_medit,
         write_medit_as,
         medit_holds,
         medit_offers},
        {"mfem", "MFEM", {".mfem"}, {"MFEM mesh"}, read_mfem, alone<write_mfem>, mfem_holds},
        {"avro", "avro", {".avro"}, no_mark, read_avro, alone<write_avro>, avro_holds},
        {"stl", "STL", {".stl"}, no_mark, read_stl, alone<write_stl>, stl_holds},
        {"off", "OFF", {".off"}, {"OFF"}, read_off, alone<write_off>, surface_holds},
        {"obj", "OBJ", {".obj"}, no_mark, read_obj, alone<write_obj>, surface_holds},
        {"ply", "PLY", {".ply"}, {"ply"}, read_ply, alone<write_ply>, surface_holds},
    };
    // clang-format on
    return all;
}

// --- losses

template<class Is>
std::string names_of(const std::vector<DataArray>& arrays, const Is& is) {
    std::string names;
    for (const DataArray& array : arrays) {
        if (array.name != "padding" && is(array)) { // the VTU writer's own
            names += (names.empty() ? "" : ", ") + array.name;
        }
    }
    return names;
}

std::string joined(const std::string& a, const std::string& b) {
    return a.empty() || b.empty() ? a + b : a + ", " + b;
}

bool is_wide(const DataArray& array) {
    constexpr std::int64_t widest = std::int64_t{1} << 53;
    const auto* values = std::get_if<Array<std::int64_t>>(&array.values);
    return values != nullptr && std::any_of(values->begin(), values->end(), [](std::int64_t value) {
               return value > widest || value < -widest;
           });
}

/// "neighbors" is put together again when read.
bool is_taken_apart(const DataArray& array) {
    const bool reals = std::holds_alternative<Array<double>>(array.values);
    return array.components > 1 && !(reals && (array.components == 3 || array.components == 9)) &&
           array.name != "neighbors" && array.name != "neighbor";
}

bool holds_lower(const Holds& holds, int top, int dimension) {
    return dimension >= holds.least_lower && (!holds.only_facets || dimension == top - 1);
}

std::string lower_simplices(const Holds& holds, const Soup& soup) {
    constexpr std::array<const char*, 4> kinds{"points", "lines", "triangles", "tetrahedra"};
    std::string text;
    for (int dimension = soup.top_dimension() - 1; dimension >= 0; --dimension) {
        const auto d = static_cast<std::size_t>(dimension);
        const std::size_t count = soup.simplices[d].size(dimension);
        if (count > 0 && !holds_lower(holds, soup.top_dimension(), dimension)) {
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, kinds[d]);
        }
    }
    return text;
}

std::string group_names(const Soup& soup) {
    std::set<std::string> names;
    for (const PatchList& groups : soup.groups) {
        for (const Patch& group : groups) {
            names.insert(group.name);
        }
    }
    names.erase("");
    return fmt::format("{}", fmt::join(names, ", "));
}

/// Whether some cells of the top dimension are in groups, and some are not.
bool has_cells_apart(const Soup& soup) {
    const auto& physical = soup.simplices[static_cast<std::size_t>(soup.top_dimension())].physical;
    const auto apart = std::count(physical.begin(), physical.end(), 0);
    return apart > 0 && static_cast<std::size_t>(apart) < physical.size();
}

std::string single_precision(const Soup& soup) {
    const bool fits = std::all_of(soup.points.begin(), soup.points.end(), [](const Point<3>& point) {
        return std::all_of(point.begin(), point.end(),
                           [](double x) { return static_cast<double>(static_cast<float>(x)) == x; });
    });
    return fits ? "" : "coordinates beyond single precision";
}

/// Whether the cells use all points and name them first in their order.
bool points_by_cells(const Soup& soup) {
    Index next = 0;
    for (const Index vertex : soup.simplices[static_cast<std::size_t>(soup.top_dimension())].vertices) {
        if (vertex > next) {
            return false;
        }
        next += vertex == next ? 1 : 0;
    }
    return next == soup.points.size();
}

/// Whether the numbers are neither absent nor first, first + 1, ... with `first` 0 or 1.
bool is_irregular(const Array<std::int64_t>& tags) {
    if (tags.empty() || tags[0] < 0 || tags[0] > 1) {
        return !tags.empty();
    }
    for (std::size_t i = 0; i < tags.size(); ++i) {
        if (tags[i] != tags[0] + static_cast<std::int64_t>(i)) {
            return true;
        }
    }
    return false;
}

/// Whether some group has cells of several geometric entities.
bool has_entities(const Soup& soup) {
    for (const SimplexBlock& block : soup.simplices) {
        std::set<std::int32_t> groups(block.physical.begin(), block.physical.end());
        std::set<std::int32_t> entities(block.entity.begin(), block.entity.end());
        if (entities.size() > std::max<std::size_t>(1, groups.size())) {
            return true;
        }
    }
    return false;
}

bool has_groups(const Soup& soup) {
    return std::any_of(soup.groups.begin(), soup.groups.end(),
                       [](const PatchList& groups) { return !groups.empty(); });
}

} // namespace

std::span<const Format> formats() {
    return table();
}

const Format* format_named(std::string_view name) {
    const auto found = std::find_if(table().begin(), table().end(),
                                    [&](const Format& format) { return format.name == name; });
    return found == table().end() ? nullptr : &*found;
}

const Format* format_of_extension(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    const auto found = std::find_if(table().begin(), table().end(), [&](const Format& format) {
        return std::find(format.extensions.begin(), format.extensions.end(), extension) !=
               format.extensions.end();
    });
    return found == table().end() ? nullptr : &*found;
}

const Format* format_of_content(const std::filesystem::path& path) {
    constexpr std::size_t shown = 4096;
    std::string start(shown, '\0');
    std::ifstream file{path, std::ios::binary};
    file.read(start.data(), static_cast<std::streamsize>(shown));
    start.resize(static_cast<std::size_t>(file.gcount()));
    if (start.empty()) {
        read_bytes(path); // a file that cannot be read at all is reported as that
    }
    const std::size_t first = std::min(start.find_first_not_of(" \t\r\n"), start.size());
    const auto shows = [&](std::string_view mark) {
        return mark.front() == '<' ? start.find(mark) != std::string::npos
                                   : start.compare(first, mark.size(), mark) == 0;
    };
    const auto found = std::find_if(table().begin(), table().end(), [&](const Format& format) {
        return format.read != nullptr && std::any_of(format.marks.begin(), format.marks.end(), shows);
    });
    return found == table().end() ? nullptr : &*found;
}

void require_offered(const Format& format, const WriteOptions& options, const std::string& prefix) {
    const auto require_one = [&](const char* name, const std::string& wanted,
                                 const std::vector<std::string_view>& offered) {
        if (wanted.empty() || std::find(offered.begin(), offered.end(), wanted) != offered.end()) {
            return;
        }
        throw UsageError{offered.empty()
                             ? fmt::format("{}{}: {} is written in one way only", prefix, name, format.title)
                             : fmt::format("{}{}: {} is written as {}, not as \"{}\"", prefix, name,
                                           format.title, fmt::join(offered, ", "), wanted)};
    };
    require_one("encoding", options.encoding, format.offers.encodings);
    require_one("version", options.version, format.offers.versions);
    if (options.pieces > 0 && !format.offers.pieces) {
        throw UsageError{
            fmt::format("{}pieces: {} is not written in pieces; .pvtu and MSH are", prefix, format.title)};
    }
    const auto is_default = [](const std::string& wanted, const std::vector<std::string_view>& offered) {
        return wanted.empty() || wanted == offered.front();
    };
    const Offers& offers = format.offers;
    if (options.pieces > 0 && offers.plain_pieces &&
        !(is_default(options.encoding, offers.encodings) && is_default(options.version, offers.versions))) {
        throw UsageError{fmt::format("{}pieces: {} in pieces is version {}, {}", prefix, format.title,
                                     offers.versions.front(), offers.encodings.front())};
    }
    if (options.four_dimensional && !format.offers.four_dimensional) {
        throw UsageError{fmt::format("{}four-dimensional: {} has no such dialect; Medit (.mesh) has one",
                                     prefix, format.title)};
    }
}

Soup read_mesh(const std::filesystem::path& path) {
    const Format* format = format_of_extension(path);
    if (format == nullptr || format->read == nullptr) {
        format = format_of_content(path);
    }
    if (format == nullptr) {
        throw InputError(fmt::format(
            "{}: neither the name nor the content is that of a mesh file that is read", path.string()));
    }
    return format->read(path);
}

bool keeps(const Format& format, const Soup& soup, Over over, const DataArray& array,
           const WriteOptions& options) {
    const Holds& holds = format.holds;
    if (over != Over::field && is_text(array)) {
        return false;
    }
    if (holds.keeps != nullptr) {
        return holds.keeps(soup, over, array, options);
    }
    return over == Over::points ? holds.point_data : over == Over::cells ? holds.cell_data : holds.field_data;
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

std::vector<std::string> losses(const Format& format, const Soup& soup, const WriteOptions& options) {
    const Holds& holds = format.holds;
    std::vector<std::string> lost;
    const auto lose = [&lost](const std::string& what, const std::string& names) {
        if (!names.empty()) {
            lost.push_back(what + names);
        }
    };
    const auto not_kept = [&](Over over) {
        return [&, over](const DataArray& array) { return !keeps(format, soup, over, array, options); };
    };
    const auto of_points_and_cells = [&](const auto& is) {
        const auto kept = [&](Over over) {
            return [&, over](const DataArray& array) {
                return is(array) && keeps(format, soup, over, array, options);
            };
        };
        return joined(names_of(soup.point_data, kept(Over::points)),
                      names_of(soup.cell_data, kept(Over::cells)));
    };
    lose("", lower_simplices(holds, soup));
    if (!holds.groups) {
        lose("", has_groups(soup) ? "groups of cells" : "");
    } else if (!holds.group_names) {
        lose("names of groups: ", group_names(soup));
    }
    lose("", holds.groups && !holds.no_group && has_cells_apart(soup) ? "that cells are in no group" : "");
    lose("point data ", names_of(soup.point_data, not_kept(Over::points)));
    lose("cell data ", names_of(soup.cell_data, not_kept(Over::cells)));
    lose("field data ", names_of(soup.field_data, not_kept(Over::field)));
    lose("digits above 2^53 in ", holds.wide_integers ? "" : of_points_and_cells(is_wide));
    lose("components in one array, as of ", holds.components ? "" : of_points_and_cells(is_taken_apart));
    lose("", holds.doubles ? "" : single_precision(soup));
    lose("", holds.shared_points || points_by_cells(soup) ? "" : "the order of points");
    return lost;
}

std::vector<std::string> lost_numbers(const Soup& soup) {
    std::vector<std::string> lost;
    if (has_entities(soup)) {
        lost.emplace_back("geometric entities");
    }
    if (is_irregular(soup.point_tags)) {
        lost.emplace_back("the file's own point numbers");
    }
    if (is_irregular(soup.simplices[static_cast<std::size_t>(soup.top_dimension())].tags)) {
        lost.emplace_back("the file's own cell numbers");
    }
    return lost;
}

} // namespace slabhull::io
