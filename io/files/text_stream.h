// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/atomic_file.h"

#include <charconv>
#include <memory>
#include <string_view>

namespace slabhull::io {

/// Writes text to a file through a buffer of fixed size. Doubles get the fewest digits that read back
/// exactly. Text is in the file only after flush().
class TextStream {
public:
    explicit TextStream(AtomicFile& file) : file_{file}, buffer_{std::make_unique<char[]>(buffer_bytes)} {}

    void put(std::string_view text);
    template<class T>
    void number(T value) {
        reserve(longest_number);
        used_ = static_cast<std::size_t>(
            std::to_chars(buffer_.get() + used_, buffer_.get() + buffer_bytes, value).ptr - buffer_.get());
    }
    /// Writes a number and the blank or line end that follows it.
    template<class T>
    void number(T value, char after) {
        number(value);
        buffer_[used_++] = after;
    }
    /// Writes numbers with blanks between them and `after` behind the last.
    template<class T>
    void numbers(const T* values, std::size_t count, char after) {
        for (std::size_t i = 0; i < count; ++i) {
            number(values[i], i + 1 < count ? ' ' : after);
        }
    }
    void flush();

private:
    static constexpr std::size_t buffer_bytes = std::size_t{1} << 20;
    static constexpr std::size_t longest_number = 32; ///< including what follows; a double takes at most 24

    void reserve(std::size_t bytes) {
        if (buffer_bytes - used_ < bytes) {
            flush();
        }
    }

    AtomicFile& file_;
    std::unique_ptr<char[]> buffer_;
    std::size_t used_ = 0;
};

} // namespace slabhull::io
