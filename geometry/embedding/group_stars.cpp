// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/embedding/group_stars.h"

#include "core/pieces.h"
#include "geometry/embedding/cell_pairs.h"
#include "geometry/embedding/rounding.h"

#include "slabhull/core/parallel.h"
#include "slabhull/core/progress.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/measures.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace slabhull {

namespace {

double determinant(const Point<2>& o, const Point<2>& a, const Point<2>& b) {
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}
double determinant(const Point<3>& o, const Point<3>& a, const Point<3>& b, const Point<3>& c) {
    const double ax = a[0] - o[0], ay = a[1] - o[1], az = a[2] - o[2];
    const double bx = b[0] - o[0], by = b[1] - o[1], bz = b[2] - o[2];
    const double cx = c[0] - o[0], cy = c[1] - o[1], cz = c[2] - o[2];
    return ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
}

} // namespace

/// Runs the proof vertex by vertex, reusing its memory.
template<int D>
class StarProof {
public:
    explicit StarProof(const GroupStars<D>& stars) : s_{stars} {}

    bool holds(Index v) {
        collect(v);
        Point<D + 1> direction{};
        for (const Index g : groups_) {
            for (std::size_t k = 0; k <= D; ++k) {
                direction[k] += static_cast<double>(s_.normals_[g][k]);
            }
        }
        return holds_along(direction) || (steer(direction) && holds_along(direction));
    }

private:
    using Place = Point<D>;
    /// Positions of the vertices of a cell, or of the simplex of v and a border facet, by number; v is number
    /// 0.
    struct Corners {
        std::array<std::uint32_t, D + 1> at;
        std::size_t apex; ///< local number of v
    };

    void collect(Index v) {
        v_ = v;
        groups_ = s_.groups_.groups_of(v);
        first_.clear();
        cells_.clear();
        blocks_ = {};
        for (const Index g : groups_) {
            first_.push_back(s_.groups_.first_cell(g));
            cells_.push_back(static_cast<Index>(s_.groups_.cell_count(g)));
            mark_block(first_.back());
            mark_block(first_.back() + cells_.back() - 1);
        }
        while (first_.size() % at_once != 0) { // no cell is in these
            first_.push_back(0);
            cells_.push_back(0);
        }
    }

    bool holds_along(const Point<D + 1>& direction) {
        return project(direction) && keeps_orientation() && covers_once();
    }

    /// Positions of all vertices relative to v, projected along `direction` onto all coordinates but that of
    /// its largest component. False if they are out of the range in which the error bounds hold.
    ///
    /// The slopes have no error, since they define the direction. With u the unit roundoff and m[j] the
    /// largest |x_j| + |slope_j x_k| of all positions, a computed coordinate j is within 3.1 u m[j] of the
    /// true one: one rounding of each difference, one of the product, one of the sum. The difference of two
    /// is within 8.2 u m[j] of the true one and not larger than 2 m[j]. A determinant is a sum of six
    /// products of three of these (two of two), each off by 99 u times the product of the m by its factors
    /// and by 48 u times it by its own roundings: 882 u in all. Underflow loses far less, as the m are kept
    /// from being tiny or huge.
    bool project(const Point<D + 1>& direction) {
        std::size_t axis = 0;
        for (std::size_t k = 1; k <= D; ++k) {
            axis = std::abs(direction[k]) > std::abs(direction[axis]) ? k : axis;
        }
        std::array<std::size_t, D> kept;
        Place slope;
        for (std::size_t j = 0; j < D; ++j) {
            kept[j] = (axis + 1 + j) % (D + 1);
            slope[j] = direction[kept[j]] / s_.scale_[kept[j]] * s_.scale_[axis] / direction[axis];
        }
        const Point<D + 1>& origin = s_.points_[v_];
        Place largest{};
        places_.resize(1 + CellGroups<D>::most_vertices * groups_.size());
        Place* next = places_.data();
        *next++ = {};
        for (const Index g : groups_) {
            for (const Index w : s_.groups_.vertices(g)) {
                const Point<D + 1>& p = s_.points_[w];
                const double along = p[axis] - origin[axis];
                Place& place = *next++;
                for (std::size_t j = 0; j < D; ++j) {
                    const double x = p[kept[j]] - origin[kept[j]];
                    const double shift = slope[j] * along;
                    place[j] = x - shift;
                    largest[j] = std::max(largest[j], std::abs(x) + std::abs(shift));
                }
            }
        }
        places_.resize(static_cast<std::size_t>(next - places_.data()));
        tolerance_ = 1024 * unit_roundoff;
        bool in_range = true;
        for (std::size_t j = 0; j < D; ++j) {
            tolerance_ *= largest[j];
            in_range = in_range && std::isfinite(slope[j]) && largest[j] > 1e-60 && largest[j] < 1e60;
        }
        return in_range;
    }

