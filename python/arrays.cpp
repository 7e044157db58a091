// SPDX-License-Identifier: BSD-3-Clause
#include "python/arrays.h"

#include "slabhull/core/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

namespace slabhull::python {

namespace {

py::array as_array(const py::handle& values, const char* name) {
    py::array array = py::array::ensure(values);
    if (!array) {
        PyErr_Clear();
        throw UsageError{fmt::format("{}: expected an array of numbers", name)};
    }
    return array;
}

std::string shape_of(const py::array& array) {
    return fmt::format("({})", fmt::join(array.shape(), array.shape() + array.ndim(), ", "));
}

/// Whole numbers of any type, or the numbers of an empty list, which numpy takes for reals.
py::array_t<std::int64_t> as_integers(const py::array& array, const char* name) {
    const char kind = array.dtype().kind();
    if (kind != 'i' && kind != 'u' && array.size() > 0) {
        throw UsageError{fmt::format("{}: expected whole numbers, not {}", name,
                                     py::str(array.dtype()).cast<std::string>())};
    }
    return py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>{array};
}

py::array_t<double> as_reals(const py::array& array, const char* name) {
    const char kind = array.dtype().kind();
    if (kind != 'f' && kind != 'i' && kind != 'u') {
        throw UsageError{fmt::format("{}: expected real numbers, not {}", name,
                                     py::str(array.dtype()).cast<std::string>())};
    }
    return py::array_t<double, py::array::c_style | py::array::forcecast>{array};
}

template<class T>
void copy_numbers(const py::array& array, const char* name, T* out) {
    if constexpr (std::is_same_v<T, double>) {
        const auto reals = as_reals(array, name);
        std::copy_n(reals.data(), reals.size(), out);
    } else {
        const auto integers = as_integers(array, name);
        for (py::ssize_t k = 0; k < integers.size(); ++k) {
            const std::int64_t number = integers.data()[k];
            if (!std::in_range<T>(number)) {
                throw UsageError{fmt::format("{}: {} in row {} is out of range", name, number,
                                             array.ndim() > 1 ? k / array.shape(1) : k)};
            }
            out[k] = static_cast<T>(number);
        }
    }
}

} // namespace

py::array view_of(const py::dtype& type, std::vector<py::ssize_t> shape, const void* memory,
                  const Owner& owner) {
    const py::capsule keeper{new Owner{owner}, [](void* kept) { delete static_cast<Owner*>(kept); }};
    py::array view{type, std::move(shape), {}, memory, keeper};
    py::detail::array_proxy(view.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return view;
}

py::array integers_of(const IntegerList& list) {
    Array<std::int64_t> all(list.size());
    list.copy(0, list.size(), all.data());
    return given_to_numpy(std::move(all));
}

template<class T, std::size_t N>
Array<std::array<T, N>> rows_from(const py::handle& values, const char* name) {
    const py::array array = as_array(values, name);
    if (array.size() == 0) {
        return {};
    }
    if (array.ndim() != 2 || array.shape(1) != static_cast<py::ssize_t>(N)) {
        throw UsageError{
            fmt::format("{}: expected an array of shape (n, {}), not {}", name, N, shape_of(array))};
    }
    Array<std::array<T, N>> rows(static_cast<std::size_t>(array.shape(0)));
    copy_numbers(array, name, rows.front().data());
    return rows;
}

template<class T>
Array<T> list_from(const py::handle& values, const char* name) {
    const py::array array = as_array(values, name);
    if (array.ndim() != 1) {
        throw UsageError{fmt::format("{}: expected an array of shape (n,), not {}", name, shape_of(array))};
    }
    Array<T> list(static_cast<std::size_t>(array.size()));
    copy_numbers(array, name, list.data());
    return list;
}

std::size_t width_of(const py::handle& values, const char* name) {
    const py::array array = as_array(values, name);
    if (array.ndim() != 2) {
        throw UsageError{
            fmt::format("{}: expected an array with two axes, not one of shape {}", name, shape_of(array))};
    }
    return static_cast<std::size_t>(array.shape(1));
}

py::dict as_dict(const PatchList& patches) {
    py::dict names;
    for (const Patch& patch : patches) {
        names[py::int_(patch.number)] = patch.name;
    }
    return names;
}

PatchList patches_from(const py::dict& names) {
    PatchList patches;
    for (const auto& [number, name] : names) {
        patches.push_back({number.cast<PatchNumber>(), name.cast<std::string>()});
    }
    std::sort(patches.begin(), patches.end(),
              [](const Patch& a, const Patch& b) { return a.number < b.number; });
    return patches;
}

template Array<std::array<double, 2>> rows_from<double, 2>(const py::handle&, const char*);
template Array<std::array<double, 3>> rows_from<double, 3>(const py::handle&, const char*);
template Array<std::array<double, 4>> rows_from<double, 4>(const py::handle&, const char*);
template Array<std::array<Index, 1>> rows_from<Index, 1>(const py::handle&, const char*);
template Array<std::array<Index, 2>> rows_from<Index, 2>(const py::handle&, const char*);
template Array<std::array<Index, 3>> rows_from<Index, 3>(const py::handle&, const char*);
template Array<std::array<Index, 4>> rows_from<Index, 4>(const py::handle&, const char*);
template Array<std::array<Index, 5>> rows_from<Index, 5>(const py::handle&, const char*);
template Array<double> list_from<double>(const py::handle&, const char*);
template Array<std::int32_t> list_from<std::int32_t>(const py::handle&, const char*);
template Array<std::int64_t> list_from<std::int64_t>(const py::handle&, const char*);

} // namespace slabhull::python
