// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/files/file_cursor.h"

#include <cctype>
#include <cmath>
#include <fmt/format.h>

namespace slabhull::io {

namespace {

/// Titles start with a letter; a number may start with one only as "nan" or "inf", which is caught as such.
bool holds_no_point(std::string_view line) {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos || line[first] == '#') {
        return true;
    }
    std::string word;
    for (std::size_t i = first; i < line.size() && !is_blank(line[i]); ++i) {
        word += static_cast<char>(std::tolower(static_cast<unsigned char>(line[i])));
    }
    const bool is_number = word == "nan" || word == "inf" || word == "infinity";
    return std::isalpha(static_cast<unsigned char>(line[first])) != 0 && !is_number;
}

Point<3> read_point(FileCursor& in) {
    Point<3> point{};
    const std::size_t start = in.offset();
    const std::size_t end = start + in.line().size();
    in.seek(start);
    for (std::size_t i = 0; i < 2; ++i) {
        point[i] = in.parsed<double>("a coordinate");
        if (in.offset() > end) {
            in.fail_at(start, "two coordinates \"x y\" were expected");
        }
        if (!std::isfinite(point[i])) {
            in.fail("a coordinate is not a finite number");
        }
    }
    if (in.line().find_first_not_of(" \t\r") != std::string_view::npos) {
        in.fail_at(start, "two coordinates \"x y\" were expected and nothing else");
    }
    return point;
}

void close_loop(Soup& soup) {
    SimplexBlock& lines = soup.simplices[1];
    const Index count = checked_index(soup.points.size(), "points");
    for (Index i = 0; i < count; ++i) {
        lines.vertices.push_back(i);
        lines.vertices.push_back((i + 1) % count);
    }
}

} // namespace

Soup read_curve(const std::filesystem::path& path) {
    const Array<char> bytes = read_bytes(path);
    FileCursor in{{bytes.data(), bytes.size()}, path.string()};
    Soup soup;
    soup.path = path.string();
    while (!in.at_end()) {
        const std::size_t start = in.offset();
        if (!holds_no_point(in.line())) {
            in.seek(start);
            soup.points.push_back(read_point(in));
        }
    }
    if (soup.points.size() > 1 && soup.points.back() == soup.points.front()) {
        soup.points.pop_back();
    }
    constexpr std::size_t fewest = 3;
    if (soup.points.size() < fewest) {
        throw InputError(
            fmt::format("{}: {} points make no closed curve", path.string(), soup.points.size()));
    }
    close_loop(soup);
    return soup;
}

} // namespace slabhull::io
