// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/soup.h"

#include "core/rows.h"

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
void add(Values& values, const Values& more) {
    values.insert(values.end(), more.begin(), more.end());
}

void add(IntegerList& values, const IntegerList& more) {
    values.append_list(more);
}

} // namespace

void DataArray::keep_rows(std::span<const Index> kept) {
    const auto width = static_cast<std::size_t>(components);
    std::visit([&](auto& own) { slabhull::keep_rows(own, kept, width); }, values);
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
