// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/parallel_sort.h"
#include "core/pieces.h"

#include "slabhull/core/array.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

namespace slabhull {

/// An axis-parallel closed box. The default one is empty and meets nothing.
template<int D>
struct Box {
    static_assert(2 <= D && D <= 4);

    Point<D> low = filled(std::numeric_limits<double>::infinity());
    Point<D> high = filled(-std::numeric_limits<double>::infinity());

    void include(const Point<D>& p) {
        for (std::size_t k = 0; k < D; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    }
    void include(const Box& other) {
        for (std::size_t k = 0; k < D; ++k) {
            low[k] = std::min(low[k], other.low[k]);
            high[k] = std::max(high[k], other.high[k]);
        }
    }
    bool empty() const { return low[0] > high[0]; }
    bool meets(const Box& other) const {
        // Branch-free, as branches per axis are unpredictable; two axes at once, which the compiler does not find.
        using Two = double __attribute__((vector_size(16)));
        const auto two = [](const double* from) {
            Two values;
            std::memcpy(&values, from, sizeof(values));
            return values;
        };
        bool apart = false;
        if constexpr (D % 2 == 1) {
            apart = (low[D - 1] > other.high[D - 1]) | (other.low[D - 1] > high[D - 1]);
        }
        auto both = two(&low[0]) > two(&other.high[0]);
        both |= two(&other.low[0]) > two(&high[0]);
        if constexpr (D >= 4) {
            both |= two(&low[2]) > two(&other.high[2]);
            both |= two(&other.low[2]) > two(&high[2]);
        }
        return !(apart | ((both[0] | both[1]) != 0));
    }
    double extent() const {
        double largest = 0;
        for (std::size_t k = 0; k < D; ++k) {
            largest = std::max(largest, high[k] - low[k]);
        }
        return largest;
    }

private:
    static constexpr Point<D> filled(double value) {
        Point<D> p{};
        p.fill(value);
        return p;
    }
};

/// A bounding box tree over facets: finds those whose boxes meet.
///
/// The boxes are ordered by size class first and along a Morton curve second, then grouped: `block` of them
/// to a leaf, `fan` nodes to a parent. Without the size classes, one large facet among small ones would
/// enlarge all nodes above it. The result does not depend on the number of threads.
template<int D>
class BoxTree {
public:
    static constexpr std::size_t block = 8;
    static constexpr std::size_t fan_bits = 2;
    static constexpr std::size_t fan = std::size_t{1} << fan_bits;

    /// `boxes`: one per item; empty ones are never found.
    explicit BoxTree(const Array<Box<D>>& boxes)
        : BoxTree{boxes.size(), [&boxes](std::size_t item) { return boxes[item]; }} {}
    /// The same for boxes that are not stored: box_of(item) is called three times per item, from several
    /// threads.
    template<class BoxOf>
    BoxTree(std::size_t count, const BoxOf& box_of) {
        order_items(count, box_of);
        build_levels();
    }

    std::size_t blocks() const { return levels_.front().size(); }

    /// Calls visit(item) for each item whose box meets `box`.
    template<class Visit>
    void find(const Box<D>& box, Visit&& visit) const {
        descend(levels_.size() - 1, 0, 0, box, [&](std::size_t leaf) {
            for (std::size_t k = leaf * block; k < block_end(leaf); ++k) {
                if (boxes_[k].meets(box)) {
                    visit(items_[k]);
                }
            }
        });
    }

    /// Calls visit(a, b) once for each pair of items whose boxes meet, with a in block `own` and b in the
    /// same block or a later one.
    template<class Visit>
    void find_pairs(std::size_t own, Visit&& visit) const {
        const Box<D>& around = levels_.front()[own];
        descend(levels_.size() - 1, 0, own, around, [&](std::size_t leaf) {
            for (std::size_t k = leaf * block; k < block_end(leaf); ++k) {
                if (boxes_[k].meets(around)) {
                    const std::size_t end = leaf == own ? k : block_end(own);
                    pair_up(k, own * block, end, visit);
                }
            }
        });
    }

private:
    std::size_t block_end(std::size_t leaf) const { return std::min(boxes_.size(), (leaf + 1) * block); }

    template<class Visit>
    void pair_up(std::size_t one, std::size_t begin, std::size_t end, Visit&& visit) const {
        for (std::size_t k = begin; k < end; ++k) {
            if (boxes_[k].meets(boxes_[one])) {
                visit(items_[k], items_[one]);
            }
        }
    }

