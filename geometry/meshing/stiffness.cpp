// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/stiffness.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/geometry/measures.h"

#include "geometry/basics/vector_algebra.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

namespace slabhull::detail {

namespace {

constexpr std::size_t cells_per_piece = 1 << 14;
constexpr std::size_t vertices_per_piece = 1 << 12;

/// The pairs of corners of a cell: number of the pair of corners i and j.
template<int D>
struct CornerPairs {
    static constexpr std::size_t count = D * (D + 1) / 2;
    static constexpr auto number = [] {
        std::array<std::array<std::uint8_t, D + 1>, D + 1> result{};
        std::uint8_t next = 0;
        for (std::size_t i = 0; i <= D; ++i) {
            for (std::size_t j = i + 1; j <= D; ++j) {
                result[i][j] = result[j][i] = next++;
            }
        }
        return result;
    }();
};

/// The off-diagonal entries of one cell, by pair of corners.
template<int D>
using CellStiffness = std::array<float, CornerPairs<D>::count>;

/// Gradients of the barycentric coordinates, times D! V.
template<int D>
std::array<Point<D>, D + 1> scaled_gradients(const std::array<Point<D>, D + 1>& corners) {
    std::array<Point<D>, D + 1> g{};
    const auto u = minus(corners[1], corners[0]);
    const auto v = minus(corners[2], corners[0]);
    if constexpr (D == 2) {
        g[1] = {v[1], -v[0]};
        g[2] = {-u[1], u[0]};
    } else {
        const auto cross = [](const Point<3>& a, const Point<3>& b) {
            return Point<3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        };
        const auto w = minus(corners[3], corners[0]);
        g[1] = cross(v, w);
        g[2] = cross(w, u);
        g[3] = cross(u, v);
    }
    for (std::size_t i = 1; i <= D; ++i) {
        g[0] = minus(g[0], g[i]);
    }
    return g;
}

/// `unit`: the unit of length.
template<int D>
CellStiffness<D> cell_stiffness(const std::array<Point<D>, D + 1>& corners, double unit) {
    const auto g = scaled_gradients<D>(corners);
    const double volume = dot(g[1], minus(corners[1], corners[0])); // D! times the volume
    double squares = 0;
    for (const Point<D>& gradient : g) {
        squares += dot(gradient, gradient);
    }
    const double steepness = unit * unit * squares / (volume * volume);
    const double factor = steepness * steepness * (D == 3 ? 1 / unit : 1) / volume;
    CellStiffness<D> result{};
    for (std::size_t i = 0; i <= D; ++i) {
        for (std::size_t j = i + 1; j <= D; ++j) {
            result[CornerPairs<D>::number[i][j]] = static_cast<float>(factor * dot(g[i], g[j]));
        }
    }
    return result;
}

/// Edge of a cube as large as the mean cell, estimated from the bounding box: only its order of magnitude
/// matters.
template<int D>
double typical_length(std::span<const Point<D>> points, std::span<const Simplex<D>> cells) {
    double volume = 1;
    for (std::size_t k = 0; k < D; ++k) {
        const auto less = [k](const Point<D>& a, const Point<D>& b) { return a[k] < b[k]; };
        const auto [low, high] = std::minmax_element(points.begin(), points.end(), less);
        volume *= (*high)[k] - (*low)[k];
    }
    return std::pow(volume / static_cast<double>(cells.size()), 1.0 / D);
}

/// The cells around each free vertex.
struct Stars {
    Array<std::size_t> first;
    Array<Index> cells;
};

template<int D>
Stars stars_of(std::span<const Simplex<D>> cells, std::span<const std::uint8_t> fixed) {
    Stars stars;
    stars.first.assign(fixed.size() + 1, 0);
    for (const Simplex<D>& cell : cells) {
        for (const Index v : cell) {
            stars.first[v + 1] += 1U - fixed[v];
        }
    }
    for (std::size_t v = 0; v < fixed.size(); ++v) {
        stars.first[v + 1] += stars.first[v];
    }
    stars.cells.resize(stars.first.back());
    Array<std::size_t> next{stars.first};
    for (std::size_t c = 0; c < cells.size(); ++c) {
        for (const Index v : cells[c]) {
            if (fixed[v] == 0) {
                stars.cells[next[v]++] = static_cast<Index>(c);
            }
        }
    }
    return stars;
}

/// Number of neighbours of a vertex, given the number of cells around it. For D = 2 its link is a cycle; for
/// D = 3 it is a sphere of so many triangles, with half as many vertices, plus two, by Euler's formula.
template<int D>
std::size_t neighbors_in_ball(std::size_t cells) {
    return D == 2 ? cells : cells / 2 + 2;
}

template<int D>
class Assembly {
public:
    Assembly(std::span<const Point<D>> points, std::span<const Simplex<D>> cells,
             std::span<const std::uint8_t> fixed)
        : points_{points}, cells_{cells}, fixed_{fixed}, stars_{stars_of<D>(cells, fixed)} {}

