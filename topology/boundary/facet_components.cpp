// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/facet_components.h"

#include "slabhull/topology/dual_graph.h"

#include <boost/graph/connected_components.hpp>

namespace slabhull {

template<int D>
FacetComponents<D>::FacetComponents(std::span<const Neighbors<D - 1>> neighbors)
    : component_(neighbors.size()) {
    boost::connected_components(DualGraph<D - 1>{neighbors}, component_.data());
    for (Index facet = 0; facet < component_.size(); ++facet) {
        if (component_[facet] == first_facet_.size()) {
            first_facet_.push_back(facet);
        }
    }
}

template<int D>
std::vector<std::vector<Index>> FacetComponents<D>::facets() const {
    std::vector<std::vector<Index>> by_component(count());
    for (Index facet = 0; facet < component_.size(); ++facet) {
        by_component[component_[facet]].push_back(facet);
    }
    return by_component;
}

template class FacetComponents<2>;
template class FacetComponents<3>;

} // namespace slabhull
