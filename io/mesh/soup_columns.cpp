// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/soup.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <unordered_map>

namespace slabhull::io {

namespace {

using Group = MeshColumns::Group;

Column<double> columns_of(const Array<Point<3>>& points) {
    return {points.size(), 3, [&points](std::size_t begin, std::size_t end, double* out) {
                for (std::size_t row = begin; row < end; ++row) {
                    out = std::copy(points[row].begin(), points[row].end(), out);
                }
            }};
}

Column<std::int64_t> cells_of(const SimplexBlock& block, int dimension) {
    return Column<std::int64_t>::over(std::span<const Index>{block.vertices}, dimension + 1);
}

/// Runs of cells of one group, then the groups without cells.
std::vector<Group> groups_of(const SimplexBlock& block, const PatchList& list) {
    std::vector<Group> groups;
    std::set<PatchNumber> used;
    std::unordered_map<PatchNumber, std::string> names;
    for (const Patch& each : list) {
        names.emplace(each.number, each.name);
    }
    for (std::size_t cell = 0; cell < block.physical.size(); ++cell) {
        const PatchNumber number = block.physical[cell];
        if (groups.empty() || groups.back().number != number) {
            groups.push_back({cell, cell, number, names[number]});
            used.insert(number);
        }
        groups.back().end = cell + 1;
    }
    for (const Patch& each : list) {
        if (!block.physical.empty() && !used.contains(each.number)) {
            groups.push_back({block.physical.size(), block.physical.size(), each.number, each.name});
        }
    }
    return groups;
}

std::vector<DataColumn> columns_of(const std::vector<DataArray>& arrays) {
    std::vector<DataColumn> columns;
    for (const DataArray& array : arrays) {
        if (const auto* reals = std::get_if<Array<double>>(&array.values)) {
            columns.push_back({array.name, Scalar::float64,
                               Column<double>::over(std::span<const double>{*reals}, array.components)});
        } else if (const auto* integers = std::get_if<IntegerList>(&array.values)) {
            columns.push_back({array.name, Scalar::int64, integer_column(*integers, array.components)});
        }
    }
    return columns;
}

} // namespace

MeshColumns columns_of(const Soup& soup) {
    const auto top = static_cast<std::size_t>(soup.top_dimension());
    MeshColumns mesh;
    mesh.dimension = soup.top_dimension();
    mesh.points = columns_of(soup.points);
    mesh.cells = cells_of(soup.simplices[top], mesh.dimension);
    mesh.groups = groups_of(soup.simplices[top], soup.groups[top]);
    for (int dimension = mesh.dimension - 1; dimension >= 0; --dimension) {
        const auto d = static_cast<std::size_t>(dimension);
        if (!soup.simplices[d].vertices.empty()) {
            mesh.lower.push_back({dimension, cells_of(soup.simplices[d], dimension),
                                  groups_of(soup.simplices[d], soup.groups[d])});
        }
    }
    mesh.point_data = columns_of(soup.point_data);
    mesh.cell_data = columns_of(soup.cell_data);
    // "padding" is added by the VTU writer and has no meaning.
    std::copy_if(soup.field_data.begin(), soup.field_data.end(), std::back_inserter(mesh.field_data),
                 [](const DataArray& array) { return array.name != "padding"; });
    return mesh;
}

} // namespace slabhull::io
