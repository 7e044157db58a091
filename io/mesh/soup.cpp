// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/soup.h"

#include <algorithm>
#include <utility>

namespace slabhull::io {

namespace {

const DataArray* find(const std::vector<DataArray>& arrays, const std::string& name) {
    const auto found = std::find_if(arrays.begin(), arrays.end(),
                                    [&](const DataArray& array) { return array.name == name; });
    return found == arrays.end() ? nullptr : &*found;
}

template<class Values>
void keep(Values& values, std::span<const Index> rows, std::size_t width) {
    Values kept;
    kept.reserve(rows.size() * width);
    for (const Index row : rows) {
        for (std::size_t k = 0; k < width; ++k) {
            kept.push_back(values[row * width + k]);
        }
    }
    values = std::move(kept);
}

void keep(IntegerList& values, std::span<const Index> rows, std::size_t width) {
    values = IntegerList::generated(
        rows.size() * width, [&](std::size_t i) { return values[rows[i / width] * width + i % width]; });
}

template<class Values>
void add(Values& values, const Values& more) {
    values.insert(values.end(), more.begin(), more.end());
}

void add(IntegerList& values, const IntegerList& more) {
    values.append_list(more);
}

} // namespace

void DataArray::keep_rows(std::span<const Index> kept) {
    const auto keep_own = [&](auto& own) {
        if (!own.empty()) {
            keep(own, kept, static_cast<std::size_t>(components));
        }
    };
    std::visit(keep_own, values);
}

void DataArray::append(const DataArray& more) {
    std::visit([&](auto& own) { add(own, std::get<std::decay_t<decltype(own)>>(more.values)); }, values);
}

int Soup::top_dimension() const {
    int dimension = 3;
    while (dimension > 0 && simplices[static_cast<std::size_t>(dimension)].vertices.empty()) {
        --dimension;
    }
    return dimension;
}

const DataArray* Soup::find_point_data(const std::string& name) const {
    return find(point_data, name);
}
const DataArray* Soup::find_cell_data(const std::string& name) const {
    return find(cell_data, name);
}
const DataArray* Soup::find_field_data(const std::string& name) const {
    return find(field_data, name);
}

} // namespace slabhull::io
