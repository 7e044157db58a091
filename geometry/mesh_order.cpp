// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/mesh_order.h"

#include "z_order.h"

#include "slabhull/core/parallel.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace slabhull {

namespace {

constexpr std::size_t grain = 1 << 14;

/// A place along the curve, and who is there.
using Keyed = std::pair<std::uint64_t, Index>;

/// Sorts pieces, then merges them by twos.
void sort_by_place(Array<Keyed>& keyed) {
    const auto at = [&keyed](std::size_t i) { return keyed.begin() + static_cast<std::ptrdiff_t>(i); };
    parallel_for(keyed.size(), grain,
                 [&](std::size_t begin, std::size_t end) { std::sort(at(begin), at(end)); });
    for (std::size_t width = grain; width < keyed.size(); width *= 2) {
        parallel_for(keyed.size(), 2 * width, [&](std::size_t begin, std::size_t end) {
            std::inplace_merge(at(begin), at(std::min(begin + width, end)), at(end));
        });
    }
}

/// `count` things by their places along the curve; what is in one place by number.
template<class Place>
Array<Index> sorted_along_curve(std::size_t count, const Place& place) {
    Array<Keyed> keyed(count);
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            keyed[k] = {place(k), static_cast<Index>(k)};
        }
    });
    sort_by_place(keyed);
    Array<Index> order(count);
    std::transform(keyed.begin(), keyed.end(), order.begin(), [](const auto& entry) { return entry.second; });
    return order;
}

/// From old numbers to new ones.
Array<Index> inverse(const Array<Index>& order) {
    Array<Index> fresh(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        fresh[order[k]] = static_cast<Index>(k);
    }
    return fresh;
}

template<class T>
void permute(Array<T>& values, const Array<Index>& order) {
    Array<T> result(values.size());
    parallel_for(order.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            result[k] = values[order[k]];
        }
    });
    values = std::move(result);
}

template<std::size_t N>
void renumber(Array<std::array<Index, N>>& lists, const Array<Index>& fresh) {
    parallel_for(lists.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            for (Index& entry : lists[k]) {
                entry = entry == no_index ? no_index : fresh[entry];
            }
        }
    });
}

template<int D>
Point<D> centre(const CapMesh<D>& mesh, std::size_t cell) {
    Point<D> sum{};
    for (const Index v : mesh.cells[cell]) {
        for (std::size_t k = 0; k < D; ++k) {
            sum[k] += mesh.points[v][k] / (D + 1);
        }
    }
    return sum;
}

} // namespace

template<int D>
void order_along_curve(CapMesh<D>& mesh, std::size_t fixed_points) {
    if (mesh.points.empty()) {
        return;
    }
    const ZOrder<D> curve{mesh.points};
    Array<Index> order(mesh.points.size());
    for (std::size_t v = 0; v < fixed_points; ++v) {
        order[v] = static_cast<Index>(v);
    }
    const Array<Index> free = sorted_along_curve(mesh.points.size() - fixed_points, [&](std::size_t v) {
        return curve(mesh.points[fixed_points + v]);
    });
    std::transform(free.begin(), free.end(), order.begin() + static_cast<std::ptrdiff_t>(fixed_points),
                   [=](Index v) { return static_cast<Index>(fixed_points + v); });
    permute(mesh.points, order);
    renumber(mesh.cells, inverse(order));

    order = sorted_along_curve(mesh.cells.size(), [&](std::size_t c) { return curve(centre<D>(mesh, c)); });
    permute(mesh.cells, order);
    permute(mesh.neighbors, order);
    renumber(mesh.neighbors, inverse(order));
}

template<int D>
Array<Index> curve_order(std::span<const Point<D>> points) {
    if (points.empty()) {
        return {};
    }
    const ZOrder<D> curve{points};
    return sorted_along_curve(points.size(), [&](std::size_t v) { return curve(points[v]); });
}

template void order_along_curve<2>(CapMesh<2>&, std::size_t);
template void order_along_curve<3>(CapMesh<3>&, std::size_t);
template Array<Index> curve_order<2>(std::span<const Point<2>>);
template Array<Index> curve_order<3>(std::span<const Point<3>>);

} // namespace slabhull
