// SPDX-License-Identifier: BSD-3-Clause
// Tables as text: the part of RFC 4180 that numbers need, and the variants of spreadsheets and numpy.
#include "slabhull/io/files.h"

#include "io/files/file_cursor.h"
#include "io/tables/table_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace slabhull::io {

namespace {

constexpr std::size_t most_columns = 1000;
constexpr std::size_t longest_name = 100;

std::string_view without_blanks(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) {
        text.remove_prefix(1);
    }
    while (!text.empty() && is_blank(text.back())) {
        text.remove_suffix(1);
    }
    return text;
}

std::string_view unquoted(std::string_view text) {
    const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
    return quoted ? text.substr(1, text.size() - 2) : text;
}

/// Removes the next field from a line; the separator ' ' stands for any blanks.
std::string_view next_field(std::string_view& line, char separator) {
    const auto is_end = [separator](char c) { return separator == ' ' ? is_blank(c) : c == separator; };
    if (separator == ' ') {
        line = without_blanks(line);
    }
    const auto end = static_cast<std::size_t>(std::find_if(line.begin(), line.end(), is_end) - line.begin());
    const std::string_view field = without_blanks(line.substr(0, end));
    line.remove_prefix(std::min(end + 1, line.size()));
    return unquoted(field);
}

bool is_name(std::string_view text) {
    const bool printable = std::all_of(text.begin(), text.end(),
                                       [](unsigned char c) { return c >= 0x80 || std::isprint(c) != 0; });
    return !text.empty() && text.size() <= longest_name && printable;
}

class CsvReader {
public:
    CsvReader(std::string_view bytes, std::string path) : rest_{bytes} { table_.path = std::move(path); }

    CsvTable run() {
        constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
        if (rest_.starts_with(byte_order_mark)) {
            rest_.remove_prefix(byte_order_mark.size());
        }
        read_header();
        for (std::string_view line; next_line(line);) {
            if (!line.empty() && line.front() != '#') {
                read_row(line);
            }
        }
        return std::move(table_);
    }

private:
    /// The next line without blanks at its ends; false after the last.
    bool next_line(std::string_view& line) {
        if (rest_.empty()) {
            return false;
        }
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        line = without_blanks(rest_.substr(0, end));
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        ++line_;
        return true;
    }

    /// Reads the names: the first line that is not blank, optionally after a '#'.
    void read_header() {
        std::string_view line;
        while (line.empty() && next_line(line)) {
        }
        if (!line.empty() && line.front() == '#') {
            line = without_blanks(line.substr(1));
        }
        if (line.empty()) {
            fail("a line with the names of the columns was expected, but the file is empty; write it again");
        }
        const std::string_view start = line.substr(0, most_columns * (longest_name + 1));
        separator_ = start.find(',') != start.npos ? ',' : start.find(';') != start.npos ? ';' : ' ';
        while (!line.empty()) {
            add_column(next_field(line, separator_));
        }
    }

    void add_column(std::string_view name) {
        double number = 0;
        if (!is_name(name) || parse_number(name, number)) {
            fail(fmt::format(
                "the name of column {} was expected, not {}; the first line names the columns, such as "
                "time, angle",
                table_.columns.size() + 1, in_quotes(name)));
        }
        if (table_.find(name)) {
            fail(fmt::format("there are two columns {}", in_quotes(name)));
        }
        if (table_.columns.size() == most_columns) {
            fail(fmt::format("a table may have {} columns at most", most_columns));
        }
        table_.columns.emplace_back(name);
    }

    void read_row(std::string_view line) {
        const std::size_t count = table_.columns.size();
        for (std::size_t column = 0; column < count; ++column) {
            if (line.empty()) {
                fail(fmt::format(
                    "column {} is missing: {} values where the header names {} columns; give a value for "
                    "each",
                    in_quotes(table_.columns[column]), column, count));
            }
            table_.values.push_back(number_in(next_field(line, separator_), column));
        }
        if (!line.empty()) {
            fail(fmt::format(
                "more than the {} values that the header names columns for: {}; numbers have a decimal "
                "point, and commas part them",
                count, in_quotes(line)));
        }
        table_.lines.push_back(line_);
    }

    double number_in(std::string_view field, std::size_t column) const {
        double value = 0;
        if (!parse_number(field, value) || !std::isfinite(value)) {
            const bool comma = field.find(',') != field.npos;
            fail(fmt::format("column {}: a finite number was expected, not {}{}",
                             in_quotes(table_.columns[column]), in_quotes(field),
                             comma ? "; write numbers with a decimal point" : ""));
        }
        return value;
    }

    [[noreturn]] void fail(const std::string& text) const {
        fail_in_line(table_.path, std::max<std::size_t>(line_, 1), text);
    }

    std::string_view rest_;
    std::size_t line_ = 0; ///< the one being read
    char separator_ = ',';
    CsvTable table_;
};

} // namespace

std::optional<std::size_t> CsvTable::find(std::string_view name) const {
    const auto found = std::find(columns.begin(), columns.end(), name);
    return found == columns.end() ? std::nullopt
                                  : std::optional{static_cast<std::size_t>(found - columns.begin())};
}

void CsvTable::fail(std::size_t row, const std::string& text) const {
    fail_in_line(path, lines[row], text);
}

void CsvTable::fail_columns(const std::string& text) const {
    throw InputError(fmt::format("{}: {}; the columns are {}", path, text, fmt::join(columns, ", ")));
}

CsvTable read_csv(const std::filesystem::path& path) {
    const Array<char> bytes = read_bytes(path);
    return CsvReader{{bytes.data(), bytes.size()}, path.string()}.run();
}

CsvTable read_motion_table(const std::filesystem::path& path) {
    const Array<char> bytes = read_bytes(path);
    const std::string_view text{bytes.data(), bytes.size()};
    return is_six_dof_list(text) ? read_six_dof_list(text, path.string())
                                 : CsvReader{text, path.string()}.run();
}

} // namespace slabhull::io
