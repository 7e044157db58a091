// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/motion.h"

#include "geometry/basics/vector_algebra.h"
#include "geometry/motion/turn.h"

#include "slabhull/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace slabhull {

namespace {

using namespace detail;

template<int D>
class Standing final : public Motion<D> {
public:
    void velocity(std::span<const Point<D>>, double, std::span<Point<D>> v) const override {
        std::fill(v.begin(), v.end(), Point<D>{});
    }
    std::optional<AffineMap<D>> map(double, double) const override { return AffineMap<D>{}; }
    bool moves() const override { return false; }
};

template<int D>
class Translation final : public Motion<D> {
public:
    explicit Translation(const Point<D>& velocity) : velocity_{velocity} {
        require_finite(velocity, "the velocity of a translation");
    }
    void velocity(std::span<const Point<D>>, double, std::span<Point<D>> v) const override {
        std::fill(v.begin(), v.end(), velocity_);
    }
    std::optional<AffineMap<D>> map(double from, double to) const override {
        return AffineMap<D>{AffineMap<D>::unit_rows(), times(to - from, velocity_)};
    }
    bool moves() const override { return velocity_ != Point<D>{}; }

private:
    Point<D> velocity_;
};

template<int D>
class Rotation final : public Motion<D> {
public:
    Rotation(const Point<D>& axis, const Point<D>& centre, double rate)
        : turn_{quarter_turn(axis)}, centre_{centre}, rate_{rate} {
        require_finite(centre, "the centre of a rotation");
        require_finite(rate, "the rate of a rotation");
    }
    void velocity(std::span<const Point<D>> x, double, std::span<Point<D>> v) const override {
        for (std::size_t i = 0; i < x.size(); ++i) {
            v[i] = times(rate_, turn_.linear(minus(x[i], centre_)));
        }
    }
    std::optional<AffineMap<D>> map(double from, double to) const override {
        return map_about<D>(centre_, turn_by<D>(rate_ * (to - from), turn_).rows);
    }
    bool moves() const override { return rate_ != 0; }

private:
    AffineMap<D> turn_;
    Point<D> centre_;
    double rate_;
};

template<int D>
class Expansion final : public Motion<D> {
public:
    Expansion(const Point<D>& centre, double rate, double start)
        : centre_{centre}, rate_{rate}, start_{start} {
        require_finite(centre, "the centre of an expansion");
        require_finite(rate, "the rate of an expansion");
        require_finite(start, "the start of an expansion");
    }
    void velocity(std::span<const Point<D>> x, double t, std::span<Point<D>> v) const override {
        const double relative_rate = rate_ / factor(t);
        for (std::size_t i = 0; i < x.size(); ++i) {
            v[i] = times(relative_rate, minus(x[i], centre_));
        }
    }
    std::optional<AffineMap<D>> map(double from, double to) const override {
        const double scale = factor(to) / factor(from);
        std::array<Point<D>, D> rows{};
        for (std::size_t i = 0; i < D; ++i) {
            rows[i][i] = scale;
        }
        return map_about<D>(centre_, rows);
    }
    bool moves() const override { return rate_ != 0; }

private:
    double factor(double t) const {
        const double factor = 1 + rate_ * (t - start_);
        if (!(factor > 0)) {
            throw GeometryError{
                fmt::format("an expansion about {} with rate {} has shrunk to a point at t = {}; "
                            "asked for t = {}",
                            to_text(centre_), rate_, start_ - 1 / rate_, t)};
        }
        return factor;
    }

    Point<D> centre_;
    double rate_;
    double start_;
};

} // namespace

template<int D>
MotionPointer<D> standing() {
    return std::make_shared<Standing<D>>();
}

template<int D>
MotionPointer<D> rotation(const Point<D>& axis, const Point<D>& centre, double rate) {
    return std::make_shared<Rotation<D>>(axis, centre, rate);
}

template<int D>
MotionPointer<D> translation(const Point<D>& velocity) {
    return std::make_shared<Translation<D>>(velocity);
}

template<int D>
MotionPointer<D> expansion(const Point<D>& centre, double rate, double start) {
    return std::make_shared<Expansion<D>>(centre, rate, start);
}

template MotionPointer<2> standing<2>();
template MotionPointer<3> standing<3>();
template MotionPointer<2> rotation<2>(const Point<2>&, const Point<2>&, double);
template MotionPointer<3> rotation<3>(const Point<3>&, const Point<3>&, double);
template MotionPointer<2> translation<2>(const Point<2>&);
template MotionPointer<3> translation<3>(const Point<3>&);
template MotionPointer<2> expansion<2>(const Point<2>&, double, double);
template MotionPointer<3> expansion<3>(const Point<3>&, double, double);

} // namespace slabhull
