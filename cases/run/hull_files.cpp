// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/cases/hull_files.h"

#include "cases/run/index_rows.h"
#include "cases/run/mesh_soup.h"
#include "edit/soup_cells.h"
#include "geometry/embedding/box_tree.h"
#include "slab/check/part_exchange.h"
#include "slabhull/core/error.h"
#include "slabhull/io/files.h"
#include "slabhull/slab/hull_columns.h"
#include "slabhull/topology/adjacency.h"
#include "slabhull/topology/cell_stretches.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <memory>
#include <mutex>
#include <unordered_map>

namespace slabhull {

namespace {

using io::DataArray;
using io::DataColumn;
using io::MeshColumns;
using io::Scalar;

/// A column computed row by row.
template<class T, class Value>
Column<T> computed(std::size_t rows, Value value) {
    return Column<T>{rows, 1, [value](std::size_t begin, std::size_t end, T* out) {
                         for (std::size_t row = begin; row < end; ++row) {
                             *out++ = static_cast<T>(value(row));
                         }
                     }};
}

/// Three coordinates for every point: (x, y, t) or (x, y, z) of a hull, (x, y, 0) or (x, y, z) of a cap.
template<std::size_t N>
Column<double> first_three(std::span<const Point<static_cast<int>(N)>> points) {
    return {points.size(), 3, [points](std::size_t begin, std::size_t end, double* out) {
                for (std::size_t row = begin; row < end; ++row) {
                    for (std::size_t k = 0; k < 3; ++k) {
                        *out++ = k < N ? points[row][k] : 0.0;
                    }
                }
            }};
}

Column<std::int64_t> ids(const Array<std::int64_t>& values) {
    return Column<std::int64_t>::over(std::span<const std::int64_t>{values});
}

/// The first cell of each point, found for a block of points after the other, as writers ask for them.
template<int D>
class CellsOfPoints {
public:
    explicit CellsOfPoints(const Hull<D>& hull)
        : hull_{hull}, stretches_{hull.cells, hull.points.size(), block},
          cell_(std::min(block, hull.points.size())) {}

    void copy(std::size_t begin, std::size_t end, std::int64_t* out) {
        const std::lock_guard guard{lock_};
        for (std::size_t v = begin; v < end; ++v) {
            if (v / block != block_) {
                find(v / block);
            }
            *out++ = std::int64_t{cell_[v % block]};
        }
    }

private:
    static constexpr std::size_t block = std::size_t{1} << 20;

    void find(std::size_t which) {
        block_ = which;
        const std::size_t begin = which * block;
        const std::size_t end = std::min(hull_.points.size(), begin + block);
        std::fill(cell_.begin(), cell_.end(), no_index);
        for (const Index stretch : stretches_.using_vertices(begin, end)) {
            stretches_.each_cell(stretch, [&](std::size_t c) {
                for (const Index v : hull_.cells[c]) {
                    if (begin <= v && v < end) {
                        Index& first = cell_[v - begin];
                        first = std::min(first, static_cast<Index>(c));
                    }
                }
            });
        }
    }

