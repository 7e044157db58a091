// SPDX-License-Identifier: BSD-3-Clause
#include "edit/soup_rows.h"

#include "core/used_vertices.h"
#include "edit/soup_cells.h"

#include <algorithm>
#include <utility>

namespace slabhull::detail {

namespace {

template<class Values>
void pick(Values& values, const Order& order, std::size_t width) {
    if (values.empty()) {
        return;
    }
    Values picked(order.size() * width);
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (std::size_t k = 0; k < width; ++k) {
            picked[i * width + k] = values[order[i] * width + k];
        }
    }
    values = std::move(picked);
}

void renumber(Array<std::int64_t>& values, const Array<Index>& fresh) {
    for (std::int64_t& value : values) {
        const bool stays = value >= 0 && static_cast<std::size_t>(value) < fresh.size() &&
                           fresh[static_cast<std::size_t>(value)] != no_index;
        value = stays ? static_cast<std::int64_t>(fresh[static_cast<std::size_t>(value)]) : -1;
    }
}

Array<std::int64_t>* neighbors_of(io::Soup& soup) {
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

const Array<std::int64_t>* whole_numbers(const std::vector<io::DataArray>& arrays, const std::string& name,
                                         int components) {
    const auto found = std::find_if(arrays.begin(), arrays.end(), [&](const io::DataArray& array) {
        return array.name == name && array.components == components;
    });
    return found == arrays.end() ? nullptr : std::get_if<Array<std::int64_t>>(&found->values);
}

Array<std::int64_t>* whole_numbers(std::vector<io::DataArray>& arrays, const std::string& name,
                                   int components) {
    return const_cast<Array<std::int64_t>*>(whole_numbers(std::as_const(arrays), name, components));
}

void pick_rows(std::vector<io::DataArray>& arrays, const Order& order) {
    for (io::DataArray& array : arrays) {
        std::visit([&](auto& values) { pick(values, order, static_cast<std::size_t>(array.components)); },
                   array.values);
    }
}

void keep_cells(io::Soup& soup, const std::array<Order, 4>& orders) {
    const auto top = static_cast<std::size_t>(soup.top_dimension());
    const Array<Index> fresh = inverse(orders[top], soup.simplices[top].size(soup.top_dimension()));
    if (orders[top].empty()) { // another dimension is the top one now, and the data are not about it
        soup.cell_data.clear();
    } else {
        pick_rows(soup.cell_data, orders[top]);
        if (Array<std::int64_t>* neighbors = neighbors_of(soup)) {
            renumber(*neighbors, fresh);
        }
    }
    if (Array<std::int64_t>* cell = whole_numbers(soup.point_data, "cell")) {
        renumber(*cell, fresh);
    }
    for (std::size_t d = 0; d < orders.size(); ++d) {
        io::SimplexBlock& block = soup.simplices[d];
        pick(block.vertices, orders[d], d + 1);
        pick(block.physical, orders[d], 1);
        pick(block.entity, orders[d], 1);
        pick(block.tags, orders[d], 1);
    }
}

void keep_points(io::Soup& soup, const Order& order) {
    const Array<Index> fresh = inverse(order, soup.points.size());
    pick(soup.points, order, 1);
    pick(soup.point_tags, order, 1);
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
    Array<std::int64_t>* cell = whole_numbers(soup.point_data, "cell");
    if (cell == nullptr) {
        return;
    }
    const int dimension = soup.top_dimension();
    const io::SimplexBlock& block = soup.simplices[static_cast<std::size_t>(dimension)];
    const auto corners = static_cast<std::size_t>(dimension) + 1;
    const auto uses = [&](std::int64_t c, std::size_t v) {
        const auto first = block.vertices.begin() + static_cast<std::ptrdiff_t>(corners) * c;
        return std::find(first, first + static_cast<std::ptrdiff_t>(corners), v) !=
               first + static_cast<std::ptrdiff_t>(corners);
    };
    const auto cells = static_cast<std::int64_t>(block.size(dimension));
    for (std::size_t v = 0; v < cell->size(); ++v) {
        const std::int64_t c = (*cell)[v];
        (*cell)[v] = c >= 0 && c < cells && uses(c, v) ? c : -1;
    }
    for (std::size_t i = 0; i < block.vertices.size(); ++i) {
        if (std::int64_t& c = (*cell)[block.vertices[i]]; c == -1) {
            c = static_cast<std::int64_t>(i / corners);
        }
    }
}

} // namespace slabhull::detail

namespace slabhull {

const Array<double>* soup_times(const io::Soup& soup) {
    const io::DataArray* array = soup.find_point_data("t");
    const auto* times = array == nullptr ? nullptr : std::get_if<Array<double>>(&array->values);
    return times != nullptr && times->size() == soup.points.size() ? times : nullptr;
}

} // namespace slabhull
