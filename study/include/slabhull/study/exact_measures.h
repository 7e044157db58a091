// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

namespace slabhull {

/// Measures of a slab as the continuous geometry has them, in space-time: areas for D = 2, volumes for D = 3.
struct ExactMeasures {
    double initial;
    double side;
    double terminating;
    double enclosed; ///< the integral over time of the domain's area or volume
    double hull() const { return initial + side + terminating; }
};

/// The exact measures of one of the paper's six experiments over t in [0, 1]. Those at rest and the expanding
/// ones have closed forms; the sides of turning ellipsoids are quadratures good to 12 digits. (The paper has
/// exact values of the whole hull for the first four only, and of the terminating cap for the turning ones.)
/// Throws UsageError naming the experiments there are.
ExactMeasures exact_measures(const std::string& experiment);

/// What a surface that turns about z at `rate` (radians per unit of time) sweeps in a unit of time: the
/// integral of sqrt(1 + v_n^2) over the ellipsoid with these semi-axes, v_n its normal velocity. With rate 0,
/// its area. Good to 12 digits for ratios of semi-axes up to 5. Cost: some milliseconds.
double turning_ellipsoid_measure(const std::array<double, 3>& semi_axes, double rate);

} // namespace slabhull
