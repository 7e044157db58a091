// SPDX-License-Identifier: BSD-3-Clause
// Paths by Boost.Numeric.Odeint, whose steppers treat a chunk of points as one flat state.
#include "slabhull/geometry/trajectory.h"

#include "geometry/basics/vector_algebra.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"

#include <boost/array.hpp>
#include <boost/fusion/include/make_vector.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/euler.hpp>
#include <boost/numeric/odeint/stepper/explicit_generic_rk.hpp>
#include <boost/numeric/odeint/stepper/generation/generation_controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation/generation_runge_kutta_dopri5.hpp>
#include <boost/numeric/odeint/stepper/generation/make_controlled.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace slabhull {

namespace {

using namespace detail;
namespace odeint = boost::numeric::odeint;

constexpr std::array<std::string_view, 5> names{"euler", "heun", "rk4", "dopri5", "exact"};

/// Points per chunk: a state and its few stages fit the second-level cache. The adaptive scheme has one
/// substep per chunk, and chunks do not depend on the number of threads.
constexpr std::size_t chunk_size = 512;

/// Chunks per task of a thread: fewer points are not worth another thread.
constexpr std::size_t chunks_at_once = 8;

constexpr int most_adaptive_steps = 10'000;

using State = std::vector<double>;

template<int D>
std::span<Point<D>> as_points(State& state) {
    static_assert(sizeof(Point<D>) == D * sizeof(double));
    return {reinterpret_cast<Point<D>*>(state.data()), state.size() / D};
}

template<int D>
std::span<const Point<D>> as_points(const State& state) {
    static_assert(sizeof(Point<D>) == D * sizeof(double));
    return {reinterpret_cast<const Point<D>*>(state.data()), state.size() / D};
}

/// Heun's scheme, order 2: the mean of the velocities at both ends. Odeint provides generic Runge-Kutta
/// steps, but not this tableau.
odeint::explicit_generic_rk<2, 2, State> heun() {
    const boost::array<double, 1> second_stage{{1.0}};
    const boost::array<double, 2> weights{{0.5, 0.5}};
    const boost::array<double, 2> stage_times{{0.0, 1.0}};
    return {boost::fusion::make_vector(second_stage), weights, stage_times};
}

/// The path of one chunk.
struct Course {
    double from;
    double to;
    const TrajectoryOptions& options;
    double length; ///< length to which tolerances are relative

    double substep() const { return (to - from) / options.substeps; }
};

template<class Stepper, class Velocity>
void take_substeps(Stepper stepper, const Velocity& velocity, State& x, const Course& course) {
    const double dt = course.substep();
    for (int k = 0; k < course.options.substeps; ++k) {
        stepper.do_step(velocity, x, course.from + k * dt, dt);
    }
}

[[noreturn]] void give_up(double t, double dt, const Course& course) {
    throw GeometryError{
        fmt::format("dopri5 came from t = {} only to t = {} before its substep of {:g} was too short or its "
                    "{} substeps were used up (tolerance {:g}); loosen trajectory.tolerance or use rk4",
                    course.from, t, dt, most_adaptive_steps, course.options.tolerance)};
}

template<class Velocity>
void take_adaptive_substeps(const Velocity& velocity, State& x, const Course& course) {
    // Tolerance absolute in length: one relative to coordinates would be too loose far from the origin.
    auto stepper = odeint::make_controlled(course.options.tolerance * course.length, 0.0,
                                           odeint::runge_kutta_dopri5<State>{});
    double t = course.from;
    double dt = course.substep();
    for (int k = 0; k < most_adaptive_steps; ++k) {
        const bool last = std::abs(dt) >= std::abs(course.to - t);
        if (last) {
            dt = course.to - t;
        }
        const bool too_short = t + dt == t;
        if (too_short) {
            give_up(t, dt, course);
        }
        const bool accepted = stepper.try_step(velocity, x, t, dt) == odeint::success;
        if (accepted && (last || t == course.to)) {
            return;
        }
    }
    give_up(t, dt, course);
}

template<int D>
void integrate(const Motion<D>& motion, State& x, const Course& course) {
    const auto velocity = [&motion](const State& at, State& v, double t) {
        motion.velocity(as_points<D>(at), t, as_points<D>(v));
    };
    switch (course.options.scheme) {
    case Scheme::euler:
        return take_substeps(odeint::euler<State>{}, velocity, x, course);
    case Scheme::heun:
        return take_substeps(heun(), velocity, x, course);
    case Scheme::rk4:
        return take_substeps(odeint::runge_kutta4<State>{}, velocity, x, course);
    case Scheme::dopri5:
        return take_adaptive_substeps(velocity, x, course);
    case Scheme::exact:
        return; // not integrated, see advance()
    }
}

/// Diagonal of the points' bounding box; if that is zero, their distance from the origin, or 1.
template<int D>
double extent(std::span<const Point<D>> x) {
    if (x.empty()) {
        return 1;
    }
    Point<D> low = x[0];
    Point<D> high = x[0];
    for (const Point<D>& point : x) {
        for (std::size_t i = 0; i < D; ++i) {
            low[i] = std::min(low[i], point[i]);
            high[i] = std::max(high[i], point[i]);
        }
    }
    const double diagonal = norm(minus(high, low));
    const double length = diagonal > 0 ? diagonal : norm(high);
    return length > 0 ? length : 1;
}

template<int D>
void require_finite_points(std::span<const Point<D>> x, std::size_t first, double t) {
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!all_finite(x[i])) {
            const auto number = static_cast<std::int64_t>(first + i);
            throw GeometryError{
                fmt::format("the path of point {} leaves the finite numbers before t = {}: it ends at {}",
                            number, t, to_text(x[i])),
                {{"vertex", number, {}}}};
        }
    }
}

