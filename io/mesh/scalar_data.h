// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/soup.h"

#include <algorithm>
#include <string>
#include <vector>

namespace slabhull::io {

/// A number for each point of a mesh to be written, accessed row by row in ascending order.
template<class T>
class PointScalars {
public:
    PointScalars() = default;
    /// The point data with that name, type T and one component, if there are any.
    PointScalars(const MeshColumns& mesh, const std::string& name) {
        for (const DataColumn& data : mesh.point_data) {
            const auto* column = std::get_if<Column<T>>(&data.values);
            if (data.name == name && column != nullptr && column->components() == 1) {
                column_ = *column;
            }
        }
    }

    bool given() const { return column_.given(); }
    T operator[](std::size_t row) {
        if (row >= end_) {
            fill_from(row);
        }
        return values_[row - begin_];
    }

private:
    void fill_from(std::size_t row) {
        constexpr std::size_t chunk = 1024;
        values_.resize(chunk);
        begin_ = row;
        end_ = std::min(column_.rows(), row + chunk);
        column_.fill(begin_, end_, values_.data());
    }

    Column<T> column_;
    std::vector<T> values_; ///< values of rows [begin_, end_)
    std::size_t begin_ = 0;
    std::size_t end_ = 0;
};

} // namespace slabhull::io
