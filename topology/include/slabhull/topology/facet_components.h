// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/index.h"
#include "slabhull/core/point.h"

#include <cstddef>
#include <span>
#include <vector>

namespace slabhull {

/// The connected components of a closed (D-1)-manifold of facets, joined through ridges and numbered by their
/// first facet.
template<int D>
class FacetComponents {
public:
    /// Of no facets; only good to be assigned to.
    FacetComponents() = default;

    /// `neighbors`: the facet across each ridge. Needs: they are in range and mutual. Cost: linear; 4 bytes
    /// per facet stay.
    explicit FacetComponents(std::span<const Neighbors<D - 1>> neighbors);

    std::size_t count() const { return first_facet_.size(); }
    Index component(std::size_t facet) const { return component_[facet]; }
    Index first_facet(std::size_t component) const { return first_facet_[component]; }
    /// The facets of each component, ascending. Cost: linear.
    std::vector<std::vector<Index>> facets() const;

private:
    std::vector<Index> component_;   ///< of each facet
    std::vector<Index> first_facet_; ///< of each component
};

extern template class FacetComponents<2>;
extern template class FacetComponents<3>;

} // namespace slabhull
