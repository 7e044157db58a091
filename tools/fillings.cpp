// SPDX-License-Identifier: BSD-3-Clause
#include "fillings.h"

#include "mesh_formats.h"
#include "slabhull/cases/filling_files.h"
#include "slabhull/cases/hull_files.h"
#include "slabhull/cases/report.h"
#include "slabhull/core/error.h"
#include "slabhull/io/formats.h"
#include "slabhull/topology/adjacency.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace slabhull::tools {

namespace {

template<int D>
void tell(const std::string& file, io::SpaceTimeSoup& soup, bool json) {
    const bool with_ids = !soup.vertex_id.empty();
    const FillingArrays<D> arrays = filling_of_soup<D>(soup);
    const FillingReport seen = check_filling<D>(arrays.columns());
    if (json) {
        nlohmann::ordered_json out{{"file", file}, {"kind", "filling"}};
        out.update(nlohmann::ordered_json::parse(report_as_json(seen)));
        fmt::print("{}\n", out.dump(2));
        return;
    }
    fmt::print("{}: filling of a slab in {}D+t, t = {:.10g} to {:.10g}\n", file, D, seen.time[0],
               seen.time[1]);
    fmt::print("  {} points{}, {} {}, volume {:.10g}\n", seen.vertices, with_ids ? " with ids" : "",
               seen.cells, D == 2 ? "tetrahedra" : "pentatopes", seen.volume);
    for (const auto& [attribute, facets] : seen.facets_by_attribute) {
        fmt::print("  facets of attribute {}: {}\n", attribute, facets);
    }
    fmt::print("  {}\n", seen.clean() ? "sound" : "not sound: `slabhull check` tells why");
}

bool is_of_fillings_only(const std::string& out, const std::string& to) {
    const std::string extension = std::filesystem::path{out}.extension().string();
    const std::string name = !to.empty() ? to : extension.empty() ? "" : extension.substr(1);
    return name == "getfem" || name == "h5";
}

/// Takes the mesh's triangles as the outer facets, and the numbers of their groups as attributes, if there
/// are as many as the tetrahedra have outer facets.
void take_facets(const io::Soup& mesh, std::size_t outer_facets, io::SpaceTimeSoup& soup) {
    const io::SimplexBlock& triangles = mesh.simplices[2];
    const auto in_group = [](PatchNumber group) { return group > 0; };
    if (triangles.size(2) == outer_facets && triangles.physical.size() == outer_facets &&
        std::all_of(triangles.physical.begin(), triangles.physical.end(), in_group)) {
        soup.facets.assign(triangles.vertices.begin(), triangles.vertices.end());
        soup.facet_attribute.assign(triangles.physical.begin(), triangles.physical.end());
    }
}

Array<std::int64_t> point_numbers(const io::Soup& mesh, const char* name) {
    Array<std::int64_t> numbers;
    if (const io::DataArray* data = mesh.find_point_data(name)) {
        if (const auto* list = std::get_if<IntegerList>(&data->values)) {
            numbers.assign(list->begin(), list->end());
        }
    }
    return numbers;
}

/// Caps have the ids of vertices, and one time.
bool is_cap(const io::Soup& mesh) {
    const io::DataArray* time = mesh.find_field_data("time");
    const auto* values = time == nullptr ? nullptr : std::get_if<Array<double>>(&time->values);
    return values != nullptr && values->size() == 1 && mesh.find_point_data("vertex_id") != nullptr;
}

void require_filling(const io::Soup& mesh) {
    const bool hull = kind_of(mesh).hull;
    if (hull || is_cap(mesh)) {
        throw InputError{
            fmt::format("{}: the {} of a slab, but the formats getfem and h5 are for fillings; {}", mesh.path,
                        hull ? "hull" : "cap",
                        hull ? "slabhull fill makes one of it"
                             : "convert it to a format of meshes, such as .vtu or .msh")};
    }
}

/// What is not taken of a mesh. Facets become attributes, if they are the outer ones.
std::vector<std::string> not_taken(const io::Soup& mesh, bool facets) {
    io::Format taken;
    taken.features.groups = true;
    taken.features.group_names = false;
    if (facets) {
        taken.features.min_lower_dimension = 2;
    }
    taken.features.stores_array = [](const io::Soup&, io::ArrayAssociation, const io::DataArray& array,
                                     const io::WriteOptions&) {
        return array.name == "vertex_id" || array.name == "track_id" || array.name == "neighbors" ||
               array.name == "time";
    };
    return io::losses(taken, mesh, {});
}

/// What was taken, but is not in files of the format.
std::vector<std::string> not_held(const io::SpaceTimeSoup& soup, const std::string& format) {
    std::vector<std::string> lost;
    if (!soup.vertex_id.empty() && (format == "mfem" || format == "getfem")) {
        lost.emplace_back("point data vertex_id, track_id");
    }
    if (!soup.facet_attribute.empty() && format == "vtu") {
        lost.emplace_back("attributes of facets");
    }
    return lost;
}

std::string title_of(const std::string& format) {
    return format == "h5"       ? "HDF5"
           : format == "getfem" ? "GetFEM"
                                : std::string{io::format_named(format)->title};
}

template<int D>
void write(const FillingConversion& conversion, io::SpaceTimeSoup& soup, std::vector<std::string> lost) {
    const std::string format = filling_format(conversion.out, conversion.to, D);
    const std::vector<std::string> also_lost = not_held(soup, format);
    lost.insert(lost.end(), also_lost.begin(), also_lost.end());
    const Filling<D> filling = filling_to_write<D>(soup);
    io::AtomicFiles files;
    write_filling<D>(files, conversion.out, filling, format);
    conversion.read.require_none(files.paths());
    if (!lost.empty()) {
        fmt::print(stderr, "slabhull: {}: {} does not hold: {}\n", conversion.out, title_of(format),
                   fmt::join(lost, "; "));
    }
    files.commit();
    fmt::print("{}: {} points, {} {}\n", conversion.out, filling.points.size(), filling.cells.size(),
               D == 2 ? "tetrahedra" : "pentatopes");
}

} // namespace

