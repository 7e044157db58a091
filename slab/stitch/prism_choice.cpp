// SPDX-License-Identifier: BSD-3-Clause
#include "slab/stitch/prism_choice.h"

#include "slabhull/core/parallel.h"
#include "slabhull/geometry/measures.h"

#include <algorithm>

namespace slabhull {

namespace {

constexpr std::size_t prisms_per_choice = 1 << 12;

template<int D>
class Chooser {
public:
    Chooser(const SideOptions& options, const PrismGraph<D>& graph, const DiagonalFacts<D>& facts)
        : recipe_{recipe_of(options.split)}, graph_{graph}, facts_{facts}, by_shape_{recipe_.pairs() &&
                                                                                     options.diagonals ==
                                                                                         Diagonals::shape} {}

    PrismChoice run() {
        if constexpr (D == 3) { // no split of D = 2 leaves diagonals free
            if (by_shape_) {
                judge_shapes();
            }
        }
        const std::size_t layers = by_shape_ ? facts_.sweep.layers() : 1;
        PrismChoice choice{graph_.facets(), layers, !by_shape_};
        each_prism(layers, [&](std::size_t layer, std::size_t facet) {
            choice.at(layer, facet) = template_number<D>(quads_of(layer, facet));
        });
        return choice;
    }

private:
    template<class Visit>
    void each_prism(std::size_t layers, const Visit& visit) const {
        parallel_for(layers * graph_.facets(), prisms_per_choice, [&](std::size_t begin, std::size_t end) {
            for (std::size_t prism = begin; prism < end; ++prism) {
                visit(prism / graph_.facets(), prism % graph_.facets());
            }
        });
    }

    Quads<D> quads_of(std::size_t layer, std::size_t facet) const {
        Quads<D> quads;
        for (std::size_t q = 0; q < quads.size(); ++q) {
            quads[q] = graph_.is_centred(facet, q) ? Quad::centred : diagonal(layer, facet, q);
        }
        return quads;
    }

    Quad diagonal(std::size_t layer, std::size_t facet, std::size_t q) const {
        const Quad by_id = by_smallest_id(facet, q);
        return by_shape_ && against_id_[diagonal_number(layer, facet, q)] != 0 ? other(by_id) : by_id;
    }

    static Quad other(Quad quad) { return quad == Quad::rising ? Quad::falling : Quad::rising; }

    Quad by_smallest_id(std::size_t facet, std::size_t q) const {
        const auto [j, k] = quad_corners<D>(q);
        const auto& corners = facts_.sweep.boundary.facets()[facet];
        const std::span<const TrackId> track = facts_.sweep.boundary.tracks();
        return track[corners[j]] < track[corners[k]] ? Quad::rising : Quad::falling;
    }

    std::size_t diagonal_number(std::size_t layer, std::size_t facet, std::size_t q) const {
        return layer * (graph_.quads - graph_.centred) + graph_.quad[facet][q] - graph_.centred;
    }

    /// Chooses each free diagonal, at the facet that owns it.
    void judge_shapes() {
        against_id_.resize(facts_.sweep.layers() * (graph_.quads - graph_.centred));
        each_prism(facts_.sweep.layers(), [&](std::size_t layer, std::size_t facet) {
            for (std::size_t q = 0; q < PrismGraph<D>::quads_of_facet; ++q) {
                if (graph_.owns(facet, q) && !graph_.is_centred(facet, q)) {
                    against_id_[diagonal_number(layer, facet, q)] =
                        better_against_id(layer, facet, q) ? 1 : 0;
                }
            }
        });
    }

    bool better_against_id(std::size_t layer, std::size_t facet, std::size_t q) const {
        constexpr double equal = 1e-6;
        const Quad by_id = by_smallest_id(facet, q);
        return smallest_angle(layer, facet, q, other(by_id)) > smallest_angle(layer, facet, q, by_id) + equal;
    }

    /// Smallest dihedral angle of the tetrahedra on both sides of a diagonal.
    double smallest_angle(std::size_t layer, std::size_t facet, std::size_t q, Quad quad) const {
        const auto prism = facts_.vertices.of_prism(layer, facet);
        const auto [j, k] = quad_corners<D>(q);
        const auto [start, end] = quad == Quad::rising ? std::pair{j, k} : std::pair{k, j};
        double smallest = 180;
        for (const Index apex : {apex_of(layer, facet), apex_of(layer, graph_.across(facet, q))}) {
            for (const Index corner : {prism[end], prism[D + start]}) {
                const Simplex<D> cell{prism[start], prism[D + end], corner, apex};
                const auto angles = dihedral_angles<D, D + 1>(corners_of<D, D + 1>(cell, facts_.points));
                smallest = std::min(smallest, angles.smallest);
            }
        }
        return smallest;
    }

    Index apex_of(std::size_t layer, std::size_t facet) const {
        if (recipe_.apex == SplitRecipe::Apex::prism_centre) {
            return static_cast<Index>(facts_.vertices.prism_centre(layer, facet));
        }
        std::size_t q = 0;
        while (!graph_.is_centred(facet, q)) {
            ++q;
        }
        return static_cast<Index>(facts_.vertices.face_centre(layer, graph_.quad[facet][q]));
    }

    const SplitRecipe& recipe_;
    const PrismGraph<D>& graph_;
    const DiagonalFacts<D>& facts_;
    bool by_shape_;
    Array<std::uint8_t> against_id_; ///< of each diagonal: whether shape overrules the ids
};

} // namespace

template<int D>
PrismChoice choose_templates(const SideOptions& options, const PrismGraph<D>& graph,
                             const DiagonalFacts<D>& facts) {
    return Chooser<D>{options, graph, facts}.run();
}

template PrismChoice choose_templates<2>(const SideOptions&, const PrismGraph<2>&, const DiagonalFacts<2>&);
template PrismChoice choose_templates<3>(const SideOptions&, const PrismGraph<3>&, const DiagonalFacts<3>&);

} // namespace slabhull
