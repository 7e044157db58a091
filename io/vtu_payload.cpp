// SPDX-License-Identifier: BSD-3-Clause
#include "vtu_payload.h"

#include "base64.h"
#include "byte_order.h"

#include <algorithm>
#include <fmt/format.h>

namespace slabhull::io {

namespace {

/// The first bytes of `data`: in place, or decoded to `own`.
std::string_view first_bytes(std::string_view data, bool is_base64, std::uint64_t size, Array<char>& own) {
    if (!is_base64) {
        if (size > data.size()) {
            throw PayloadError{"its data reach beyond the end of the file"};
        }
        return data.substr(0, size);
    }
    auto decoded = decode_base64(data, size);
    if (!decoded) {
        throw PayloadError{"its base64 data are cut short or damaged"};
    }
    own = std::move(*decoded);
    return {own.data(), own.size()};
}

/// What stands in front of packed blocks: all are of `block_bytes`, but for the last one.
struct BlockHead {
    std::uint64_t blocks = 0;
    std::uint64_t block_bytes = 0;
    std::uint64_t last_bytes = 0; ///< 0: the last is as large as the others
    std::uint64_t bytes_of(std::uint64_t block) const {
        return block + 1 == blocks && last_bytes > 0 ? last_bytes : block_bytes;
    }
};

class PayloadReader {
public:
    PayloadReader(const PayloadFormat& format, std::string_view data, bool is_base64, std::uint64_t most)
        : format_{format}, data_{data}, is_base64_{is_base64}, most_{most} {}

    Payload read() const { return format_.compressor == Compressor::none ? plain() : packed(); }

private:
    /// The first bytes of the file's data stand in `own` or in the file.
    std::string_view first(std::uint64_t size, Array<char>& own) const {
        return first_bytes(data_, is_base64_, size, own);
    }

    std::uint64_t word(std::string_view head, std::uint64_t i) const {
        const char* place = head.data() + i * format_.word_bytes;
        return format_.word_bytes == sizeof(std::uint64_t) ? load<std::uint64_t>(place, format_.swapped)
                                                           : load<std::uint32_t>(place, format_.swapped);
    }

    /// Bytes of the file that so many bytes take, to the letter but for padding.
    std::uint64_t in_file(std::uint64_t size) const { return is_base64_ ? size / 3 * 4 : size; }

    Payload plain() const {
        Payload payload;
        const std::size_t head = format_.word_bytes;
        const std::uint64_t size = word(first(head, payload.own), 0);
        if (size > data_.size() - std::min(data_.size(), head)) {
            throw PayloadError{"its data reach beyond the end of the file"};
        }
        payload.bytes = first(head + size, payload.own).substr(head);
        payload.consumed = in_file(head + size);
        return payload;
    }

    /// Where blocks are packed, the numbers are: blocks, bytes of a block, bytes of the last one, and the
    /// packed size of each.
    Payload packed() const {
        constexpr std::uint64_t fixed_words = 3;
        Array<char> own;
        Payload payload;
        BlockHead head;
        head.blocks = word(first(format_.word_bytes, own), 0);
        payload.consumed = in_file(format_.word_bytes);
        if (head.blocks == 0) {
            return payload;
        }
        const std::string_view fixed = first(fixed_words * format_.word_bytes, own);
        head.block_bytes = word(fixed, 1);
        head.last_bytes = word(fixed, 2);
        if (head.blocks > data_.size() / format_.word_bytes) {
            throw PayloadError{fmt::format("{} packed blocks reach beyond the end of the file", head.blocks)};
        }
        const std::uint64_t head_bytes = (fixed_words + head.blocks) * format_.word_bytes;
        const std::uint64_t packed_bytes = packed_size(first(head_bytes, own), head.blocks);
        const std::uint64_t size = unpacked_size(head, packed_bytes);
        const std::string_view all = first(head_bytes + packed_bytes, own);
        payload.own.resize(size);
        unpack_blocks(head, all, all.substr(head_bytes), payload.own.data());
        payload.bytes = {payload.own.data(), payload.own.size()};
        payload.consumed = in_file(head_bytes + packed_bytes);
        return payload;
    }

    std::uint64_t packed_size(std::string_view head, std::uint64_t blocks) const {
        std::uint64_t sum = 0;
        for (std::uint64_t block = 0; block < blocks; ++block) {
            const std::uint64_t size = word(head, 3 + block);
            if (size > data_.size() - sum) {
                throw PayloadError{"its packed data reach beyond the end of the file"};
            }
            sum += size;
        }
        return sum;
    }

    std::uint64_t unpacked_size(const BlockHead& head, std::uint64_t packed_bytes) const {
        const std::uint64_t most = std::min(most_, most_unpacked(format_.compressor, packed_bytes));
        const std::uint64_t full = head.blocks - (head.last_bytes > 0 ? 1 : 0);
        const bool fits = full == 0 || head.block_bytes <= most / full;
        const std::uint64_t size = fits ? full * head.block_bytes : 0;
        if (!fits || head.last_bytes > most - size) {
            throw PayloadError{fmt::format("its {} packed bytes claim to hold more than the {} that can be",
                                           packed_bytes, most)};
        }
        return size + head.last_bytes;
    }

    void unpack_blocks(const BlockHead& head, std::string_view words, std::string_view source,
                       char* out) const {
        for (std::uint64_t block = 0; block < head.blocks; ++block) {
            const std::uint64_t size = word(words, 3 + block);
            const std::uint64_t unpacked = head.bytes_of(block);
            if (!unpack(format_.compressor, source.substr(0, size), out, unpacked)) {
                throw PayloadError{fmt::format("its packed block {} is damaged", block)};
            }
            out += unpacked;
            source.remove_prefix(size);
        }
    }

    PayloadFormat format_;
    std::string_view data_;
    bool is_base64_;
    std::uint64_t most_;
};

} // namespace

Payload read_payload(const PayloadFormat& format, std::string_view data, bool is_base64, std::uint64_t most) {
    return PayloadReader{format, data, is_base64, most}.read();
}

} // namespace slabhull::io
