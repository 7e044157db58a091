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

    /// How far off the surface may be by the way it was given, as a length: the tolerance of a CAD file, the
    /// rounding of a file in single precision. 0: none beyond the rounding of doubles.
    virtual double tolerance() const { return 0; }
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

/// A surface as it lies when `placement`, a similarity, has been applied to it.
template<int D>
struct PlacedSurface {
    const ProjectionSurface<D>* surface = nullptr;
    AffineMap<D> placement;
};

/// Puts points on all of `surfaces` at once: those of a crease on two of them, those of a corner on three.
/// A point near x, not always the nearest: the first steps are towards the nearest point that the tangent
/// planes have in common, later ones make up for their curvature. Surfaces may meet at any angle, down to
/// touching without crossing; then the place is as uncertain as their meeting is. How near is near enough is
/// the caller's to judge by `moved`. With one surface the same as project().
/// Needs: at least one surface; `extent`, the size of the mesh, which says what counts as rounding; `moved`
/// empty or as long as `x`. Afterwards each point is within 1e-13 extent of each surface, or within the sum
/// of their tolerances where these are larger. Throws GeometryError when a placement is no similarity, or
/// names a point near which the surfaces do not meet. Cost: some 5 closest points per point and surface.
/// The result does not depend on the number of threads.
/// Source: Newton's method for f_i = 0 with the surfaces' own tangent planes, safeguarded by alternating
/// projections (von Neumann).
template<int D>
ProjectionReport project_onto_all(std::span<const PlacedSurface<D>> surfaces, std::span<Point<D>> x,
                                  double extent, std::span<double> moved = {});

} // namespace slabhull
