// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/embedding/embedded_caps.h"

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"
#include "slabhull/core/point_set.h"
#include "slabhull/topology/partial_stars.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace slabhull {

/// Groups of consecutive cells of a hull: the simplices of a prism if they are consecutive, as in hulls made
/// by this library and in files of them, else single cells. The grouping affects speed only.
///
/// The first `tested` groups hold the cells to be tested. Others, one cell per group, follow: those that
/// complete() adds, or that others have sent.
template<int D>
class CellGroups {
public:
    static constexpr std::size_t most_cells = D == 2 ? 4 : 14;
    static constexpr std::size_t most_vertices = D == 2 ? 5 : 10;

    /// `caps`: of each cell; those in no cap are tested.
    CellGroups(std::span<const Simplex<D>> cells, std::size_t vertex_count, std::span<const CapOf> caps);
    /// Those of the own cells of a mesh whose ghosts add_ghosts() will bring; before that, only they are
    /// known, not the groups at a vertex.
    CellGroups(std::span<const Simplex<D>> cells, std::span<const CapOf> caps);

    /// `mesh`: with the same own cells. `ghost_sizes`: of the groups that the first ghosts are in, which are
    /// tested, too. Of the own cells in caps, those of `touching` count; and so do the other ghosts. To be
    /// called once.
    void add_ghosts(const PartialMesh<D>& mesh, std::size_t vertex_count,
                    std::span<const std::uint8_t> ghost_sizes, const PointSet& touching);
    /// Adds the cells in caps that are at one of these vertices, so that groups_of() these has all their
    /// cells. For meshes without ghosts; to be called once.
    void complete(std::span<const Index> at_vertices, std::span<const CapOf> caps);

    /// The tested groups without ghosts, which come first.
    std::size_t own() const { return own_; }
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
    /// The groups at the vertex, ascending. All cells there are in one only after complete(), or in a mesh
    /// with ghosts.
    std::span<const Index> groups_of(Index vertex) const {
        return {groups_.data() + first_group_[vertex], first_group_[vertex + 1] - first_group_[vertex]};
    }
    std::span<const Index> tested_groups_of(Index vertex) const;

private:
    void find_prisms(std::span<const CapOf> caps);
    template<class Pieces>
    void make_room(const Pieces& pieces);
    void add_group(std::size_t first, std::size_t count);
    void add_cells(std::size_t first, std::size_t count);
    void finish();

    PartialMesh<D> mesh_;
    std::size_t vertex_count_ = 0;
    std::size_t own_ = 0;
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
