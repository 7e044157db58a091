// SPDX-License-Identifier: BSD-3-Clause
#include "column_stream.h"

#include "slabhull/core/array.h"
#include "slabhull/core/parallel.h"

namespace slabhull::io {

void stream_rows(AtomicFile& file, std::size_t rows, std::size_t row_bytes, const RowFill& fill) {
    stream_rows(rows, row_bytes, fill, [&](std::size_t, std::size_t count, const char* bytes) {
        file.write(bytes, count * row_bytes);
    });
}

void stream_rows(std::size_t rows, std::size_t row_bytes, const RowFill& fill,
                 const std::function<void(std::size_t first, std::size_t count, const char* bytes)>& take) {
    constexpr std::size_t block_bytes = std::size_t{8} << 20;
    constexpr std::size_t pieces = 8;
    const std::size_t block_rows = std::max(pieces, block_bytes / row_bytes);
    Array<char> block(std::min(rows, block_rows) * row_bytes);
    for (std::size_t first = 0; first < rows; first += block_rows) {
        const std::size_t count = std::min(rows - first, block_rows);
        parallel_for(count, block_rows / pieces, [&](std::size_t begin, std::size_t end) {
            fill(first + begin, first + end, block.data() + begin * row_bytes);
        });
        take(first, count, block.data());
    }
}

void stream_blocks(std::size_t rows, std::size_t block_rows, std::size_t row_bytes, const RowFill& fill,
                   const std::function<std::string(std::string_view bytes)>& transform,
                   const std::function<void(const std::string&)>& take) {
    constexpr std::size_t at_once = 32;
    std::vector<std::string> results(at_once);
    const std::size_t blocks = (rows + block_rows - 1) / block_rows;
    for (std::size_t first = 0; first < blocks; first += at_once) {
        const std::size_t count = std::min(blocks - first, at_once);
        parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::size_t row = (first + i) * block_rows;
                const std::size_t last = std::min(rows, row + block_rows);
                Array<char> bytes((last - row) * row_bytes);
                fill(row, last, bytes.data());
                results[i] = transform({bytes.data(), bytes.size()});
            }
        });
        std::for_each_n(results.begin(), count, take);
    }
}

std::size_t rows_of(const DataColumn& data) {
    return std::visit([](const auto& column) { return column.rows(); }, data.values);
}

int components_of(const DataColumn& data) {
    return std::visit([](const auto& column) { return column.components(); }, data.values);
}

} // namespace slabhull::io
