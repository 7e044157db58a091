// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/displacement_series.h"

#include "geometry/random_points.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

using namespace slabhull;
using tests::not_a_number;
using tests::random_points;

namespace {

/// Tracks 10, 13, 16 ... that start at random points and are displaced by displacement(point, t).
template<int D, class Displacement>
DisplacementRows<D> sampled(const std::vector<double>& times, std::size_t count,
                            Displacement&& displacement) {
    DisplacementRows<D> rows;
    rows.times = times;
    const auto points = random_points<D>(count, 1);
    rows.start.assign(points.begin(), points.end());
    for (std::size_t i = 0; i < count; ++i) {
        rows.tracks.push_back(static_cast<TrackId>(10 + 3 * i));
    }
    for (const double t : times) {
        Array<Point<D>>& row = rows.displacements.emplace_back();
        for (const Point<D>& x : points) {
            row.push_back(displacement(x, t));
        }
    }
    return rows;
}

/// Every coordinate displaced by f(t), each vertex with a factor of its own.
template<int D, class Function>
DisplacementRows<D> scaled_rows(const std::vector<double>& times, std::size_t count, Function&& f) {
    return sampled<D>(times, count, [&](Point<D> x, double t) {
        for (double& coordinate : x) {
            coordinate *= f(t);
        }
        return x;
    });
}

template<int D>
std::vector<Point<D>> positions_at(const NodalMotion<D>& motion, const std::vector<TrackId>& tracks,
                                   double t) {
    std::vector<Point<D>> x(tracks.size());
    motion.positions(tracks, t, x);
    return x;
}

std::vector<double> even_times(std::size_t pieces) {
    std::vector<double> times(pieces + 1);
    for (std::size_t i = 0; i <= pieces; ++i) {
        times[i] = static_cast<double>(i) / static_cast<double>(pieces);
    }
    return times;
}

/// The largest error between the rows of x0 (1 + f(t)), relative to the largest coordinate.
template<int D, class Function>
double error_between_rows(const std::vector<double>& times, TimeInterpolation interpolation, Function&& f) {
    const auto rows = scaled_rows<D>(times, 5, f);
    const auto motion = displacement_series<D>(rows, interpolation);
    double worst = 0;
    constexpr int times_asked = 4999;
    for (int s = 0; s <= times_asked; ++s) {
        const double t = times.front() + (times.back() - times.front()) * s / times_asked;
        const auto x = positions_at<D>(*motion, rows.tracks, t);
        for (std::size_t i = 0; i < x.size(); ++i) {
            for (std::size_t k = 0; k < D; ++k) {
                worst = std::max(worst, std::abs(x[i][k] - rows.start[i][k] * (1 + f(t))));
            }
        }
    }
    return worst;
}

template<class Spoil>
std::int64_t row_blamed(Spoil&& spoil) {
    auto rows = scaled_rows<2>({0, 1, 2, 3}, 4, [](double t) { return t; });
    spoil(rows);
    try {
        displacement_series<2>(rows, TimeInterpolation::linear);
    } catch (const UsageError& error) {
        return error.entities.empty() ? -1 : error.entities.front().number;
    }
    return -2;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("displacements are exact at their rows, whatever is between them", "", ((int D), D), 2,
                       3) {
    const std::vector<double> times{-1, -0.9, 0, 0.3, 0.31, 2, 5};
    const auto rows = sampled<D>(times, 50, [](Point<D> x, double t) {
        for (double& coordinate : x) {
            coordinate = std::sin(1e3 * coordinate * (t + 2));
        }
        return x;
    });
    for (const auto interpolation : {TimeInterpolation::linear, TimeInterpolation::cubic}) {
        const auto motion = displacement_series<D>(rows, interpolation);
        for (std::size_t row = 0; row < times.size(); ++row) {
            const auto x = positions_at<D>(*motion, rows.tracks, times[row]);
            for (std::size_t i = 0; i < x.size(); ++i) {
                for (std::size_t k = 0; k < D; ++k) {
                    CHECK(x[i][k] == rows.start[i][k] + rows.displacements[row][i][k]);
                }
            }
        }
    }
}

TEST_CASE("polynomials are met between rows: lines by linear, cubics by cubic, by three rows a parabola") {
    const auto polynomial = [](int degree) {
        return [degree](double t) { return std::pow(t - 0.3, degree); };
    };
    const std::vector<double> times{0, 0.1, 0.25, 0.6, 0.7, 1, 1.4};
    CHECK(error_between_rows<3>(times, TimeInterpolation::linear, polynomial(1)) < 1e-14);
    CHECK(error_between_rows<3>(times, TimeInterpolation::linear, polynomial(2)) > 1e-3);
    CHECK(error_between_rows<3>(times, TimeInterpolation::cubic, polynomial(3)) < 1e-13);
    CHECK(error_between_rows<3>(times, TimeInterpolation::cubic, polynomial(4)) > 1e-6);
    CHECK(error_between_rows<2>({0, 0.3, 1}, TimeInterpolation::cubic, polynomial(2)) < 1e-14);
    CHECK(error_between_rows<2>({0, 1}, TimeInterpolation::cubic, polynomial(1)) < 1e-14);
}

TEST_CASE("the error between rows is of order 2 (linear) and 4 (cubic)") {
    const auto wave = [](double t) { return std::sin(7 * t); };
    const auto order = [&](TimeInterpolation interpolation) {
        return std::log2(error_between_rows<2>(even_times(256), interpolation, wave) /
                         error_between_rows<2>(even_times(512), interpolation, wave));
    };
    CHECK(order(TimeInterpolation::linear) == Approx(2).margin(0.05));
    CHECK(order(TimeInterpolation::cubic) == Approx(4).margin(0.2));
}

TEST_CASE("cubic displacements have no kinks at the rows, linear ones do") {
    const auto rows =
        scaled_rows<2>({0, 0.5, 0.6, 1.5, 2, 3, 3.2}, 3, [](double t) { return std::cos(3 * t); });
    const auto jump_of_velocity = [&](TimeInterpolation interpolation) {
        const auto motion = displacement_series<2>(rows, interpolation);
        const double h = 1e-6;
        double worst = 0;
        for (std::size_t row = 1; row + 1 < rows.times.size(); ++row) {
            const double t = rows.times[row];
            const auto before = positions_at<2>(*motion, rows.tracks, t - h);
            const auto at = positions_at<2>(*motion, rows.tracks, t);
            const auto after = positions_at<2>(*motion, rows.tracks, t + h);
            worst = std::max(worst, std::abs(after[0][0] - 2 * at[0][0] + before[0][0]) / h);
        }
        return worst;
    };
    CHECK(jump_of_velocity(TimeInterpolation::cubic) < 1e-4);
    CHECK(jump_of_velocity(TimeInterpolation::linear) > 0.1);
}

TEST_CASE("a row is felt three rows away and no farther") {
    const auto times = even_times(20);
    const auto rows = scaled_rows<2>(times, 3, [](double) { return 0.0; });
    auto nudged = rows;
    nudged.displacements[10][0] = {1, 1};
    const auto motion = displacement_series<2>(nudged, TimeInterpolation::cubic);
    for (std::size_t piece = 0; piece < 20; ++piece) {
        const auto x = positions_at<2>(*motion, rows.tracks, 0.5 * (times[piece] + times[piece + 1]));
        CHECK((x[0] != rows.start[0]) == (piece >= 7 && piece < 13));
        CHECK(x[1] == rows.start[1]);
    }
}

TEST_CASE("tracks may be asked for in any order, some of them, and again") {
    const auto rows = scaled_rows<3>({0, 1, 2}, 40, [](double t) { return t; });
    const auto motion = displacement_series<3>(rows, TimeInterpolation::cubic);
    const auto all = positions_at<3>(*motion, rows.tracks, 1.3);
    std::vector<TrackId> tracks;
    for (std::size_t i = 0; i < 100; ++i) {
        tracks.push_back(rows.tracks[(i * 17) % rows.tracks.size()]);
    }
    const auto some = positions_at<3>(*motion, tracks, 1.3);
    for (std::size_t i = 0; i < tracks.size(); ++i) {
        CHECK(some[i] == all[(i * 17) % rows.tracks.size()]);
    }
}

TEST_CASE("a track without displacements is refused by its number") {
    const auto rows = scaled_rows<3>({0, 1}, 4, [](double t) { return t; });
    const auto motion = displacement_series<3>(rows, TimeInterpolation::linear);
    for (const TrackId stranger : {0, 11, 20}) {
        try {
            positions_at<3>(*motion, {10, stranger}, 0.5);
            FAIL("accepted");
        } catch (const GeometryError& error) {
            REQUIRE(error.entities.size() == 1);
            CHECK(error.entities[0].number == stranger);
        }
    }
}

TEST_CASE("times outside the rows are refused with the rows' times named, but for rounding") {
    const auto rows = scaled_rows<2>({0.5, 1, 2.5}, 4, [](double t) { return t; });
    const auto motion = displacement_series<2>(rows, TimeInterpolation::cubic);
    for (const double t : {0.49, 2.51, not_a_number}) {
        try {
            positions_at<2>(*motion, rows.tracks, t);
            FAIL("accepted");
        } catch (const GeometryError& error) {
            CHECK(std::string{error.what()}.find("from t = 0.5 to 2.5") != std::string::npos);
        }
    }
    CHECK(positions_at<2>(*motion, rows.tracks, 2.5 + 1e-12) == positions_at<2>(*motion, rows.tracks, 2.5));
    CHECK(positions_at<2>(*motion, rows.tracks, 0.5 - 1e-12) == positions_at<2>(*motion, rows.tracks, 0.5));
}

TEST_CASE("a single row holds at its time") {
    const auto rows = scaled_rows<2>({0.5}, 4, [](double t) { return t; });
    const auto motion = displacement_series<2>(rows, TimeInterpolation::cubic);
    CHECK(positions_at<2>(*motion, {10}, 0.5)[0][0] == rows.start[0][0] + 0.5 * rows.start[0][0]);
    CHECK_THROWS_AS(positions_at<2>(*motion, {10}, 0.6), GeometryError);
}

TEST_CASE("rows that make no series are refused, the row at fault named") {
    CHECK(row_blamed([](auto&) {}) == -2);
    CHECK(row_blamed([](auto& rows) { rows.times[2] = 1; }) == 2);
    CHECK(row_blamed([](auto& rows) { rows.times[3] = not_a_number; }) == 3);
    CHECK(row_blamed([](auto& rows) { rows.displacements[1].pop_back(); }) == 1);
    CHECK(row_blamed([](auto& rows) { rows.displacements[3][2][1] = not_a_number; }) == 3);
    CHECK(row_blamed([](auto& rows) { rows.times.pop_back(); }) == -1);
    CHECK(row_blamed([](auto& rows) { rows.start.pop_back(); }) == -1);
    CHECK(row_blamed([](auto& rows) { std::swap(rows.tracks[0], rows.tracks[1]); }) == -1);
    CHECK(row_blamed([](auto& rows) { rows.start[0][0] = not_a_number; }) == -1);
    CHECK(row_blamed([](auto& rows) { rows = {}; }) == -1);
}

TEST_CASE("any function of track and time is a nodal motion, the same on any number of threads") {
    const auto motion = nodal_motion<3>([](TrackId track, double t) {
        const auto n = static_cast<double>(track);
        return Point<3>{n + t, std::sin(n), n * t};
    });
    std::vector<TrackId> tracks(10'000);
    std::iota(tracks.begin(), tracks.end(), TrackId{5});
    set_thread_count(1);
    const auto alone = positions_at<3>(*motion, tracks, 2);
    set_thread_count(4);
    const auto together = positions_at<3>(*motion, tracks, 2);
    set_thread_count(0);
    CHECK(alone == together);
    CHECK(alone[7] == Point<3>{14, std::sin(12.0), 24});
}

TEST_CASE("a nodal motion's value that is not finite is refused with track and time; no function, too") {
    const auto motion = nodal_motion<2>([](TrackId track, double t) {
        return Point<2>{track == 7 ? not_a_number : 0, t};
    });
    try {
        positions_at<2>(*motion, {5, 6, 7}, 0.25);
        FAIL("accepted");
    } catch (const GeometryError& error) {
        CHECK(error.entities.at(0).number == 7);
        CHECK(std::string{error.what()}.find("t = 0.25") != std::string::npos);
    }
    CHECK_THROWS_AS(nodal_motion<2>(nullptr), UsageError);
}