    /// Calls visit(leaf) for the leaves under a node, from `first` on, whose box meets `box`.
    template<class Visit>
    void descend(std::size_t level, std::size_t node, std::size_t first, const Box<D>& box,
                 const Visit& visit) const {
        if (!levels_[level][node].meets(box)) {
            return;
        }
        if (level == 0) {
            visit(node);
            return;
        }
        const std::size_t end = std::min(levels_[level - 1].size(), (node + 1) * fan);
        for (std::size_t child = std::max(node * fan, first >> (fan_bits * (level - 1))); child < end;
             ++child) {
            descend(level - 1, child, first, box, visit);
        }
    }

    template<class BoxOf>
    void order_items(std::size_t count, const BoxOf& box_of);
    void build_levels();

    std::vector<Index> items_;
    Array<Box<D>> boxes_;               ///< in the order of items_
    std::vector<Array<Box<D>>> levels_; ///< leaves first, the last has one node
};

namespace detail {

/// The bits of numbers, spread: D - 1 zeros stand before each.
template<int D>
constexpr auto spread_bytes = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t value = 0; value < table.size(); ++value) {
        for (int k = 0; k < 8; ++k) {
            table[value] |= ((value >> k) & 1) << (k * D);
        }
    }
    return table;
}();

/// Spreads the lowest `bits` bits of `value`, which has no others.
template<int D>
std::uint64_t spread_bits(std::uint64_t value, int bits) {
    std::uint64_t spread = 0;
    for (int k = 0; k < bits; k += 8) {
        spread |= std::uint64_t{spread_bytes<D>[value >> k & 255]} << (k * D);
    }
    return spread;
}

/// Sort key of a box: size class in the upper 8 bits, Morton code of its centre below.
template<int D>
std::uint64_t tree_key(const Box<D>& box, const Box<D>& all) {
    constexpr int bits = 54 / D;
    constexpr int classes = 255;
    if (box.empty()) {
        return std::numeric_limits<std::uint64_t>::max();
    }
    const double ratio = all.extent() / box.extent();
    const int size_class = ratio >= 1 && std::isfinite(ratio) ? std::ilogb(ratio) / 2 : classes - 1;
    std::uint64_t code = 0;
    for (std::size_t k = 0; k < D; ++k) {
        const double place = (0.5 * box.low[k] + 0.5 * box.high[k] - all.low[k]) / all.extent();
        const double cell = place > 0 ? std::min(place, 0.999999) * static_cast<double>(1 << bits) : 0;
        code |= spread_bits<D>(static_cast<std::uint64_t>(cell), bits) << k;
    }
    return static_cast<std::uint64_t>(std::min(size_class, classes - 1)) << 56 | code;
}

} // namespace detail

template<int D>
template<class BoxOf>
void BoxTree<D>::order_items(std::size_t count, const BoxOf& box_of) {
    constexpr std::size_t grain = 1 << 14;
    Box<D> all;
    const auto include = [&](std::size_t begin, std::size_t end, Box<D>& piece) {
        for (std::size_t k = begin; k < end; ++k) {
            piece.include(box_of(k));
        }
    };
    for (const Box<D>& piece : parallel_pieces<Box<D>>(count, grain, include)) {
        all.include(piece);
    }
    Array<std::pair<std::uint64_t, Index>> order(count);
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            order[k] = {detail::tree_key(box_of(k), all), static_cast<Index>(k)};
        }
    });
    parallel_sort(order);
    items_.resize(count);
    boxes_.resize(count);
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            items_[k] = order[k].second;
            boxes_[k] = box_of(order[k].second);
        }
    });
}

template<int D>
void BoxTree<D>::build_levels() {
    const auto group = [](const Array<Box<D>>& parts, std::size_t width) {
        Array<Box<D>> nodes;
        nodes.assign(std::max<std::size_t>(1, (parts.size() + width - 1) / width), Box<D>{});
        parallel_for(parts.size(), width << 11, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                nodes[k / width].include(parts[k]);
            }
        });
        return nodes;
    };
    levels_.push_back(group(boxes_, block));
    while (levels_.back().size() > 1) {
        levels_.push_back(group(levels_.back(), fan));
    }
}

} // namespace slabhull
