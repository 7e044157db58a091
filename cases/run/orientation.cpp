// SPDX-License-Identifier: BSD-3-Clause
#include "cases/run/orientation.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/topology/adjacency.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <vector>

namespace slabhull {

namespace {

template<int D>
class Orientation {
public:
    Orientation(Surface<D>& surface, const FacetNaming& naming)
        : surface_{surface}, naming_{naming}, adjacency_{build_adjacency<D - 1>(surface.facets,
                                                                                surface.points.size())},
          turned_(surface.facets.size(), false), reached_(surface.facets.size(), false) {
        mark_disagreements();
    }

    std::size_t run(bool encloses_domain) {
        std::size_t count = 0;
        for (Index start = 0; start < surface_.facets.size(); ++start) {
            if (!reached_[start]) {
                count += turn_component(start, encloses_domain);
            }
        }
        return count;
    }

private:
    using Ridge = std::array<Index, D - 1>;

    static Ridge ridge_of(const Facet<D>& facet, std::size_t i) {
        Ridge ridge{};
        std::size_t place = 0;
        for (std::size_t k = 0; k < D; ++k) {
            if (k != i) {
                ridge[place++] = facet[k];
            }
        }
        std::sort(ridge.begin(), ridge.end());
        return ridge;
    }

    void mark_disagreements() {
        for (const FacetDefect<D - 1>& defect : adjacency_.defects) {
            if (defect.kind != FacetDefect<D - 1>::Kind::disoriented) {
                continue;
            }
            disagrees_.resize(surface_.facets.size());
            for (const Index f : defect.cells) {
                for (std::size_t i = 0; i < D; ++i) {
                    disagrees_[f][i] = disagrees_[f][i] || ridge_of(surface_.facets[f], i) == defect.facet;
                }
            }
        }
    }

    bool disagrees(Index f, std::size_t i) const { return !disagrees_.empty() && disagrees_[f][i]; }

    /// The component of `start`, and whether each facet is to be turned to agree with it.
    std::vector<Index> component_of(Index start) {
        std::vector<Index> component(1, start);
        reached_[start] = true;
        for (std::size_t next = 0; next < component.size(); ++next) {
            const Index f = component[next];
            for (std::size_t i = 0; i < D; ++i) {
                const Index across = adjacency_.neighbors[f][i];
                if (across == no_index) {
                    continue;
                }
                const bool turn = turned_[f] != disagrees(f, i);
                if (!reached_[across]) {
                    reached_[across] = true;
                    turned_[across] = turn;
                    component.push_back(across);
                } else if (turned_[across] != turn) {
                    refuse(f, across);
                }
            }
        }
        return component;
    }

    std::size_t turn_component(Index start, bool encloses_domain) {
        const std::vector<Index> component = component_of(start);
        const auto turns = [this](Index f) { return turned_[f]; };
        const bool agrees = std::none_of(component.begin(), component.end(), turns);
        for (const Index f : component) {
            if (turned_[f]) {
                turn(f);
            }
        }
        if ((enclosed_by<D>(surface_, component) > 0) != encloses_domain) {
            for (const Index f : component) {
                turn(f);
                turned_[f] = !turned_[f];
            }
        }
        // A body's own outside is the domain, so what was turned pointed out of the body.
        const auto pointed_in = [&](Index f) { return turned_[f] == encloses_domain; };
        return agrees
                   ? 0
                   : static_cast<std::size_t>(std::count_if(component.begin(), component.end(), pointed_in));
    }

    void turn(Index f) { std::swap(surface_.facets[f][0], surface_.facets[f][1]); }

    [[noreturn]] void refuse(Index a, Index b) const {
        const auto number = [this](Index f) {
            return naming_.numbers.empty() ? static_cast<std::int64_t>(f) : naming_.numbers[f];
        };
        const auto name = [this](Index f) { return patch_name(surface_.patches, surface_.patch[f]); };
        throw InputError{
            fmt::format(
                "{}: the surface has one side only, as a Moebius band or a Klein bottle has: the facets "
                "{} and {} cannot be turned to agree. A body needs an inside",
                naming_.where, number(a), number(b)),
            {{"facet", number(a), name(a)}, {"facet", number(b), name(b)}}};
    }

    Surface<D>& surface_;
    const FacetNaming& naming_;
    Adjacency<D - 1> adjacency_;
    std::vector<std::array<bool, D>> disagrees_; ///< across each ridge; empty: nowhere
    std::vector<bool> turned_;
    std::vector<bool> reached_;
};

} // namespace

template<int D>
std::size_t turn_outward(Surface<D>& surface, bool encloses_domain, const FacetNaming& naming) {
    return Orientation<D>{surface, naming}.run(encloses_domain);
}

template std::size_t turn_outward<2>(Surface<2>&, bool, const FacetNaming&);
template std::size_t turn_outward<3>(Surface<3>&, bool, const FacetNaming&);

} // namespace slabhull
