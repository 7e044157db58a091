// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/soup.h"

#include <algorithm>

namespace slabhull::io {

namespace {

const DataArray* find(const std::vector<DataArray>& arrays, const std::string& name) {
    const auto found = std::find_if(arrays.begin(), arrays.end(),
                                    [&](const DataArray& array) { return array.name == name; });
    return found == arrays.end() ? nullptr : &*found;
}

} // namespace

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
