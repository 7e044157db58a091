// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/projection.h"

#include "geometry/basics/vector_algebra.h"
#include "geometry/projection/moved_points.h"

#include <algorithm>
#include <cmath>

namespace slabhull {

namespace {

using namespace detail;

template<int D>
class Sphere final : public ProjectionSurface<D> {
public:
    Sphere(const Point<D>& centre, double radius) : centre_{centre}, radius_{radius} {
        require_finite(centre, "the centre of a sphere or circle");
        require_positive(radius, "the radius of a sphere or circle");
    }
    Point<D> closest(const Point<D>& x) const override {
        const Point<D> arm = minus(x, centre_);
        const double distance = norm(arm);
        if (distance == 0) {
            Point<D> chosen = centre_;
            chosen[0] += radius_;
            return chosen;
        }
        return plus(centre_, times(radius_ / distance, arm));
    }

private:
    Point<D> centre_;
    double radius_;
};

/// With e the smallest semi-axis, the closest point y to p (both relative to the centre) has
/// y_i = e_i^2 p_i / (e_i^2 + s) for the one s > -e^2 that puts it on the ellipsoid. In units of e, with
/// u = 1 + s/e^2 > 0:
///     y_i / e_i = w_i(u) = b_i / (u + gap_i),   b_i = e_i p_i / e^2,   gap_i = (e_i^2 - e^2) / e^2,
///     |w(u)| = 1.
/// u is counted from the pole at s = -e^2, where points near the medial axis have their solution, so that no
/// digits are lost. On the medial axis (b_i = 0 wherever gap_i = 0) u is 0, and a component along a smallest
/// axis makes up for the rest of |w| = 1.
template<int D>
class Ellipsoid final : public ProjectionSurface<D> {
public:
    Ellipsoid(const Point<D>& centre, const Point<D>& semi_axes) : centre_{centre}, semi_axes_{semi_axes} {
        require_finite(centre, "the centre of an ellipsoid or ellipse");
        for (const double axis : semi_axes) {
            require_positive(axis, "a semi-axis of an ellipsoid or ellipse");
        }
        const auto smallest = std::min_element(semi_axes.begin(), semi_axes.end());
        shortest_ = static_cast<std::size_t>(smallest - semi_axes.begin());
        const double e = *smallest;
        for (std::size_t i = 0; i < D; ++i) {
            gap_[i] = ((semi_axes[i] - e) / e) * ((semi_axes[i] + e) / e);
        }
    }

    Point<D> closest(const Point<D>& x) const override {
        const Point<D> p = minus(x, centre_);
        const double e = semi_axes_[shortest_];
        Point<D> b;
        for (std::size_t i = 0; i < D; ++i) {
            b[i] = (semi_axes_[i] / e) * (p[i] / e);
            b[i] = std::abs(b[i]) <= vanishing ? 0 : b[i];
        }
        const double start = lower_bound(b);
        const Point<D> w = start > 0 ? shares(b, multiplier(b, start)) : on_medial_axis(b, p[shortest_] < 0);
        Point<D> y;
        for (std::size_t i = 0; i < D; ++i) {
            y[i] = centre_[i] + semi_axes_[i] * w[i];
        }
        return y;
    }

private:
    /// b_i below this counts as 0: far below the rounding of any position, and large enough that 1 / u^3 does
    /// not overflow.
    static constexpr double vanishing = 1e-90;

    Point<D> shares(const Point<D>& b, double u) const {
        Point<D> w;
        for (std::size_t i = 0; i < D; ++i) {
            w[i] = b[i] == 0 ? 0 : b[i] / (u + gap_[i]); // test first: the divisor may be 0 if b_i is
        }
        return w;
    }

    /// A u at which no |w_i| exceeds 1 and one equals 1, so that 1 <= |w|: not right of the solution. Not
    /// positive exactly if u = 0 may be the solution for p.
    double lower_bound(const Point<D>& b) const {
        double bound = 0;
        for (std::size_t i = 0; i < D; ++i) {
            bound = std::max(bound, std::abs(b[i]) - gap_[i]);
        }
        return bound;
    }

    /// The u with |w(u)| = 1, by Newton's method on 1/|w(u)| (Hebden 1973, as in trust-region methods). This
    /// is nearly linear in u and concave, so iterates increase monotonically and converge in few steps,
    /// except for points extremely close to the rim of the medial axis.
    double multiplier(const Point<D>& b, double u) const {
        constexpr int most_steps = 1000;
        for (int step = 0; step < most_steps; ++step) {
            const Point<D> w = shares(b, u);
            double slope = 0;
            for (std::size_t i = 0; i < D; ++i) {
                slope += w[i] == 0 ? 0 : w[i] * w[i] / (u + gap_[i]);
            }
            const double length = norm(w);
            const double next = u + (length - 1) * (length * length / slope);
            if (!(next > u)) {
                break;
            }
            u = next;
        }
        return u;
    }

