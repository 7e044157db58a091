// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/motion.h"

#include "geometry/basics/vector_algebra.h"

#include "slabhull/core/error.h"

#include <fmt/core.h>

namespace slabhull {

namespace {

using namespace detail;

template<int D>
class VelocityField final : public Motion<D> {
public:
    explicit VelocityField(VelocityOfPoints<D> field) : field_{std::move(field)} {}

    void velocity(std::span<const Point<D>> x, double t, std::span<Point<D>> v) const override {
        field_(x, t, v);
        for (std::size_t i = 0; i < x.size(); ++i) {
            if (!all_finite(v[i])) {
                throw GeometryError{fmt::format("a velocity field is {} at the point {} at t = {}",
                                                to_text(v[i]), to_text(x[i]), t)};
            }
        }
    }
    std::optional<AffineMap<D>> map(double, double) const override { return std::nullopt; }

private:
    VelocityOfPoints<D> field_;
};

template<class Function>
void require_callable(const Function& function) {
    if (!function) {
        throw UsageError{"a velocity field needs a function"};
    }
}

} // namespace

template<int D>
MotionPointer<D> velocity_field(VelocityOfPoint<D> velocity) {
    require_callable(velocity);
    return std::make_shared<VelocityField<D>>(
        [velocity = std::move(velocity)](std::span<const Point<D>> x, double t, std::span<Point<D>> v) {
            for (std::size_t i = 0; i < x.size(); ++i) {
                v[i] = velocity(x[i], t);
            }
        });
}

template<int D>
MotionPointer<D> velocity_field(VelocityOfPoints<D> velocity) {
    require_callable(velocity);
    return std::make_shared<VelocityField<D>>(std::move(velocity));
}

template MotionPointer<2> velocity_field<2>(VelocityOfPoint<2>);
template MotionPointer<3> velocity_field<3>(VelocityOfPoint<3>);
template MotionPointer<2> velocity_field<2>(VelocityOfPoints<2>);
template MotionPointer<3> velocity_field<3>(VelocityOfPoints<3>);

} // namespace slabhull