    const Hull<D>& hull_;
    CellStretches<D> stretches_;
    std::mutex lock_;
    Array<Index> cell_; ///< of the block's points
    std::size_t block_ = static_cast<std::size_t>(-1);
};

template<int D>
Column<std::int64_t> cells_of_points(const Hull<D>& hull) {
    const auto cells = std::make_shared<CellsOfPoints<D>>(hull);
    return {hull.points.size(), 1,
            [cells](std::size_t begin, std::size_t end, std::int64_t* out) { cells->copy(begin, end, out); }};
}

DataArray number_field(std::string name, Array<std::int64_t> values) {
    return {std::move(name), 1, std::move(values)};
}

DataArray real_field(std::string name, const std::vector<double>& values) {
    return {std::move(name), 1, Array<double>(values.begin(), values.end())};
}

void add_patch_fields(MeshColumns& mesh, const PatchList& patches) {
    Array<std::int64_t> numbers;
    std::vector<std::string> names;
    for (const Patch& each : patches) {
        numbers.push_back(each.number);
        names.push_back(each.name);
    }
    mesh.field_data.push_back(number_field("patch_number", std::move(numbers)));
    mesh.field_data.push_back({"patch_name", 1, std::move(names)});
}

/// The rows of a hull, or of a part of one, that files have.
template<int D>
struct HullRows {
    const HullOrder<D>& order;
    HullRange range; ///< of the cells
    std::span<const Point<D + 1>> points;
    std::span<const Simplex<D>> cells;
    const IntegerList& vertex_ids;
    const IntegerList& track_ids;
    /// Neighbours, with so much added to each.
    std::function<Column<std::int64_t>(std::int64_t shift)> neighbors;
};

template<int D>
HullRows<D> rows_of(const Hull<D>& hull) {
    return {hull,
            {0, hull.cells.size()},
            hull.points,
            hull.cells,
            hull.vertex_ids,
            hull.track_ids,
            [&hull](std::int64_t shift) {
                return index_rows(std::span<const Neighbors<D>>{hull.neighbors}, shift);
            }};
}

template<int D>
HullRows<D> rows_of(const HullPart<D>& part, const HullOrder<D>& order) {
    const auto neighbors = [&part](std::int64_t shift) {
        return Column<std::int64_t>{
            part.cells.size(), D + 1, [&part, shift](std::size_t begin, std::size_t end, std::int64_t* out) {
                for (std::size_t c = begin; c < end; ++c) {
                    for (const Index neighbor : part.neighbors[c]) {
                        *out++ = static_cast<std::int64_t>(part.in_hull(neighbor)) + shift;
                    }
                }
            }};
    };
    return {order, part.range, part.points, part.cells, part.vertex_ids, part.track_ids, neighbors};
}

template<int D>
Column<double> times_of(std::span<const Point<D + 1>> points) {
    return computed<double>(points.size(), [points](std::size_t v) { return points[v][D]; });
}

template<int D>
MeshColumns mesh_columns(const HullRows<D>& hull) {
    MeshColumns mesh;
    mesh.dimension = D;
    mesh.points = first_three<D + 1>(hull.points);
    mesh.cells = index_rows(hull.cells);
    return mesh;
}

template<int D>
MeshColumns vtu_columns(const HullRows<D>& hull, Column<std::int64_t> cells_of_points) {
    MeshColumns mesh = mesh_columns(hull);
    mesh.point_data = {{"t", Scalar::float64, times_of<D>(hull.points)},
                       {"vertex_id", Scalar::int64, integer_column(hull.vertex_ids)},
                       {"track_id", Scalar::int64, integer_column(hull.track_ids)},
                       {"cell", Scalar::int64, std::move(cells_of_points)}};
    mesh.cell_data = {{"region", Scalar::int32, region_column(hull.order, hull.range)},
                      {"patch", Scalar::int32, patch_column(hull.order, hull.range)},
                      {"layer", Scalar::int32, layer_column(hull.order, hull.range)},
                      {"neighbors", Scalar::int64, hull.neighbors(0)}};
    const HullOrder<D>& order = hull.order;
    mesh.field_data = {number_field("slab", {order.slab}),
                       {"time", 1, Array<double>{order.time[0], order.time[1]}},
                       number_field("dimension", {D})};
    add_patch_fields(mesh, order.patches);
    if (!order.adapt_settings.empty()) {
        mesh.field_data.push_back(real_field("adapt_settings", order.adapt_settings));
        mesh.field_data.push_back(real_field("adapt_spacing", order.adapt_spacing));
    }
    return mesh;
}

/// Runs of cells of one region or patch, in cell order.
template<int D>
std::vector<MeshColumns::Group> groups_of(const HullOrder<D>& hull, std::size_t cells) {
    PatchNumber largest = 0;
    std::unordered_map<PatchNumber, std::string> names; // patches, and then runs, may be very many
    for (const Patch& patch : hull.patches) {
        largest = std::max(largest, patch.number);
        names.emplace(patch.number, patch_name({patch}, patch.number));
    }
    std::vector<MeshColumns::Group> groups{{0, hull.initial_cells, largest + 1, "initial"}};
    for (std::size_t begin = hull.initial_cells; begin < hull.terminating_begin();) {
        const PatchNumber number = hull.patch(begin);
        const std::size_t end = hull.prism_end(begin);
        if (groups.back().number == number) {
            groups.back().end = end;
        } else {
            const auto name = names.find(number);
            groups.push_back(
                {begin, end, number, name != names.end() ? name->second : patch_name({}, number)});
        }
        begin = end;
    }
    groups.push_back({hull.terminating_begin(), cells, largest + 2, "terminating"});
    return groups;
}

template<int D>
MeshColumns msh_columns(const HullRows<D>& hull) {
    MeshColumns mesh = mesh_columns(hull);
    if constexpr (D == 3) {
        mesh.point_data.push_back({"t", Scalar::float64, times_of<D>(hull.points)});
    }
    mesh.point_data.push_back({"vertex_id", Scalar::int64, integer_column(hull.vertex_ids)});
    mesh.point_data.push_back({"track_id", Scalar::int64, integer_column(hull.track_ids)});
    // Element tags count from 1.
    mesh.cell_data = {{"neighbor", Scalar::int64, hull.neighbors(1)}};
    return mesh;
}

/// The lowest cell of the part that uses each of its points, as a number in the hull.
template<int D>
Array<std::int64_t> first_cells_here(const HullPart<D>& part) {
    Array<std::int64_t> first(part.points.size(), -1);
    for (std::size_t c = part.cells.size(); c-- > 0;) {
        for (const Index v : part.cells[c]) {
            first[v] = static_cast<std::int64_t>(part.range.first + c);
        }
    }
    return first;
}

std::size_t row_count(const DataArray& array) {
    const auto values = std::visit([](const auto& stored) { return stored.size(); }, array.values);
    return values / static_cast<std::size_t>(std::max(1, array.components));
}

/// The array, which may go, as whole numbers; MSH holds them as doubles.
IntegerList whole_numbers(const io::Soup& soup, DataArray&& array) {
    if (auto* integers = std::get_if<IntegerList>(&array.values)) {
        return std::move(*integers);
    }
    const auto* reals = std::get_if<Array<double>>(&array.values);
    return IntegerList::generated(reals != nullptr ? reals->size() : 0, [&](std::size_t k) {
        const double value = (*reals)[k];
        if (!(value >= -9e15 && value <= 9e15) ||
            value != static_cast<double>(static_cast<std::int64_t>(value))) {
            throw InputError(
                fmt::format("{}: array \"{}\": {} is not a whole number", soup.path, array.name, value));
        }
        return static_cast<std::int64_t>(value);
    });
}

/// A given array of whole numbers with the right shape, or an empty one. It is taken out of the soup's
/// arrays.
IntegerList take_numbers(const io::Soup& soup, std::vector<DataArray>& arrays, const std::string& name,
                         std::size_t rows, int components) {
    const auto array =
        std::find_if(arrays.begin(), arrays.end(), [&](const DataArray& each) { return each.name == name; });
    if (array == arrays.end()) {
        return {};
    }
    if (array->components != components || row_count(*array) != rows) {
        throw InputError(fmt::format("{}: array \"{}\" has {} rows of {}, expected {} of {}", soup.path,
                                     array->name, row_count(*array), array->components, rows, components));
    }
    DataArray taken = std::move(*array);
    arrays.erase(array);
    return whole_numbers(soup, std::move(taken));
}

/// In 2D + t the array repeats the third coordinate.
void require_same_times(const io::Soup& soup, const Array<double>& times) {
    for (std::size_t v = 0; v < times.size(); ++v) {
        if (soup.points[v][2] != times[v] && std::isfinite(soup.points[v][2])) {
            throw InputError(
                fmt::format("{}: point {} has t = {} in the point array \"t\", and {} as its third "
                            "coordinate: one of them is damaged",
                            soup.path, v, times[v], soup.points[v][2]),
                {{"vertex", static_cast<std::int64_t>(v), {}}});
        }
    }
}

template<int D>
void require_times(const io::Soup& soup) {
    if (D == 3 && soup_times(soup) == nullptr) {
        throw InputError(
            fmt::format("{}: needs a point array \"t\" of real numbers, one for each point", soup.path));
    }
    if (D == 2 && soup_times(soup) != nullptr) {
        require_same_times(soup, *soup_times(soup));
    }
}

/// The soup's points go into these from behind, so that no coordinate is held twice.
template<int D>
Array<Point<D + 1>> take_points(io::Soup& soup) {
    if constexpr (D == 2) {
        return std::move(soup.points);
    } else {
        const auto array = std::find_if(soup.point_data.begin(), soup.point_data.end(),
                                        [](const DataArray& each) { return each.name == "t"; });
        auto& times = std::get<Array<double>>(array->values);
        constexpr std::size_t block = 1 << 20;
        Array<Point<4>> points(soup.points.size());
        for (std::size_t end = points.size(); end > 0;) {
            const std::size_t begin = end - std::min(end, block);
            for (std::size_t v = begin; v < end; ++v) {
                const Point<3>& x = soup.points[v];
                points[v] = {x[0], x[1], x[2], times[v]};
            }
            shorten(soup.points, begin);
            shorten(times, begin);
            end = begin;
        }
        return points;
    }
}

/// What an MSH says through physical groups: regions by name, the other groups are patches.
template<int D>
void read_groups(const io::Soup& soup, HullArrays<D>& hull) {
    PatchNumber initial = 0;
    PatchNumber terminating = 0;
    for (const Patch& group : soup.groups[D]) {
        if (group.name == "initial") {
            initial = group.number;
        } else if (group.name == "terminating") {
            terminating = group.number;
        } else {
            hull.patches.push_back(group);
        }
    }
    if (initial == 0 || terminating == 0) {
        hull.patches.clear();
        return;
    }
    for (const PatchNumber group : soup.simplices[D].physical) {
        const bool cap = group == initial || group == terminating;
        hull.region.push_back(cap ? (group == initial ? 0 : 2) : 1);
        hull.patch.push_back(cap ? 0 : group);
    }
}

template<int D>
IntegerList take_msh_neighbors(io::Soup& soup, std::size_t cells) {
    std::array<IntegerList, D + 1> tags;
    for (std::size_t i = 0; i <= D; ++i) {
        tags[i] = take_numbers(soup, soup.cell_data, fmt::format("neighbor_{}", i), cells, 1);
        if (tags[i].empty()) {
            return {};
        }
    }
    return IntegerList::generated(cells * (D + 1),
                                  [&](std::size_t k) { return tags[k % (D + 1)][k / (D + 1)] - 1; });
}

template<int D>
void read_fields(const io::Soup& soup, HullArrays<D>& hull) {
    if (const DataArray* time = soup.find_field_data("time")) {
        if (const auto* values = std::get_if<Array<double>>(&time->values);
            values != nullptr && values->size() == 2) {
            hull.time = {{(*values)[0], (*values)[1]}};
        }
    }
    const DataArray* numbers = soup.find_field_data("patch_number");
    const DataArray* names = soup.find_field_data("patch_name");
    if (numbers != nullptr && names != nullptr) {
        const IntegerList given = whole_numbers(soup, DataArray{*numbers});
        const auto* texts = std::get_if<std::vector<std::string>>(&names->values);
        for (std::size_t i = 0; texts != nullptr && i < std::min(given.size(), texts->size()); ++i) {
            hull.patches.push_back({static_cast<PatchNumber>(given[i]), (*texts)[i]});
        }
    }
}

Column<std::int64_t> optional_column(const IntegerList& values, int components = 1) {
    return values.empty() ? Column<std::int64_t>{} : integer_column(values, components);
}

/// The array as a table, without a copy: -1 in 32 bits is no_index. Nothing where it cannot be one of that
/// many cells, or where these are so many that it has 64 bits.
template<int D>
std::span<const Neighbors<D>> as_table(const IntegerList& neighbors, std::size_t cells) {
    const std::span<const std::int32_t> narrow = neighbors.narrow();
    const bool possible = std::all_of(narrow.begin(), narrow.end(), [cells](std::int32_t n) {
        return n >= -1 && n < static_cast<std::int64_t>(cells);
    });
    return possible ? std::span{reinterpret_cast<const Neighbors<D>*>(narrow.data()), narrow.size() / (D + 1)}
                    : std::span<const Neighbors<D>>{};
}

} // namespace

template<int D>
void write_hull(io::AtomicFiles& files, const std::filesystem::path& path, const Hull<D>& hull,
                const std::string& format, const io::WriteOptions& options) {
    MeshColumns mesh;
    if (format == "msh") {
        mesh = msh_columns(rows_of(hull));
        mesh.groups = groups_of<D>(hull, hull.cells.size());
    } else {
        mesh = vtu_columns(rows_of(hull), cells_of_points(hull));
    }
    io::format_named(format)->write(files, path, mesh, options);
}

template<int D>
PartToWrite<D> part_to_write(const HullPart<D>& part, const HullOrder<D>& order, Communicator& ranks) {
    PartToWrite<D> all{part,
                       order,
                       static_cast<std::size_t>(ranks.rank()),
                       static_cast<std::size_t>(ranks.size()),
                       lowest_at_points<std::int64_t>(part, ranks, first_cells_here(part)),
                       {}};
    Box<3> box;
    for (const Point<D + 1>& point : part.points) {
        box.include(Point<3>{point[0], point[1], point[2]});
    }
    for (const Box<3>& of_rank : ranks.gather(box)) {
        box.include(of_rank);
    }
    all.box = {box.low, box.high};
    return all;
}

template<int D>
void write_part(io::AtomicFiles& files, const std::filesystem::path& path, const PartToWrite<D>& part,
                const std::string& format, const io::WriteOptions& options) {
    const HullRows<D> rows = rows_of(part.part, part.order);
    const std::span<const std::int64_t> first_cells{part.first_cells};
    io::PieceColumns piece;
    piece.mesh =
        format == "msh" ? msh_columns(rows) : vtu_columns(rows, Column<std::int64_t>::over(first_cells));
    piece.pieces = part.parts;
    piece.number = part.number;
    piece.all_cells = part.part.hull_cells;
    piece.first_cell = part.part.range.first;
    piece.points = part.part.points_used;
    if (format == "msh") {
        piece.groups = groups_of<D>(part.order, part.part.hull_cells);
    }
    piece.lower_corner = part.box[0];
    piece.upper_corner = part.box[1];
    io::format_named(format)->write_piece(files, path, piece, options);
}

template<int D>
void write_cap(io::AtomicFile& file, const SpatialMesh<D>& cap, double time) {
    MeshColumns mesh;
    mesh.dimension = D;
    mesh.points = first_three<D>(cap.points);
    mesh.cells = index_rows(std::span<const Simplex<D>>{cap.cells});
    mesh.point_data = {{"vertex_id", Scalar::int64, ids(cap.vertex_ids)},
                       {"track_id", Scalar::int64, ids(cap.track_ids)}};
    mesh.field_data = {{"time", 1, Array<double>{time}}, number_field("dimension", {D})};
    io::write_vtu(file, mesh);
}

template<int D>
void write_terminating_cap(io::AtomicFile& file, const Hull<D>& hull) {
    const std::size_t first_point = hull.terminating_points_begin();
    const std::size_t first_cell = hull.terminating_begin();
    MeshColumns mesh;
    mesh.dimension = D;
    mesh.points = {hull.points.size() - first_point, 3,
                   [&hull, first_point](std::size_t begin, std::size_t end, double* out) {
                       for (std::size_t v = first_point + begin; v < first_point + end; ++v) {
                           for (std::size_t k = 0; k < 3; ++k) {
                               *out++ = k < D ? hull.points[v][k] : 0.0;
                           }
                       }
                   }};
    mesh.cells = index_rows(std::span<const Simplex<D>>{hull.cells}.subspan(first_cell),
                            -static_cast<std::int64_t>(first_point));
    mesh.point_data = {{"vertex_id", Scalar::int64, integer_column(hull.vertex_ids, 1, first_point)},
                       {"track_id", Scalar::int64, integer_column(hull.track_ids, 1, first_point)}};
    mesh.field_data = {{"time", 1, Array<double>{hull.time[1]}}, number_field("dimension", {D})};
    io::write_vtu(file, mesh);
}

template<int D>
SpatialMesh<D> read_cap(const std::filesystem::path& path) {
    io::Soup soup = io::read_vtu(path);
    MeshArrays<D> mesh = mesh_of_soup<D>(soup);
    const auto ids = [&](const char* name) {
        return take_numbers(soup, soup.point_data, name, mesh.points.size(), 1);
    };
    SpatialMesh<D> cap;
    const IntegerList vertex_ids = ids("vertex_id");
    const IntegerList track_ids = ids("track_id");
    cap.vertex_ids.assign(vertex_ids.begin(), vertex_ids.end());
    cap.track_ids.assign(track_ids.begin(), track_ids.end());
    if (cap.vertex_ids.empty() || cap.track_ids.empty()) {
        throw InputError(fmt::format("{}: has no vertex_id and track_id of a cap", path.string()));
    }
    cap.neighbors = build_adjacency<D>(mesh.cells, mesh.points.size()).neighbors;
    cap.points = std::move(mesh.points);
    cap.cells = std::move(mesh.cells);
    return cap;
}

template<int D>
void read_slab_fields(const io::Soup& soup, Hull<D>& hull) {
    if (const DataArray* slab = soup.find_field_data("slab")) {
        const auto* numbers = std::get_if<IntegerList>(&slab->values);
        hull.slab = numbers != nullptr && !numbers->empty() ? static_cast<int>((*numbers)[0]) : hull.slab;
    }
    const auto read = [&](const char* name, std::vector<double>& numbers) {
        if (const DataArray* field = soup.find_field_data(name)) {
            if (const auto* values = std::get_if<Array<double>>(&field->values)) {
                numbers.assign(values->begin(), values->end());
            }
        }
    };
    read("adapt_settings", hull.adapt_settings);
    read("adapt_spacing", hull.adapt_spacing);
}

template<int D>
void write_section(io::AtomicFile& file, const Section<D>& section) {
    const Surface<D>& surface = section.surface;
    const auto over = [](const auto& values) {
        return Column<std::int64_t>::over(std::span{values.data(), values.size()});
    };
    MeshColumns mesh;
    mesh.dimension = D - 1;
    mesh.points = first_three<D>(surface.points);
    mesh.cells = index_rows(std::span<const Facet<D>>{surface.facets});
    mesh.point_data = {{"vertex_id", Scalar::int64, ids(section.vertex_ids)},
                       {"track_id", Scalar::int64, ids(section.track_ids)}};
    mesh.cell_data = {{"patch", Scalar::int32, over(surface.patch)},
                      {"hull_cell", Scalar::int64, over(section.hull_cell)}};
    mesh.field_data = {{"time", 1, Array<double>{section.time}}, number_field("dimension", {D})};
    add_patch_fields(mesh, surface.patches);
    io::write_vtu(file, mesh);
}

template<int D>
void write_section(io::AtomicFile& file, const FillingSection<D>& section,
                   std::span<const VertexValues> solution) {
    const auto of_edge = [&section](auto member) {
        using Value =
            std::conditional_t<std::is_same_v<decltype(member), double PointOnEdge::*>, double, std::int64_t>;
        return computed<Value>(section.edge.size(), [&section, member](std::size_t v) {
            return static_cast<Value>(section.edge[v].*member);
        });
    };
    MeshColumns mesh;
    mesh.dimension = D;
    mesh.points = first_three<D>(section.points);
    mesh.cells = index_rows(std::span<const Simplex<D>>{section.cells});
    mesh.point_data = {{"lower_vertex", Scalar::int64, of_edge(&PointOnEdge::lower)},
                       {"upper_vertex", Scalar::int64, of_edge(&PointOnEdge::upper)},
                       {"share", Scalar::float64, of_edge(&PointOnEdge::share)}};
    for (const VertexValues& at_vertices : solution) {
        mesh.point_data.push_back(
            {at_vertices.name, Scalar::float64,
             computed<double>(section.edge.size(), [&section, values = at_vertices.values](std::size_t v) {
                 return section.edge[v].value(values);
             })});
    }
    mesh.cell_data = {
        {"filling_cell", Scalar::int64,
         Column<std::int64_t>::over(std::span{section.filling_cell.data(), section.filling_cell.size()})}};
    mesh.field_data = {{"time", 1, Array<double>{section.time}}, number_field("dimension", {D})};
    io::write_vtu(file, mesh);
}

MeshKind kind_of(const io::Soup& soup) {
    const int dimension = soup.top_dimension();
    if (dimension < 2) {
        throw InputError(fmt::format("{}: has neither triangles nor tetrahedra", soup.path));
    }
    const PatchList& groups = soup.groups[static_cast<std::size_t>(dimension)];
    return {dimension, soup.find_point_data("t") != nullptr || patch_number(groups, "terminating") != 0};
}

template<int D>
HullArrays<D> hull_of_soup(io::Soup& soup) {
    HullArrays<D> hull;
    const std::size_t cells = soup.simplices[D].size(D);
    const std::size_t points = soup.points.size();
    const auto of_cells = [&](const char* name, int components = 1) {
        return take_numbers(soup, soup.cell_data, name, cells, components);
    };
    const auto of_points = [&](const char* name) {
        return take_numbers(soup, soup.point_data, name, points, 1);
    };
    require_times<D>(soup);
    read_fields(soup, hull);
    const bool of_msh = soup.find_cell_data("neighbor_0") != nullptr;
    const bool has_regions = soup.find_cell_data("region") != nullptr;
    hull.layer = of_cells("layer");
    if (has_regions) {
        hull.region = of_cells("region");
        hull.patch = of_cells("patch");
    } else {
        read_groups(soup, hull);
    }
    hull.neighbors = has_regions ? of_cells("neighbors", D + 1) : take_msh_neighbors<D>(soup, cells);
    hull.vertex_id = of_points("vertex_id");
    hull.track_id = of_points("track_id");
    hull.cell_of_vertex = of_points("cell");
    if (of_msh) { // an MSH has element tags there, too
        hull.cell_of_vertex = IntegerList::generated(
            hull.cell_of_vertex.size(), [&](std::size_t v) { return hull.cell_of_vertex[v] - 1; });
    }
    hull.vertices = std::move(soup.simplices[D].vertices);
    hull.points = take_points<D>(soup);
    soup.cell_data.clear();
    soup.point_data.clear();
    return hull;
}

template<int D>
HullColumns<D> HullArrays<D>::columns() const {
    HullColumns<D> all;
    all.points = points;
    all.cells = as_simplices<D>(vertices);
    all.region = optional_column(region);
    all.patch = optional_column(patch);
    all.layer = optional_column(layer);
    all.vertex_id = optional_column(vertex_id);
    all.track_id = optional_column(track_id);
    all.neighbors = optional_column(neighbors, D + 1);
    all.neighbor_table = as_table<D>(neighbors, all.cells.size());
    all.cell_of_vertex = optional_column(cell_of_vertex);
    all.patches = patches;
    all.time = time;
    return all;
}

template<int D>
MeshArrays<D> mesh_of_soup(const io::Soup& soup) {
    MeshArrays<D> mesh;
    const std::span<const Simplex<D>> cells = simplices_of<D>(soup);
    mesh.cells.assign(cells.begin(), cells.end());
    for (std::size_t v = 0; v < soup.points.size(); ++v) {
        mesh.points.push_back(point_in_space<D>(soup, v));
    }
    return mesh;
}

template void write_hull<2>(io::AtomicFiles&, const std::filesystem::path&, const Hull<2>&,
                            const std::string&, const io::WriteOptions&);
template void write_hull<3>(io::AtomicFiles&, const std::filesystem::path&, const Hull<3>&,
                            const std::string&, const io::WriteOptions&);
template PartToWrite<2> part_to_write<2>(const HullPart<2>&, const HullOrder<2>&, Communicator&);
template PartToWrite<3> part_to_write<3>(const HullPart<3>&, const HullOrder<3>&, Communicator&);
template void write_part<2>(io::AtomicFiles&, const std::filesystem::path&, const PartToWrite<2>&,
                            const std::string&, const io::WriteOptions&);
template void write_part<3>(io::AtomicFiles&, const std::filesystem::path&, const PartToWrite<3>&,
                            const std::string&, const io::WriteOptions&);
template void write_cap<2>(io::AtomicFile&, const SpatialMesh<2>&, double);
template void write_cap<3>(io::AtomicFile&, const SpatialMesh<3>&, double);
template void write_terminating_cap<2>(io::AtomicFile&, const Hull<2>&);
template void write_terminating_cap<3>(io::AtomicFile&, const Hull<3>&);
template SpatialMesh<2> read_cap<2>(const std::filesystem::path&);
template SpatialMesh<3> read_cap<3>(const std::filesystem::path&);
template void write_section<2>(io::AtomicFile&, const Section<2>&);
template void write_section<3>(io::AtomicFile&, const Section<3>&);
template void write_section<2>(io::AtomicFile&, const FillingSection<2>&, std::span<const VertexValues>);
template void write_section<3>(io::AtomicFile&, const FillingSection<3>&, std::span<const VertexValues>);
template void read_slab_fields<2>(const io::Soup&, Hull<2>&);
template void read_slab_fields<3>(const io::Soup&, Hull<3>&);
template struct HullArrays<2>;
template struct HullArrays<3>;
template HullArrays<2> hull_of_soup<2>(io::Soup&);
template HullArrays<3> hull_of_soup<3>(io::Soup&);
template MeshArrays<2> mesh_of_soup<2>(const io::Soup&);
template MeshArrays<3> mesh_of_soup<3>(const io::Soup&);

} // namespace slabhull
