// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/formats.h"

#include "file_cursor.h"
#include "slabhull/io/files.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
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

void write_raw_vtu(AtomicFile& file, const MeshColumns& mesh) {
    write_vtu(file, mesh);
}
void write_plain_medit(AtomicFile& file, const MeshColumns& mesh) {
    write_medit(file, mesh);
}

void write_pvtu_pieces(const std::filesystem::path& path, const MeshColumns& mesh, std::size_t pieces) {
    write_pvtu(path, mesh, pieces);
}

constexpr Holds vtu_holds{.point_data = true, .cell_data = true, .field_data = true};
constexpr Holds msh_holds{.lower_simplices = true,
                          .groups = true,
                          .point_data = true,
                          .cell_data = true,
                          .wide_integers = false,
                          .tags = true};

constexpr Holds numbered_groups{.groups = true};
constexpr Holds triangles_only{.least_dimension = 2, .most_dimension = 2};

/// A line for each format; one without a writer says nothing of what it holds.
const std::vector<Format>& table() {
    static const std::vector<Format> all{
        {"msh", "MSH", {".msh"}, read_msh, write_msh, msh_holds},
        {"vtu", "VTU", {".vtu"}, read_vtu, write_raw_vtu, vtu_holds},
        {"pvtu", "partitioned VTU", {".pvtu"}, read_pvtu, nullptr, vtu_holds, write_pvtu_pieces},
        {"vtk", "legacy VTK", {".vtk"}, read_vtk, write_vtk, vtu_holds},
        {"tetgen", "TetGen", {".node", ".ele", ".face", ".poly", ".smesh"}, read_tetgen, nullptr, {}},
        {"medit", "Medit", {".mesh"}, read_medit, write_plain_medit, numbered_groups},
        {"mfem", "MFEM", {".mfem"}, read_mfem, write_mfem, numbered_groups},
        {"avro", "avro", {".avro"}, read_avro, write_avro, {.least_dimension = 1}},
        {"stl", "STL", {".stl"}, read_stl, write_stl, triangles_only},
        {"off", "OFF", {".off"}, read_off, write_off, triangles_only},
        {"obj", "OBJ", {".obj"}, read_obj, write_obj, triangles_only},
        {"ply", "PLY", {".ply"}, read_ply, write_ply, triangles_only},
    };
    return all;
}

std::string names_of(const std::vector<DataArray>& arrays) {
    std::string names;
    for (const DataArray& array : arrays) {
        if (array.name != "padding") { // the VTU writer's own
            names += (names.empty() ? "" : ", ") + array.name;
        }
    }
    return names;
}

bool is_text(const DataArray& array) {
    return std::holds_alternative<std::vector<std::string>>(array.values);
}

std::string names_of_texts(const Soup& soup) {
    std::vector<DataArray> texts;
    std::copy_if(soup.point_data.begin(), soup.point_data.end(), std::back_inserter(texts), is_text);
    std::copy_if(soup.cell_data.begin(), soup.cell_data.end(), std::back_inserter(texts), is_text);
    return names_of(texts);
}

std::string names_of_wide(const Soup& soup) {
    constexpr std::int64_t widest = std::int64_t{1} << 53;
    std::string names;
    for (const auto* arrays : {&soup.point_data, &soup.cell_data}) {
        for (const DataArray& array : *arrays) {
            const auto* values = std::get_if<Array<std::int64_t>>(&array.values);
            if (values != nullptr && std::any_of(values->begin(), values->end(), [](std::int64_t value) {
                    return value > widest || value < -widest;
                })) {
                names += (names.empty() ? "" : ", ") + array.name;
            }
        }
    }
    return names;
}

std::string lower_simplices(const Soup& soup) {
    constexpr std::array<const char*, 4> kinds{"points", "lines", "triangles", "tetrahedra"};
    std::string text;
    for (int dimension = soup.top_dimension() - 1; dimension >= 0; --dimension) {
        const auto d = static_cast<std::size_t>(dimension);
        if (const std::size_t count = soup.simplices[d].size(dimension); count > 0) {
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, kinds[d]);
        }
    }
    return text;
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

std::vector<std::string> losses(const Format& format, const Soup& soup) {
    const Holds& holds = format.holds;
    std::vector<std::string> lost;
    const auto lose = [&lost](bool held, const char* what, const std::string& names) {
        if (!held && !names.empty()) {
            lost.push_back(what + names);
        }
    };
    lose(holds.lower_simplices, "", lower_simplices(soup));
    lose(holds.groups, "", has_groups(soup) ? "groups of cells" : "");
    lose(holds.point_data, "point data ", names_of(soup.point_data));
    lose(holds.cell_data, "cell data ", names_of(soup.cell_data));
    lose(holds.field_data, "field data ", names_of(soup.field_data));
    lose(!holds.point_data && !holds.cell_data, "texts ", names_of_texts(soup));
    lose(holds.wide_integers, "digits above 2^53 in ", names_of_wide(soup));
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