    /// Checks points 1 and 2 of the proof and lists the border.
    bool keeps_orientation() {
        border_.clear();
        sign_ = 0;
        std::uint32_t offset = 1;
        for (std::size_t k = 0; k < groups_.size(); ++k) {
            const auto cells = s_.cells_of(groups_[k]);
            const auto vertices = s_.groups_.vertices(groups_[k]);
            const auto own = static_cast<std::uint32_t>(
                std::lower_bound(vertices.begin(), vertices.end(), v_) - vertices.begin());
            for (std::size_t c = 0; c < cells.size(); ++c) {
                Corners corners;
                unsigned opposite = 0; // the facet opposite to v
                for (std::size_t i = 0; i <= D; ++i) {
                    corners.at[i] = offset + cells[c].corner[i];
                    opposite |= unsigned{cells[c].corner[i] == own} << i;
                }
                const unsigned outer = opposite != 0 ? cells[c].outer & opposite : cells[c].outer;
                if (!is_positive(corners) || !sees_border(first_[k] + c, outer, corners)) {
                    return false;
                }
            }
            offset += static_cast<std::uint32_t>(vertices.size());
        }
        return true;
    }

    /// `outer`: the facets of a cell that may be in the border. Those at v never are: all cells at v are
    /// here.
    bool sees_border(std::size_t cell, unsigned outer, const Corners& corners) {
        for (; outer != 0; outer &= outer - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(outer));
            if (is_here(s_.mesh_.neighbor(static_cast<Index>(cell), i))) {
                continue;
            }
            Corners seen = corners;
            seen.at[i] = 0;
            seen.apex = i;
            if (!is_positive(seen)) {
                return false;
            }
            border_.push_back(seen);
        }
        return true;
    }

    /// Cells by blocks of so many, of which a group meets two at most: no other cell of a block that is not
    /// marked is here. Of two blocks with the same bit, both are.
    static constexpr Index block = 16;
    static_assert(CellGroups<D>::most_cells <= block);
    void mark_block(Index cell) { blocks_[cell / block / 64 % blocks_.size()] |= block_bit(cell); }
    bool may_be_here(Index cell) const {
        return (blocks_[cell / block / 64 % blocks_.size()] & block_bit(cell)) != 0;
    }
    static std::uint64_t block_bit(Index cell) { return std::uint64_t{1} << cell / block % 64; }

    /// A linear search is fine: vertices have few groups, hubs of meshes excepted.
    bool is_here(Index cell) const {
        if (!may_be_here(cell)) {
            return false;
        }
        if (groups_.size() > 64) {
            return is_here_by_search(cell);
        }
        using Four = Index __attribute__((vector_size(at_once * sizeof(Index))));
        Four here{};
        for (std::size_t k = 0; k < first_.size(); k += at_once) {
            Four first;
            Four cells;
            std::memcpy(&first, &first_[k], sizeof(first));
            std::memcpy(&cells, &cells_[k], sizeof(cells));
            here |= static_cast<Four>(cell - first < cells);
        }
        return (here[0] | here[1] | here[2] | here[3]) != 0;
    }
    bool is_here_by_search(Index cell) const {
        const auto tested = std::lower_bound(groups_.begin(), groups_.end(), s_.groups_.tested());
        const auto middle = first_.begin() + (tested - groups_.begin());
        const auto in = [&](auto begin, auto end) {
            const auto next = std::upper_bound(begin, end, cell);
            return next != begin &&
                   cell - next[-1] < cells_[static_cast<std::size_t>(next - first_.begin()) - 1];
        };
        return in(first_.begin(), middle) ||
               in(middle, first_.begin() + static_cast<std::ptrdiff_t>(groups_.size()));
    }

    double orientation(const std::array<std::uint32_t, D + 1>& at) const {
        if constexpr (D == 2) {
            return determinant(places_[at[0]], places_[at[1]], places_[at[2]]);
        } else {
            return determinant(places_[at[0]], places_[at[1]], places_[at[2]], places_[at[3]]);
        }
    }

    /// Whether the sign is provably that of the first simplex asked for.
    bool is_positive(const Corners& corners) {
        const double value = orientation(corners.at);
        if (sign_ == 0) {
            sign_ = value > 0 ? 1 : -1;
        }
        return sign_ * value > tolerance_;
    }

    /// Checks point 3 of the proof, with the centroid of some border facet as the direction.
    bool covers_once() {
        constexpr std::size_t tries = 4;
        places_.emplace_back();
        for (std::size_t k = 0; k < tries && !border_.empty(); ++k) {
            const std::size_t facet = k * border_.size() / tries;
            Place middle{};
            for (const std::uint32_t w : border_[facet].at) {
                for (std::size_t j = 0; j < D; ++j) {
                    middle[j] += places_[w][j] / D;
                }
            }
            places_.back() = middle;
            if (lies_in(border_[facet]) && is_alone(facet)) {
                return true;
            }
        }
        return false;
    }

    bool is_alone(std::size_t facet) const {
        for (std::size_t other = 0; other < border_.size(); ++other) {
            if (other != facet && !lies_off(border_[other])) {
                return false;
            }
        }
        return true;
    }

    /// Orientation of the simplex of v and a facet with the direction in place of vertex i. Its position has
    /// no error and is no larger than the others, so the bound holds.
    double side(const Corners& facet, std::size_t i) const {
        auto at = facet.at;
        at[i] = static_cast<std::uint32_t>(places_.size() - 1);
        return sign_ * orientation(at);
    }
    bool lies_in(const Corners& facet) const {
        bool in = true;
        for (std::size_t i = 0; i <= D; ++i) {
            in = in && (i == facet.apex || side(facet, i) > tolerance_);
        }
        return in;
    }
    bool lies_off(const Corners& facet) const {
        for (std::size_t i = 0; i <= D; ++i) {
            if (i != facet.apex && side(facet, i) < -tolerance_) {
                return true;
            }
        }
        return false;
    }

    /// Turns `direction` so that all normals are on its side, by the relaxation method (Motzkin and
    /// Schoenberg, Canad. J. Math. 6, 1954). False if that does not succeed soon.
    bool steer(Point<D + 1>& direction) {
        constexpr int most_steps = 100;
        constexpr std::size_t most_cells = 4096;
        find_unit_normals();
        if (unit_normals_.size() > most_cells) {
            return false;
        }
        for (int step = 0; step < most_steps; ++step) {
            const double length = norm(direction);
            const Point<D + 1>* worst = nullptr;
            double least = 0.02 * length; // with a margin
            for (const Point<D + 1>& normal : unit_normals_) {
                const double along = dot(direction, normal);
                if (along < least) {
                    least = along;
                    worst = &normal;
                }
            }
            if (worst == nullptr) {
                return step > 0;
            }
            for (std::size_t k = 0; k <= D; ++k) {
                direction[k] += (2 * std::abs(least) + 0.05 * length) * (*worst)[k];
            }
        }
        return false;
    }

    void find_unit_normals() {
        unit_normals_.clear();
        for (std::size_t k = 0; k < groups_.size(); ++k) {
            for (std::size_t c = first_[k]; c < first_[k] + cells_[k]; ++c) {
                Point<D + 1> normal = s_.scaled_normal(c);
                const double length = norm(normal);
                for (double& x : normal) {
                    x /= length;
                }
                unit_normals_.push_back(normal);
            }
        }
    }

    const GroupStars<D>& s_;
    Index v_ = 0;
    std::span<const Index> groups_;
    static constexpr std::size_t at_once = 4;

    std::vector<Index> first_; ///< first cell of each group; then some zeros, up to a multiple of at_once
    std::vector<Index> cells_; ///< number of cells of each group, and as many zeros
    std::array<std::uint64_t, 4> blocks_{}; ///< marks of blocks of cells, see mark_block()
    std::vector<Place> places_;
    std::vector<Corners> border_;
    std::vector<Point<D + 1>> unit_normals_;
    double tolerance_ = 0;
    double sign_ = 0;
};

