// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/embedding/embedded_caps.h"

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace slabhull {

/// Groups of consecutive cells of a hull: the simplices of a prism if they are consecutive, as in hulls made
/// by this library and in files of them, else single cells. The grouping affects speed only.
///
/// The first `tested` groups hold the cells to be tested. Others that complete() adds follow, one cell per
/// group.
template<int D>
class CellGroups {
public:
    static constexpr std::size_t most_cells = D == 2 ? 4 : 14;

    /// `caps`: of each cell; those in no cap are tested.
    CellGroups(std::span<const Simplex<D>> cells, std::size_t vertex_count, std::span<const CapOf> caps);

    /// Adds the cells in caps that are at one of these vertices, so that groups_of() these has all their
    /// cells. To be called once.
    void complete(std::span<const Index> at_vertices, std::span<const CapOf> caps);

    std::size_t tested() const { return tested_; }
    std::size_t count() const { return first_cell_.size() - 1; }

    Index first_cell(std::size_t group) const { return first_cell_[group]; }
    /// Number of cells in the groups before this one.
    std::size_t cells_before(std::size_t group) const { return cells_before_[group]; }
    std::size_t cell_count(std::size_t group) const {
        return cells_before_[group + 1] - cells_before_[group];
    }
    /// Ascending.
    std::span<const Index> vertices(std::size_t group) const {
        return {vertices_.data() + first_vertex_[group], first_vertex_[group + 1] - first_vertex_[group]};
    }
    /// The groups at the vertex, ascending. All cells there are in one only after complete().
    std::span<const Index> groups_of(Index vertex) const {
        return {groups_.data() + first_group_[vertex], first_group_[vertex + 1] - first_group_[vertex]};
    }
    std::span<const Index> tested_groups_of(Index vertex) const;

private:
    void find_prisms(std::span<const CapOf> caps);
    template<class Pieces>
    void make_room(const Pieces& pieces);
    void add_group(std::size_t first, std::size_t count);
    void list_groups();

    std::span<const Simplex<D>> all_cells_;
    std::size_t vertex_count_;
    std::size_t tested_ = 0;
    Array<Index> first_cell_;
    Array<std::size_t> cells_before_;
    Array<std::size_t> first_vertex_;
    Array<Index> vertices_;
    Array<std::size_t> first_group_;
    Array<Index> groups_;
};

extern template class CellGroups<2>;
extern template class CellGroups<3>;

} // namespace slabhull
