// SPDX-License-Identifier: BSD-3-Clause
#include "core/hash.h"
#include "slabhull/edit/soup_edit.h"

#include "edit/soup_cells.h"
#include "edit/soup_rows.h"
#include "slabhull/core/vector.h"
#include "slabhull/topology/adjacency.h"
#include "topology/complex/repeated_vertex.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <unordered_map>

namespace slabhull {

namespace {

using detail::Order;

/// A place in space-time, or a box of a grid; in space alone with t = 0.
using Place = std::array<double, 4>;

struct PlaceHash {
    std::size_t operator()(const Place& place) const {
        std::uint64_t hash = 0;
        for (const double x : place) {
            hash = combined_hash(hash, std::bit_cast<std::uint64_t>(x));
        }
        return hash;
    }
};

/// The points kept so far, hashed by boxes of twice the tolerance: so the points within the tolerance of a
/// point lie in at most two boxes along each axis.
class PointGrid {
public:
    PointGrid(const io::Soup& soup, double tolerance)
        : points_{soup.points}, times_{has_time_as_coordinate(soup) ? nullptr : soup_times(soup)},
          tolerance_{tolerance} {}

    /// A kept point within the tolerance of v; v itself, kept from now on, when there is none.
    Index keep(Index v) {
        const Place at = place(v);
        for (unsigned corner = 0; corner < (tolerance_ > 0 ? 16U : 1U); ++corner) {
            const auto [first, last] = boxes_.equal_range(box(at, corner));
            for (auto entry = first; entry != last; ++entry) {
                if (near(place(entry->second), at)) {
                    return entry->second;
                }
            }
        }
        boxes_.emplace(box_of(at), v);
        return v;
    }

private:
    Place place(Index v) const {
        const Point<3>& x = points_[v];
        return {x[0] + 0.0, x[1] + 0.0, x[2] + 0.0, times_ == nullptr ? 0.0 : (*times_)[v] + 0.0};
    }
    bool near(const Place& a, const Place& b) const {
        return squared_distance(a, b) <= tolerance_ * tolerance_;
    }
    Place box_of(Place at) const {
        for (double& x : at) {
            x = tolerance_ > 0 ? std::floor(x / (2 * tolerance_)) + 0.0 : x;
        }
        return at;
    }
    /// The box that holds one corner of the cube of the tolerance about a place. Corners in one box are asked
    /// again, which does no harm.
    Place box(Place at, unsigned corner) const {
        for (unsigned k = 0; k < at.size(); ++k) {
            at[k] += (corner >> k & 1U) != 0 ? tolerance_ : -tolerance_;
        }
        return box_of(at);
    }

    const Array<Point<3>>& points_;
    const Array<double>* times_ = nullptr;
    double tolerance_;
    std::unordered_multimap<Place, Index, PlaceHash> boxes_;
};

Order sound_cells(const io::SimplexBlock& block, std::size_t corners) {
    Order order;
    for (std::size_t c = 0; c < block.vertices.size() / corners; ++c) {
        if (!repeats_a_vertex(std::span{&block.vertices[c * corners], corners})) {
            order.push_back(static_cast<Index>(c));
        }
    }
    return order;
}

template<int D>
Array<std::int64_t> neighbors_of(const io::Soup& soup) {
    const Array<Index>& vertices = soup.simplices[D].vertices;
    Array<Simplex<D>> cells(vertices.size() / (D + 1));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        cells[i / (D + 1)][i % (D + 1)] = vertices[i];
    }
    Array<std::int64_t> neighbors;
    for (const auto& across : build_adjacency<D>(cells, soup.points.size()).neighbors) {
        for (const Index cell : across) {
            neighbors.push_back(cell == no_index ? -1 : static_cast<std::int64_t>(cell));
        }
    }
    return neighbors;
}

void find_neighbors_anew(io::Soup& soup) {
    const int dimension = soup.top_dimension();
    Array<std::int64_t>* neighbors = detail::whole_numbers(soup.cell_data, "neighbors", dimension + 1);
    if (neighbors != nullptr && dimension > 0) {
        *neighbors = dimension == 1   ? neighbors_of<1>(soup)
                     : dimension == 2 ? neighbors_of<2>(soup)
                                      : neighbors_of<3>(soup);
    }
}

} // namespace

Welded weld(io::Soup& soup, double tolerance) {
    PointGrid grid{soup, tolerance};
    Array<Index> stays(soup.points.size());
    Order order;
    for (std::size_t v = 0; v < stays.size(); ++v) {
        stays[v] = grid.keep(static_cast<Index>(v));
        if (stays[v] == v) {
            order.push_back(static_cast<Index>(v));
        }
    }
    Welded welded{soup.points.size() - order.size(), 0};
    std::array<Order, 4> orders;
    for (std::size_t d = 0; d < orders.size(); ++d) {
        io::SimplexBlock& block = soup.simplices[d];
        std::transform(block.vertices.begin(), block.vertices.end(), block.vertices.begin(),
                       [&](Index v) { return stays[v]; });
        orders[d] = sound_cells(block, d + 1);
        welded.cells += block.vertices.size() / (d + 1) - orders[d].size();
    }
    detail::keep_cells(soup, orders);
    detail::keep_points(soup, order);
    find_neighbors_anew(soup);
    detail::mend_cells_of_points(soup);
    return welded;
}

} // namespace slabhull
