// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/files/byte_order.h"
#include "io/files/file_bytes.h"
#include "slabhull/core/array.h"
#include "slabhull/core/error.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

namespace slabhull::io {

/// The bytes of a file, read at once. A mapping would be as fast, but truncating the file meanwhile would
/// kill us. Throws InputError.
Array<char> read_bytes(const std::filesystem::path& path);
/// ".msh" for "ROOM.MSH".
std::string lower_extension(const std::filesystem::path& path);

/// A reading position in text, binary values, or a mixture: in the bytes of a whole file or of a text, or in
/// FileBytes, which are read once from front to back. With FileBytes, returned references last until the next
/// call, and rest() must not be used. Reading beyond the end or malformed input throws InputError with file
/// and line (text) or byte (binary).
class FileCursor {
public:
    FileCursor(std::string_view bytes, std::string path)
        : bytes_{bytes}, loaded_end_{bytes.size()}, path_{std::move(path)} {}
    /// Bytes [begin, end) of the file.
    FileCursor(FileBytes& file, std::size_t begin, std::size_t end, std::string path)
        : file_{&file}, bytes_{file.view().substr(0, end)}, path_{std::move(path)}, offset_{begin} {
        bring(begin, begin + 1);
    }
    explicit FileCursor(FileBytes& file) : FileCursor{file, 0, file.size(), file.path().string()} {}

    /// Whether numbers are read as binary values from now on; words and lines are always text.
    void set_binary(bool binary) { binary_ = binary; }
    bool binary() const { return binary_; }
    /// Whether binary values are not in the machine's own byte order.
    void set_swapped(bool swapped) { swapped_ = swapped; }
    bool swapped() const { return swapped_; }

    std::size_t offset() const { return offset_; }
    std::size_t remaining() const { return bytes_.size() - offset_; }
    std::string_view rest() const { return bytes_.substr(offset_); }
    void seek(std::size_t offset) {
        offset_ = offset;
        bring(offset, offset);
    }
    /// Moves to the next occurrence of the text; false if there is none.
    bool seek_text(std::string_view text);

    /// The rest of the line without its end, which is skipped.
    std::string_view line();
    /// The next word after blanks and line ends; empty at the end of the file.
    std::string_view word();
    /// A text in double quotes on this line.
    std::string quoted();
    /// Skips blanks and line ends.
    void skip_blanks();
    /// True if nothing but blanks is left.
    bool at_end();

    /// The next number, as text or in binary.
    template<class T>
    T number(const char* what) {
        return binary_ ? raw<T>(what) : parsed<T>(what);
    }
    template<class T>
    void numbers(T* out, std::size_t count, const char* what);

    /// The next number, always as text.
    template<class T>
    T parsed(const char* what);
    /// The next number, always in binary.
    template<class T>
    T raw(const char* what) {
        return load<T>(take(sizeof(T), what), swapped_);
    }
    /// The next `size` bytes.
    const char* take(std::size_t size, const char* what);

    /// Throws unless the rest of the file can hold `count` items of at least `least_size` bytes each. Claimed
    /// counts must pass this before they are trusted.
    std::size_t plausible(std::uint64_t count, std::size_t least_size, const char* what) const;

    /// Throws InputError: file, place, text.
    [[noreturn]] void fail(const std::string& text) const { fail_at(offset_, text); }
    [[noreturn]] void fail_at(std::size_t offset, const std::string& text) const;
    /// fail() unless the condition holds. Too slow for each entity of a file, as the text is made in any
    /// case.
    void require(bool condition, const std::string& text) const {
        if (!condition) {
            fail(text);
        }
    }

private:
    [[noreturn]] void fail_word(std::string_view word, const char* what) const;
    /// Loads at least [begin, end), as far as the file goes.
    void bring(std::size_t begin, std::size_t end) {
        if (file_ != nullptr) {
            file_->load(begin, std::min(end, bytes_.size()));
            loaded_end_ = std::min(file_->loaded_end(), bytes_.size());
        }
    }
    /// Loads more bytes, keeping those from `begin` on; false at the end of the file.
    bool load_more(std::size_t begin) {
        const std::size_t before = loaded_end_;
        bring(begin, 2 * before - begin + 1);
        return loaded_end_ > before;
    }

    FileBytes* file_ = nullptr;
    std::string_view bytes_;
    std::size_t loaded_end_ = 0; ///< end of the bytes in memory
    std::string path_;
    std::size_t offset_ = 0;
    bool binary_ = false;
    bool swapped_ = false;
};

inline bool is_blank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

inline void FileCursor::skip_blanks() {
    do {
        while (offset_ < loaded_end_ && is_blank(bytes_[offset_])) {
            ++offset_;
        }
    } while (offset_ == loaded_end_ && load_more(offset_));
}

inline bool FileCursor::at_end() {
    skip_blanks();
    return offset_ == bytes_.size();
}

inline const char* FileCursor::take(std::size_t size, const char* what) {
    if (size > remaining()) {
        fail(std::string{"the file ends within "} + what);
    }
    if (size > loaded_end_ - offset_) {
        bring(offset_, offset_ + size);
    }
    const char* place = bytes_.data() + offset_;
    offset_ += size;
    return place;
}

template<class T>
T FileCursor::parsed(const char* what) {
    skip_blanks();
    const char* begin = bytes_.data() + offset_;
    const char* end = bytes_.data() + loaded_end_;
    if (begin != end && *begin == '+') { // from_chars accepts no plus sign
        ++begin;
    }
    T value{};
    const auto [stop, problem] = std::from_chars(begin, end, value);
    if (problem != std::errc{} || stop == end || !is_blank(*stop)) {
        // A number cut off at the window's end, such as "-" or "1e-", looks like another one or like none.
        if (std::find_if(begin, end, is_blank) == end && load_more(offset_)) {
            return parsed<T>(what);
        }
        if (problem != std::errc{} || stop != end) {
            fail_word(word(), what);
        }
    }
    offset_ = static_cast<std::size_t>(stop - bytes_.data());
    return value;
}

template<class T>
void FileCursor::numbers(T* out, std::size_t count, const char* what) {
    if (binary_) {
        constexpr std::size_t at_once = (std::size_t{1} << 20) / sizeof(T);
        plausible(count, sizeof(T), what);
        for (std::size_t done = 0; done < count; done += at_once) {
            const std::size_t bytes = std::min(at_once, count - done) * sizeof(T);
            std::memcpy(out + done, take(bytes, what), bytes);
        }
        for (std::size_t i = 0; swapped_ && i < count; ++i) {
            out[i] = load<T>(reinterpret_cast<const char*>(out + i), true);
        }
        return;
    }
    for (std::size_t i = 0; i < count; ++i) {
        out[i] = parsed<T>(what);
    }
}

/// That some editors put before UTF-8.
inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// Skips a byte order mark; to be called at the start of a file.
inline void pass_byte_order_mark(FileCursor& in) {
    constexpr std::size_t size = byte_order_mark.size();
    if (in.remaining() < size || std::string_view{in.take(size, "a line"), size} != byte_order_mark) {
        in.seek(0);
    }
}

} // namespace slabhull::io
