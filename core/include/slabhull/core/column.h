// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>

namespace slabhull {

/// A column of values that is stored somewhere or computed piece by piece when asked for: writers and
/// checkers take columns, so that no second copy of a mesh is made. An empty column stands for "not given".
template<class T>
class Column {
public:
    /// Writes the values of rows [begin, end) to `out`, `components` per row.
    using Fill = std::function<void(std::size_t begin, std::size_t end, T* out)>;

    Column() = default;
    Column(std::size_t rows, int components, Fill fill)
        : rows_{rows}, components_{components}, fill_{std::move(fill)} {}

    /// A column over stored values, which must outlive it. U converts to T.
    template<class U>
    static Column over(std::span<const U> values, int components = 1) {
        return Column{values.size() / static_cast<std::size_t>(components), components,
                      [values, components](std::size_t begin, std::size_t end, T* out) {
                          const auto width = static_cast<std::size_t>(components);
                          std::transform(values.begin() + static_cast<std::ptrdiff_t>(begin * width),
                                         values.begin() + static_cast<std::ptrdiff_t>(end * width), out,
                                         [](const U& value) { return static_cast<T>(value); });
                      }};
    }

    /// Every row the same value.
    static Column constant(std::size_t rows, T value) {
        return Column{rows, 1, [value](std::size_t begin, std::size_t end, T* out) {
                          std::fill(out, out + (end - begin), value);
                      }};
    }

    bool given() const { return static_cast<bool>(fill_); }
    std::size_t rows() const { return rows_; }
    int components() const { return components_; }
    void fill(std::size_t begin, std::size_t end, T* out) const { fill_(begin, end, out); }

private:
    std::size_t rows_ = 0;
    int components_ = 1;
    Fill fill_;
};

} // namespace slabhull
