// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/rigid_table.h"

#include "geometry/basics/vector_algebra.h"
#include "geometry/motion/cubic_spline.h"
#include "geometry/motion/turn.h"

#include "slabhull/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace slabhull {

namespace {

using namespace detail;

/// Orientation of a body at one time, and its rate.
template<int D>
struct Attitude {
    AffineMap<D> turn; ///< R, from rest
    AffineMap<D> spin; ///< R' R^T, from arm to velocity: the cross product with the angular velocity
};

template<int D>
using AttitudeFunction = std::function<Attitude<D>(double t)>;

template<int D>
AttitudeFunction<D> turning_about(const AffineMap<D>& quarter, CubicSpline<1> angle) {
    return [quarter, angle = std::move(angle)](double t) {
        const auto [value, rate] = angle.at(t);
        return Attitude<D>{turn_by<D>(value[0], quarter), scaled<D>(rate[0], quarter)};
    };
}

/// R = Rx(roll) Ry(pitch) Rz(yaw): roll turns about x at rest, pitch about the rolled y, yaw about the body's
/// own z.
Attitude<3> attitude_of_angles(const Sample<3>& angles) {
    Attitude<3> attitude;
    Point<3> angular_velocity{};
    for (std::size_t k = 0; k < 3; ++k) {
        Point<3> axis{};
        axis[k] = 1;
        angular_velocity = plus(angular_velocity, times(angles.rate[k], attitude.turn.linear(axis)));
        attitude.turn = compose(attitude.turn, turn_by<3>(angles.value[k], quarter_turn(axis)));
    }
    attitude.spin = cross_map(angular_velocity);
    return attitude;
}

AffineMap<3> turn_of(const Point<4>& unit) {
    const auto [w, x, y, z] = unit;
    return {{{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
              {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
              {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}},
            {}};
}

/// Attitude of the quaternion q = p / |p|, whose rate is q' = (p' - (q . p') q) / |p| and whose angular
/// velocity is the vector part of 2 q' q*. The component of p' along q contributes nothing, so p' / |p|
/// serves as q'.
Attitude<3> attitude_of_quaternion(const Sample<4>& p, double t) {
    const double length = norm(p.value);
    constexpr double shortest = 0.25; // half a turn between two rows still gives 0.7
    if (!(length > shortest)) {
        throw GeometryError{fmt::format("the quaternions of a rigid table turn too far between the rows "
                                        "around t = {} to be interpolated; give more rows there",
                                        t)};
    }
    const auto [w, x, y, z] = times(1 / length, p.value);
    const auto [dw, dx, dy, dz] = times(2 / length, p.rate);
    return {turn_of({w, x, y, z}),
            cross_map({-dw * x + dx * w - dy * z + dz * y, -dw * y + dx * z + dy * w - dz * x,
                       -dw * z - dx * y + dy * x + dz * w})};
}

/// Motion of a body displaced and rotated by a table.
template<int D>
class TabulatedMotion final : public Motion<D> {
public:
    TabulatedMotion(const Point<D>& centre, std::vector<double> times, CubicSpline<D> shift,
                    AttitudeFunction<D> attitude)
        : centre_{centre}, times_{std::move(times)}, shift_{std::move(shift)}, attitude_{
                                                                                   std::move(attitude)} {}

    void velocity(std::span<const Point<D>> x, double t, std::span<Point<D>> v) const override {
        const double time = inside(t);
        const auto [shift, drift] = shift_.at(time);
        const Point<D> centre = plus(centre_, shift);
        const AffineMap<D> spin = attitude_(time).spin;
        for (std::size_t i = 0; i < x.size(); ++i) {
            v[i] = plus(drift, spin.linear(minus(x[i], centre)));
        }
    }

    std::optional<AffineMap<D>> map(double from, double to) const override {
        return compose(placement(to), inverse_of_similarity<D>(placement(from)));
    }

    std::vector<double> row_times() const override { return times_; }

private:
    /// The map from rest to time t.
    AffineMap<D> placement(double t) const {
        const double time = inside(t);
        AffineMap<D> place = map_about<D>(centre_, attitude_(time).turn.rows);
        place.shift = plus(place.shift, shift_.at(time).value);
        return place;
    }

    /// The time, clamped to the table if it is outside by rounding only.
    double inside(double t) const {
        const double slack = 1e-9 * (shift_.last() - shift_.first());
        const double time = std::clamp(t, shift_.first(), shift_.last());
        if (!(std::abs(t - time) <= slack)) { // written so that NaN is refused
            throw GeometryError{fmt::format("a motion by table is known from t = {} to {}, not at t = {}; "
                                            "extend the table",
                                            shift_.first(), shift_.last(), t)};
        }
        return time;
    }

    Point<D> centre_;
    std::vector<double> times_;
    CubicSpline<D> shift_;
    AttitudeFunction<D> attitude_;
};

[[noreturn]] void refuse_row(std::size_t row, const std::string& complaint) {
    throw UsageError{fmt::format("row {} of a motion by table: {}", row, complaint),
                     {{"row", static_cast<std::int64_t>(row), {}}}};
}

void require_ascending(const std::vector<double>& times) {
    if (times.size() < 2) {
        throw UsageError{fmt::format("a motion by table needs at least two rows, not {}", times.size())};
    }
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (!std::isfinite(times[i])) {
            refuse_row(i, fmt::format("the time {} is not finite", times[i]));
        }
        if (i > 0 && !(times[i - 1] < times[i])) {
            refuse_row(i, fmt::format("its time {} is not after that of the row before, {}; put the rows in "
                                      "order of time, one for each time",
                                      times[i], times[i - 1]));
        }
    }
}

/// Throws unless `rows` is empty or has one finite entry per time.
template<std::size_t N>
void require_rows(const std::vector<std::array<double, N>>& rows, std::size_t count, const char* what) {
    if (!rows.empty() && rows.size() != count) {
        throw UsageError{
            fmt::format("a motion by table has {} rows of {} for {} times", rows.size(), what, count)};
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!all_finite(rows[i])) {
            refuse_row(i, fmt::format("{} {} that are not finite", what, to_text(rows[i])));
        }
    }
}

/// Quaternions normalised, each with the sign nearer to the one before.
std::vector<Point<4>> continuous(std::vector<Point<4>> quaternions) {
    constexpr double allowed = 1e-3; // for quaternions printed with a few digits
    const double least_cosine = std::cos(std::numbers::pi / 180 * 179 / 2); // of half the turn between rows
    for (std::size_t i = 0; i < quaternions.size(); ++i) {
        const double length = norm(quaternions[i]);
        if (!(std::abs(length - 1) <= allowed)) {
            refuse_row(i, fmt::format("a quaternion of length {}, not 1", length));
        }
        quaternions[i] = times(1 / length, quaternions[i]);
        const double cosine = i > 0 ? dot(quaternions[i - 1], quaternions[i]) : 1;
        if (std::abs(cosine) < least_cosine) {
            refuse_row(i, "it is half a turn from the row before, so that the sense of turning cannot be "
                          "told; give more rows, or angles");
        }
        quaternions[i] = times(cosine < 0 ? -1 : 1, quaternions[i]);
    }
    return quaternions;
}

AttitudeFunction<2> attitude_of(const RigidTable<2>& table) {
    return turning_about<2>(quarter_turn(Point<2>{}), {table.times, table.angles});
}

AttitudeFunction<3> attitude_of(const RigidTable<3>& table) {
    if (table.angles.empty()) {
        return [quaternion = CubicSpline<4>{table.times, continuous(table.quaternions)}](double t) {
            return attitude_of_quaternion(quaternion.at(t), t);
        };
    }
    return [angles = CubicSpline<3>{table.times, table.angles}](double t) {
        return attitude_of_angles(angles.at(t));
    };
}

template<int D>
AttitudeFunction<D> not_turning() {
    AffineMap<D> no_spin;
    no_spin.rows = {};
    return [no_spin](double) { return Attitude<D>{{}, no_spin}; };
}

template<int D>
CubicSpline<D> standing_shift(const std::vector<double>& times) {
    return {{times.front(), times.back()}, std::vector<Point<D>>(2)};
}

} // namespace