void require_sense(const TrajectoryOptions& options, double from, double to) {
    require_finite(from, "the start of a trajectory");
    require_finite(to, "the end of a trajectory");
    if (options.substeps < 1) {
        throw UsageError{fmt::format("trajectory.substeps must be 1 or more, not {}", options.substeps)};
    }
    require_positive(options.tolerance, "trajectory.tolerance");
}

void for_each_chunk(std::size_t points, const std::function<void(std::size_t, std::size_t)>& body) {
    parallel_for(points, chunks_at_once * chunk_size, [&](std::size_t begin, std::size_t end) {
        for (std::size_t first = begin; first < end; first += chunk_size) {
            body(first, std::min(end, first + chunk_size));
        }
    });
}

template<int D>
void advance_exactly(const Motion<D>& motion, std::span<Point<D>> x, double from, double to) {
    const std::optional<AffineMap<D>> map = motion.map(from, to);
    if (!map) {
        throw UsageError{
            "trajectory.scheme \"exact\" needs motions with a closed form; a velocity formula has none: "
            "use rk4 or dopri5"};
    }
    parallel_for(x.size(), chunk_size, [&](std::size_t begin, std::size_t end) {
        const auto chunk = x.subspan(begin, end - begin);
        std::transform(chunk.begin(), chunk.end(), chunk.begin(), *map);
        require_finite_points<D>(chunk, begin, to);
    });
}

template<int D>
void advance_by_steps(const Motion<D>& motion, std::span<Point<D>> x, const Course& course) {
    const auto move_points = [&](std::size_t begin, std::size_t end) {
        const auto chunk = x.subspan(begin, end - begin);
        State state(chunk.size() * D);
        std::copy(chunk.begin(), chunk.end(), as_points<D>(state).begin());
        integrate(motion, state, course);
        const auto moved = as_points<D>(state);
        std::copy(moved.begin(), moved.end(), chunk.begin());
        require_finite_points<D>(chunk, begin, course.to);
    };
    if (motion.in_one_call()) {
        move_points(0, x.size());
    } else {
        for_each_chunk(x.size(), move_points);
    }
}

} // namespace

Scheme scheme_from_name(std::string_view name) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
        throw UsageError{fmt::format("there is no trajectory scheme \"{}\"; choose one of {}", name,
                                     fmt::join(names, ", "))};
    }
    return static_cast<Scheme>(found - names.begin());
}

std::string_view scheme_name(Scheme scheme) {
    return names[static_cast<std::size_t>(scheme)];
}

template<int D>
void advance(const Motion<D>& motion, std::span<Point<D>> x, double from, double to,
             const TrajectoryOptions& options) {
    require_sense(options, from, to);
    if (!motion.moves() || from == to) {
        return;
    }
    if (options.scheme == Scheme::exact) {
        return advance_exactly<D>(motion, x, from, to);
    }
    advance_by_steps<D>(motion, x, Course{from, to, options, extent<D>(x)});
}

template void advance<2>(const Motion<2>&, std::span<Point<2>>, double, double, const TrajectoryOptions&);
template void advance<3>(const Motion<3>&, std::span<Point<3>>, double, double, const TrajectoryOptions&);

} // namespace slabhull
