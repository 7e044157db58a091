// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/displacement_series.h"

#include "geometry/basics/vector_algebra.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"

#include <algorithm>
#include <fmt/core.h>
#include <map>

namespace slabhull {

namespace {

using namespace detail;

/// Weight of each row that counts.
using Weights = std::map<std::size_t, double>;

/// Adds `factor` times the slope at row i of the polynomial through the rows near it: the derivative of
/// Lagrange's polynomials at a node, in barycentric form. Berrut and Trefethen, "Barycentric Lagrange
/// Interpolation", SIAM Review 46 (2004), section 9.3.
void add_slope(const std::vector<double>& t, std::size_t i, double factor, Weights& weights) {
    constexpr std::size_t most = 5;
    const std::size_t count = std::min(most, t.size());
    const std::size_t first = std::min(i - std::min(i, most / 2), t.size() - count);
    for (std::size_t j = first; j < first + count; ++j) {
        if (j == i) {
            continue;
        }
        double ratio = 1; // of the barycentric weights of j and i
        for (std::size_t k = first; k < first + count; ++k) {
            ratio *= (k == i ? 1 : t[i] - t[k]) / (k == j ? 1 : t[j] - t[k]);
        }
        const double weight = factor * ratio / (t[i] - t[j]);
        weights[j] += weight;
        weights[i] -= weight;
    }
}

/// Needs: times.front() <= t <= times.back().
Weights weights_at(const std::vector<double>& times, double t, TimeInterpolation interpolation) {
    const auto after = std::lower_bound(times.begin(), times.end(), t);
    const auto j = static_cast<std::size_t>(after - times.begin());
    if (*after == t) {
        return {{j, 1}};
    }
    const std::size_t i = j - 1;
    const double h = times[j] - times[i];
    const double u = (t - times[i]) / h;
    const double w = 1 - u;
    if (interpolation == TimeInterpolation::linear) {
        return {{i, w}, {j, u}};
    }
    Weights weights{{i, w * w * (1 + 2 * u)}, {j, u * u * (1 + 2 * w)}};
    add_slope(times, i, h * u * w * w, weights);
    add_slope(times, j, -h * u * u * w, weights);
    return weights;
}

[[noreturn]] void refuse_row_of_series(std::size_t row, const std::string& what) {
    throw UsageError{what, {{"row", static_cast<std::int64_t>(row), ""}}};
}

template<int D>
void require_row(const DisplacementRows<D>& rows, std::size_t row) {
    if (row > 0 && !(rows.times[row] > rows.times[row - 1])) {
        refuse_row_of_series(row, fmt::format("the times of displacements must ascend, but {} comes after {}",
                                              rows.times[row], rows.times[row - 1]));
    }
    if (!std::isfinite(rows.times[row])) {
        refuse_row_of_series(
            row, fmt::format("the time {} of displacements is no finite number", rows.times[row]));
    }
    const auto& row_of_points = rows.displacements[row];
    if (row_of_points.size() != rows.tracks.size()) {
        refuse_row_of_series(row, fmt::format("{} displacements at t = {} for {} tracks",
                                              row_of_points.size(), rows.times[row], rows.tracks.size()));
    }
    for (std::size_t i = 0; i < row_of_points.size(); ++i) {
        if (!all_finite(row_of_points[i])) {
            refuse_row_of_series(row, fmt::format("track {} is displaced by {} at t = {}", rows.tracks[i],
                                                  to_text(row_of_points[i]), rows.times[row]));
        }
    }
}

template<int D>
class DisplacementSeries final : public NodalMotion<D> {
public:
    DisplacementSeries(DisplacementRows<D> rows, TimeInterpolation interpolation)
        : rows_{std::move(rows)}, interpolation_{interpolation} {
        require_consistent();
        for (std::size_t row = 0; row < rows_.times.size(); ++row) {
            require_row(rows_, row);
        }
    }

    void positions(std::span<const TrackId> tracks, double t, std::span<Point<D>> x) const override {
        const Weights weights = weights_at(rows_.times, clamped(t), interpolation_);
        constexpr std::size_t grain = 4096;
        parallel_for(tracks.size(), grain, [&](std::size_t begin, std::size_t end) {
            std::size_t place = rows_.tracks.size();
            for (std::size_t i = begin; i < end; ++i) {
                place = place_of(tracks[i], place + 1);
                Point<D> moved = rows_.start[place];
                for (const auto& [row, weight] : weights) {
                    moved = plus(moved, times(weight, rows_.displacements[row][place]));
                }
                x[i] = moved;
            }
        });
    }

    std::vector<double> row_times() const override { return rows_.times; }

private:
    void require_consistent() const {
        const bool lengths_agree =
            rows_.start.size() == rows_.tracks.size() && rows_.displacements.size() == rows_.times.size();
        if (rows_.times.empty() || !lengths_agree) {
            throw UsageError{fmt::format(
                "{} times with {} rows of displacements, {} tracks with {} starts: a "
                "displacement series needs one of the latter for each of the former",
                rows_.times.size(), rows_.displacements.size(), rows_.tracks.size(), rows_.start.size())};
        }
        for (std::size_t i = 1; i < rows_.tracks.size(); ++i) {
            if (rows_.tracks[i] <= rows_.tracks[i - 1]) {
                throw UsageError{fmt::format("the tracks of displacements must ascend, but {} comes after {}",
                                             rows_.tracks[i], rows_.tracks[i - 1])};
            }
        }
        for (const Point<D>& point : rows_.start) {
            require_finite(point, "the start of a displaced track");
        }
    }

    /// Clamps to the rows: levels computed from a slab's times may miss the first or last row by a rounding
    /// error.
    double clamped(double t) const {
        const double first = rows_.times.front();
        const double last = rows_.times.back();
        const double slack = 1e-9 * (last - first);
        if (!(t >= first - slack && t <= last + slack)) {
            throw GeometryError{fmt::format(
                "displacements are known from t = {} to {}, but t = {} was asked for", first, last, t)};
        }
        return std::clamp(t, first, last);
    }

    /// `likely`: the track's place if tracks are queried in order.
    std::size_t place_of(TrackId track, std::size_t likely) const {
        if (likely < rows_.tracks.size() && rows_.tracks[likely] == track) {
            return likely;
        }
        const auto found = std::lower_bound(rows_.tracks.begin(), rows_.tracks.end(), track);
        if (found == rows_.tracks.end() || *found != track) {
            throw GeometryError{fmt::format("track {} has no displacements", track), {{"track", track, ""}}};
        }
        return static_cast<std::size_t>(found - rows_.tracks.begin());
    }

    DisplacementRows<D> rows_;
    TimeInterpolation interpolation_;
};

} // namespace

template<int D>
NodalMotionPointer<D> displacement_series(DisplacementRows<D> rows, TimeInterpolation interpolation) {
    return std::make_shared<DisplacementSeries<D>>(std::move(rows), interpolation);
}

template NodalMotionPointer<2> displacement_series<2>(DisplacementRows<2>, TimeInterpolation);
template NodalMotionPointer<3> displacement_series<3>(DisplacementRows<3>, TimeInterpolation);

} // namespace slabhull