    Point<D> on_medial_axis(Point<D> b, bool negative_side) const {
        double rest = 1;
        Point<D> w{};
        for (std::size_t i = 0; i < D; ++i) {
            if (gap_[i] > 0) {
                w[i] = b[i] / gap_[i];
                rest -= w[i] * w[i];
            }
        }
        if (rest < 0) { // beyond the rim of the medial axis after all
            return shares(b, multiplier(b, 0));
        }
        w[shortest_] = negative_side ? -std::sqrt(rest) : std::sqrt(rest);
        return w;
    }

    Point<D> centre_;
    Point<D> semi_axes_;
    Point<D> gap_;
    std::size_t shortest_;
};

/// A unit vector normal to `axis`: the coordinate direction least along it, made orthogonal.
Point<3> any_direction_across(const Point<3>& axis) {
    const auto least = std::min_element(axis.begin(), axis.end(),
                                        [](double a, double b) { return std::abs(a) < std::abs(b); });
    Point<3> direction{};
    direction[static_cast<std::size_t>(least - axis.begin())] = 1;
    return unit_vector(minus(direction, times(*least, axis)), "a direction across the axis of a cylinder");
}

class Cylinder final : public ProjectionSurface<3> {
public:
    Cylinder(const Point<3>& centre, const Point<3>& axis, double radius)
        : centre_{centre}, axis_{unit_vector(axis, "the axis of a cylinder")},
          across_{any_direction_across(axis_)}, radius_{radius} {
        require_finite(centre, "the centre of a cylinder");
        require_positive(radius, "the radius of a cylinder");
    }
    Point<3> closest(const Point<3>& x) const override {
        const Point<3> along = times(dot(minus(x, centre_), axis_), axis_);
        const Point<3> foot = plus(centre_, along);
        const Point<3> arm = minus(minus(x, centre_), along);
        const double distance = norm(arm);
        return plus(foot, distance == 0 ? times(radius_, across_) : times(radius_ / distance, arm));
    }

private:
    Point<3> centre_;
    Point<3> axis_;
    Point<3> across_;
    double radius_;
};

template<int D>
class Plane final : public ProjectionSurface<D> {
public:
    Plane(const Point<D>& point, const Point<D>& normal)
        : point_{point}, normal_{unit_vector(normal, "the normal of a plane")} {
        require_finite(point, "the point of a plane");
    }
    Point<D> closest(const Point<D>& x) const override {
        return minus(x, times(dot(minus(x, point_), normal_), normal_));
    }

private:
    Point<D> point_;
    Point<D> normal_;
};

} // namespace

template<int D>
ProjectionSurfacePointer<D> sphere_surface(const Point<D>& centre, double radius) {
    return std::make_shared<Sphere<D>>(centre, radius);
}

template<int D>
ProjectionSurfacePointer<D> ellipsoid_surface(const Point<D>& centre, const Point<D>& semi_axes) {
    return std::make_shared<Ellipsoid<D>>(centre, semi_axes);
}

ProjectionSurfacePointer<3> cylinder_surface(const Point<3>& centre, const Point<3>& axis, double radius) {
    return std::make_shared<Cylinder>(centre, axis, radius);
}

template<int D>
ProjectionSurfacePointer<D> plane_surface(const Point<D>& point, const Point<D>& normal) {
    return std::make_shared<Plane<D>>(point, normal);
}

template<int D>
ProjectionReport project(const ProjectionSurface<D>& surface, const AffineMap<D>& placement,
                         std::span<Point<D>> x, std::span<double> moved) {
    const AffineMap<D> inverse = inverse_of_similarity<D>(placement);
    return move_points<D>(x, moved, [&](const Point<D>& point, std::size_t number) {
        const Point<D> image = placement(surface.closest(inverse(point)));
        require_on_surface(image, point, number);
        return image;
    });
}

template ProjectionSurfacePointer<2> sphere_surface<2>(const Point<2>&, double);
template ProjectionSurfacePointer<3> sphere_surface<3>(const Point<3>&, double);
template ProjectionSurfacePointer<2> ellipsoid_surface<2>(const Point<2>&, const Point<2>&);
template ProjectionSurfacePointer<3> ellipsoid_surface<3>(const Point<3>&, const Point<3>&);
template ProjectionSurfacePointer<2> plane_surface<2>(const Point<2>&, const Point<2>&);
template ProjectionSurfacePointer<3> plane_surface<3>(const Point<3>&, const Point<3>&);
template ProjectionReport project<2>(const ProjectionSurface<2>&, const AffineMap<2>&, std::span<Point<2>>,
                                     std::span<double>);
template ProjectionReport project<3>(const ProjectionSurface<3>&, const AffineMap<3>&, std::span<Point<3>>,
                                     std::span<double>);

} // namespace slabhull
