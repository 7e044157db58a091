// SPDX-License-Identifier: BSD-3-Clause
#include "edit/soup_rows.h"

#include "core/rows.h"
#include "core/used_vertices.h"
#include "edit/soup_cells.h"

#include <algorithm>
#include <utility>

namespace slabhull::detail {

namespace {

void renumber(IntegerList& values, const Array<Index>& fresh) {
    values = IntegerList::generated(values.size(), [&](std::size_t k) {
        const std::int64_t value = values[k];
        const bool stays = value >= 0 && static_cast<std::size_t>(value) < fresh.size() &&
                           fresh[static_cast<std::size_t>(value)] != no_index;
        return stays ? std::int64_t{fresh[static_cast<std::size_t>(value)]} : -1;
    });
}

IntegerList* neighbors_of(io::Soup& soup) {
    return whole_numbers(soup.cell_data, "neighbors", soup.top_dimension() + 1);
}

} // namespace

Array<Index> inverse(const Order& order, std::size_t count) {
    Array<Index> fresh;
    fresh.assign(count, no_index);
    for (std::size_t i = 0; i < order.size(); ++i) {
        fresh[order[i]] = static_cast<Index>(i);
    }
    return fresh;
}

const IntegerList* whole_numbers(const std::vector<io::DataArray>& arrays, const std::string& name,
                                 int components) {
    const auto found = std::find_if(arrays.begin(), arrays.end(), [&](const io::DataArray& array) {
        return array.name == name && array.components == components;
    });
    return found == arrays.end() ? nullptr : std::get_if<IntegerList>(&found->values);
}

IntegerList* whole_numbers(std::vector<io::DataArray>& arrays, const std::string& name, int components) {
    return const_cast<IntegerList*>(whole_numbers(std::as_const(arrays), name, components));
}

void pick_rows(std::vector<io::DataArray>& arrays, const Order& order) {
    for (io::DataArray& array : arrays) {
        array.keep_rows(order);
    }
}

void keep_cells(io::Soup& soup, const std::array<Order, 4>& orders) {
    const auto top = static_cast<std::size_t>(soup.top_dimension());
    const Array<Index> fresh = inverse(orders[top], soup.simplices[top].size(soup.top_dimension()));
    if (orders[top].empty()) { // another dimension is the top one now, and the data are not about it
        soup.cell_data.clear();
    } else {
        pick_rows(soup.cell_data, orders[top]);
        if (IntegerList* neighbors = neighbors_of(soup)) {
            renumber(*neighbors, fresh);
        }
    }
    if (IntegerList* cell = whole_numbers(soup.point_data, "cell")) {
        renumber(*cell, fresh);
    }
    for (std::size_t d = 0; d < orders.size(); ++d) {
        io::SimplexBlock& block = soup.simplices[d];
        keep_rows(block.vertices, orders[d], d + 1);
        keep_rows(block.physical, orders[d]);
        keep_rows(block.entity, orders[d]);
        keep_rows(block.tags, orders[d]);
    }
}

void keep_points(io::Soup& soup, const Order& order) {
    const Array<Index> fresh = inverse(order, soup.points.size());
    keep_rows(soup.points, order);
    keep_rows(soup.point_tags, order);
    pick_rows(soup.point_data, order);
    for (io::SimplexBlock& block : soup.simplices) {
        std::transform(block.vertices.begin(), block.vertices.end(), block.vertices.begin(),
                       [&](Index v) { return fresh[v]; });
    }
}

void drop_unused_points(io::Soup& soup) {
    const auto& blocks = soup.simplices;
    const UsedVertices used{soup.points.size(), blocks[0].vertices, blocks[1].vertices, blocks[2].vertices,
                            blocks[3].vertices};
    if (used.vertices.size() < soup.points.size()) {
        keep_points(soup, used.vertices);
    }
}

void mend_cells_of_points(io::Soup& soup) {
    IntegerList* cells_of_points = whole_numbers(soup.point_data, "cell");
    if (cells_of_points == nullptr) {
        return;
    }
    Array<std::int64_t> cell(cells_of_points->begin(), cells_of_points->end());
    const int dimension = soup.top_dimension();
    const io::SimplexBlock& block = soup.simplices[static_cast<std::size_t>(dimension)];
    const auto corners = static_cast<std::size_t>(dimension) + 1;
    const auto uses = [&](std::int64_t c, std::size_t v) {
        const auto first = block.vertices.begin() + static_cast<std::ptrdiff_t>(corners) * c;
        return std::find(first, first + static_cast<std::ptrdiff_t>(corners), v) !=
               first + static_cast<std::ptrdiff_t>(corners);
    };
    const auto cells = static_cast<std::int64_t>(block.size(dimension));
    for (std::size_t v = 0; v < cell.size(); ++v) {
        const std::int64_t c = cell[v];
        cell[v] = c >= 0 && c < cells && uses(c, v) ? c : -1;
    }
    for (std::size_t i = 0; i < block.vertices.size(); ++i) {
        if (std::int64_t& c = cell[block.vertices[i]]; c == -1) {
            c = static_cast<std::int64_t>(i / corners);
        }
    }
    *cells_of_points = std::move(cell);
}

} // namespace slabhull::detail

namespace slabhull {

const Array<double>* soup_times(const io::Soup& soup) {
    const io::DataArray* array = soup.find_point_data("t");
    const auto* times = array == nullptr ? nullptr : std::get_if<Array<double>>(&array->values);
    return times != nullptr && times->size() == soup.points.size() ? times : nullptr;
}

} // namespace slabhull
