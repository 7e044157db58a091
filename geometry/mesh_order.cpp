// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_order.h"

#include "slabhull/core/parallel.h"

#include "z_order.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace slabhull {

namespace {

/// A place along the curve, and who is there.
using Keyed = std::pair<std::uint64_t, Index>;

constexpr std::size_t grain = std::size_t{1} << 16;

/// Sorts pieces, then merges them by twos.
void sort_by_place(Array<Keyed>& order) {
    const auto at = [&order](std::size_t i) {
        return order.begin() + static_cast<std::ptrdiff_t>(std::min(i, order.size()));
    };
    parallel_for(order.size(), grain,
                 [&](std::size_t begin, std::size_t end) { std::sort(at(begin), at(end)); });
    for (std::size_t width = grain; width < order.size(); width *= 2) {
        parallel_for(order.size(), 2 * width, [&](std::size_t begin, std::size_t end) {
            std::inplace_merge(at(begin), at(std::min(begin + width, end)), at(end));
        });
    }
}

/// The numbers `first` .. `first + count - 1` in the order of their places.
template<class Place>
Array<Keyed> in_order(std::size_t first, std::size_t count, const Place& place) {
    Array<Keyed> order(count);
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto number = static_cast<Index>(first + i);
            order[i] = {place(number), number};
        }
    });
    sort_by_place(order);
    return order;
}

template<int D>
void order_points(CapMesh<D>& mesh, std::size_t given, const ZOrder<D>& curve) {
    const Array<Keyed> order =
        in_order(given, mesh.points.size() - given, [&](Index v) { return curve(mesh.points[v]); });
    Array<Point<D>> points(mesh.points.size());
    Array<Index> fresh(mesh.points.size());
    std::copy_n(mesh.points.begin(), given, points.begin());
    std::iota(fresh.begin(), fresh.begin() + static_cast<std::ptrdiff_t>(given), Index{0});
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Index old = order[i].second;
        fresh[old] = static_cast<Index>(given + i);
        points[given + i] = mesh.points[old];
    }
    mesh.points = std::move(points);
    parallel_for(mesh.cells.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            for (Index& v : mesh.cells[c]) {
                v = fresh[v];
            }
        }
    });
}

template<int D>
Point<D> centre_of(const CapMesh<D>& mesh, Index cell) {
    Point<D> centre{};
    for (const Index v : mesh.cells[cell]) {
        for (std::size_t k = 0; k < D; ++k) {
            centre[k] += mesh.points[v][k] / (D + 1);
        }
    }
    return centre;
}

template<int D>
void order_cells(CapMesh<D>& mesh, const ZOrder<D>& curve) {
    const Array<Keyed> order =
        in_order(0, mesh.cells.size(), [&](Index c) { return curve(centre_of(mesh, c)); });
    Array<Index> fresh(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        fresh[order[i].second] = static_cast<Index>(i);
    }
    Array<Simplex<D>> cells(order.size());
    Array<Neighbors<D>> neighbors(order.size());
    parallel_for(order.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Index old = order[i].second;
            cells[i] = mesh.cells[old];
            for (std::size_t k = 0; k <= D; ++k) {
                const Index across = mesh.neighbors[old][k];
                neighbors[i][k] = across == no_index ? no_index : fresh[across];
            }
        }
    });
    mesh.cells = std::move(cells);
    mesh.neighbors = std::move(neighbors);
}

} // namespace

template<int D>
void order_along_curve(CapMesh<D>& mesh, std::size_t given) {
    const ZOrder<D> curve{mesh.points};
    order_points(mesh, given, curve);
    order_cells(mesh, curve);
}

template void order_along_curve<2>(CapMesh<2>&, std::size_t);
template void order_along_curve<3>(CapMesh<3>&, std::size_t);

} // namespace slabhull
