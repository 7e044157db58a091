// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/basics/point_finder.h"

#include <algorithm>
#include <cmath>

namespace slabhull {

namespace {

/// Position along a unit vector whose entries are not in simple ratios.
template<int D>
double along_direction(const Point<D>& x) {
    constexpr std::array<double, 3> direction{0.5436182, 0.8113417, 0.2154843};
    double sum = 0;
    double squares = 0;
    for (std::size_t k = 0; k < D; ++k) {
        sum += direction[k] * x[k];
        squares += direction[k] * direction[k];
    }
    return sum / std::sqrt(squares);
}

} // namespace

template<int D>
PointFinder<D>::PointFinder(std::span<const Point<D>> points) : points_{points}, places_(points.size()) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        places_[i] = {along_direction<D>(points[i]), i};
    }
    std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
        return a.along != b.along ? a.along < b.along : a.point < b.point;
    });
}

template<int D>
std::vector<std::size_t> PointFinder<D>::within(const Point<D>& x, double radius) const {
    const double along = along_direction<D>(x);
    const double reach = radius + 1e-12 * (std::abs(along) + radius); // rounding of the positions
    const auto first = std::partition_point(places_.begin(), places_.end(),
                                            [&](const Place& place) { return place.along < along - reach; });
    std::vector<std::pair<double, std::size_t>> found;
    for (auto place = first; place != places_.end() && place->along <= along + reach; ++place) {
        const double far = distance(points_[place->point], x);
        if (far <= radius) {
            found.emplace_back(far, place->point);
        }
    }
    std::sort(found.begin(), found.end());
    std::vector<std::size_t> numbers;
    for (const auto& [far, point] : found) {
        numbers.push_back(point);
    }
    return numbers;
}

template<int D>
std::size_t PointFinder<D>::nearest(const Point<D>& x) const {
    const auto nearest =
        std::min_element(points_.begin(), points_.end(), [&x](const Point<D>& a, const Point<D>& b) {
            return distance(a, x) < distance(b, x);
        });
    return static_cast<std::size_t>(nearest - points_.begin());
}

template class PointFinder<2>;
template class PointFinder<3>;

} // namespace slabhull
