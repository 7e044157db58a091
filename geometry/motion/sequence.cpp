// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/motion.h"

#include "geometry/basics/vector_algebra.h"

#include "slabhull/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <vector>

namespace slabhull {

namespace {

using namespace detail;

/// Composition M(t) = M_k(t) o ... o M_1(t), from the position at the start. By the chain rule,
/// M' M^-1 = v_k + A_k (v_(k-1) + A_(k-1) (...)) with the linear parts A_i of M_i, each velocity v_i at the
/// point mapped back through M_k, ..., M_(i+1).
template<int D>
class Sequence final : public Motion<D> {
public:
    Sequence(std::vector<MotionPointer<D>> steps, double start) : steps_{std::move(steps)}, start_{start} {
        require_finite(start, "the start of a sequence of motions");
        if (steps_.empty()) {
            throw UsageError{"a sequence of motions needs at least one step"};
        }
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            require_step(i);
        }
    }

    void velocity(std::span<const Point<D>> x, double t, std::span<Point<D>> v) const override {
        steps_.back()->velocity(x, t, v);
        std::vector<Point<D>> within(x.begin(), x.end());
        std::vector<Point<D>> velocity(x.size());
        AffineMap<D> outer;
        for (std::size_t step = steps_.size() - 1; step > 0; --step) {
            const AffineMap<D> back = *steps_[step]->map(t, start_);
            std::transform(within.begin(), within.end(), within.begin(), back);
            outer = compose(outer, *steps_[step]->map(start_, t));
            steps_[step - 1]->velocity(within, t, velocity);
            for (std::size_t i = 0; i < x.size(); ++i) {
                v[i] = plus(v[i], outer.linear(velocity[i]));
            }
        }
    }

    std::optional<AffineMap<D>> map(double from, double to) const override {
        AffineMap<D> back;
        AffineMap<D> forth;
        for (const auto& step : steps_) {
            const auto inverse = step->map(from, start_);
            const auto place = step->map(start_, to);
            if (!inverse || !place) {
                return std::nullopt;
            }
            back = compose(back, *inverse);
            forth = compose(*place, forth);
        }
        return compose(forth, back);
    }

    bool moves() const override {
        return std::any_of(steps_.begin(), steps_.end(), [](const auto& step) { return step->moves(); });
    }

    bool in_one_call() const override {
        return std::any_of(steps_.begin(), steps_.end(),
                           [](const auto& step) { return step->in_one_call(); });
    }

    std::vector<double> row_times() const override {
        std::vector<double> all;
        for (const auto& step : steps_) {
            const std::vector<double> times = step->row_times();
            all.insert(all.end(), times.begin(), times.end());
        }
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
        return all;
    }

private:
    void require_step(std::size_t i) const {
        if (steps_[i] == nullptr) {
            throw UsageError{fmt::format("step {} of a sequence of motions is empty", i + 1)};
        }
        if (i > 0 && !steps_[i]->map(start_, start_)) {
            throw UsageError{
                fmt::format("step {} of a sequence of motions has no closed form, so that it cannot carry "
                            "the steps before it; a velocity field may be the first step only",
                            i + 1)};
        }
    }

    std::vector<MotionPointer<D>> steps_;
    double start_;
};

} // namespace

template<int D>
MotionPointer<D> sequence(std::vector<MotionPointer<D>> steps, double start) {
    return std::make_shared<Sequence<D>>(std::move(steps), start);
}

template MotionPointer<2> sequence<2>(std::vector<MotionPointer<2>>, double);
template MotionPointer<3> sequence<3>(std::vector<MotionPointer<3>>, double);

} // namespace slabhull
