// SPDX-License-Identifier: BSD-3-Clause
#include "io/surfaces/polygon.h"

#include "slabhull/core/vector.h"

#include <algorithm>
#include <cmath>

namespace slabhull::io {

namespace {

using Place = std::array<double, 2>;

constexpr std::size_t longest = 10'000;
constexpr double no_ear = -1;

/// Twice the polygon's area, along its normal (Newell).
Point<3> area_vector(std::span<const Point<3>> corners) {
    Point<3> sum{};
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        sum = plus(sum, cross(minus(corners[i], corners[0]), minus(corners[i + 1], corners[0])));
    }
    return sum;
}

struct Size {
    double extent = 0;     ///< the longest side of the box
    double coordinate = 0; ///< the largest one
};

Size size_of(std::span<const Point<3>> corners) {
    Size size;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto [least, most] =
            std::minmax_element(corners.begin(), corners.end(),
                                [k](const Point<3>& a, const Point<3>& b) { return a[k] < b[k]; });
        size.extent = std::max(size.extent, (*most)[k] - (*least)[k]);
        size.coordinate = std::max({size.coordinate, std::abs((*least)[k]), std::abs((*most)[k])});
    }
    return size;
}

bool is_planar(std::span<const Point<3>> corners, const Point<3>& normal, const Size& size) {
    double least = 0;
    double most = 0;
    for (const Point<3>& corner : corners) {
        const double height = dot(minus(corner, corners[0]), normal);
        least = std::min(least, height);
        most = std::max(most, height);
    }
    const double tolerance = std::min(1e-6 * size.coordinate, 1e-3 * size.extent);
    return most - least <= 2 * tolerance * norm(normal);
}

/// The polygon projected to the nearest coordinate plane, so that it is counterclockwise.
std::vector<Place> flattened(std::span<const Point<3>> corners, const Point<3>& normal) {
    std::size_t k = 0;
    for (std::size_t i = 1; i < 3; ++i) {
        k = std::abs(normal[i]) > std::abs(normal[k]) ? i : k;
    }
    std::size_t l = (k + 1) % 3;
    std::size_t m = (k + 2) % 3;
    if (normal[k] < 0) {
        std::swap(l, m);
    }
    std::vector<Place> places;
    for (const Point<3>& corner : corners) {
        places.push_back({corner[l], corner[m]});
    }
    return places;
}

/// Cuts ears off a counterclockwise polygon. Turns below the tolerance (a sine) count as straight, so that
/// rounded vertices on a side do not give triangles without area.
class EarClipper {
public:
    EarClipper(const std::vector<Place>& places, double tolerance)
        : places_{places}, tolerance_{tolerance}, size_{places.size()} {
        for (std::size_t i = 0; i < size_; ++i) {
            before_.push_back((i + size_ - 1) % size_);
            after_.push_back((i + 1) % size_);
        }
    }

    bool run(std::vector<PolygonTriangle>& triangles) {
        weigh_all();
        for (std::size_t left = size_; left > 3; --left) {
            std::size_t ear = best(left);
            if (quality_[ear] == no_ear) {
                weigh_all();
                ear = best(left);
            }
            if (quality_[ear] == no_ear) {
                return false;
            }
            triangles.push_back(triangle(ear));
            cut(ear);
        }
        triangles.push_back(triangle(first_));
        return shape(first_) > 0;
    }

private:
    /// Positive for a left turn, 0 if straight.
    double turn(std::size_t i, std::size_t j, std::size_t k) const {
        const Place a{places_[j][0] - places_[i][0], places_[j][1] - places_[i][1]};
        const Place b{places_[k][0] - places_[i][0], places_[k][1] - places_[i][1]};
        const double value = a[0] * b[1] - a[1] * b[0];
        const double scale = std::hypot(a[0], a[1]) * std::hypot(b[0], b[1]);
        return std::abs(value) <= tolerance_ * scale ? 0 : value;
    }

