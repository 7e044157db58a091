// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/geometry/affine.h"

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace slabhull {

/// Motion of the points of a boundary patch: a velocity field dx/dt = v(x, t). Immutable; all members may be
/// called from several threads at once.
template<int D>
class Motion {
public:
    virtual ~Motion() = default;

    /// v[i] = velocity at x[i] at time t; the spans are equally long and do not overlap.
    /// Throws GeometryError where the field has no finite value.
    virtual void velocity(std::span<const Point<D>> x, double t, std::span<Point<D>> v) const = 0;

    /// The path in closed form: maps the position at time `from` to that at time `to`. Empty if none is
    /// known.
    virtual std::optional<AffineMap<D>> map(double from, double to) const = 0;

    /// False only for a motion that leaves every point in its place.
    virtual bool moves() const { return true; }

    /// Times of a table's rows, ascending. Paths are smooth between two of them; a caller that samples a path
    /// must not step over them. Empty if the motion is not a table.
    virtual std::vector<double> row_times() const { return {}; }

    /// Whether velocity() wants all points in one call, since calls are expensive (an interpreter's
    /// function). Then they are not divided into chunks for several threads, and dopri5 has one substep for
    /// all of them.
    virtual bool in_one_call() const { return false; }
};

template<int D>
using MotionPointer = std::shared_ptr<const Motion<D>>;

// All factories throw UsageError when an argument is not finite.

/// Every point keeps its place.
template<int D>
MotionPointer<D> standing();

/// Turns about the axis through `centre`, right-handed (D = 2: counter-clockwise, `axis` is ignored), by
/// `rate` radians per unit of time. The axis need not be of unit length; throws UsageError when it is zero.
template<int D>
MotionPointer<D> rotation(const Point<D>& axis, const Point<D>& centre, double rate);

/// Moves every point by `velocity` per unit of time.
template<int D>
MotionPointer<D> translation(const Point<D>& velocity);

/// Scaling: a point x0 at time `start` is at centre + (1 + rate (t - start)) (x0 - centre) at time t.
/// velocity() and map() throw GeometryError at times at which the factor is not positive: all points coincide
/// when it is zero.
template<int D>
MotionPointer<D> expansion(const Point<D>& centre, double rate, double start);

/// One formula per component of the velocity, in x, y, (z,) t, `pi` and the named constants, in the language
/// of muParser (https://beltoforion.de/en/muparser/features.php). Compiled once per thread that evaluates.
/// Throws UsageError, quoting the formula, if it is not one plain expression; velocity() throws GeometryError
/// naming formula, point and time if a value is not finite.
template<int D>
MotionPointer<D> formula_velocity(const std::array<std::string, D>& formulas,
                                  const std::map<std::string, double>& constants = {});

/// v(x, t) at one point.
template<int D>
using VelocityOfPoint = std::function<Point<D>(const Point<D>& x, double t)>;
/// v[i] = v(x[i], t) for many points.
template<int D>
using VelocityOfPoints = std::function<void(std::span<const Point<D>> x, double t, std::span<Point<D>> v)>;

/// The velocity field of the caller's function. Needs: callable from several threads at once, with the same
/// values however the points are divided among calls. Its exceptions pass through; if a value is not finite,
/// velocity() throws GeometryError naming the point and the time. Throws UsageError if the function is empty.
template<int D>
MotionPointer<D> velocity_field(VelocityOfPoint<D> velocity);
template<int D>
MotionPointer<D> velocity_field(VelocityOfPoints<D> velocity);

/// Composition of motions in moving frames, innermost first: a point moves with the first step, that with the
/// second, and so on. The point that was at x0 at `start` is at M_k(t)( .. M_1(t)(x0)) at time t, where
/// M_i(t) maps positions of step i from `start` to t. So axes and centres are those at `start`; a later step
/// carries the earlier ones with it. A step may be a sequence. Throws UsageError for no steps, or if a step
/// after the first has no closed form. The result has a closed form if all steps have one. Cost of
/// velocity(): the sum of the steps'.
template<int D>
MotionPointer<D> sequence(std::vector<MotionPointer<D>> steps, double start);

} // namespace slabhull
