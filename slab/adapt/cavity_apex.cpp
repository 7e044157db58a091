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
                if (across == no_index ||
                    std::find(cavity.removed.begin(), cavity.removed.end(), across) == cavity.removed.end()) {
                    add_wall(outward_facet<D>(mesh.cells[cell], static_cast<int>(i)));
                }
            }
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
        Point<D + 1> point;
        for (std::size_t k = 0; k < D; ++k) {
            point[k] = (places[v][k] - centre_[k]) / unit_;
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
