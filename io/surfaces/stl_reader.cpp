// SPDX-License-Identifier: BSD-3-Clause
#include "io/surfaces/surface_readers.h"

#include "core/hash.h"
#include "io/files/coordinate.h"
#include "io/files/file_cursor.h"
#include "slabhull/core/vector.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace slabhull::io {

namespace {

constexpr std::size_t head_size = 84; // title and count
constexpr std::size_t facet_size = 50;

/// Whether a word is a keyword, ignoring case; `keyword` is in lower case.
bool is(std::string_view word, std::string_view keyword) {
    return word.size() == keyword.size() &&
           std::equal(word.begin(), word.end(), keyword.begin(),
                      [](unsigned char a, char b) { return static_cast<char>(std::tolower(a)) == b; });
}

/// Numbers points of single precision, equal ones alike, in the order of first occurrence; 0 and -0 are
/// equal. An open-addressing hash table of the numbers.
class Welder {
public:
    explicit Welder(Array<Point<3>>& points) : points_{points}, table_(1024, no_index) {}

    /// Not inlined: gcc 12 would drop the rounding of two doubles to floats and back.
    [[gnu::noinline]] Index operator()(const std::array<float, 3>& x) {
        const Point<3> point{x[0], x[1], x[2]};
        if (2 * points_.size() >= table_.size()) {
            grow();
        }
        const std::size_t place = place_of(point);
        if (table_[place] == no_index) {
            table_[place] = static_cast<Index>(points_.size());
            points_.push_back(point);
        }
        return table_[place];
    }

private:
    static std::uint64_t hash(const Point<3>& x) {
        std::uint64_t value = 0;
        for (const double each : x) {
            value = combined_hash(value, std::bit_cast<std::uint64_t>(each + 0.0)); // 0 for -0
        }
        return value;
    }

    std::size_t place_of(const Point<3>& point) const {
        std::size_t place = hash(point) & (table_.size() - 1);
        while (table_[place] != no_index && points_[table_[place]] != point) {
            place = (place + 1) & (table_.size() - 1);
        }
        return place;
    }

    void grow() {
        table_.assign(2 * table_.size(), no_index);
        for (std::size_t i = 0; i < points_.size(); ++i) {
            table_[place_of(points_[i])] = static_cast<Index>(i);
        }
    }

    Array<Point<3>>& points_;
    Array<Index> table_;
};

class StlReader {
public:
    StlReader(FileBytes& file, SurfaceBuilder& surface)
        : in_{file}, surface_{surface}, weld_{surface.points} {
        surface_.labels.resize(1);
    }

    void run() {
        in_.set_binary(true);
        const std::size_t size = in_.remaining();
        const std::string_view head{in_.take(std::min(size, head_size), "the head"),
                                    std::min(size, head_size)};
        const std::size_t start = head.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
        const bool has_name = is(head.substr(start, 5), "solid");
        const auto count = size < head_size ? 0 : load<std::uint32_t>(head.data() + head_size - 4, false);
        const std::uint64_t binary_size = head_size + std::uint64_t{facet_size} * count;
        if (size == binary_size) { // the only safe test: binary files may also start with "solid"
            read_binary();
        } else if (has_name) {
            in_.seek(start);
            in_.set_binary(false);
            read_text();
        } else {
            in_.seek(0);
            in_.fail(size < head_size ? "this is no STL file: it is too short for one"
                     : is_text(head)
                         ? "this is no STL file: as text, it would begin with \"solid\"; export it anew"
                         : fmt::format("{} facets take {} bytes, but the file has {}: it was {}; export or "
                                       "copy it again",
                                       count, binary_size, size,
                                       size < binary_size ? "cut short" : "added to"));
        }
        remark_rounding();
    }

private:
    /// Heads of binary files end with a count, of which one byte at least is no letter.
    static bool is_text(std::string_view head) {
        return std::all_of(head.begin(), head.end(),
                           [](unsigned char c) { return std::isprint(c) != 0 || std::isspace(c) != 0; });
    }

