// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/mesh_order.h"

#include "geometry/meshing/curve_places.h"
#include "geometry/meshing/z_order.h"

#include "slabhull/core/parallel.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

constexpr std::size_t indices_per_chunk = 1 << 14;

/// A position along the curve, and the item there.
using Keyed = std::pair<std::uint64_t, Index>;

/// Items grouped by stretches of the curve; within a stretch, ascending by number.
struct Stretches {
    Array<Index> members;
    std::vector<std::size_t> begin; ///< of each stretch, and the end of the last
};

/// Counting sort by the leading bits of the positions, in two passes. Each thread takes one part of the items
/// and has its own counters.
template<class Place>
Stretches sort_into_stretches(std::size_t count, const Place& place) {
    constexpr std::size_t wanted_members = 256;
    constexpr int most_bits = 16;
    const int bits = std::min(most_bits, static_cast<int>(std::bit_width(count / wanted_members)));
    const auto stretch_of = [&place, bits](std::size_t k) { return bits == 0 ? 0 : place(k) >> (64 - bits); };
    const std::size_t stretches = std::size_t{1} << bits;
    const auto parts = static_cast<std::size_t>(thread_count());
    const std::size_t part_size = std::max<std::size_t>(1, (count + parts - 1) / parts);
    std::vector<std::size_t> next(parts * stretches, 0); // by part and stretch
    parallel_for(count, part_size, [&](std::size_t begin, std::size_t end) {
        std::size_t* const counts = next.data() + begin / part_size * stretches;
        for (std::size_t k = begin; k < end; ++k) {
            ++counts[stretch_of(k)];
        }
    });
    Stretches result{Array<Index>(count), std::vector<std::size_t>(stretches + 1, count)};
    std::size_t sum = 0;
    for (std::size_t s = 0; s < stretches; ++s) {
        result.begin[s] = sum;
        for (std::size_t k = s; k < next.size(); k += stretches) {
            sum += std::exchange(next[k], sum);
        }
    }
    parallel_for(count, part_size, [&](std::size_t begin, std::size_t end) {
        std::size_t* const places = next.data() + begin / part_size * stretches;
        for (std::size_t k = begin; k < end; ++k) {
            result.members[places[stretch_of(k)]++] = static_cast<Index>(k);
        }
    });
    return result;
}

/// Numbers 0 .. count - 1 sorted by position along the curve, then by number. Positions are stored for one
/// stretch at a time.
template<class Place>
Array<Index> sorted_along_curve(std::size_t count, const Place& place) {
    constexpr std::size_t stretches_per_piece = 16;
    Stretches stretches = sort_into_stretches(count, place);
    parallel_for(stretches.begin.size() - 1, stretches_per_piece, [&](std::size_t first, std::size_t last) {
        std::vector<Keyed> keyed;
        for (std::size_t s = first; s < last; ++s) {
            const std::span<Index> members{stretches.members.data() + stretches.begin[s],
                                           stretches.begin[s + 1] - stretches.begin[s]};
            keyed.clear();
            for (const Index k : members) {
                keyed.emplace_back(place(k), k);
            }
            std::sort(keyed.begin(), keyed.end());
            std::transform(keyed.begin(), keyed.end(), members.begin(),
                           [](const Keyed& entry) { return entry.second; });
        }
    });
    return std::move(stretches.members);
}

template<class T>
void permute(Array<T>& values, const Array<Index>& order) {
    Array<T> result(values.size());
    parallel_for(order.size(), indices_per_chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            result[k] = values[order[k]];
        }
    });
    values = std::move(result);
}

template<std::size_t N>
void renumber(Array<std::array<Index, N>>& lists, const Array<Index>& fresh) {
    parallel_for(lists.size(), indices_per_chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            for (Index& entry : lists[k]) {
                entry = entry == no_index ? no_index : fresh[entry];
            }
        }
    });
}

} // namespace

Array<Index> inverse_order(const Array<Index>& order) {
    Array<Index> fresh(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        fresh[order[k]] = static_cast<Index>(k);
    }
    return fresh;
}

template<int D>
Array<Index> point_order(std::span<const Point<D>> points, std::size_t fixed) {
    const ZOrder<D> curve{points};
    Array<Index> order(points.size());
    for (std::size_t v = 0; v < fixed; ++v) {
        order[v] = static_cast<Index>(v);
    }
    const Array<Index> free =
        sorted_along_curve(points.size() - fixed, [&](std::size_t v) { return curve(points[fixed + v]); });
    std::transform(free.begin(), free.end(), order.begin() + static_cast<std::ptrdiff_t>(fixed),
                   [=](Index v) { return static_cast<Index>(fixed + v); });
    return order;
}

template<int D>
Point<D> centre_of_cell(const Simplex<D>& cell, std::span<const Point<D>> points) {
    Point<D> sum{};
    for (const Index v : cell) {
        for (std::size_t k = 0; k < D; ++k) {
            sum[k] += points[v][k] / (D + 1);
        }
    }
    return sum;
}

template<int D>
void order_along_curve(CapMesh<D>& mesh, std::size_t fixed_points) {
    if (mesh.points.empty()) {
        return;
    }
    Array<Index> order = point_order<D>(mesh.points, fixed_points);
    permute(mesh.points, order);
    renumber(mesh.cells, inverse_order(order));

    const ZOrder<D> curve{mesh.points};
    order = sorted_along_curve(mesh.cells.size(), [&](std::size_t c) {
        return curve(centre_of_cell<D>(mesh.cells[c], mesh.points));
    });
    permute(mesh.cells, order);
    permute(mesh.neighbors, order);
    renumber(mesh.neighbors, inverse_order(order));
}

template<int D>
Array<Index> curve_order(std::span<const Point<D>> points) {
    if (points.empty()) {
        return {};
    }
    const ZOrder<D> curve{points};
    return sorted_along_curve(points.size(), [&](std::size_t v) { return curve(points[v]); });
}

template Array<Index> point_order<2>(std::span<const Point<2>>, std::size_t);
template Array<Index> point_order<3>(std::span<const Point<3>>, std::size_t);
template Point<2> centre_of_cell<2>(const Simplex<2>&, std::span<const Point<2>>);
template Point<3> centre_of_cell<3>(const Simplex<3>&, std::span<const Point<3>>);
template void order_along_curve<2>(CapMesh<2>&, std::size_t);
template void order_along_curve<3>(CapMesh<3>&, std::size_t);
template Array<Index> curve_order<2>(std::span<const Point<2>>);
template Array<Index> curve_order<3>(std::span<const Point<3>>);

} // namespace slabhull