template<int D>
MotionPointer<D> rotation(const Point<D>& axis, const Point<D>& centre, const AngleTable& table) {
    require_finite(centre, "the centre of a rotation");
    require_ascending(table.times);
    std::vector<Point<1>> angles;
    for (const double angle : table.angles) {
        angles.push_back({angle});
    }
    require_rows(angles, table.times.size(), "angles");
    if (angles.empty()) {
        throw UsageError{"a rotation by table needs angles"};
    }
    return std::make_shared<TabulatedMotion<D>>(
        centre, table.times, standing_shift<D>(table.times),
        turning_about<D>(quarter_turn(axis), {table.times, std::move(angles)}));
}

template<int D>
MotionPointer<D> rigid_table(const RigidTable<D>& table, const Point<D>& centre) {
    require_finite(centre, "the centre of a rigid table");
    require_ascending(table.times);
    require_rows(table.shifts, table.times.size(), "displacements");
    require_rows(table.angles, table.times.size(), "angles");
    require_rows(table.quaternions, table.times.size(), "quaternions");
    if (!table.quaternions.empty() && (D == 2 || !table.angles.empty())) {
        throw UsageError{"a rigid table turns by angles or, in space, by quaternions; not by both"};
    }
    const bool turns = !table.angles.empty() || !table.quaternions.empty();
    return std::make_shared<TabulatedMotion<D>>(
        centre, table.times,
        table.shifts.empty() ? standing_shift<D>(table.times) : CubicSpline<D>{table.times, table.shifts},
        turns ? attitude_of(table) : not_turning<D>());
}

template MotionPointer<2> rotation<2>(const Point<2>&, const Point<2>&, const AngleTable&);
template MotionPointer<3> rotation<3>(const Point<3>&, const Point<3>&, const AngleTable&);
template MotionPointer<2> rigid_table<2>(const RigidTable<2>&, const Point<2>&);
template MotionPointer<3> rigid_table<3>(const RigidTable<3>&, const Point<3>&);

} // namespace slabhull
