// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/geometry/affine.h"

#include <cstddef>
#include <memory>
#include <span>

namespace slabhull {

/// A CAD surface (D = 2: curve) that boundary points are put back on after their paths were integrated.
/// Immutable; may be used from several threads at once.
template<int D>
class ProjectionSurface {
public:
    virtual ~ProjectionSurface() = default;

    /// The point of the surface closest to x, to rounding. Where several are equally close, always the same
    /// one.
    virtual Point<D> closest(const Point<D>& x) const = 0;
};

template<int D>
using ProjectionSurfacePointer = std::shared_ptr<const ProjectionSurface<D>>;

// All factories throw UsageError when an argument is not finite, a radius or semi-axis not positive, a
// direction zero.

/// A sphere, for D = 2 a circle.
template<int D>
ProjectionSurfacePointer<D> sphere_surface(const Point<D>& centre, double radius);

/// An ellipsoid with its axes along the coordinate axes, for D = 2 an ellipse. The true closest point, for
/// points outside, inside and on the medial axis: Eberly, "Distance from a Point to an Ellipse, an Ellipsoid,
/// or a Hyperellipsoid" (2013).
template<int D>
ProjectionSurfacePointer<D> ellipsoid_surface(const Point<D>& centre, const Point<D>& semi_axes);

/// An infinite circular cylinder about the line through `centre` along `axis`.
ProjectionSurfacePointer<3> cylinder_surface(const Point<3>& centre, const Point<3>& axis, double radius);

/// The plane, for D = 2 the line, through `point` across `normal`.
template<int D>
ProjectionSurfacePointer<D> plane_surface(const Point<D>& point, const Point<D>& normal);

/// How far a projection moved its points.
struct ProjectionReport {
    double largest = 0;
    double mean = 0;
    std::size_t count = 0;
};

/// Puts points on `surface` as it lies when `placement`, a similarity, has been applied to it: the motion of
/// its patch from the start until now. Needs: `moved` empty or as long as `x`; it receives how far each point
/// went. Throws GeometryError when the placement is no similarity, or names a point whose image is not
/// finite. Cost: linear. The result does not depend on the number of threads.
template<int D>
ProjectionReport project(const ProjectionSurface<D>& surface, const AffineMap<D>& placement,
                         std::span<Point<D>> x, std::span<double> moved = {});

extern template ProjectionSurfacePointer<2> sphere_surface<2>(const Point<2>&, double);
extern template ProjectionSurfacePointer<3> sphere_surface<3>(const Point<3>&, double);
extern template ProjectionSurfacePointer<2> ellipsoid_surface<2>(const Point<2>&, const Point<2>&);
extern template ProjectionSurfacePointer<3> ellipsoid_surface<3>(const Point<3>&, const Point<3>&);
extern template ProjectionSurfacePointer<2> plane_surface<2>(const Point<2>&, const Point<2>&);
extern template ProjectionSurfacePointer<3> plane_surface<3>(const Point<3>&, const Point<3>&);
extern template ProjectionReport project<2>(const ProjectionSurface<2>&, const AffineMap<2>&,
                                            std::span<Point<2>>, std::span<double>);
extern template ProjectionReport project<3>(const ProjectionSurface<3>&, const AffineMap<3>&,
                                            std::span<Point<3>>, std::span<double>);

} // namespace slabhull
