// SPDX-License-Identifier: BSD-3-Clause
#include "fillings.h"

#include "mesh_formats.h"
#include "slabhull/cases/filling_files.h"
#include "slabhull/cases/hull_files.h"
#include "slabhull/cases/report.h"
#include "slabhull/topology/adjacency.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
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

template<int D>
void write(io::SpaceTimeSoup& soup, const std::string& out, const std::string& to) {
    const std::string format = filling_format(out, to, D);
    const Filling<D> filling = filling_to_write<D>(soup);
    io::AtomicFiles files;
    write_filling<D>(files, out, filling, format);
    files.commit();
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

void convert_filling(const std::string& in, const std::string& from, const std::string& out,
                     const std::string& to) {
    io::SpaceTimeSoup soup =
        io::is_space_time_file(in) ? io::read_space_time(in) : filling_of_tetrahedra(read_named(in, from));
    soup.dimension == 3 ? write<2>(soup, out, to) : write<3>(soup, out, to);
}

} // namespace slabhull::tools
