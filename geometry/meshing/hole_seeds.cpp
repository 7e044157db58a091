// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/hole_seeds.h"

#include "geometry/basics/vector_algebra.h"
#include "geometry/embedding/components.h"
#include "geometry/embedding/facet_names.h"
#include "geometry/embedding/facet_pair.h"

#include "slabhull/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace slabhull {

namespace {

constexpr double unreached = std::numeric_limits<double>::infinity();

/// Distance, in lengths of `direction`, at which a ray crosses a triangle (Moeller and Trumbore 1997).
double distance_along(const Point<3>& from, const Point<3>& direction, const FacetCorners<3>& t) {
    const Point<3> u = minus(t[1], t[0]);
    const Point<3> v = minus(t[2], t[0]);
    const Point<3> w = minus(from, t[0]);
    const Point<3> p = cross(direction, v);
    const Point<3> q = cross(w, u);
    const double det = dot(u, p);
    const double r = dot(w, p) / det;
    const double s = dot(direction, q) / det;
    const bool through = r >= 0 && s >= 0 && r + s <= 1;
    const double distance = dot(v, q) / det;
    return through && distance > 0 ? distance : unreached;
}

class SeedSearch {
public:
    SeedSearch(const FacetComponents<3>& components, const Surface<3>& surface)
        : components_{components}, surface_{surface}, tree_{facet_boxes(surface)} {
        Box<3> all;
        for (const Point<3>& p : surface.points) {
            all.include(p);
        }
        diameter_ = norm(minus(all.high, all.low));
    }

    Point<3> inside(Index part, const std::vector<Index>& facets) const;

private:
    struct Candidate {
        double clearance;
        Point<3> place;
    };
    Candidate behind(Index facet) const;
    double reach(Index facet, const Point<3>& from, const Point<3>& direction) const;
    bool proven(Index part, const Point<3>& place) const;

    const FacetComponents<3>& components_;
    const Surface<3>& surface_;
    BoxTree<3> tree_;
    double diameter_;
};

/// Distance from a facet to the next one along a unit vector. Short rays are tried first: they meet few
/// boxes.
double SeedSearch::reach(Index facet, const Point<3>& from, const Point<3>& direction) const {
    const FacetCorners<3> corners = corners_of_facet(surface_, facet);
    for (double length = norm(minus(corners[1], corners[0])); length < 2 * diameter_; length *= 2) {
        Box<3> along;
        along.include(from);
        along.include(plus(from, times(length, direction)));
        double nearest = unreached;
        tree_.find(along, [&](Index other) {
            if (other != facet) {
                nearest =
                    std::min(nearest, distance_along(from, direction, corners_of_facet(surface_, other)));
            }
        });
        if (nearest <= length) {
            return nearest;
        }
    }
    return unreached;
}

/// The midpoint between a facet's centroid and the opposite facet across the body.
SeedSearch::Candidate SeedSearch::behind(Index facet) const {
    const FacetCorners<3> corners = corners_of_facet(surface_, facet);
    const Point<3> centroid = times(1.0 / 3, plus(plus(corners[0], corners[1]), corners[2]));
    const Point<3> normal = cross(minus(corners[1], corners[0]),
                                  minus(corners[2], corners[0])); // outward from the domain, so into the body
    const Point<3> direction = times(1 / norm(normal), normal);
    const double distance = reach(facet, centroid, direction);
    return {std::isfinite(distance) ? distance : 0, plus(centroid, times(0.5 * distance, direction))};
}

bool SeedSearch::proven(Index part, const Point<3>& place) const {
    return all_finite(place) && winding_number<3>(surface_, tree_, place, [](Index) { return true; }) == 0 &&
           winding_number<3>(surface_, tree_, place,
                             [&](Index f) { return components_.component(f) == part; }) == -1;
}

Point<3> SeedSearch::inside(Index part, const std::vector<Index>& facets) const {
    constexpr std::size_t tried = 64;
    const std::size_t stride = (facets.size() + tried - 1) / tried;
    std::vector<Candidate> candidates;
    for (std::size_t k = 0; k < facets.size(); k += stride) {
        candidates.push_back(behind(facets[k]));
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.clearance > b.clearance; });
    for (const Candidate& candidate : candidates) {
        if (proven(part, candidate.place)) {
            return candidate.place;
        }
    }
    throw GeometryError{fmt::format("found no point inside the body whose boundary has a vertex at {}; "
                                    "it may be too thin",
                                    place_in_words(surface_.points[surface_.facets[facets[0]][0]]))};
}

} // namespace

std::vector<Point<3>> hole_seeds(const Boundary<3>& boundary, const Surface<3>& surface) {
    const FacetComponents<3>& components = boundary.facet_components();
    const std::vector<double> enclosed = enclosed_by_components(components, surface);
    const std::vector<std::vector<Index>> facets = components.facets();
    std::optional<SeedSearch> search; // its tree is not needed if there are no bodies
    std::vector<Point<3>> seeds;
    for (Index part = 0; part < enclosed.size(); ++part) {
        if (!(enclosed[part] > 0)) {
            if (!search) {
                search.emplace(components, surface);
            }
            seeds.push_back(search->inside(part, facets[part]));
        }
    }
    return seeds;
}

} // namespace slabhull
