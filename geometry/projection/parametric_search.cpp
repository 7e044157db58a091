// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/projection/parametric_search.h"

#include "geometry/basics/vector_algebra.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace slabhull::detail {

namespace {

/// Derivatives of half the squared distance as a function of (u, v) at one point. Variables held by the rim
/// are fixed.
class Slope {
public:
    Slope(const SurfaceJet& jet, const Point<3>& x, const std::array<bool, 2>& low,
          const std::array<bool, 2>& high) {
        const Point<3> arm = minus(jet.value, x);
        gradient_ = {dot(arm, jet.du), dot(arm, jet.dv)};
        metric_ = {dot(jet.du, jet.du), dot(jet.du, jet.dv), dot(jet.dv, jet.dv)};
        const std::array<double, 3> bending{dot(arm, jet.duu), dot(arm, jet.duv), dot(arm, jet.dvv)};
        std::transform(metric_.begin(), metric_.end(), bending.begin(), hessian_.begin(),
                       [](double a, double b) { return a + b; });
        for (std::size_t k = 0; k < 2; ++k) {
            if ((low[k] && gradient_[k] > 0) || (high[k] && gradient_[k] < 0)) { // the rim holds it
                gradient_[k] = 0;
                hessian_[1] = metric_[1] = 0;
            }
        }
    }

    /// Length of the gradient in space: directions of (u, v) are measured on the surface.
    double steepness() const {
        double square = 0;
        for (std::size_t k = 0; k < 2; ++k) {
            const double length = metric_[2 * k];
            square += length > 0 ? gradient_[k] * gradient_[k] / length : 0;
        }
        return std::sqrt(square);
    }

    /// Newton's step, or the damped Gauss-Newton step, which always descends, where the distance is not
    /// convex.
    std::array<double, 2> step() const {
        const double determinant = hessian_[0] * hessian_[2] - hessian_[1] * hessian_[1];
        constexpr double convex = 1e-10;
        if (hessian_[0] > 0 && determinant > convex * hessian_[0] * hessian_[2]) {
            return solve(hessian_);
        }
        // Scaled per direction: beside a pole the length of one is tiny, at the pole it is zero.
        constexpr double damping = 1e-3;
        const double least = 1e-16 * (metric_[0] + metric_[2]);
        const std::array<double, 3> damped{metric_[0] * (1 + damping) + least, metric_[1],
                                           metric_[2] * (1 + damping) + least};
        return solve(damped);
    }

private:
    std::array<double, 2> solve(const std::array<double, 3>& m) const {
        const double determinant = m[0] * m[2] - m[1] * m[1];
        if (!(determinant > 0)) {
            return {};
        }
        return {(m[1] * gradient_[1] - m[2] * gradient_[0]) / determinant,
                (m[1] * gradient_[0] - m[0] * gradient_[1]) / determinant};
    }

    std::array<double, 2> gradient_{};
    std::array<double, 3> metric_{};  ///< uu, uv, vv
    std::array<double, 3> hessian_{}; ///< uu, uv, vv
};

} // namespace

ParametricSearch::ParametricSearch(Surface surface, const Parameters& low, const Parameters& high,
                                   const std::array<std::size_t, 2>& samples)
    : surface_{std::move(surface)}, low_{low}, high_{high}, samples_{samples},
      points_(samples[0] * samples[1]), reach_(points_.size()), distances_(points_.size()) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
        points_[i] = surface_(parameters(i)).value;
    }
    const auto link = [this](std::size_t a, std::size_t b) {
        const double length = norm(minus(points_[a], points_[b]));
        reach_[a] = std::max(reach_[a], length);
        reach_[b] = std::max(reach_[b], length);
    };
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const bool right = i % samples_[0] + 1 < samples_[0];
        const bool up = i / samples_[0] + 1 < samples_[1];
        if (right) {
            link(i, i + 1);
        }
        if (up) {
            link(i, i + samples_[0]);
        }
        if (right && up) {
            link(i, i + samples_[0] + 1);
            link(i + 1, i + samples_[0]);
        }
    }
}

ParametricSearch::Parameters ParametricSearch::parameters(std::size_t sample) const {
    const std::array<std::size_t, 2> place{sample % samples_[0], sample / samples_[0]};
    Parameters at;
    for (std::size_t k = 0; k < 2; ++k) {
        const double share = static_cast<double>(place[k]) / static_cast<double>(samples_[k] - 1);
        at[k] = low_[k] * (1 - share) + high_[k] * share;
    }
    return at;
}

bool ParametricSearch::locally_closest(std::size_t sample) const {
    // At a pole many samples coincide, each with another direction of descent.
    constexpr double as_close = 1 - 1e-12;
    const auto [width, height] = samples_;
    const std::size_t u = sample % width;
    const std::size_t v = sample / width;
    for (std::size_t j = v - (v > 0 ? 1 : 0); j < std::min(v + 2, height); ++j) {
        for (std::size_t i = u - (u > 0 ? 1 : 0); i < std::min(u + 2, width); ++i) {
            if (distances_[j * width + i] < as_close * distances_[sample]) {
                return false;
            }
        }
    }
    return true;
}

void ParametricSearch::visit_feet(const Point<3>& x, double limit, const Visit& visit) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
        distances_[i] = norm(minus(points_[i], x));
    }
    starts_.clear();
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (distances_[i] - reach_[i] <= limit && locally_closest(i)) {
            starts_.push_back(i);
        }
    }
    std::sort(starts_.begin(), starts_.end(), [this](std::size_t a, std::size_t b) {
        return std::pair{distances_[a], a} < std::pair{distances_[b], b};
    });
    for (const std::size_t start : starts_) {
        if (distances_[start] - reach_[start] <= limit) {
            const Parameters at = descend(x, parameters(start));
            const Point<3> foot = surface_(at).value;
            limit = visit(at, foot, norm(minus(foot, x)));
        }
    }
}

/// Descends from `at`. Near the minimum the distance is flat to rounding; there, steps are accepted that
/// reduce its slope.
ParametricSearch::Parameters ParametricSearch::descend(const Point<3>& x, Parameters at) const {
    constexpr int most_steps = 50;
    const auto slope_at = [&](const Parameters& place, const SurfaceJet& jet) {
        return Slope{
            jet, x, {place[0] <= low_[0], place[1] <= low_[1]}, {place[0] >= high_[0], place[1] >= high_[1]}};
    };
    SurfaceJet jet = surface_(at);
    Slope slope = slope_at(at, jet);
    for (int count = 0; count < most_steps; ++count) {
        const double distance = norm(minus(jet.value, x));
        std::array<double, 2> step = slope.step();
        bool moved = false;
        for (double share = 1; share > 1e-3 && !moved; share /= 2) {
            Parameters next;
            for (std::size_t k = 0; k < 2; ++k) {
                next[k] = std::clamp(at[k] + share * step[k], low_[k], high_[k]);
            }
            const SurfaceJet there = surface_(next);
            const Slope next_slope = slope_at(next, there);
            const double change = norm(minus(there.value, x)) - distance;
            const bool flat = std::abs(change) <= 1e-13 * (distance + norm(there.value));
            if (next != at && (flat ? next_slope.steepness() < slope.steepness() : change < 0)) {
                at = next;
                jet = there;
                slope = next_slope;
                moved = true;
            }
        }
        if (!moved) {
            break;
        }
    }
    return at;
}

} // namespace slabhull::detail
