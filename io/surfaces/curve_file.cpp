// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/files/file_cursor.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <optional>
#include <span>

namespace slabhull::io {

namespace {

/// Titles start with a letter; of numbers, only "nan" and "inf" do, which are refused elsewhere.
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

// --- Lednicer's order: the counts of the upper and the lower side, then both from the leading edge on

struct Counts {
    std::size_t upper;
    std::size_t lower;
};

/// The counts, if the first line has two whole numbers.
std::optional<Counts> counts_in(const Point<3>& line) {
    constexpr double fewest = 2;
    constexpr double most = 1e6;
    for (std::size_t k = 0; k < 2; ++k) {
        if (!(line[k] >= fewest && line[k] <= most && line[k] == std::floor(line[k]))) {
            return std::nullopt;
        }
    }
    return Counts{static_cast<std::size_t>(line[0]), static_cast<std::size_t>(line[1])};
}

double extent_of(std::span<const Point<3>> points) {
    double extent = 0;
    for (const Point<3>& x : points) {
        extent = std::max({extent, std::abs(x[0] - points[0][0]), std::abs(x[1] - points[0][1])});
    }
    return extent;
}

/// Joins the sides to one curve: from the trailing edge over the upper side to the leading edge, back on the
/// lower.
void join_sides(Array<Point<3>>& points, const Counts& counts) {
    const auto lower = points.begin() + 1 + static_cast<std::ptrdiff_t>(counts.upper);
    Array<Point<3>> curve(std::make_reverse_iterator(lower), std::make_reverse_iterator(points.begin() + 1));
    const bool same_nose = curve.back() == *lower;
    curve.insert(curve.end(), lower + (same_nose ? 1 : 0), points.end());
    points = std::move(curve);
}

/// Reorders the points of a file in Lednicer's order along the curve. Refuses a file whose first line looks
/// like counts, being far larger than what follows, but does not match the points.
void settle_order(Soup& soup) {
    const auto counts = soup.points.size() > 4 ? counts_in(soup.points[0]) : std::nullopt;
    if (!counts) {
        return;
    }
    const auto rest = std::span{soup.points}.subspan(1);
    const double extent = extent_of(rest);
    const bool complete = rest.size() == counts->upper + counts->lower;
    if (complete) {
        const Point<3>& nose = rest[0];
        const Point<3>& other = rest[counts->upper];
        if (std::hypot(nose[0] - other[0], nose[1] - other[1]) <= 0.01 * extent) {
            join_sides(soup.points, *counts);
            soup.remarks.push_back(
                fmt::format("{}: {} points of an upper and {} of a lower side, both from the "
                            "leading edge on (Lednicer's order), are one curve",
                            soup.path, counts->upper, counts->lower));
            return;
        }
    }
    const bool stands_apart =
        std::hypot(soup.points[0][0] - rest[0][0], soup.points[0][1] - rest[0][1]) > 2 * extent;
    if (stands_apart) {
        throw InputError(
            fmt::format("{}: its first line looks like the counts of Lednicer's order, {} points of the "
                        "upper side and {} of the lower, each from the leading edge on, but {}",
                        soup.path, counts->upper, counts->lower,
                        complete ? "the two sides do not start at one place"
                                 : fmt::format("{} points follow", rest.size())));
    }
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
    settle_order(soup);
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
