// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "byte_order.h"
#include "slabhull/core/array.h"
#include "slabhull/core/error.h"

#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

namespace slabhull::io {

/// The bytes of a file, read at once. A mapping would be as fast, but a file cut short meanwhile would kill
/// us. Throws InputError.
Array<char> read_bytes(const std::filesystem::path& path);
/// ".msh" for "ROOM.MSH".
std::string lower_extension(const std::filesystem::path& path);

/// A place in a file that holds text, binary values, or both by turns. Whatever is asked for
/// beyond the end, or does not look as it should, ends in an InputError with file and line (text) or byte
/// (binary).
class FileCursor {
public:
    FileCursor(std::string_view bytes, std::string path) : bytes_{bytes}, path_{std::move(path)} {}

    /// Whether numbers are read as binary values from now on; words and lines are always text.
    void set_binary(bool binary) { binary_ = binary; }
    bool binary() const { return binary_; }
    /// Whether binary values are not in the machine's own byte order.
    void set_swapped(bool swapped) { swapped_ = swapped; }

    std::size_t offset() const { return offset_; }
    std::size_t remaining() const { return bytes_.size() - offset_; }
    std::string_view rest() const { return bytes_.substr(offset_); }
    void seek(std::size_t offset) { offset_ = offset; }

    /// What is left of the line, without its end, which is passed.
    std::string_view line();
    /// The next word after blanks and line ends; empty at the end of the file.
    std::string_view word();
    /// A text in double quotes on this line.
    std::string quoted();
    /// Passes blanks and line ends.
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

    /// Throws unless `count` things of at least `least_size` bytes each can still follow: a claimed count is
    /// believed only after this.
    std::size_t plausible(std::uint64_t count, std::size_t least_size, const char* what) const;

    /// Throws InputError: file, place, text.
    [[noreturn]] void fail(const std::string& text) const { fail_at(offset_, text); }
    [[noreturn]] void fail_at(std::size_t offset, const std::string& text) const;
    /// fail() unless the condition holds. Not for each entity of a file: the text is made in any case.
    void require(bool condition, const std::string& text) const {
        if (!condition) {
            fail(text);
        }
    }

private:
    [[noreturn]] void fail_word(std::string_view word, const char* what) const;

    std::string_view bytes_;
    std::string path_;
    std::size_t offset_ = 0;
    bool binary_ = false;
    bool swapped_ = false;
};

inline bool is_blank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

inline void FileCursor::skip_blanks() {
    while (offset_ < bytes_.size() && is_blank(bytes_[offset_])) {
        ++offset_;
    }
}

inline bool FileCursor::at_end() {
    skip_blanks();
    return offset_ == bytes_.size();
}

inline const char* FileCursor::take(std::size_t size, const char* what) {
    if (size > remaining()) {
        fail(std::string{"the file ends within "} + what);
    }
    const char* place = bytes_.data() + offset_;
    offset_ += size;
    return place;
}

template<class T>
T FileCursor::parsed(const char* what) {
    skip_blanks();
    const char* begin = bytes_.data() + offset_;
    const char* end = bytes_.data() + bytes_.size();
    if (begin != end && *begin == '+') { // from_chars knows no plus sign
        ++begin;
    }
    T value{};
    const auto [stop, problem] = std::from_chars(begin, end, value);
    if (problem != std::errc{} || (stop != end && !is_blank(*stop))) {
        fail_word(word(), what);
    }
    offset_ = static_cast<std::size_t>(stop - bytes_.data());
    return value;
}

template<class T>
void FileCursor::numbers(T* out, std::size_t count, const char* what) {
    if (binary_) {
        if (count > 0) {
            plausible(count, sizeof(T), what);
            std::memcpy(out, take(count * sizeof(T), what), count * sizeof(T));
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

} // namespace slabhull::io