template<int D>
GroupStars<D>::GroupStars(const JoinedSpans<Point<D + 1>>& points, const PartialMesh<D>& mesh,
                          const CellGroups<D>& groups, const Point<D + 1>& scale)
    : points_{points}, mesh_{mesh}, groups_{groups}, scale_{scale} {
    local_.resize(groups.cells_before(groups.count()));
    normals_.resize(groups.count());
    parallel_for(groups.count(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g) {
            list_cells(g);
            normals_[g] = group_normal(g);
        }
    });
}

template<int D>
void GroupStars<D>::list_cells(std::size_t group) {
    const auto vertices = groups_.vertices(group);
    const Index first = groups_.first_cell(group);
    const std::size_t count = groups_.cell_count(group);
    for (std::size_t k = 0; k < count; ++k) {
        LocalCell& local = local_[groups_.cells_before(group) + k];
        local.outer = 0;
        for (std::size_t i = 0; i <= D; ++i) {
            const auto place =
                std::find(vertices.begin(), vertices.end(), mesh_.cell(static_cast<Index>(first + k))[i]);
            local.corner[i] = static_cast<std::uint8_t>(place - vertices.begin());
            const bool outer = mesh_.neighbor(static_cast<Index>(first + k), i) - first >= count;
            local.outer = static_cast<std::uint8_t>(local.outer | unsigned{outer} << i);
        }
    }
}

