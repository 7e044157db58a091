// SPDX-License-Identifier: BSD-3-Clause
#include "slab/adapt/cavity_apex.h"

#include "geometry/basics/largest_minimum.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/topology/spatial_mesh.h"
#include "topology/complex/sorted_cell.h"
#include <algorithm>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace slabhull {

namespace {

/// The program of one cavity, in units in which a layer and half of the cavity's extent are 1.
template<int D>
class ApexProgram {
public:
    ApexProgram(const AdaptMesh<D>& mesh, const Cavity<D>& cavity) : mesh_{mesh}, cavity_{cavity} {
        frame();
        distances_.push_back({{}, 0.5}); // above the cells removed
        distances_.back().gradient[D] = 1;
        distances_.push_back({{}, 0.5}); // below those added
        distances_.back().gradient[D] = -1;
        for (const Index cell : cavity.removed) {
            for (std::size_t i = 0; i <= D; ++i) {
                const Index across = mesh.neighbors[cell][i];
                if (std::find(cavity.removed.begin(), cavity.removed.end(), across) != cavity.removed.end()) {
                    continue;
                }
                if (const Facet<D> facet = outward_facet<D>(mesh.cells[cell], static_cast<int>(i));
                    across != no_index || !on_side(facet)) {
                    add_wall(facet);
                }
            }
        }
        if (cavity.on_boundary()) {
            add_side();
        }
    }

    /// The apex in space, and time from -1/2 to 1/2; false if there is none.
    bool solve(Point<D + 1>& apex) const {
        constexpr double ample = 0.05;
        constexpr double sufficient = 0.005;
        Point<D + 1> place{};
        for (std::size_t k = 0; k < D; ++k) {
            place[k] = (cavity_.kernel[k] - centre_[k]) / unit_;
        }
        if (least(place) < ample) {
            const Point<D + 1> best =
                largest_minimum<D + 1>(std::span<const AffineFunction<D + 1>>{distances_});
            if (!(least(best) > sufficient)) {
                return false;
            }
            place = best;
        }
        for (std::size_t k = 0; k < D; ++k) {
            apex[k] = centre_[k] + unit_ * place[k];
        }
        apex[D] = place[D];
        return true;
    }

private:
    /// Centre and half the extent of the cells removed.
    void frame() {
        Point<D> low;
        Point<D> high;
        low.fill(std::numeric_limits<double>::infinity());
        high.fill(-std::numeric_limits<double>::infinity());
        for (const Index cell : cavity_.removed) {
            for (const Index v : mesh_.cells[cell]) {
                for (std::size_t k = 0; k < D; ++k) {
                    low[k] = std::min(low[k], mesh_.before[v][k]);
                    high[k] = std::max(high[k], mesh_.before[v][k]);
                }
            }
        }
        for (std::size_t k = 0; k < D; ++k) {
            centre_[k] = (low[k] + high[k]) / 2;
            unit_ = std::max(unit_, (high[k] - low[k]) / 2);
        }
    }

    /// Whether the operation removes a facet of the boundary.
    bool on_side(const Facet<D>& facet) const {
        return std::any_of(cavity_.side_removed.begin(), cavity_.side_removed.end(), [&](const Facet<D>& f) {
            return std::is_permutation(f.begin(), f.end(), facet.begin());
        });
    }

    /// The cone of the hull's side. The chain (F', s) - (F, s) - (P, s) is outward, with F below, F' above
    /// and the prisms P over the ridges around them.
    void add_side() {
        Point<D + 1> apex;
        for (std::size_t k = 0; k < D; ++k) {
            apex[k] = (cavity_.side.apex[k] - centre_[k]) / unit_;
        }
        apex[D] = 0; // half time
        const auto cone = [&](std::array<Point<D + 1>, D + 1> corners, bool inward) {
            corners[D] = apex;
            add(corners, inward);
        };
        for (const Facet<D>& facet : cavity_.side_removed) {
            std::array<Point<D + 1>, D + 1> below;
            for (std::size_t k = 0; k < D; ++k) {
                below[k] = at(mesh_.before, facet[k], -0.5);
            }
            cone(below, true);
            for (std::size_t i = 0; i < D; ++i) {
                if (is_around_side(facet, i)) {
                    add_ridge(facet, i, cone);
                }
            }
        }
        for (const Facet<D>& facet : cavity_.side.added) {
            std::array<Point<D + 1>, D + 1> above;
            for (std::size_t k = 0; k < D; ++k) {
                above[k] = facet[k] == Cavity<D>::new_vertex ? in_frame(cavity_.new_place, 0.5)
                                                             : at(mesh_.now, facet[k], 0.5);
            }
            cone(above, false);
        }
    }