    /// Quality of a vertex's triangle, its area over the longest side squared; not positive unless it turns
    /// left.
    double shape(std::size_t i) const {
        double longest_side = 0;
        const PolygonTriangle corners = triangle(i);
        for (std::size_t k = 0; k < 3; ++k) {
            const Place& a = places_[corners[k]];
            const Place& b = places_[corners[(k + 1) % 3]];
            longest_side = std::max(longest_side, std::hypot(a[0] - b[0], a[1] - b[1]));
        }
        return turn(before_[i], i, after_[i]) / (longest_side * longest_side);
    }

    PolygonTriangle triangle(std::size_t i) const { return {before_[i], i, after_[i]}; }

    bool holds(const PolygonTriangle& corners, std::size_t vertex) const {
        return turn(corners[0], corners[1], vertex) >= 0 && turn(corners[1], corners[2], vertex) >= 0 &&
               turn(corners[2], corners[0], vertex) >= 0;
    }

    void weigh(std::size_t i) {
        quality_[i] = no_ear;
        const double value = shape(i);
        if (!(value > 0)) {
            return;
        }
        const PolygonTriangle corners = triangle(i);
        for (std::size_t other = after_[corners[2]]; other != corners[0]; other = after_[other]) {
            // Only vertices that do not turn left are tested: if one that does is inside, so is one that does
            // not.
            if (turn(before_[other], other, after_[other]) <= 0 && holds(corners, other)) {
                return;
            }
        }
        quality_[i] = value;
    }

    void weigh_all() {
        quality_.resize(size_, no_ear);
        std::size_t i = first_;
        do {
            weigh(i);
            i = after_[i];
        } while (i != first_);
    }

    /// The best ear; of four vertices, also counts the triangle that is left.
    std::size_t best(std::size_t left) const {
        std::size_t result = first_;
        double most = no_ear;
        std::size_t i = first_;
        do {
            const double rest = left == 4 ? quality_[after_[after_[i]]] : quality_[i];
            const double value = std::min(quality_[i], rest);
            if (value > most) {
                most = value;
                result = i;
            }
            i = after_[i];
        } while (i != first_);
        return result;
    }

    void cut(std::size_t ear) {
        const std::size_t a = before_[ear];
        const std::size_t b = after_[ear];
        after_[a] = b;
        before_[b] = a;
        first_ = ear == first_ ? b : first_;
        weigh(a);
        weigh(b);
    }

    const std::vector<Place>& places_;
    double tolerance_;
    std::size_t size_;
    std::size_t first_ = 0;
    std::vector<std::size_t> before_;
    std::vector<std::size_t> after_;
    std::vector<double> quality_;
};

} // namespace

const char* explained(PolygonFault fault) {
    switch (fault) {
    case PolygonFault::too_long:
        return ", but polygons of up to 10000 are read; cut it into triangles";
    case PolygonFault::no_area:
        return " and no area, or a vertex twice";
    case PolygonFault::not_planar:
        return " that are not in one plane; cut it into triangles";
    case PolygonFault::not_simple:
        return ", and its sides cross or touch";
    case PolygonFault::none:
        break;
    }
    return "";
}

PolygonFault cut_polygon(std::span<const Point<3>> corners, std::vector<PolygonTriangle>& triangles) {
    triangles.clear();
    if (corners.size() > longest) {
        return PolygonFault::too_long;
    }
    const Size size = size_of(corners);
    const Point<3> normal = area_vector(corners);
    if (!(norm(normal) > 1e-12 * size.extent * size.extent)) {
        return PolygonFault::no_area;
    }
    if (!is_planar(corners, normal, size)) {
        return PolygonFault::not_planar;
    }
    const std::vector<Place> places = flattened(corners, normal);
    for (const double tolerance : {1e-6, 1e-14}) {
        triangles.clear();
        if (EarClipper{places, tolerance}.run(triangles)) {
            return PolygonFault::none;
        }
    }
    return PolygonFault::not_simple;
}

} // namespace slabhull::io
