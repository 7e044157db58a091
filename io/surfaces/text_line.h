// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/files/coordinate.h"
#include "io/files/file_cursor.h"
#include "slabhull/core/point.h"

#include <charconv>
#include <fmt/format.h>
#include <string_view>

namespace slabhull::io {

/// The words of one line of a file. The cursor is already past the line, which stays in memory.
class TextLine {
public:
    /// The next line without a comment after '#'.
    explicit TextLine(FileCursor& in) : in_{&in}, begin_{in.offset()}, rest_{in.line()} {
        rest_ = rest_.substr(0, rest_.find('#'));
        skip_blanks();
    }

    bool at_end() const { return rest_.empty(); }
    /// The rest of the line.
    std::string_view rest() const { return rest_; }

    /// The next word; empty at the end.
    std::string_view word() {
        std::size_t size = 0;
        while (size < rest_.size() && !is_blank(rest_[size])) {
            ++size;
        }
        const std::string_view found = rest_.substr(0, size);
        rest_.remove_prefix(size);
        skip_blanks();
        return found;
    }

    template<class T>
    T parsed(const char* what) {
        const char* end = rest_.data() + rest_.size();
        const char* begin = rest_.data();
        if (begin != end && *begin == '+') { // from_chars accepts no plus sign
            ++begin;
        }
        T value{};
        const auto [stop, problem] = std::from_chars(begin, end, value);
        if (problem != std::errc{} || (stop != end && !is_blank(*stop))) {
            fail_word(word(), what);
        }
        rest_.remove_prefix(static_cast<std::size_t>(stop - rest_.data()));
        skip_blanks();
        return value;
    }

    /// Three coordinates; `kind` and `number` name their owner in messages.
    Point<3> point(const char* kind, std::size_t number) {
        Point<3> x{};
        for (double& value : x) {
            value = parsed<double>("a coordinate");
            if (!is_coordinate(value)) {
                fail(why_no_coordinate(value, fmt::format("{} {}", kind, number)));
            }
        }
        return x;
    }

    [[noreturn]] void fail(const std::string& text) const { in_->fail_at(begin_, text); }
    [[noreturn]] void fail_word(std::string_view word, const char* what) const {
        constexpr std::size_t shown = 40;
        fail(word.empty() ? fmt::format("{} was expected, but nothing follows", what)
                          : fmt::format("{} was expected, not \"{}\"", what, word.substr(0, shown)));
    }

private:
    void skip_blanks() {
        while (!rest_.empty() && is_blank(rest_.front())) {
            rest_.remove_prefix(1);
        }
    }

    const FileCursor* in_;
    std::size_t begin_;
    std::string_view rest_;
};

} // namespace slabhull::io