    void read_binary() {
        for (std::size_t facet = 0; in_.remaining() > 0; ++facet) {
            const char* bytes = in_.take(facet_size, "a facet") + 3 * sizeof(float); // the normal
            std::array<Index, 3> corners{};
            for (std::size_t k = 0; k < 3; ++k) {
                std::array<float, 3> x{};
                std::memcpy(x.data(), bytes + k * sizeof x, sizeof x);
                corners[k] = vertex(facet, {x[0], x[1], x[2]});
            }
            add(corners);
        }
    }

    void read_text() {
        while (!in_.at_end()) {
            expect("solid");
            surface_.labels[0].set(surface_.triangles(), in_.line());
            std::string_view word = in_.word();
            for (; is(word, "facet"); word = in_.word()) {
                read_facet();
            }
            if (!is(word, "endsolid")) {
                in_.fail(
                    fmt::format("\"facet\" or \"endsolid\" was expected, not \"{}\"", word.substr(0, 40)));
            }
            in_.line();
            surface_.labels[0].set(surface_.triangles(), "");
        }
    }

    void read_facet() {
        expect("normal");
        for (int i = 0; i < 3; ++i) {
            in_.word(); // normals are often wrong, and not needed
        }
        expect("outer");
        expect("loop");
        std::array<Index, 3> corners{};
        for (Index& corner : corners) {
            expect("vertex");
            Point<3> x{};
            for (double& value : x) {
                value = in_.parsed<double>("a coordinate");
            }
            corner = vertex(surface_.faces(), x);
        }
        const std::string_view end = in_.word();
        if (is(end, "vertex")) {
            in_.fail(fmt::format("facet {} has more than three vertices", surface_.faces()));
        }
        if (!is(end, "endloop")) {
            in_.fail(fmt::format("\"endloop\" was expected, not \"{}\"", end.substr(0, 40)));
        }
        expect("endfacet");
        add(corners);
    }

    void expect(std::string_view keyword) {
        const std::string_view found = in_.word();
        if (!is(found, keyword)) {
            in_.fail(fmt::format("\"{}\" was expected, not \"{}\"", keyword, found.substr(0, 40)));
        }
    }

    /// Far from the origin, single precision may move places by more than a solver would accept.
    void remark_rounding() {
        constexpr double told = 1e-3; // of an edge
        const double step = std::numeric_limits<float>::epsilon() * largest_;
        const double edge = edges_ / static_cast<double>(surface_.triangles());
        if (step > told * edge) {
            surface_.remarks.push_back(fmt::format("STL has single precision: coordinates of {:.3g} go in "
                                                   "steps of {:.2g}, and an edge is {:.2g} long, "
                                                   "so the shape is not what it was. Use PLY, OBJ or OFF, or "
                                                   "move it to the origin before you export it",
                                                   largest_, step, edge));
        }
    }

    Index vertex(std::size_t facet, const Point<3>& x) {
        for (const double value : x) {
            largest_ = std::max(largest_, std::abs(value));
            if (!is_coordinate(value)) {
                in_.fail(why_no_coordinate(value, fmt::format("facet {}", facet)));
            }
        }
        if (surface_.points.size() >= no_index) {
            in_.fail(fmt::format("there are more than {} points", no_index));
        }
        return weld_({static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])});
    }

    void add(const std::array<Index, 3>& corners) {
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
            surface_.skip_face();
        } else {
            surface_.add_triangle(corners[0], corners[1], corners[2]);
            edges_ += distance(surface_.points[corners[0]], surface_.points[corners[1]]);
        }
    }

    FileCursor in_;
    SurfaceBuilder& surface_;
    Welder weld_;
    double largest_ = 0; ///< coordinate
    double edges_ = 0;   ///< length of one edge of each triangle
};

} // namespace

void read_stl(FileBytes& file, SurfaceBuilder& surface) {
    StlReader{file, surface}.run();
}

} // namespace slabhull::io
