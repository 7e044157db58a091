// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/column_stream.h"

#include "slabhull/core/array.h"
#include "slabhull/core/parallel.h"

#include <array>

namespace slabhull::io {

namespace {

/// Least number of rows worth a thread, fewer if rows are long.
std::size_t least_rows(std::size_t longest_row) {
    constexpr std::size_t most_bytes = std::size_t{1} << 20;
    constexpr std::size_t enough = 4096;
    return std::clamp<std::size_t>(most_bytes / longest_row, 1, enough);
}

/// Makes `count` rows from `first` on at `out`, which has room for that many of the longest. Returns their
/// size.
std::size_t make_rows(std::size_t first, std::size_t count, std::size_t longest_row, const TextFill& fill,
                      char* out) {
    constexpr std::size_t pieces = 8;
    const std::size_t piece_rows = std::max(least_rows(longest_row), (count + pieces - 1) / pieces);
    std::array<std::size_t, pieces> lengths{};
    parallel_for(count, piece_rows, [&](std::size_t begin, std::size_t end) {
        char* const piece = out + begin * longest_row;
        lengths[begin / piece_rows] =
            static_cast<std::size_t>(fill(first + begin, first + end, piece) - piece);
    });
    std::size_t used = 0;
    for (std::size_t piece = 0; piece < pieces; ++piece) { // closes gaps between pieces
        const std::size_t place = piece * piece_rows * longest_row;
        if (lengths[piece] > 0 && place != used) {
            std::memmove(out + used, out + place, lengths[piece]);
        }
        used += lengths[piece];
    }
    return used;
}

/// Adapts rows of equal length to the interface for text.
TextFill as_text(const RowFill& fill, std::size_t row_bytes) {
    return [&fill, row_bytes](std::size_t begin, std::size_t end, char* out) {
        fill(begin, end, out);
        return out + (end - begin) * row_bytes;
    };
}

} // namespace

void stream_rows(AtomicFile& file, std::size_t rows, std::size_t row_bytes, const RowFill& fill) {
    stream_text(file, rows, row_bytes, as_text(fill, row_bytes));
}

void stream_rows(std::size_t rows, std::size_t row_bytes, const RowFill& fill,
                 const std::function<void(std::size_t first, std::size_t count, const char* bytes)>& take) {
    constexpr std::size_t block_bytes = std::size_t{8} << 20;
    const std::size_t block_rows = std::max<std::size_t>(1, block_bytes / row_bytes);
    Array<char> block(std::min(rows, block_rows) * row_bytes);
    for (std::size_t first = 0; first < rows; first += block_rows) {
        const std::size_t count = std::min(rows - first, block_rows);
        make_rows(first, count, row_bytes, as_text(fill, row_bytes), block.data());
        take(first, count, block.data());
    }
}

void stream_text(AtomicFile& file, std::size_t rows, std::size_t longest_row, const TextFill& fill) {
    std::vector<char> apart; // rows that may extend into the next block
    for (std::size_t first = 0; first < rows;) {
        const std::span<char> room = file.room();
        std::size_t count = std::min(rows - first, room.size() / longest_row);
        if (count >= std::min(rows - first, least_rows(longest_row))) {
            file.advance(make_rows(first, count, longest_row, fill, room.data()));
        } else {
            count = std::min(rows - first, least_rows(longest_row));
            apart.resize(count * longest_row);
            file.write(apart.data(), make_rows(first, count, longest_row, fill, apart.data()));
        }
        first += count;
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
