// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/hull_embedding.h"

#include "geometry/basics/predicates.h"
#include "geometry/embedding/box_tree.h"
#include "geometry/embedding/cell_meeting.h"
#include "geometry/embedding/cell_separation.h"
#include "geometry/embedding/embedded_caps.h"
#include "geometry/embedding/facet_pair.h"

#include "slabhull/core/parallel.h"
#include "slabhull/geometry/measures.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace slabhull {

namespace {

bool degenerate(const std::array<Point<3>, 3>& triangle) {
    return exact::degenerate(triangle);
}

/// A tetrahedron in R^4 is flat when its images along all four axes are; the one along the axis nearest to
/// its normal settles it nearly always.
bool degenerate(const std::array<Point<4>, 4>& tetrahedron) {
    const Point<4> normal = simplex_normal<3>(tetrahedron);
    const auto steeper = [](double a, double b) { return std::abs(a) < std::abs(b); };
    const auto nearest =
        static_cast<std::size_t>(std::max_element(normal.begin(), normal.end(), steeper) - normal.begin());
    for (std::size_t turn = 0; turn < 4; ++turn) {
        const std::size_t axis = (nearest + turn) % 4;
        std::array<Point<3>, 4> image;
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                image[i][k] = tetrahedron[i][(axis + 1 + k) % 4];
            }
        }
        if (exact::orientation(image) != 0) {
            return false;
        }
    }
    return true;
}

/// What the search in one stretch of the tree gave.
template<int D>
struct Piece {
    std::vector<Crossing<D + 1>> crossings;
    std::size_t tested = 0;
    std::size_t exact = 0;
};

template<int D>
class EmbeddingSearch {
public:
    EmbeddingSearch(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
                    std::size_t limit)
        : points_{points}, cells_{cells}, limit_{limit} {}

    HullEmbedding<D> run(const Adjacency<D>& adjacency) {
        const std::vector<CapOf> caps = find_caps<D>(points_, cells_);
        result_.caps_proven = caps_are_embedded<D>(points_, cells_, adjacency, caps);
        select(caps);
        const Array<Box<D + 1>> boxes = cell_boxes();
        find_scale(boxes);
        search(BoxTree<D + 1>{boxes});
        finish();
        return std::move(result_);
    }

private:
    void select(const std::vector<CapOf>& caps) {
        for (std::size_t c = 0; c < cells_.size(); ++c) {
            if (!result_.caps_proven || caps[c] == CapOf::none) {
                selected_.push_back(static_cast<Index>(c));
            }
        }
        result_.tested_cells = selected_.size();
    }