template<int D>
Point<D + 1> GroupStars<D>::scaled_normal(std::size_t cell) const {
    auto corners = corners_of<D, D + 1>(mesh_.cell(static_cast<Index>(cell)), points_);
    for (auto& corner : corners) {
        for (std::size_t k = 0; k <= D; ++k) {
            corner[k] *= scale_[k];
        }
    }
    return simplex_normal<D>(corners);
}

template<int D>
std::array<float, D + 1> GroupStars<D>::group_normal(std::size_t group) const {
    Point<D + 1> sum{};
    for (std::size_t c = 0; c < groups_.cell_count(group); ++c) {
        const Point<D + 1> normal = scaled_normal(groups_.first_cell(group) + c);
        for (std::size_t k = 0; k <= D; ++k) {
            sum[k] += normal[k];
        }
    }
    const double length = norm(sum);
    std::array<float, D + 1> unit;
    for (std::size_t k = 0; k <= D; ++k) {
        unit[k] = static_cast<float>(sum[k] / length);
    }
    return unit;
}

template<int D>
std::vector<char> GroupStars<D>::prove(std::span<const Index> vertices) const {
    std::vector<char> proven(vertices.size());
    expect_work(vertices.size());
    parallel_for(vertices.size(), 1024, [&](std::size_t begin, std::size_t end) {
        StarProof<D> proof{*this};
        for (std::size_t k = begin; k < end; ++k) {
            proven[k] = proof.holds(vertices[k]);
        }
        work_done(end - begin);
    });
    return proven;
}

namespace {

/// Whether another vertex is in all tested groups of v, and represents it.
template<int D>
bool is_covered(const CellGroups<D>& groups, Index v) {
    const auto own = groups.tested_groups_of(v);
    const auto around = groups.vertices(own.front());
    return std::any_of(around.begin(), around.end(), [&](Index w) {
        const auto other = groups.tested_groups_of(w);
        const bool stands = other.size() > own.size() || (other.size() == own.size() && w < v);
        return stands && std::includes(other.begin(), other.end(), own.begin(), own.end());
    });
}

} // namespace

template<int D>
std::vector<Index> star_centres(const CellGroups<D>& groups, std::size_t vertex_count) {
    constexpr std::size_t grain = 1 << 14;
    return parallel_gather<Index>(vertex_count, grain,
                                  [&](std::size_t begin, std::size_t end, std::vector<Index>& centres) {
                                      for (std::size_t k = begin; k < end; ++k) {
                                          const auto v = static_cast<Index>(k);
                                          if (!groups.tested_groups_of(v).empty() && !is_covered(groups, v)) {
                                              centres.push_back(v);
                                          }
                                      }
                                  });
}

template class GroupStars<2>;
template class GroupStars<3>;
template std::vector<Index> star_centres<2>(const CellGroups<2>&, std::size_t);
template std::vector<Index> star_centres<3>(const CellGroups<3>&, std::size_t);

} // namespace slabhull
