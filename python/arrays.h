// SPDX-License-Identifier: BSD-3-Clause
// Arrays of numpy: views of ours, and ours made from theirs.
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/integer_list.h"
#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace slabhull::python {

namespace py = pybind11;

/// Keeps the C++ object alive that an array looks into.
using Owner = std::shared_ptr<const void>;

/// An array of numpy over memory of ours, read-only. Nothing is copied; `owner` lives as long as the array.
py::array view_of(const py::dtype& type, std::vector<py::ssize_t> shape, const void* memory,
                  const Owner& owner);

/// The same of rows of numbers. They may be shown as another type of the same size.
template<class As, class T, std::size_t N>
py::array rows_as(std::span<const std::array<T, N>> rows, const Owner& owner) {
    static_assert(sizeof(As) == sizeof(T));
    return view_of(py::dtype::of<As>(), {static_cast<py::ssize_t>(rows.size()), N}, rows.data(), owner);
}
template<class T, std::size_t N>
py::array rows_of(std::span<const std::array<T, N>> rows, const Owner& owner) {
    return rows_as<T, T, N>(rows, owner);
}
template<class Rows>
py::array rows_of(const Rows& rows, const Owner& owner) {
    return rows_of(std::span{rows}, owner);
}

/// Cells across facets: as signed numbers none is -1, in a mesh of fewer than 2^31 cells.
template<std::size_t N>
py::array neighbors_of(std::span<const std::array<Index, N>> neighbors, const Owner& owner) {
    return neighbors.size() >> 31 == 0 ? rows_as<std::int32_t>(neighbors, owner) : rows_of(neighbors, owner);
}
template<class Rows>
py::array neighbors_of(const Rows& neighbors, const Owner& owner) {
    return neighbors_of(std::span{neighbors}, owner);
}

/// A list of numbers.
template<class T>
py::array list_of(std::span<const T> numbers, const Owner& owner) {
    return view_of(py::dtype::of<T>(), {static_cast<py::ssize_t>(numbers.size())}, numbers.data(), owner);
}

/// An array that numpy is to own, read-only.
template<class T>
py::array given_to_numpy(std::vector<T, PageAllocator<T>> numbers) {
    const auto kept = std::make_shared<const Array<T>>(std::move(numbers));
    return list_of(std::span<const T>{*kept}, kept);
}

/// The integers of a list, which stores them in its own way, as int64.
py::array integers_of(const IntegerList& list);

/// Any array or nested list as rows of N numbers of a type. Throws UsageError calling it `name` when it has
/// another shape or other contents; whole numbers must be in the range of the type.
template<class T, std::size_t N>
Array<std::array<T, N>> rows_from(const py::handle& values, const char* name);
template<class T>
Array<T> list_from(const py::handle& values, const char* name);

/// The width of an array with two axes; throws UsageError.
std::size_t width_of(const py::handle& values, const char* name);

/// {number: name}
py::dict as_dict(const PatchList& patches);
/// From {number: name}.
PatchList patches_from(const py::dict& names);

} // namespace slabhull::python