    /// Boxes of the selected cells; those without extent keep an empty one, which pairs with nothing, and are
    /// reported.
    Array<Box<D + 1>> cell_boxes() {
        Array<Box<D + 1>> boxes;
        boxes.assign(selected_.size(), Box<D + 1>{});
        parallel_for(boxes.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                const auto corners = corners_of<D, D + 1>(cells_[selected_[k]], points_);
                if (!degenerate(corners)) {
                    std::for_each(corners.begin(), corners.end(),
                                  [&](const auto& p) { boxes[k].include(p); });
                }
            }
        });
        for (std::size_t k = 0; k < boxes.size(); ++k) {
            if (boxes[k].empty()) {
                const Index c = selected_[k];
                result_.crossings.push_back({c, c, points_[cells_[c][0]]});
            }
        }
        return boxes;
    }

    /// One over the mean extent of the cells along each axis, to the next power of two.
    void find_scale(const Array<Box<D + 1>>& boxes) {
        for (std::size_t axis = 0; axis <= D; ++axis) {
            double sum = 0;
            for (const Box<D + 1>& box : boxes) {
                sum += box.empty() ? 0 : box.high[axis] - box.low[axis];
            }
            const double mean = sum / static_cast<double>(boxes.size());
            const int exponent = std::isfinite(mean) && mean > 0 ? std::ilogb(mean) : 0;
            scale_[axis] = std::ldexp(1.0, std::clamp(-exponent, -500, 500));
        }
    }

    /// In rounds, so that a hull which crosses itself everywhere ends soon, with the same result for any
    /// number of threads.
    void search(const BoxTree<D + 1>& tree) {
        constexpr std::size_t round = std::size_t{1} << 14; // blocks
        for (std::size_t begin = 0; begin < tree.blocks() && result_.crossings.size() <= limit_;
             begin += round) {
            search_round(tree, begin, std::min(begin + round, tree.blocks()));
        }
    }

    void search_round(const BoxTree<D + 1>& tree, std::size_t first, std::size_t last) {
        constexpr std::size_t grain = 64;
        std::vector<Piece<D>> pieces((last - first + grain - 1) / grain);
        parallel_for(last - first, grain, [&](std::size_t begin, std::size_t end) {
            pieces[begin / grain] = search_blocks(tree, first + begin, first + end);
        });
        for (const Piece<D>& piece : pieces) {
            result_.crossings.insert(result_.crossings.end(), piece.crossings.begin(), piece.crossings.end());
            result_.tested_pairs += piece.tested;
            result_.exact_pairs += piece.exact;
        }
    }

    Piece<D> search_blocks(const BoxTree<D + 1>& tree, std::size_t begin, std::size_t end) const {
        Piece<D> piece;
        for (std::size_t block = begin; block < end && piece.crossings.size() <= limit_; ++block) {
            tree.find_pairs(block, [&](Index a, Index b) {
                if (piece.crossings.size() <= limit_) {
                    const auto [first, second] = std::minmax(selected_[a], selected_[b]);
                    decide(first, second, piece);
                }
            });
        }
        return piece;
    }

    /// The shared vertices first, in the same order.
    FacetPair<D + 1> pair_of(Index first, Index second) const {
        Simplex<D> f = cells_[first];
        Simplex<D> g = cells_[second];
        FacetPair<D + 1> pair;
        for (std::size_t i = 0; i <= D; ++i) {
            const auto twin = std::find(g.begin() + pair.shared, g.end(), f[i]);
            if (twin != g.end()) {
                std::swap(f[i], f[pair.shared]);
                std::swap(*twin, g[pair.shared]);
                ++pair.shared;
            }
        }
        pair.f = corners_of<D, D + 1>(f, points_);
        pair.g = corners_of<D, D + 1>(g, points_);
        return pair;
    }

    void decide(Index first, Index second, Piece<D>& piece) const {
        const FacetPair<D + 1> pair = pair_of(first, second);
        ++piece.tested;
        if (const auto place = meeting(pair, piece)) {
            piece.crossings.push_back({first, second, *place});
        }
    }

    std::optional<Point<3>> meeting(const FacetPair<3>& pair, Piece<D>&) const {
        return meet_elsewhere(pair) ? std::optional{meeting_place(pair)} : std::nullopt;
    }

    std::optional<Point<4>> meeting(const FacetPair<4>& pair, Piece<D>& piece) const {
        if (pair.shared == 4) {
            return pair.f[0];
        }
        if (proven_apart(pair, scale_)) {
            return {};
        }
        ++piece.exact;
        return common_point(pair);
    }

    void finish() {
        auto& crossings = result_.crossings;
        std::sort(crossings.begin(), crossings.end(), [](const auto& a, const auto& b) {
            return std::tie(a.first, a.second) < std::tie(b.first, b.second);
        });
        if (crossings.size() > limit_) {
            crossings.resize(limit_);
            result_.all_listed = false;
        }
    }

    std::span<const Point<D + 1>> points_;
    std::span<const Simplex<D>> cells_;
    std::size_t limit_;
    std::vector<Index> selected_; ///< cells that are paired
    Point<D + 1> scale_{};
    HullEmbedding<D> result_;
};

} // namespace

template<int D>
HullEmbedding<D> examine_embedding(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
                                   const Adjacency<D>& adjacency, std::size_t limit) {
    return EmbeddingSearch<D>{points, cells, limit}.run(adjacency);
}

template HullEmbedding<2> examine_embedding<2>(std::span<const Point<3>>, std::span<const Simplex<2>>,
                                               const Adjacency<2>&, std::size_t);
template HullEmbedding<3> examine_embedding<3>(std::span<const Point<4>>, std::span<const Simplex<3>>,
                                               const Adjacency<3>&, std::size_t);

} // namespace slabhull
