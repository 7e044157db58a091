// SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/vtu_payload.h"

#include "io/files/base64.h"
#include "io/files/byte_order.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace slabhull::io {

namespace {

/// The bytes of a range of a file in order, raw or decoded from base64.
class ByteStream {
public:
    ByteStream(FileBytes& file, FileRange range, bool is_base64)
        : file_{file}, at_{range.begin}, end_{range.end}, is_base64_{is_base64} {}

    /// Upper bound of the number of bytes that follow.
    std::uint64_t most_left() const {
        return is_base64_ ? (end_ - at_) / 4 * 3 + (decoded_.size() - given_) : end_ - at_;
    }
    std::size_t at() const { return at_; }

    /// The next bytes, valid until the next call.
    std::string_view next(std::uint64_t size) {
        if (size > most_left()) {
            throw PayloadError{"its data reach beyond the end of the file"};
        }
        return is_base64_ ? decoded(size) : plain(size);
    }

private:
    std::string_view plain(std::size_t size) {
        file_.load(at_, at_ + size);
        at_ += size;
        return file_.view().substr(at_ - size, size);
    }

    std::string_view decoded(std::size_t size) {
        decoded_.erase(decoded_.begin(), decoded_.begin() + static_cast<std::ptrdiff_t>(given_));
        given_ = size;
        while (decoded_.size() < size) {
            file_.load(at_, at_ + 4);
            const std::size_t there = std::min(end_, file_.loaded_end()) - at_;
            const auto taken = decode_base64(file_.view().substr(at_, there), size, decoded_);
            if (taken.value_or(0) == 0) {
                throw PayloadError{"its base64 data are cut short or damaged"};
            }
            at_ += *taken;
        }
        return {decoded_.data(), size};
    }

    FileBytes& file_;
    std::size_t at_;
    std::size_t end_;
    bool is_base64_;
    Array<char> decoded_;
    std::size_t given_ = 0; ///< bytes of decoded_ already returned
};

/// The sizes in front of packed blocks: all unpack to `block_bytes`, except perhaps the last.
struct BlockHead {
    std::uint64_t blocks = 0;
    std::uint64_t block_bytes = 0;
    std::uint64_t last_bytes = 0; ///< 0: the last is as large as the others
    std::uint64_t bytes_of(std::uint64_t block) const {
        return block + 1 == blocks && last_bytes > 0 ? last_bytes : block_bytes;
    }
};

std::uint64_t word_at(const PayloadFormat& format, const char* place) {
    return format.word_bytes == sizeof(std::uint64_t) ? load<std::uint64_t>(place, format.swapped)
                                                      : load<std::uint32_t>(place, format.swapped);
}

class PayloadReader {
public:
    PayloadReader(const PayloadFormat& format, ByteStream& in, std::uint64_t most, const PayloadTaker& taker)
        : format_{format}, in_{in}, most_{most}, taker_{taker} {}

    void read() { format_.compressor == Compressor::none ? plain() : packed(); }

private:
    std::uint64_t word(std::string_view head, std::uint64_t i) const {
        return word_at(format_, head.data() + i * format_.word_bytes);
    }

    void plain() {
        constexpr std::uint64_t portion = std::uint64_t{1} << 20;
        const std::uint64_t size = word(in_.next(format_.word_bytes), 0);
        if (size > in_.most_left()) {
            throw PayloadError{"its data reach beyond the end of the file"};
        }
        taker_.start(size);
        for (std::uint64_t done = 0; done < size; done += portion) {
            taker_.take(in_.next(std::min(portion, size - done)));
        }
    }

    /// Reads packed blocks. The numbers before them are: blocks, bytes of a block, bytes of the last one, and
    /// the packed size of each.
    void packed() {
        BlockHead head;
        head.blocks = word(in_.next(format_.word_bytes), 0);
        if (head.blocks == 0) {
            taker_.start(0);
            return;
        }
        const std::string_view sizes = in_.next(2 * format_.word_bytes);
        head.block_bytes = word(sizes, 0);
        head.last_bytes = word(sizes, 1);
        if (head.blocks > in_.most_left() / format_.word_bytes) {
            throw PayloadError{fmt::format("{} packed blocks reach beyond the end of the file", head.blocks)};
        }
        const std::string_view there = in_.next(head.blocks * format_.word_bytes);
        const Array<char> words(there.begin(), there.end());
        taker_.start(unpacked_size(head, packed_size({words.data(), words.size()}, head.blocks)));
        unpack_blocks(head, {words.data(), words.size()});
    }

    std::uint64_t packed_size(std::string_view head, std::uint64_t blocks) const {
        std::uint64_t sum = 0;
        for (std::uint64_t block = 0; block < blocks; ++block) {
            const std::uint64_t size = word(head, block);
            if (size > in_.most_left() - sum) {
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

    /// Passes portions of multiples of 8 bytes, whatever the block size.
    void unpack_blocks(const BlockHead& head, std::string_view words) {
        Array<char> portion;
        std::size_t left = 0; // bytes left from the block before
        for (std::uint64_t block = 0; block < head.blocks; ++block) {
            const std::uint64_t unpacked = head.bytes_of(block);
            portion.resize(left + unpacked);
            if (!unpack(format_.compressor, in_.next(word(words, block)), portion.data() + left, unpacked)) {
                throw PayloadError{fmt::format("its packed block {} is damaged", block)};
            }
            left = block + 1 < head.blocks ? portion.size() % 8 : 0;
            const std::size_t whole = portion.size() - left;
            taker_.take({portion.data(), whole});
            std::copy_n(portion.begin() + static_cast<std::ptrdiff_t>(whole), left, portion.begin());
        }
    }

    PayloadFormat format_;
    ByteStream& in_;
    std::uint64_t most_;
    const PayloadTaker& taker_;
};

} // namespace

std::uint64_t read_payload(const PayloadFormat& format, FileBytes& file, FileRange range, bool is_base64,
                           std::uint64_t most, const PayloadTaker& taker) {
    ByteStream in{file, range, is_base64};
    PayloadReader{format, in, most, taker}.read();
    return in.at() - range.begin;
}

std::optional<FileRange> plain_payload(const PayloadFormat& format, const FileBytes& file, FileRange range,
                                       bool is_base64) {
    const std::size_t there = range.end - range.begin;
    if (is_base64 || format.compressor != Compressor::none) {
        return std::nullopt;
    }
    std::array<char, sizeof(std::uint64_t)> head{};
    if (there >= format.word_bytes) {
        file.copy(range.begin, range.begin + format.word_bytes, head.data());
    }
    const std::uint64_t size = word_at(format, head.data());
    if (there < format.word_bytes || size > there - format.word_bytes) {
        throw PayloadError{"its data reach beyond the end of the file"};
    }
    const std::size_t begin = range.begin + format.word_bytes;
    return FileRange{begin, begin + size};
}

} // namespace slabhull::io
