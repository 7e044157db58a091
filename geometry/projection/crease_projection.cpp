// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/projection.h"

#include "geometry/basics/vector_algebra.h"
#include "geometry/projection/moved_points.h"

#include "slabhull/core/error.h"

#include <Eigen/Core>
#include <Eigen/SVD>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace slabhull {

namespace {

using namespace detail;

/// A surface at its present placement.
template<int D>
class Wall {
public:
    explicit Wall(const PlacedSurface<D>& placed)
        : surface_{placed.surface}, placement_{placed.placement}, inverse_{inverse_of_similarity<D>(
                                                                      placed.placement)} {}

    Point<D> closest(const Point<D>& x) const { return placement_(surface_->closest(inverse_(x))); }
    double tolerance() const { return placement_.scale() * surface_->tolerance(); }

private:
    const ProjectionSurface<D>* surface_;
    AffineMap<D> placement_;
    AffineMap<D> inverse_;
};

/// A point with its closest points on all surfaces.
template<int D>
struct Stance {
    Point<D> x;
    std::vector<Point<D>> feet;
    double gap = 0; ///< distance to the farthest of these
};

/// The plane through `foot` with the unit normal `normal`.
template<int D>
struct TangentPlane {
    Point<D> foot;
    Point<D> normal;
};

/// Finds points that lie on several surfaces.
template<int D>
class Meeting {
public:
    Meeting(std::span<const PlacedSurface<D>> surfaces, double extent)
        : walls_(surfaces.begin(), surfaces.end()), extent_{extent} {
        for (const Wall<D>& wall : walls_) {
            loose_ += wall.tolerance();
        }
    }

    /// Iterates until the gap no longer shrinks or is zero to rounding: points on all surfaces stay.
    Point<D> near(const Point<D>& x, std::size_t number) const {
        constexpr int most_steps = 200;
        const double rounding = 2 * std::numeric_limits<double>::epsilon() * extent_;
        Stance<D> best = stand(x);
        require_on_surface(best.feet.front(), x, number);
        for (int step = 0; step < most_steps && best.gap > rounding; ++step) {
            Stance<D> next = better(best);
            if (!(next.gap < best.gap)) {
                break;
            }
            best = std::move(next);
        }
        require_meeting(best, x, number);
        return best.x;
    }

private:
    Stance<D> stand(const Point<D>& x) const {
        Stance<D> stance{x, {}, 0};
        for (const Wall<D>& wall : walls_) {
            stance.feet.push_back(wall.closest(x));
            // Written so that NaN is kept.
            const double gap = norm(minus(x, stance.feet.back()));
            stance.gap = gap <= stance.gap ? stance.gap : gap;
        }
        return stance;
    }

    /// Newton's step if it closes the gap well, else alternating projections, which are slow where surfaces
    /// meet at a small angle, but robust at their edges.
    Stance<D> better(const Stance<D>& now) const {
        Stance<D> next = stand(on_tangent_planes(now));
        if (next.gap <= 0.5 * now.gap) {
            return next;
        }
        Point<D> x = now.x;
        for (const Wall<D>& wall : walls_) {
            x = wall.closest(x);
        }
        Stance<D> walked = stand(x);
        return walked.gap < next.gap || !std::isfinite(next.gap) ? walked : next;
    }

    /// The common point of the tangent planes closest to x; the least-squares point if they have none in
    /// common.
    Point<D> on_tangent_planes(const Stance<D>& now) const {
        // Normals at smaller angles are equal up to the rounding errors of their finite differences.
        constexpr double same_direction = 1e-9;
        const auto count = static_cast<Eigen::Index>(walls_.size());
        Eigen::Matrix<double, Eigen::Dynamic, D> normals{count, D};
        Eigen::VectorXd distances{count};
        for (Eigen::Index i = 0; i < count; ++i) {
            const auto w = static_cast<std::size_t>(i);
            const TangentPlane<D> plane = tangent_plane(walls_[w], now.x, now.feet[w]);
            normals.row(i) = Eigen::Map<const Eigen::Matrix<double, 1, D>>(plane.normal.data());
            distances[i] = dot(plane.normal, minus(plane.foot, now.x));
        }
        Eigen::JacobiSVD<Eigen::MatrixXd> svd{normals, Eigen::ComputeThinU | Eigen::ComputeThinV};
        svd.setThreshold(same_direction);
        const Eigen::VectorXd step = svd.solve(distances);
        Point<D> moved = now.x;
        for (std::size_t k = 0; k < D; ++k) {
            moved[k] += step[static_cast<Eigen::Index>(k)];
        }
        return moved;
    }