    /// Whether no other facet that is removed has the ridge opposite to corner i.
    bool is_around_side(const Facet<D>& facet, std::size_t i) const {
        return std::none_of(cavity_.side_removed.begin(), cavity_.side_removed.end(), [&](const Facet<D>& f) {
            std::size_t shared = 0;
            for (std::size_t k = 0; k < D; ++k) {
                shared += k != i && std::find(f.begin(), f.end(), facet[k]) != f.end() ? 1 : 0;
            }
            return shared == D - 1 && std::find(f.begin(), f.end(), facet[i]) == f.end();
        });
    }

    /// Adds the cones over the prism above ridge i, with both diagonals.
    template<class Cone>
    void add_ridge(const Facet<D>& facet, std::size_t i, const Cone& cone) {
        std::array<Index, D - 1> ridge;
        for (std::size_t k = 0, n = 0; k < D; ++k) {
            if (k != i) {
                ridge[n++] = facet[k];
            }
        }
        for (const bool reversed : {false, true}) {
            for (std::size_t m = 0; m + 1 < D; ++m) {
                std::array<Point<D + 1>, D + 1> corners;
                for (std::size_t k = 0; k < D; ++k) {
                    corners[k] = k <= m ? at(mesh_.before, ridge[k], -0.5) : at(mesh_.now, ridge[k - 1], 0.5);
                }
                cone(corners, (i + m) % 2 == (reversed ? 1 : 0));
            }
            if (D == 2) {
                return; // over a vertex, there is one
            }
            std::reverse(ridge.begin(), ridge.end());
        }
    }

    void add_wall(const Facet<D>& outward) {
        std::size_t on_boundary = 0;
        for (const Index v : outward) {
            on_boundary += mesh_.on_boundary[v];
        }
        SortedCell<D - 1> facet = sort_cell<D - 1>(outward);
        add_staircase(facet.vertices, facet.odd);
        if (on_boundary >= 2) {
            std::reverse(facet.vertices.begin(), facet.vertices.end());
            add_staircase(facet.vertices, facet.odd != (D * (D - 1) / 2 % 2 == 1));
        }
    }
    /// `odd`: whether the facet in this order is inward.
    void add_staircase(const Facet<D>& facet, bool odd) {
        for (std::size_t m = 0; m < D; ++m) {
            std::array<Point<D + 1>, D + 1> corners;
            for (std::size_t k = 0; k <= D; ++k) {
                corners[k] = k <= m ? at(mesh_.before, facet[k], -0.5) : at(mesh_.now, facet[k - 1], 0.5);
            }
            add(corners, odd != ((m + D) % 2 == 1));
        }
    }

    /// `inward`: whether the normal of the corners is.
    void add(const std::array<Point<D + 1>, D + 1>& corners, bool inward) {
        Point<D + 1> normal = simplex_normal<D>(corners);
        const double length = norm(normal);
        AffineFunction<D + 1> function{{}, -1}; // of a wall without extent
        if (length > 0) {
            const double scale = (inward ? 1 : -1) / length;
            for (std::size_t k = 0; k <= D; ++k) {
                function.gradient[k] = scale * normal[k];
            }
            function.value = -scale * dot(normal, corners[0]);
        }
        distances_.push_back(function);
    }

    Point<D + 1> at(const Array<Point<D>>& places, Index v, double time) const {
        return in_frame(places[v], time);
    }

    Point<D + 1> in_frame(const Point<D>& place, double time) const {
        Point<D + 1> point;
        for (std::size_t k = 0; k < D; ++k) {
            point[k] = (place[k] - centre_[k]) / unit_;
        }
        point[D] = time;
        return point;
    }

    double least(const Point<D + 1>& place) const {
        double value = std::numeric_limits<double>::infinity();
        for (const AffineFunction<D + 1>& distance : distances_) {
            value = std::min(value, distance.at(place));
        }
        return value;
    }

    const AdaptMesh<D>& mesh_;
    const Cavity<D>& cavity_;
    Point<D> centre_{};
    double unit_ = 0;
    std::vector<AffineFunction<D + 1>> distances_;
};

} // namespace

template<int D>
bool find_apex(const AdaptMesh<D>& mesh, const std::array<double, 2>& times, Cavity<D>& cavity) {
    if (!ApexProgram<D>{mesh, cavity}.solve(cavity.apex)) {
        return false;
    }
    cavity.apex[D] = times[0] + (times[1] - times[0]) * (0.5 + cavity.apex[D]);
    return times[0] < cavity.apex[D] && cavity.apex[D] < times[1];
}

template bool find_apex<2>(const AdaptMesh<2>&, const std::array<double, 2>&, Cavity<2>&);
template bool find_apex<3>(const AdaptMesh<3>&, const std::array<double, 2>&, Cavity<3>&);

} // namespace slabhull
