// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/facet_surface.h"

#include "geometry/basics/vector_algebra.h"
#include "geometry/projection/closest_on_facet.h"

#include "slabhull/core/error.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Bbox_3.h>
#include <CGAL/Simple_cartesian.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

using namespace detail;

// CGAL's tree is for boxes in space, so curves of the plane lie in z = 0. The tree sorts and traverses the
// facets; the closest point of a facet is computed here, since CGAL needs facets with an extent.
using TreeKernel = CGAL::Simple_cartesian<double>;

template<int D>
TreeKernel::Point_3 cgal(const Point<D>& p) {
    if constexpr (D == 3) {
        return {p[0], p[1], p[2]};
    } else {
        return {p[0], p[1], 0};
    }
}

/// A facet as a primitive of CGAL's tree.
template<int D>
class TreeFacet {
public:
    using Id = const FacetCorners<D>*;
    using Point = TreeKernel::Point_3;
    using Datum = std::conditional_t<D == 3, TreeKernel::Triangle_3, TreeKernel::Segment_3>;

    TreeFacet() = default;
    explicit TreeFacet(typename std::vector<FacetCorners<D>>::const_iterator facet) : facet_{&*facet} {}

    Id id() const { return facet_; }
    Datum datum() const {
        if constexpr (D == 3) {
            return {cgal<D>((*facet_)[0]), cgal<D>((*facet_)[1]), cgal<D>((*facet_)[2])};
        } else {
            return {cgal<D>((*facet_)[0]), cgal<D>((*facet_)[1])};
        }
    }
    Point reference_point() const { return cgal<D>((*facet_)[0]); }

private:
    Id facet_ = nullptr;
};

template<int D>
using TreeTraits = CGAL::AABB_traits<TreeKernel, TreeFacet<D>>;

/// Traversal traits for the facet closest to a point: nodes by distance, the nearer child first.
template<int D>
class ClosestFacet {
public:
    using Priority = double;
    using Node = CGAL::AABB_node<TreeTraits<D>>;

    ClosestFacet(const Point<D>& x, double magnitude) : x_{x}, magnitude_{magnitude} {}

    const Point<D>& foot() const { return best_.point; }

    void consider(const FacetCorners<D>* facet) {
        const FootOnFacet<D> foot = closest_on_facet(x_, *facet);
        least_ = std::min(least_, foot.distance);
        if (foot.distance > reach()) {
            return;
        }
        const bool tied = facet_ != nullptr && best_.distance <= reach();
        if (!tied || std::pair{foot.rank, facet} < std::pair{best_.rank, facet_}) {
            best_ = foot;
            facet_ = facet;
        }
    }

    // --- for CGAL

    bool go_further() const { return true; }
    void intersection(const Point<D>&, const TreeFacet<D>& facet) { consider(facet.id()); }
    bool do_intersect(const Point<D>&, const Node& node) const { return distance_to(node) <= reach(); }
    std::pair<bool, Priority> do_intersect_with_priority(const Point<D>&, const Node& node) const {
        const double distance = distance_to(node);
        return {distance <= reach(), -distance};
    }

private:
    /// Largest distance that equals the least one up to rounding. On the surface all such facets are equally
    /// good, except that one which contains the point exactly keeps corners in place.
    double reach() const {
        constexpr double epsilon = 8 * std::numeric_limits<double>::epsilon();
        const double rounding = epsilon * (magnitude_ + least_);
        return least_ > rounding ? least_ + rounding : least_;
    }

    double distance_to(const Node& node) const {
        const CGAL::Bbox_3& box = node.bbox();
        double square = 0;
        for (int k = 0; k < D; ++k) {
            const double coordinate = x_[static_cast<std::size_t>(k)];
            const double out = std::max({box.min(k) - coordinate, 0.0, coordinate - box.max(k)});
            square += out * out;
        }
        return std::sqrt(square);
    }

    Point<D> x_;
    double magnitude_;
    double least_ = std::numeric_limits<double>::infinity();
    FootOnFacet<D> best_{};
    const FacetCorners<D>* facet_ = nullptr;
};

template<int D>
std::vector<FacetCorners<D>> corners_of(const Surface<D>& surface) {
    std::vector<FacetCorners<D>> all;
    all.reserve(surface.facets.size());
    for (const Facet<D>& facet : surface.facets) {
        FacetCorners<D>& corners = all.emplace_back();
        std::transform(facet.begin(), facet.end(), corners.begin(),
                       [&surface](Index v) { return surface.points[v]; });
        for (const Point<D>& corner : corners) {
            if (!all_finite(corner)) {
                const auto number = static_cast<std::int64_t>(all.size() - 1);
                throw GeometryError{fmt::format("facet {} of a projection surface has a corner at {}", number,
                                                to_text(corner)),
                                    {{"facet", number, {}}}};
            }
        }
    }
    return all;
}

template<int D>
class FacetSurface final : public ProjectionSurface<D> {
public:
    FacetSurface(const Surface<D>& surface, double tolerance)
        : corners_{corners_of(surface)}, tree_(corners_.begin(), corners_.end()), tolerance_{tolerance} {
        if (corners_.empty()) {
            throw UsageError{"a projection surface needs at least one facet"};
        }
        for (const FacetCorners<D>& corners : corners_) {
            for (const Point<D>& corner : corners) {
                for (const double coordinate : corner) {
                    magnitude_ = std::max(magnitude_, std::abs(coordinate));
                }
            }
        }
        // Built now, so that concurrent queries find everything built.
        tree_.build();
        tree_.accelerate_distance_queries();
    }

    Point<D> closest(const Point<D>& x) const override {
        if (!all_finite(x)) { // no point is closest, and CGAL must not be asked
            Point<D> nowhere;
            nowhere.fill(std::numeric_limits<double>::quiet_NaN());
            return nowhere;
        }
        ClosestFacet<D> search{x, magnitude_};
        search.consider(tree_.best_hint(cgal<D>(x)).second);
        tree_.traversal_with_priority(x, search);
        return search.foot();
    }

    double tolerance() const override { return tolerance_; }

private:
    std::vector<FacetCorners<D>> corners_;
    CGAL::AABB_tree<TreeTraits<D>> tree_;
    double magnitude_ = 0;
    double tolerance_;
};

} // namespace

template<int D>
ProjectionSurfacePointer<D> facet_surface(const Surface<D>& facets, double tolerance) {
    return std::make_shared<FacetSurface<D>>(facets, tolerance);
}

template ProjectionSurfacePointer<2> facet_surface<2>(const Surface<2>&, double);
template ProjectionSurfacePointer<3> facet_surface<3>(const Surface<3>&, double);

} // namespace slabhull