io::SpaceTimeSoup filling_of_tetrahedra(const io::Soup& mesh) {
    const MeshArrays<3> arrays = mesh_of_soup<3>(mesh);
    io::SpaceTimeSoup soup;
    soup.path = mesh.path;
    soup.dimension = 3;
    for (const Point<3>& point : arrays.points) {
        soup.points.insert(soup.points.end(), point.begin(), point.end());
    }
    for (const Simplex<3>& cell : arrays.cells) {
        soup.cells.insert(soup.cells.end(), cell.begin(), cell.end());
    }
    take_facets(mesh, build_adjacency<3>(arrays.cells, arrays.points.size()).defects.size(), soup);
    soup.vertex_id = point_numbers(mesh, "vertex_id");
    soup.track_id = point_numbers(mesh, "track_id");
    return soup;
}

bool tell_filling(const std::string& file, bool json) {
    if (!io::is_space_time_file(file)) {
        return false;
    }
    io::SpaceTimeSoup soup = io::read_space_time(file);
    soup.dimension == 3 ? tell<2>(file, soup, json) : tell<3>(file, soup, json);
    return true;
}

bool converts_filling(const std::string& in, const std::string& out, const std::string& to) {
    return io::is_space_time_file(in) || is_of_fillings_only(out, to);
}

void convert_filling(const FillingConversion& conversion) {
    io::SpaceTimeSoup soup;
    std::vector<std::string> lost;
    if (io::is_space_time_file(conversion.in)) {
        soup = io::read_space_time(conversion.in);
    } else {
        const io::Soup mesh = read_named(conversion.in, conversion.from);
        require_filling(mesh);
        soup = filling_of_tetrahedra(mesh);
        lost = not_taken(mesh, !soup.facets.empty());
    }
    soup.dimension == 3 ? write<2>(conversion, soup, std::move(lost))
                        : write<3>(conversion, soup, std::move(lost));
}

} // namespace slabhull::tools
