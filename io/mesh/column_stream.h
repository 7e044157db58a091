// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/column.h"
#include "slabhull/io/atomic_file.h"
#include "slabhull/io/soup.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace slabhull::io {

/// Writes the bytes of rows [begin, end) to `out`; called from several threads.
using RowFill = std::function<void(std::size_t begin, std::size_t end, char* out)>;

/// Writes rows to the file, large blocks at a time; within a block they are made by several threads.
void stream_rows(AtomicFile& file, std::size_t rows, std::size_t row_bytes, const RowFill& fill);
/// The same, but passes the bytes of each `count` rows from `first` on to `take`, in order.
void stream_rows(std::size_t rows, std::size_t row_bytes, const RowFill& fill,
                 const std::function<void(std::size_t first, std::size_t count, const char* bytes)>& take);

/// Writes the rows [begin, end), each of any length up to the longest, to `out` and returns where they end.
using TextFill = std::function<char*(std::size_t begin, std::size_t end, char* out)>;

/// The same for rows of different lengths, such as text.
void stream_text(AtomicFile& file, std::size_t rows, std::size_t longest_row, const TextFill& fill);

/// Makes rows in blocks of `block_rows`, transforms several blocks at a time in threads, and passes the
/// results to `take` in order.
void stream_blocks(std::size_t rows, std::size_t block_rows, std::size_t row_bytes, const RowFill& fill,
                   const std::function<std::string(std::string_view bytes)>& transform,
                   const std::function<void(const std::string&)>& take);

/// Calls use(row, values, count) for chunks of `count` rows from `row` on, which together are rows [begin,
/// end) of a column.
template<class T, class Use>
void for_each_chunk(const Column<T>& column, std::size_t begin, std::size_t end, const Use& use) {
    constexpr std::size_t chunk = 1024; // small enough to stay in the cache
    const auto width = static_cast<std::size_t>(column.components());
    std::vector<T> values(std::min(chunk, end - begin) * width);
    for (std::size_t first = begin; first < end; first += chunk) {
        const std::size_t last = std::min(end, first + chunk);
        column.fill(first, last, values.data());
        use(first, values.data(), last - first);
    }
}

/// Calls use(row, values) for rows [begin, end) of a column.
template<class T, class Use>
void for_each_row(const Column<T>& column, std::size_t begin, std::size_t end, const Use& use) {
    const auto width = static_cast<std::size_t>(column.components());
    for_each_chunk(column, begin, end, [&](std::size_t first, const T* values, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            use(first + i, values + i * width);
        }
    });
}

/// Copies the value to `out` and steps past it.
template<class T>
void put(char*& out, T value) {
    std::memcpy(out, &value, sizeof value);
    out += sizeof value;
}

/// A fill that stores a column's values as Stored.
template<class Stored, class Given>
RowFill stored_as(const Column<Given>& column) {
    return [column](std::size_t begin, std::size_t end, char* out) {
        const auto width = static_cast<std::size_t>(column.components());
        for_each_chunk(column, begin, end, [&](std::size_t, const Given* values, std::size_t count) {
            char* const first =
                out; // `out` itself might be among the bytes written, for all a compiler knows
            const std::size_t all = count * width;
            for (std::size_t i = 0; i < all; ++i) {
                const auto value = static_cast<Stored>(values[i]);
                std::memcpy(first + i * sizeof value, &value, sizeof value);
            }
            out += all * sizeof(Stored);
        });
    };
}

std::size_t rows_of(const DataColumn& data);
int components_of(const DataColumn& data);

} // namespace slabhull::io
