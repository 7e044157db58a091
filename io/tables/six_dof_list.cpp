// SPDX-License-Identifier: BSD-3-Clause
// The file of OpenFOAM's tabulated6DoFMotion: a List<Tuple2<scalar, Vector2D<vector>>> as text, that is
// "N ( (time ((x y z) (roll pitch yaw))) ... )" with the count N optional, and C++ comments.
#include "io/tables/table_text.h"

#include "io/files/file_cursor.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace slabhull::io {

namespace {

bool is_digits(std::string_view word) {
    return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

/// The tokens of a list: parentheses, and words between them.
class ListTokens {
public:
    explicit ListTokens(std::string_view text) : rest_{text} {}

    /// The next token; empty at the end.
    std::string_view next() {
        skip();
        if (rest_.empty()) {
            return {};
        }
        const std::size_t length = is_bracket(rest_.front()) ? 1 : word_length();
        const std::string_view token = rest_.substr(0, length);
        rest_.remove_prefix(length);
        return token;
    }
    /// The line of the token taken last.
    std::size_t line() const { return line_; }

private:
    static bool is_bracket(char c) { return c == '(' || c == ')'; }

    std::size_t word_length() const {
        std::size_t length = 0;
        while (length < rest_.size() && !is_bracket(rest_[length]) && !is_blank(rest_[length])) {
            ++length;
        }
        return length;
    }

    void skip() {
        while (!rest_.empty()) {
            if (rest_.starts_with("//")) {
                pass(std::min(rest_.find('\n'), rest_.size()));
            } else if (rest_.starts_with("/*")) {
                const std::size_t end = rest_.find("*/", 2);
                pass(end == rest_.npos ? rest_.size() : end + 2);
            } else if (is_blank(rest_.front())) {
                pass(1);
            } else {
                return;
            }
        }
    }

    void pass(std::size_t length) {
        for (const char c : rest_.substr(0, length)) {
            line_ += c == '\n' ? 1 : 0;
        }
        rest_.remove_prefix(length);
    }

    std::string_view rest_;
    std::size_t line_ = 1;
};

class SixDofReader {
public:
    SixDofReader(std::string_view text, const std::string& path) : tokens_{text} {
        table_.path = path;
        table_.columns = {"time", "x", "y", "z", "roll_deg", "pitch_deg", "yaw_deg"};
    }

    CsvTable run() {
        std::string_view token = tokens_.next();
        const std::string_view count = is_digits(token) ? std::exchange(token, tokens_.next()) : "";
        require("(", token);
        for (token = tokens_.next(); token != ")"; token = tokens_.next()) {
            require("(", token);
            read_row();
        }
        if (!count.empty() && count != std::to_string(table_.rows())) {
            fail(fmt::format("{} rows, where {} are announced", table_.rows(), count));
        }
        token = tokens_.next();
        if (!token.empty() && token != ";") {
            fail(fmt::format("nothing was expected after the list, not {}", in_quotes(token)));
        }
        return std::move(table_);
    }

private:
    /// "time ((x y z) (roll pitch yaw)))"
    void read_row() {
        table_.lines.push_back(tokens_.line());
        read_number(0);
        require("(", tokens_.next());
        for (const std::size_t first : {std::size_t{1}, std::size_t{4}}) {
            require("(", tokens_.next());
            for (std::size_t k = 0; k < 3; ++k) {
                read_number(first + k);
            }
            require(")", tokens_.next());
        }
        require(")", tokens_.next());
        require(")", tokens_.next());
    }

    void read_number(std::size_t column) {
        const std::string_view token = tokens_.next();
        double value = 0;
        if (!parse_number(token, value) || !std::isfinite(value)) {
            fail(fmt::format("{}: a finite number was expected, not {}", in_quotes(table_.columns[column]),
                             in_quotes(token)));
        }
        table_.values.push_back(value);
    }

    void require(std::string_view expected, std::string_view token) const {
        if (token != expected) {
            fail(fmt::format("\"{}\" was expected in the list of (time ((x y z) (roll pitch yaw))), not {}",
                             expected, in_quotes(token)));
        }
    }

    [[noreturn]] void fail(const std::string& text) const { fail_in_line(table_.path, tokens_.line(), text); }

    ListTokens tokens_;
    CsvTable table_;
};

} // namespace

bool is_six_dof_list(std::string_view text) {
    ListTokens tokens{text};
    const std::string_view first = tokens.next();
    return first == "(" || (is_digits(first) && tokens.next() == "(");
}

CsvTable read_six_dof_list(std::string_view text, const std::string& path) {
    return SixDofReader{text, path}.run();
}

} // namespace slabhull::io
