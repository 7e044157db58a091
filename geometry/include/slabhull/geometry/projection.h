// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/geometry/affine.h"

#include <cstddef>
#include <memory>
#include <span>

namespace slabhull {

/// A CAD surface (D = 2: curve) onto which boundary points are projected after their paths were integrated.
/// Immutable; may be used from several threads at once.
template<int D>
class ProjectionSurface {
public:
    virtual ~ProjectionSurface() = default;

    /// The point of the surface closest to x, to rounding. If several are equally close, always the same one.
    virtual Point<D> closest(const Point<D>& x) const = 0;

    /// Uncertainty of the surface itself, as a length: the tolerance of a CAD file, the rounding of a file in
    /// single precision. 0: none beyond the rounding of doubles.
    virtual double tolerance() const { return 0; }
};

template<int D>
using ProjectionSurfacePointer = std::shared_ptr<const ProjectionSurface<D>>;

// All factories throw UsageError when an argument is not finite, a radius or semi-axis not positive, a
// direction zero.

/// A sphere, for D = 2 a circle.
template<int D>
ProjectionSurfacePointer<D> sphere_surface(const Point<D>& centre, double radius);

/// An ellipsoid with its axes along the coordinate axes, for D = 2 an ellipse. Finds the true closest point,
/// for points outside, inside and on the medial axis: Eberly, "Distance from a Point to an Ellipse, an
/// Ellipsoid, or a Hyperellipsoid" (2013).
template<int D>
ProjectionSurfacePointer<D> ellipsoid_surface(const Point<D>& centre, const Point<D>& semi_axes);

/// An infinite circular cylinder about the line through `centre` along `axis`.
ProjectionSurfacePointer<3> cylinder_surface(const Point<3>& centre, const Point<3>& axis, double radius);

/// The plane, for D = 2 the line, through `point` with normal `normal`.
template<int D>
ProjectionSurfacePointer<D> plane_surface(const Point<D>& point, const Point<D>& normal);

/// How far a projection moved its points.
struct ProjectionReport {
    double largest = 0;
    double mean = 0;
    std::size_t count = 0;
};

/// Projects points onto `surface` moved by `placement`, a similarity: the motion of its patch from the start
/// until now. Needs: `moved` empty or as long as `x`; it receives the distance that each point moved. Throws
/// GeometryError if the placement is not a similarity, or naming a point whose image is not finite. Cost:
/// linear. The result does not depend on the number of threads.
template<int D>
ProjectionReport project(const ProjectionSurface<D>& surface, const AffineMap<D>& placement,
                         std::span<Point<D>> x, std::span<double> moved = {});

/// A surface moved by `placement`, a similarity.
template<int D>
struct PlacedSurface {
    const ProjectionSurface<D>* surface = nullptr;
    AffineMap<D> placement;
};

/// Projects points onto the intersection of all `surfaces`: those of a crease onto two of them, those of a
/// corner onto three. The result is near x, but not always nearest: the first steps go to the nearest common
/// point of the tangent planes, later ones correct for curvature. Surfaces may meet at any angle, even touch
/// without crossing; then the result is as uncertain as their intersection. By `moved`, the caller judges
/// whether a point is near enough. With one surface the same as project().
/// Needs: at least one surface; `extent`, the size of the mesh, relative to which rounding is judged; `moved`
/// empty or as long as `x`. Afterwards each point is within 1e-13 extent of each surface, within 16
/// roundings of its coordinates or within the sum of their tolerances, whichever is largest. Throws
/// GeometryError if a placement is not a similarity, or naming a point near which the surfaces do not meet.
/// Cost: some 5 closest points per point and surface. The result does not depend on the number of threads.
/// Source: Newton's method for f_i = 0 with the surfaces' own tangent planes, safeguarded by alternating
/// projections (von Neumann).
template<int D>
ProjectionReport project_onto_all(std::span<const PlacedSurface<D>> surfaces, std::span<Point<D>> x,
                                  double extent, std::span<double> moved = {});

} // namespace slabhull