    Stiffness run() {
        compute_cells();
        lay_out_rows();
        parallel_for(points_.size(), vertices_per_piece, [this](std::size_t begin, std::size_t end) {
            thread_local std::vector<Index> places;
            places.resize(points_.size());
            for (std::size_t v = begin; v < end; ++v) {
                if (fixed_[v] == 0) {
                    sum_row(v, places);
                }
            }
        });
        scale_entries();
        return std::move(result_);
    }

private:
    void compute_cells() {
        by_cell_.resize(cells_.size());
        const double unit = typical_length<D>(points_, cells_);
        parallel_for(cells_.size(), cells_per_piece, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                by_cell_[c] = cell_stiffness<D>(corners_of<D, D>(cells_[c], points_), unit);
            }
        });
    }

    void lay_out_rows() {
        result_.first.resize(points_.size() + 1);
        result_.first[0] = 0;
        for (std::size_t v = 0; v < points_.size(); ++v) {
            const std::size_t around = stars_.first[v + 1] - stars_.first[v];
            result_.first[v + 1] = result_.first[v] + (fixed_[v] != 0 ? 0 : neighbors_in_ball<D>(around));
        }
        result_.entries.resize(result_.first.back());
        result_.root.assign(points_.size(), 1);
    }

    /// Sums a row over the cells around its vertex. `places` caches the position in the row of each vertex's
    /// entry; stale positions from other rows are detected.
    void sum_row(std::size_t v, std::vector<Index>& places) {
        const auto row =
            std::span{result_.entries}.subspan(result_.first[v], result_.first[v + 1] - result_.first[v]);
        Index filled = 0;
        for (std::size_t k = stars_.first[v]; k < stars_.first[v + 1]; ++k) {
            const Index c = stars_.cells[k];
            const Simplex<D>& cell = cells_[c];
            const auto corner =
                static_cast<std::size_t>(std::find(cell.begin(), cell.end() - 1, v) - cell.begin());
            for (std::size_t j = 0; j <= D; ++j) {
                if (j == corner) {
                    continue;
                }
                Index& place = places[cell[j]];
                if (!(place < filled && row[place].column == cell[j])) {
                    place = filled++;
                    require_ball(v, filled <= row.size());
                    row[place] = {cell[j], 0};
                }
                row[place].value += by_cell_[c][CornerPairs<D>::number[corner][j]];
            }
        }
        require_ball(v, filled == row.size());
        float diagonal = 0;
        for (const Stiffness::Entry& entry : row) {
            diagonal -= entry.value;
        }
        result_.root[v] = std::sqrt(diagonal);
    }

    static void require_ball(std::size_t v, bool is_ball) {
        if (!is_ball) {
            throw GeometryError(
                fmt::format("a cap cannot be moved: the cells around vertex {}, which is not on "
                            "its boundary, do not fill a ball",
                            v));
        }
    }

    void scale_entries() {
        parallel_for(points_.size(), vertices_per_piece, [this](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                for (std::size_t k = result_.first[v]; k < result_.first[v + 1]; ++k) {
                    auto& [column, value] = result_.entries[k];
                    value /= result_.root[v] * result_.root[column];
                }
            }
        });
    }

    std::span<const Point<D>> points_;
    std::span<const Simplex<D>> cells_;
    std::span<const std::uint8_t> fixed_;
    Stars stars_;
    Array<CellStiffness<D>> by_cell_;
    Stiffness result_;
};

} // namespace

template<int D>
Stiffness assemble_stiffness(std::span<const Point<D>> points, std::span<const Simplex<D>> cells,
                             std::span<const std::uint8_t> fixed) {
    return Assembly<D>{points, cells, fixed}.run();
}

template Stiffness assemble_stiffness<2>(std::span<const Point<2>>, std::span<const Simplex<2>>,
                                         std::span<const std::uint8_t>);
template Stiffness assemble_stiffness<3>(std::span<const Point<3>>, std::span<const Simplex<3>>,
                                         std::span<const std::uint8_t>);

} // namespace slabhull::detail
