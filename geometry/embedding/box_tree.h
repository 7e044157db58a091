// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/each_bit.h"
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
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace slabhull {

/// An axis-parallel closed box. The default one is empty and meets nothing.
template<int D>
struct Box {
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
        bool apart = false; // branch-free: branches per axis are unpredictable
        for (std::size_t k = 0; k < D; ++k) {
            apart |= low[k] > other.high[k];
            apart |= other.low[k] > high[k];
        }
        return !apart;
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

/// Boxes side by side, so that two at a time are compared with another one.
template<int D, std::size_t width>
class BoxRow {
public:
    /// Empty boxes. Those of a BoxRow that is only declared are not: arrays of them are filled in parallel.
    static BoxRow none() {
        BoxRow row;
        for (std::size_t k = 0; k < width; ++k) {
            row.set(k, {});
        }
        return row;
    }

    void set(std::size_t place, const Box<D>& box) {
        for (std::size_t k = 0; k < D; ++k) {
            low_[k][place / 2][place % 2] = box.low[k];
            high_[k][place / 2][place % 2] = box.high[k];
        }
    }
    Box<D> box(std::size_t place) const {
        Box<D> box;
        for (std::size_t k = 0; k < D; ++k) {
            box.low[k] = low_[k][place / 2][place % 2];
            box.high[k] = high_[k][place / 2][place % 2];
        }
        return box;
    }
    Box<D> around() const {
        Box<D> all;
        for (std::size_t k = 0; k < width; ++k) {
            all.include(box(k));
        }
        return all;
    }

    /// Bit k: whether box k meets `other`.
    unsigned meeting(const Box<D>& other) const {
        unsigned bits = 0;
        for (std::size_t pair = 0; pair < width / 2; ++pair) {
            auto apart = low_[0][pair] > other.high[0];
            apart |= high_[0][pair] < other.low[0];
            for (std::size_t k = 1; k < D; ++k) {
                apart |= low_[k][pair] > other.high[k];
                apart |= high_[k][pair] < other.low[k];
            }
            bits |= static_cast<unsigned>((~apart[0] & 1) | (~apart[1] & 2)) << (2 * pair);
        }
        return bits;
    }

private:
    using Two = double __attribute__((vector_size(16)));

    std::array<std::array<Two, width / 2>, D> low_;
    std::array<std::array<Two, width / 2>, D> high_;
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

    std::size_t blocks() const { return boxes_.size(); }
    /// Boxes that together hold all items, at most so many (but at least one).
    Array<Box<D>> at_most(std::size_t count) const {
        if (boxes_.size() <= count) {
            return around_each(boxes_);
        }
        const auto level = std::find_if(levels_.begin(), levels_.end(),
                                        [count](const Nodes& nodes) { return nodes.size() <= count; });
        return around_each(level == levels_.end() ? levels_.back() : *level);
    }

    /// Calls visit(item) for each item whose box meets `box`.
    template<class Visit>
    void find(const Box<D>& box, Visit&& visit) const {
        descend(levels_.size(), 0, 0, box, [&](std::size_t leaf) {
            each_bit(boxes_[leaf].meeting(box), [&](std::size_t k) { visit(items_[leaf * block + k]); });
        });
    }

    /// Calls visit(a, b) once for each pair of items whose boxes meet, with a in block `own` and b in the
    /// same block or a later one.
    template<class Visit>
    void find_pairs(std::size_t own, Visit&& visit) const {
        const Box<D> around = boxes_[own].around();
        descend(levels_.size(), 0, own, around, [&](std::size_t leaf) {
            each_bit(boxes_[leaf].meeting(around), [&](std::size_t k) {
                const unsigned before = leaf == own ? (1u << k) - 1 : ~0u;
                each_bit(boxes_[own].meeting(boxes_[leaf].box(k)) & before,
                         [&](std::size_t j) { visit(items_[own * block + j], items_[leaf * block + k]); });
            });
        });
    }

private:
    template<class Rows>
    static Array<Box<D>> around_each(const Rows& rows) {
        Array<Box<D>> boxes;
        for (const auto& row : rows) {
            boxes.push_back(row.around());
        }
        return boxes;
    }

    /// Calls visit(leaf) for the leaves under a node, from `first` on, whose box meets `box`. Level 0:
    /// leaves.
    template<class Visit>
    void descend(std::size_t level, std::size_t node, std::size_t first, const Box<D>& box,
                 const Visit& visit) const {
        if (level == 0) {
            visit(node);
            return;
        }
        const std::size_t least = first >> (fan_bits * (level - 1));
        each_bit(levels_[level - 1][node].meeting(box), [&](std::size_t k) {
            if (node * fan + k >= least) {
                descend(level - 1, node * fan + k, first, box, visit);
            }
        });
    }

    template<class BoxOf>
    void order_items(std::size_t count, const BoxOf& box_of);
    void build_levels();

    using Leaves = Array<BoxRow<D, block>>;
    using Nodes = Array<BoxRow<D, fan>>;

    std::vector<Index> items_;
    Leaves boxes_;              ///< in the order of items_; those beyond them are empty
    std::vector<Nodes> levels_; ///< boxes around the nodes below, leaves first; the last has one row
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
    boxes_.resize(std::max<std::size_t>(1, (count + block - 1) / block));
    parallel_for(boxes_.size(), grain / block, [&](std::size_t begin, std::size_t end) {
        for (std::size_t leaf = begin; leaf < end; ++leaf) {
            boxes_[leaf] = BoxRow<D, block>::none();
            for (std::size_t k = leaf * block; k < std::min(count, (leaf + 1) * block); ++k) {
                items_[k] = order[k].second;
                boxes_[leaf].set(k % block, box_of(order[k].second));
            }
        }
    });
}

template<int D>
void BoxTree<D>::build_levels() {
    const auto nodes_over = [](const auto& rows) {
        Nodes nodes((rows.size() + fan - 1) / fan);
        parallel_for(nodes.size(), 1 << 11, [&](std::size_t begin, std::size_t end) {
            for (std::size_t node = begin; node < end; ++node) {
                nodes[node] = BoxRow<D, fan>::none();
                for (std::size_t k = node * fan; k < std::min(rows.size(), (node + 1) * fan); ++k) {
                    nodes[node].set(k % fan, rows[k].around());
                }
            }
        });
        return nodes;
    };
    levels_.push_back(nodes_over(boxes_));
    while (levels_.back().size() > 1) {
        levels_.push_back(nodes_over(levels_.back()));
    }
}

} // namespace slabhull