    /// The tangent plane's normal is the direction from a foot to its point. Near the surface rounding would
    /// spoil that direction, so a point farther off is used, but near enough that the strongest curvature
    /// does no harm.
    TangentPlane<D> tangent_plane(const Wall<D>& wall, const Point<D>& x, const Point<D>& foot) const {
        const double off = std::max(1e-7 * extent_, 1e5 * rounding_near(x));
        const double readable = std::max(1e-11 * extent_, 10 * rounding_near(x));
        const Point<D> arm = minus(x, foot);
        const double distance = norm(arm);
        if (distance >= off) {
            return {foot, times(1 / distance, arm)};
        }
        if (distance >= readable) {
            return seen_from(wall, plus(foot, times(off / distance, arm))).plane;
        }
        View best;
        for (std::size_t k = 0; k < D; ++k) {
            Point<D> eye = foot;
            eye[k] += off;
            const View view = seen_from(wall, eye);
            best = view.distance > best.distance ? view : best;
        }
        return best.plane;
    }

    struct View {
        TangentPlane<D> plane{};
        double distance = 0;
    };

    View seen_from(const Wall<D>& wall, const Point<D>& eye) const {
        const Point<D> foot = wall.closest(eye);
        const Point<D> arm = minus(eye, foot);
        const double distance = norm(arm);
        return {{foot, distance > 0 ? times(1 / distance, arm) : Point<D>{}}, distance};
    }

    void require_meeting(const Stance<D>& best, const Point<D>& x, std::size_t number) const {
        const double rounding = std::max(1e-13 * extent_, 16 * rounding_near(x));
        if (best.gap <= std::max(rounding, loose_)) { // false for NaN
            return;
        }
        throw GeometryError{
            fmt::format("the {} projection surfaces of point {} at {} do not meet near it: a distance of "
                        "{:.3g} is left at {}; check that the surfaces of patches that share this point "
                        "meet there, and move alike",
                        walls_.size(), number, to_text(x), best.gap, to_text(best.x)),
            {{"vertex", static_cast<std::int64_t>(number), {}}}};
    }

    /// Of coordinates: it counts where the mesh is small beside its distance from the origin.
    static double rounding_near(const Point<D>& x) {
        double largest = 0;
        for (const double each : x) {
            largest = std::max(largest, std::abs(each));
        }
        return std::numeric_limits<double>::epsilon() * largest;
    }

    std::vector<Wall<D>> walls_;
    double extent_;
    double loose_ = 0;
};

} // namespace

template<int D>
ProjectionReport project_onto_all(std::span<const PlacedSurface<D>> surfaces, std::span<Point<D>> x,
                                  double extent, std::span<double> moved) {
    if (surfaces.size() == 1) {
        return project<D>(*surfaces[0].surface, surfaces[0].placement, x, moved);
    }
    require_positive(extent, "the extent of a mesh whose points are projected");
    const Meeting<D> meeting{surfaces, extent};
    return move_points<D>(
        x, moved, [&](const Point<D>& point, std::size_t number) { return meeting.near(point, number); });
}

template ProjectionReport project_onto_all<2>(std::span<const PlacedSurface<2>>, std::span<Point<2>>, double,
                                              std::span<double>);
template ProjectionReport project_onto_all<3>(std::span<const PlacedSurface<3>>, std::span<Point<3>>, double,
                                              std::span<double>);

} // namespace slabhull
