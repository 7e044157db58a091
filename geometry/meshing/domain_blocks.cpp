// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/domain_blocks.h"

#include "core/pieces.h"
#include "core/used_vertices.h"
#include "geometry/embedding/facet_pair.h"
#include "geometry/meshing/block_interface.h"
#include "geometry/meshing/grid_directions.h"
#include "geometry/meshing/plane_frame.h"
#include "geometry/meshing/surface_division.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/geometry/embedding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace slabhull {

namespace {

/// Allowed deviation of a block's load from its share, relative to that. Planes along which boundary facets
/// lie are tried last, after all deviations.
constexpr std::array<double, 4> imbalances{0.01, 0.03, 0.1, 0.3};
/// Planes considered per direction, and planes tried over all directions.
constexpr std::size_t offsets = 7;
constexpr std::size_t tries = 8;
/// A facet lies along a plane if it is within `near_plane` spacings and the cosine between the normals is
/// above `along_plane`: it would make thin wedges. `price_along` is its price in triangles of the interface.
constexpr double near_plane = 1.5;
constexpr double along_plane = 0.7;
constexpr double price_along = 10;

struct Block {
    Array<Facet<3>> facets;
    std::vector<LoadSample> load;
};

struct CutPlane {
    Point<3> normal{};
    double offset = 0;
    double triangles = 0; ///< of the interface
    double along = 0;     ///< number of boundary facets that lie along it

    double price() const { return triangles + price_along * along; }
};

/// The axes, and the diagonals of the coordinate planes and of the cube.
std::vector<Point<3>> directions() {
    constexpr auto around = detail::grid_directions();
    std::vector<Point<3>> all;
    for (const Point<3>& d : std::span{around}.subspan(around.size() / 2 + 1)) { // one of each opposite pair
        all.push_back(times(1 / norm(d), d));
    }
    return all;
}

/// A block and the candidate planes that cut it.
class BlockCutter {
public:
    /// `boundary`: the block's, if already known.
    BlockCutter(const Array<Point<3>>& points, const Block& block, const SizeField<3>& size, double growth,
                const Boundary<3>* boundary)
        : block_{block}, size_{size}, growth_{growth}, part_{surface_of_block(points, block.facets)},
          boundary_{boundary != nullptr ? *boundary : Boundary<3>{part_.surface}} {
        for (const Point<3>& p : part_.surface.points) {
            spacing_.push_back(size_(p));
        }
    }

    /// The part below a plane, with `share` of the load, and the part above; adds the interface's points.
    std::optional<std::pair<Block, Block>> run(double share, Array<Point<3>>& points) const {
        std::vector<CutPlane> grazing;
        for (const double imbalance : imbalances) {
            std::vector<CutPlane> planes = planes_near(share, imbalance);
            const auto clear = std::stable_partition(planes.begin(), planes.end(),
                                                     [](const CutPlane& plane) { return plane.along == 0; });
            grazing.insert(grazing.end(), clear, planes.end());
            planes.erase(clear, planes.end());
            if (auto parts = cut_by_best(std::move(planes), points)) {
                return parts;
            }
        }
        return cut_by_best(std::move(grazing), points);
    }

private:
    std::vector<CutPlane> planes_near(double share, double imbalance) const;
    std::vector<CutPlane> planes_across(const Point<3>& normal, double share, double imbalance) const;
    double triangles_in(const CutPlane& plane) const;
    double facets_along(const CutPlane& plane) const;
    std::optional<std::pair<Block, Block>> cut_by_best(std::vector<CutPlane> planes,
                                                       Array<Point<3>>& points) const;
    std::pair<Block, Block> cut(const PlaneFrame& plane, Array<Point<3>>& points) const;
    Array<Facet<3>> side(const std::vector<char>& above, char which) const;
    void require_sound(const BlockInterface& interface, const Array<Facet<3>>& facets) const;

    const Block& block_;
    const SizeField<3>& size_;
    double growth_;
    BlockSurface part_;
    Boundary<3> boundary_;
    std::vector<double> spacing_; ///< of each vertex
};

std::vector<CutPlane> BlockCutter::planes_near(double share, double imbalance) const {
    const std::vector<Point<3>> normals = directions();
    return parallel_gather<CutPlane>(normals.size(), 1,
                                     [&](std::size_t k, std::size_t, std::vector<CutPlane>& planes) {
                                         planes = planes_across(normals[k], share, imbalance);
                                     });
}

std::vector<CutPlane> BlockCutter::planes_across(const Point<3>& normal, double share,
                                                 double imbalance) const {
    std::vector<std::pair<double, double>> along; // place, load
    for (const LoadSample& sample : block_.load) {
        along.emplace_back(dot(normal, sample.at), sample.cubes);
    }
    std::sort(along.begin(), along.end());
    const double total = cubes_in(block_.load);
    std::vector<CutPlane> planes;
    double sum = 0;
    for (std::size_t k = 0; k < along.size() && planes.size() < offsets; ++k) {
        sum += along[k].second;
        const double place = 2.0 * static_cast<double>(planes.size()) / (offsets - 1) - 1;
        if (sum >= share * (1 + imbalance * place) * total) {
            CutPlane plane{normal, along[k].first};
            plane.triangles = triangles_in(plane);
            plane.along = facets_along(plane);
            planes.push_back(plane);
        }
    }
    return planes;
}

/// Estimate of the interface's number of triangles.
double BlockCutter::triangles_in(const CutPlane& plane) const {
    double triangles = 0;
    for (const LoadSample& sample : block_.load) {
        if (std::abs(dot(plane.normal, sample.at) - plane.offset) < sample.spacing) {
            triangles += sample.cubes; // the slice is two spacings thick; two triangles to a square
        }
    }
    return triangles;
}

double BlockCutter::facets_along(const CutPlane& plane) const {
    const auto& p = part_.surface.points;
    double count = 0;
    for (const Facet<3>& facet : part_.surface.facets) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Index v : facet) {
            const double height = dot(plane.normal, p[v]) - plane.offset;
            nearest = std::min(nearest, std::abs(height) / spacing_[v]);
        }
        if (nearest < near_plane) {
            const Point<3> normal = cross(minus(p[facet[1]], p[facet[0]]), minus(p[facet[2]], p[facet[0]]));
            const double cosine = std::abs(dot(plane.normal, normal)) / norm(normal);
            count += cosine > along_plane ? 1 : 0;
        }
    }
    return count;
}

