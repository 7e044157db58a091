// SPDX-License-Identifier: BSD-3-Clause
#include "column_stream.h"

#include "slabhull/core/array.h"
#include "slabhull/core/parallel.h"

#include <array>

namespace slabhull::io {

namespace {
constexpr std::size_t least_rows = 4096; ///< that are worth a thread

/// Rows [first, first + count), made by several threads.
void fill_rows(std::size_t first, std::size_t count, std::size_t row_bytes, const RowFill& fill, char* out) {
    constexpr std::size_t pieces = 8;
    parallel_for(count, std::max(least_rows, count / pieces), [&](std::size_t begin, std::size_t end) {
        fill(first + begin, first + end, out + begin * row_bytes);
    });
}

} // namespace

void stream_rows(AtomicFile& file, std::size_t rows, std::size_t row_bytes, const RowFill& fill) {
    std::vector<char> split(row_bytes); // a row that reaches into the next block
    for (std::size_t first = 0; first < rows;) {
        const std::span<char> room = file.room();
        const std::size_t count = std::min(rows - first, room.size() / row_bytes);
        if (count == 0) {
            fill(first, first + 1, split.data());
            file.write(split.data(), row_bytes);
            ++first;
            continue;
        }
        fill_rows(first, count, row_bytes, fill, room.data());
        file.advance(count * row_bytes);
        first += count;
    }
}

void stream_rows(std::size_t rows, std::size_t row_bytes, const RowFill& fill,
                 const std::function<void(std::size_t first, std::size_t count, const char* bytes)>& take) {
    constexpr std::size_t block_bytes = std::size_t{8} << 20;
    const std::size_t block_rows = std::max<std::size_t>(1, block_bytes / row_bytes);
    Array<char> block(std::min(rows, block_rows) * row_bytes);
    for (std::size_t first = 0; first < rows; first += block_rows) {
        const std::size_t count = std::min(rows - first, block_rows);
        fill_rows(first, count, row_bytes, fill, block.data());
        take(first, count, block.data());
    }
}

void stream_text(AtomicFile& file, std::size_t rows, std::size_t longest_row, const TextFill& fill) {
    constexpr std::size_t block_bytes = std::size_t{8} << 20;
    constexpr std::size_t pieces = 8;
    const std::size_t piece_rows = std::max<std::size_t>(1, block_bytes / longest_row / pieces);
    const std::size_t block_rows = pieces * piece_rows;
    Array<char> block(std::min(rows, block_rows) * longest_row);
    std::array<std::size_t, pieces> lengths{};
    for (std::size_t first = 0; first < rows; first += block_rows) {
        const std::size_t count = std::min(rows - first, block_rows);
        lengths.fill(0);
        parallel_for(count, piece_rows, [&](std::size_t begin, std::size_t end) {
            char* out = block.data() + begin * longest_row;
            lengths[begin / piece_rows] =
                static_cast<std::size_t>(fill(first + begin, first + end, out) - out);
        });
        std::size_t used = 0;
        for (std::size_t piece = 0; piece < pieces; ++piece) { // closes the gaps, where there are any
            const std::size_t place = piece * piece_rows * longest_row;
            if (lengths[piece] > 0 && place != used) {
                std::memmove(block.data() + used, block.data() + place, lengths[piece]);
            }
            used += lengths[piece];
        }
        file.write(block.data(), used);
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
