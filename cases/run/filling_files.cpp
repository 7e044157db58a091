// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/cases/filling_files.h"

#include "cases/run/index_rows.h"
#include "slabhull/core/error.h"
#include "slabhull/io/formats.h"
#include "slabhull/slab/hull_columns.h"
#include "slabhull/topology/adjacency.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

namespace slabhull {

namespace {

using io::Scalar;

template<std::size_t N>
Column<double> coordinates(std::span<const std::array<double, N>> points) {
    return {points.size(), N, [points](std::size_t begin, std::size_t end, double* out) {
                for (std::size_t row = begin; row < end; ++row) {
                    out = std::copy(points[row].begin(), points[row].end(), out);
                }
            }};
}

template<int D>
struct Side {
    Simplex<D> facet; ///< ascending
    std::int64_t number;
    friend auto operator<=>(const Side&, const Side&) = default;
};

template<int D>
Simplex<D> ascending(Simplex<D> facet) {
    std::sort(facet.begin(), facet.end());
    return facet;
}

/// For each facet of the boundary its cell and place there: cell * (D + 2) + place.
template<int D>
Array<std::int64_t> sides_of_facets(const Filling<D>& filling) {
    std::vector<Side<D>> open;
    open.reserve(filling.facets.size());
    for (std::size_t c = 0; c < filling.cells.size(); ++c) {
        for (std::size_t i = 0; i <= D + 1; ++i) {
            if (filling.neighbors[c][i] == no_index) {
                open.push_back({ascending<D>(outward_facet<D + 1>(filling.cells[c], static_cast<int>(i))),
                                static_cast<std::int64_t>(c * (D + 2) + i)});
            }
        }
    }
    std::sort(open.begin(), open.end());
    Array<std::int64_t> sides(filling.facets.size());
    for (std::size_t f = 0; f < sides.size(); ++f) {
        const Simplex<D> facet = ascending<D>(filling.facets[f]);
        const auto side = std::lower_bound(open.begin(), open.end(), Side<D>{facet, 0});
        if (side == open.end() || side->facet != facet) {
            throw GeometryError{fmt::format("facet {} of the hull is in no cell of the filling", f),
                                {{"facet", static_cast<std::int64_t>(f), {}}}};
        }
        sides[f] = side->number;
    }
    return sides;
}

template<int D>
io::SpaceTimeColumns space_time_columns(const Filling<D>& filling, std::span<const std::int64_t> sides) {
    io::SpaceTimeColumns mesh;
    mesh.dimension = D + 1;
    mesh.points = coordinates<D + 1>(filling.points);
    mesh.cells = index_rows<D + 2>(filling.cells);
    mesh.neighbors = neighbor_column<D + 2>(filling.neighbors);
    mesh.facets = index_rows<D + 1>(filling.facets);
    mesh.facet_attribute =
        Column<std::int64_t>::over(std::span<const FacetAttribute>{filling.facet_attribute});
    mesh.facet_side = Column<std::int64_t>::over(sides);
    mesh.vertex_id = integer_column(filling.vertex_ids);
    mesh.track_id = integer_column(filling.track_ids);
    mesh.time = filling.time;
    mesh.slab = filling.slab;
    return mesh;
}

std::string attribute_name(const PatchList& patches, FacetAttribute attribute) {
    return attribute == 1 ? "initial" : attribute == 2 ? "terminating" : patch_name(patches, attribute - 2);
}

/// The boundary as triangles beside the tetrahedra, a group for each attribute.
io::MeshColumns::Part boundary_part(const Filling<2>& filling) {
    io::MeshColumns::Part part{2, index_rows<3>(filling.facets), {}};
    for (std::size_t f = 0; f < filling.facets.size();) {
        const FacetAttribute attribute = filling.facet_attribute[f];
        std::size_t end = f;
        while (end < filling.facets.size() && filling.facet_attribute[end] == attribute) {
            ++end;
        }
        part.groups.push_back({f, end, attribute, attribute_name(filling.patches, attribute)});
        f = end;
    }
    return part;
}

/// In two dimensions and time a filling is a mesh of tetrahedra, which all formats hold.
io::MeshColumns mesh_columns(const Filling<2>& filling) {
    io::MeshColumns mesh;
    mesh.dimension = 3;
    mesh.points = coordinates<3>(filling.points);
    mesh.cells = index_rows<4>(filling.cells);
    mesh.groups = {{0, filling.cells.size(), 1, "slab"}};
    mesh.point_data = {{"vertex_id", Scalar::int64, integer_column(filling.vertex_ids)},
                       {"track_id", Scalar::int64, integer_column(filling.track_ids)}};
    mesh.field_data = {{"slab", 1, Array<std::int64_t>{filling.slab}},
                       {"time", 1, Array<double>(filling.time.begin(), filling.time.end())}};
    mesh.lower.push_back(boundary_part(filling));
    return mesh;
}

void write_as_mesh(io::AtomicFiles& files, const std::filesystem::path& path, const Filling<2>& filling,
                   const io::Format& format) {
    io::MeshColumns mesh = mesh_columns(filling);
    if (format.name == "vtu") {
        mesh.cell_data = {{"neighbors", Scalar::int64, neighbor_column<4>(filling.neighbors)}};
        mesh.lower.clear(); // of one kind of cells
    }
    format.write(files, path, mesh, {});
}

template<class Row, class Value>
Array<Row> rows_of(Array<Value>& values) {
    constexpr std::size_t width = std::tuple_size_v<Row>;
    Array<Row> rows(values.size() / width);
    for (std::size_t r = 0; r < rows.size(); ++r) {
        for (std::size_t k = 0; k < width; ++k) {
            const Value value = values[r * width + k];
            rows[r][k] = static_cast<typename Row::value_type>(value);
        }
    }
    Array<Value>{}.swap(values);
    return rows;
}

} // namespace

template<int D>
void write_filling(io::AtomicFiles& files, const std::filesystem::path& path, const Filling<D>& filling,
                   const std::string& format, const FillingFileOptions& options) {
    if constexpr (D == 2) {
        if (format == "vtu" || format == "msh") {
            return write_as_mesh(files, path, filling, *io::format_named(format));
        }
    }
    Array<std::int64_t> sides;
    if (format == "getfem") {
        sides = sides_of_facets(filling);
    }
    const io::SpaceTimeColumns mesh = space_time_columns<D>(filling, sides);
    io::AtomicFile& file = files.open(path);
    if (format == "mfem") {
        io::write_mfem(file, mesh, options.pentatope_code);
    } else if (format == "getfem") {
        io::write_getfem(file, mesh);
    } else if (format == "h5") {
        io::write_h5(file, mesh);
    } else {
        throw UsageError{fmt::format("{}: \"{}\" is no format of a filling", path.string(), format)};
    }
}

template<int D>
FillingColumns<D> FillingArrays<D>::columns() const {
    FillingColumns<D> columns;
    columns.points = points;
    columns.cells = cells;
    columns.facets = facets;
    if (!facet_attribute.empty()) {
        columns.facet_attribute = Column<std::int64_t>::over(std::span<const std::int64_t>{facet_attribute});
    }
    columns.neighbors = neighbors;
    return columns;
}

template<int D>
FillingArrays<D> filling_of_soup(io::SpaceTimeSoup& soup) {
    FillingArrays<D> arrays;
    arrays.points = rows_of<Point<D + 1>>(soup.points);
    arrays.cells = rows_of<Simplex<D + 1>>(soup.cells);
    arrays.facets = rows_of<Simplex<D>>(soup.facets);
    arrays.facet_attribute = std::move(soup.facet_attribute);
    arrays.neighbors = rows_of<Neighbors<D + 1>>(soup.neighbors); // -1 becomes no_index
    return arrays;
}

namespace {

template<int D>
void find_neighbors(Filling<D>& filling, std::vector<FacetDefect<D + 1>>& open) {
    Adjacency<D + 1> adjacency = build_adjacency<D + 1>(filling.cells, filling.points.size());
    for (const FacetDefect<D + 1>& defect : adjacency.defects) {
        if (defect.kind != FacetDefect<D + 1>::Kind::open) {
            throw GeometryError{
                fmt::format("cells {} share a facet as they must not; `slabhull check` tells more",
                            fmt::join(defect.cells, ", ")),
                {{"cell", defect.cells.front(), {}}}};
        }
    }
    filling.neighbors = std::move(adjacency.neighbors);
    open = std::move(adjacency.defects);
}

/// Outward, by ascending vertices.
template<int D>
void find_facets(const std::vector<FacetDefect<D + 1>>& open, Filling<D>& filling) {
    for (const FacetDefect<D + 1>& defect : open) {
        filling.facets.push_back(outward_facet<D + 1>(filling.cells[defect.cells.front()], defect.facet));
    }
}

template<int D>
FacetAttribute attribute_by_time(const Filling<D>& filling, const Simplex<D>& facet) {
    for (const int end : {0, 1}) {
        const double t = filling.time[static_cast<std::size_t>(end)];
        if (std::all_of(facet.begin(), facet.end(), [&](Index v) { return filling.points[v][D] == t; })) {
            return 1 + end;
        }
    }
    return 3;
}

IntegerList ids_or_none(Array<std::int64_t>&& ids, std::size_t count) {
    IntegerList list{std::move(ids)};
    if (list.empty()) {
        list.append_run(-1, count, 0);
    }
    return list;
}

} // namespace

template<int D>
Filling<D> filling_to_write(io::SpaceTimeSoup& soup) {
    FillingArrays<D> arrays = filling_of_soup<D>(soup);
    Filling<D> filling;
    filling.points = std::move(arrays.points);
    filling.cells = std::move(arrays.cells);
    filling.facets = std::move(arrays.facets);
    if (filling.points.empty() || filling.cells.empty()) {
        throw InputError{fmt::format("{}: there are no cells", soup.path)};
    }
    const auto later = [](const auto& a, const auto& b) { return a[D] < b[D]; };
    const auto [first, last] = std::minmax_element(filling.points.begin(), filling.points.end(), later);
    filling.time = {(*first)[D], (*last)[D]};
    std::vector<FacetDefect<D + 1>> open;
    find_neighbors<D>(filling, open);
    if (filling.facets.empty()) {
        find_facets<D>(open, filling);
    }
    if (arrays.facet_attribute.size() == filling.facets.size()) {
        filling.facet_attribute.assign(arrays.facet_attribute.begin(), arrays.facet_attribute.end());
    } else {
        for (const Simplex<D>& facet : filling.facets) {
            filling.facet_attribute.push_back(attribute_by_time(filling, facet));
        }
    }
    filling.vertex_ids = ids_or_none(std::move(soup.vertex_id), filling.points.size());
    filling.track_ids = ids_or_none(std::move(soup.track_id), filling.points.size());
    return filling;
}

template Filling<2> filling_to_write<2>(io::SpaceTimeSoup&);
template Filling<3> filling_to_write<3>(io::SpaceTimeSoup&);
template struct FillingArrays<2>;
template struct FillingArrays<3>;
template FillingArrays<2> filling_of_soup<2>(io::SpaceTimeSoup&);
template FillingArrays<3> filling_of_soup<3>(io::SpaceTimeSoup&);
template void write_filling<2>(io::AtomicFiles&, const std::filesystem::path&, const Filling<2>&,
                               const std::string&, const FillingFileOptions&);
template void write_filling<3>(io::AtomicFiles&, const std::filesystem::path&, const Filling<3>&,
                               const std::string&, const FillingFileOptions&);

} // namespace slabhull