std::optional<std::pair<Block, Block>> BlockCutter::cut_by_best(std::vector<CutPlane> planes,
                                                                Array<Point<3>>& points) const {
    std::stable_sort(planes.begin(), planes.end(),
                     [](const CutPlane& a, const CutPlane& b) { return a.price() < b.price(); });
    planes.resize(std::min(planes.size(), tries));
    for (const CutPlane& plane : planes) {
        try {
            return cut(PlaneFrame{plane.normal, plane.offset}, points);
        } catch (const GeometryError&) { // try the next plane
        }
    }
    return std::nullopt;
}

Array<Facet<3>> BlockCutter::side(const std::vector<char>& above, char which) const {
    Array<Facet<3>> facets;
    for (std::size_t f = 0; f < above.size(); ++f) {
        if (above[f] == which) {
            facets.push_back(part_.surface.facets[f]);
        }
    }
    return facets;
}

/// Throws unless the facets of a side bound a domain.
void BlockCutter::require_sound(const BlockInterface& interface, const Array<Facet<3>>& facets) const {
    Array<Point<3>> points = part_.surface.points;
    points.insert(points.end(), interface.points.begin(), interface.points.end());
    require_domain_boundary<3>(surface_of_block(points, facets).surface, {}, false);
}

std::pair<Block, Block> BlockCutter::cut(const PlaneFrame& plane, Array<Point<3>>& points) const {
    std::vector<double> height;
    for (const Point<3>& p : part_.surface.points) {
        height.push_back(plane.height(p));
    }
    const std::vector<char> above = divide_surface(part_.surface, boundary_.neighbors(), height, spacing_);
    const Array<Facet<2>> rim = edges_between(part_.surface, boundary_.neighbors(), above);
    const BlockInterface interface = span_curves(part_.surface.points, rim, plane, size_, growth_);

    std::array<Array<Facet<3>>, 2> sides{side(above, 0), side(above, 1)};
    for (Facet<3> facet : interface.facets) {
        sides[0].push_back(facet);
        std::swap(facet[0], facet[1]);
        sides[1].push_back(facet);
    }
    for (Array<Facet<3>>& facets : sides) {
        require_sound(interface, facets);
        const std::size_t given = part_.vertex.size();
        for (Facet<3>& facet : facets) {
            for (Index& v : facet) {
                v = v < given ? part_.vertex[v] : checked_index(points.size() + v - given, "points of a cap");
            }
        }
    }
    points.insert(points.end(), interface.points.begin(), interface.points.end());
    std::pair<Block, Block> parts{{std::move(sides[0]), {}}, {std::move(sides[1]), {}}};
    for (const LoadSample& sample : block_.load) {
        (plane.height(sample.at) > 0 ? parts.second : parts.first).load.push_back(sample);
    }
    return parts;
}

class DomainCutter {
public:
    DomainCutter(const SizeField<3>& size, double growth) : size_{size}, growth_{growth} {}

    DomainBlocks run(const Boundary<3>& boundary, const Surface<3>& surface, std::vector<LoadSample> load,
                     int count) {
        result_.points = surface.points;
        divide({surface.facets, std::move(load)}, count, &boundary);
        return std::move(result_);
    }

private:
    void divide(Block block, int count, const Boundary<3>* boundary = nullptr) {
        if (count > 1) {
            const int below = count / 2;
            auto parts = BlockCutter{result_.points, block, size_, growth_, boundary}.run(
                static_cast<double>(below) / count, result_.points);
            if (parts) {
                block = {};
                divide(std::move(parts->first), below);
                divide(std::move(parts->second), count - below);
                return;
            }
        }
        result_.facets.push_back(std::move(block.facets));
    }

    const SizeField<3>& size_;
    double growth_;
    DomainBlocks result_;
};

} // namespace

DomainBlocks cut_domain(const Boundary<3>& boundary, const Surface<3>& surface, const SizeField<3>& size,
                        double growth, std::vector<LoadSample> load, int count) {
    return DomainCutter{size, growth}.run(boundary, surface, std::move(load), count);
}

BlockSurface surface_of_block(const Array<Point<3>>& points, const Array<Facet<3>>& facets) {
    BlockSurface block;
    UsedVertices used{points.size(), facets};
    block.surface.facets = facets;
    used.renumber(block.surface.facets);
    for (const Index v : used.vertices) {
        block.surface.points.push_back(points[v]);
    }
    block.vertex = std::move(used.vertices);
    block.surface.patch.assign(facets.size(), 0);
    return block;
}

} // namespace slabhull
