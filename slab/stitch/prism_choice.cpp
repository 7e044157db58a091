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
    Chooser(const SideOptions& options, const PrismGraph<D>& graph, const Sweep<D>& sweep,
            const SidePoints<D>& points, const LayerRange& layers)
        : recipe_{recipe_of(options.split)}, graph_{graph}, sweep_{sweep}, points_{points}, layers_{layers},
          by_shape_{recipe_.pairs() && options.diagonals == Diagonals::shape} {}

    PrismChoice run() {
        if constexpr (D == 3) { // no split of D = 2 leaves diagonals free
            if (by_shape_) {
                judge_shapes();
            }
        }
        PrismChoice choice{graph_.facets(), layers_, !by_shape_};
        each_prism(by_shape_ ? layers_ : LayerRange{0, 1}, [&](std::size_t layer, std::size_t facet) {
            choice.at(layer, facet) = template_number<D>(quads_of(layer, facet));
        });
        return choice;
    }

private:
    template<class Visit>
    void each_prism(const LayerRange& layers, const Visit& visit) const {
        parallel_for((layers.end - layers.first) * graph_.facets(), prisms_per_choice,
                     [&](std::size_t begin, std::size_t end) {
                         for (std::size_t prism = begin; prism < end; ++prism) {
                             visit(layers.first + prism / graph_.facets(), prism % graph_.facets());
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
        const auto& corners = sweep_.boundary.facets()[facet];
        const std::span<const TrackId> track = sweep_.boundary.tracks();
        return track[corners[j]] < track[corners[k]] ? Quad::rising : Quad::falling;
    }

    std::size_t diagonal_number(std::size_t layer, std::size_t facet, std::size_t q) const {
        return (layer - layers_.first) * (graph_.quads - graph_.centred) + graph_.quad[facet][q] -
               graph_.centred;
    }

    /// Chooses each free diagonal, at the facet that owns it.
    void judge_shapes() {
        against_id_.resize((layers_.end - layers_.first) * (graph_.quads - graph_.centred));
        each_prism(layers_, [&](std::size_t layer, std::size_t facet) {
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
        const auto [j, k] = quad_corners<D>(q);
        const auto [start, end] = quad == Quad::rising ? std::pair{j, k} : std::pair{k, j};
        const auto& facet_corners = sweep_.boundary.facets()[facet];
        const Point<D + 1> first = points_.on_level(layer, facet_corners[start]);
        const Point<D + 1> last = points_.on_level(layer + 1, facet_corners[end]);
        double smallest = 180;
        for (const Point<D + 1>& apex : {apex_of(layer, facet), apex_of(layer, graph_.across(facet, q))}) {
            for (const Point<D + 1>& corner : {points_.on_level(layer, facet_corners[end]),
                                               points_.on_level(layer + 1, facet_corners[start])}) {
                const auto angles =
                    dihedral_angles<D, D + 1>(std::array<Point<D + 1>, D + 1>{first, last, corner, apex});
                smallest = std::min(smallest, angles.smallest);
            }
        }
        return smallest;
    }

    Point<D + 1> apex_of(std::size_t layer, std::size_t facet) const {
        if (recipe_.apex == SplitRecipe::Apex::prism_centre) {
            return points_.prism_centre(layer, facet);
        }
        std::size_t q = 0;
        while (!graph_.is_centred(facet, q)) {
            ++q;
        }
        return points_.face_centre(layer, graph_.quad[facet][q]);
    }

    const SplitRecipe& recipe_;
    const PrismGraph<D>& graph_;
    const Sweep<D>& sweep_;
    const SidePoints<D>& points_;
    LayerRange layers_;
    bool by_shape_;
    Array<std::uint8_t> against_id_; ///< of each diagonal: whether shape overrules the ids
};

} // namespace

template<int D>
PrismChoice choose_templates(const SideOptions& options, const PrismGraph<D>& graph, const Sweep<D>& sweep,
                             const SidePoints<D>& points, const LayerRange& layers) {
    return Chooser<D>{options, graph, sweep, points, layers}.run();
}

template PrismChoice choose_templates<2>(const SideOptions&, const PrismGraph<2>&, const Sweep<2>&,
                                         const SidePoints<2>&, const LayerRange&);
template PrismChoice choose_templates<3>(const SideOptions&, const PrismGraph<3>&, const Sweep<3>&,
                                         const SidePoints<3>&, const LayerRange&);

} // namespace slabhull
