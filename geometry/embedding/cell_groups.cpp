// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/embedding/cell_groups.h"

#include "core/pieces.h"
#include "slabhull/core/parallel.h"

#include <algorithm>
#include <utility>

namespace slabhull {

namespace {

/// A kind of prism, recognised by its numbers of simplices and vertices.
struct PrismKind {
    std::size_t cells;
    std::size_t vertices;
};
template<int D>
constexpr auto prism_kinds = std::array<PrismKind, 2>{{{4, 5}, {2, 4}}};
template<>
constexpr auto prism_kinds<3> = std::array<PrismKind, 5>{{{14, 10}, {12, 9}, {10, 9}, {6, 7}, {3, 6}}};

constexpr std::size_t grain = 16'800; ///< cells; whole prisms of each kind

/// Distinct vertices, ascending, at most as many as a prism has.
template<int D>
class VertexSet {
public:
    static constexpr std::size_t most = CellGroups<D>::most_vertices;
    static_assert(most == prism_kinds<D>.front().vertices);

    /// False if the set would overflow.
    bool add(const Simplex<D>& cell) {
        return std::all_of(cell.begin(), cell.end(), [&](Index v) { return add(v); });
    }
    std::size_t size() const { return size_; }
    const Index* begin() const { return vertices_.data(); }
    const Index* end() const { return vertices_.data() + size_; }

private:
    bool add(Index v) {
        std::size_t place = 0;
        while (place < size_ && vertices_[place] < v) {
            ++place;
        }
        if (place < size_ && vertices_[place] == v) {
            return true;
        }
        if (size_ == most) {
            return false;
        }
        for (std::size_t k = size_++; k > place; --k) {
            vertices_[k] = vertices_[k - 1];
        }
        vertices_[place] = v;
        return true;
    }

    std::array<Index, most> vertices_{};
    std::size_t size_ = 0;
};

/// The groups of a range of cells, in order.
struct GroupsOfPiece {
    std::vector<std::uint8_t> cells;         ///< of each group; zero for a cell that is not tested
    std::vector<std::uint8_t> vertex_counts; ///< of those that are not zero
    std::vector<Index> vertices;
};

/// Cuts a range of cells into prisms, and into single cells where there are none.
template<int D>
class PrismFinder {
public:
    PrismFinder(std::span<const Simplex<D>> cells, std::span<const CapOf> caps)
        : cells_{cells}, caps_{caps} {}

    GroupsOfPiece cut(std::size_t begin, std::size_t end) {
        GroupsOfPiece groups;
        for (std::size_t c = begin; c < end;) {
            const std::size_t count = caps_[c] == CapOf::none ? prism_at(c, end) : 0;
            groups.cells.push_back(static_cast<std::uint8_t>(count));
            if (count > 0) {
                groups.vertex_counts.push_back(static_cast<std::uint8_t>(vertices_.size()));
                groups.vertices.insert(groups.vertices.end(), vertices_.begin(), vertices_.end());
            }
            c += std::max<std::size_t>(count, 1);
        }
        return groups;
    }

private:
    /// The number of cells of the prism there, or 1; leaves their vertices. Starts with the kind found last,
    /// since prisms of one kind follow each other.
    std::size_t prism_at(std::size_t c, std::size_t end) {
        for (std::size_t turn = 0; turn < prism_kinds<D>.size(); ++turn) {
            const std::size_t kind = (last_ + turn) % prism_kinds<D>.size();
            if (is_prism(prism_kinds<D>[kind], c, end)) {
                last_ = kind;
                return prism_kinds<D>[kind].cells;
            }
        }
        vertices_ = {};
        vertices_.add(cells_[c]);
        return 1;
    }

    bool is_prism(const PrismKind& kind, std::size_t c, std::size_t end) {
        vertices_ = {};
        for (std::size_t k = c; k < c + kind.cells; ++k) {
            if (k >= end || caps_[k] != CapOf::none || !vertices_.add(cells_[k])) {
                return false;
            }
        }
        return vertices_.size() == kind.vertices;
    }

    std::span<const Simplex<D>> cells_;
    std::span<const CapOf> caps_;
    VertexSet<D> vertices_;
    std::size_t last_ = 0;
};

} // namespace

template<int D>
CellGroups<D>::CellGroups(std::span<const Simplex<D>> cells, std::span<const CapOf> caps)
    : mesh_{cells, {}, {}, {}, {}, {}} {
    find_prisms(caps);
    tested_ = own_;
}

template<int D>
CellGroups<D>::CellGroups(std::span<const Simplex<D>> cells, std::size_t vertex_count,
                          std::span<const CapOf> caps)
    : CellGroups{cells, caps} {
    vertex_count_ = vertex_count;
    finish();
}

template<int D>
void CellGroups<D>::add_ghosts(const PartialMesh<D>& mesh, std::size_t vertex_count,
                               std::span<const std::uint8_t> ghost_sizes, const PointSet& touching) {
    mesh_ = mesh;
    vertex_count_ = vertex_count;
    std::size_t ghost = mesh.own.size();
    for (const std::uint8_t size : ghost_sizes) {
        add_cells(ghost, size);
        ghost += size;
    }
    tested_ = first_cell_.size();
    for (std::size_t k = 0, c = 0; k < touching.size(); ++k) {
        c = k == 0 ? touching.member(0) : touching.next(c);
        add_cells(c, 1);
    }
    for (; ghost < mesh.size(); ++ghost) {
        add_cells(ghost, 1);
    }
    finish();
}

template<int D>
void CellGroups<D>::complete(std::span<const Index> at_vertices, std::span<const CapOf> caps) {
    std::vector<bool> wanted(vertex_count_);
    for (const Index v : at_vertices) {
        wanted[v] = true;
    }
    const auto find = [&](std::size_t begin, std::size_t end, std::vector<Index>& found) {
        for (std::size_t c = begin; c < end; ++c) {
            const Simplex<D>& cell = mesh_.own[c];
            if (caps[c] != CapOf::none &&
                std::any_of(cell.begin(), cell.end(), [&](Index v) { return wanted[v]; })) {
                found.push_back(static_cast<Index>(c));
            }
        }
    };
    const std::vector<Index> found = parallel_gather<Index>(mesh_.own.size(), grain, find);
    if (found.empty()) {
        return;
    }
    first_cell_.pop_back();
    for (const Index c : found) {
        add_cells(c, 1);
    }
    finish();
}

/// For all groups of the pieces, and the last entries: arrays that grow touch fresh memory again and again.
template<int D>
template<class Pieces>
void CellGroups<D>::make_room(const Pieces& pieces) {
    std::size_t groups = 1;
    std::size_t vertices = 0;
    for (const auto& piece : pieces) {
        groups += piece.vertex_counts.size();
        vertices += piece.vertices.size();
    }
    first_cell_.reserve(groups);
    cells_before_.reserve(groups);
    first_vertex_.reserve(groups);
    vertices_.reserve(vertices);
}

/// The group's vertices are the last of all.
template<int D>
void CellGroups<D>::add_group(std::size_t first, std::size_t count) {
    first_cell_.push_back(static_cast<Index>(first));
    cells_before_.push_back(cells_before_.back() + count);
    first_vertex_.push_back(vertices_.size());
}

/// A group of all the vertices of these cells.
template<int D>
void CellGroups<D>::add_cells(std::size_t first, std::size_t count) {
    VertexSet<D> vertices;
    for (std::size_t c = first; c < first + count; ++c) {
        vertices.add(mesh_.cell(static_cast<Index>(c)));
    }
    vertices_.insert(vertices_.end(), vertices.begin(), vertices.end());
    add_group(first, count);
}

/// Ranges that are cut one by one are counted from the first tested cell, where prisms begin.
template<int D>
void CellGroups<D>::find_prisms(std::span<const CapOf> caps) {
    cells_before_.push_back(0);
    first_vertex_.push_back(0);
    const auto start =
        static_cast<std::size_t>(std::find(caps.begin(), caps.end(), CapOf::none) - caps.begin());
    auto pieces = parallel_pieces<GroupsOfPiece>(
        caps.size() - start, grain, [&](std::size_t begin, std::size_t end, GroupsOfPiece& groups) {
            groups = PrismFinder<D>{mesh_.own, caps}.cut(start + begin, start + end);
        });
    std::size_t c = start;
    make_room(pieces);
    for (GroupsOfPiece& piece : pieces) {
        auto vertices = piece.vertices.begin();
        auto vertex_count = piece.vertex_counts.begin();
        for (const std::size_t count : piece.cells) {
            if (count > 0) {
                const auto end = vertices + *vertex_count++;
                vertices_.insert(vertices_.end(), vertices, end);
                vertices = end;
                add_group(c, count);
            }
            c += std::max<std::size_t>(count, 1);
        }
        piece = {};
    }
    own_ = first_cell_.size();
}

/// All groups are there: lists those at each vertex.
template<int D>
void CellGroups<D>::finish() {
    first_cell_.push_back(static_cast<Index>(mesh_.size())); // keeps count() simple
    first_group_.assign(vertex_count_ + 1, 0);
    for (const Index v : vertices_) {
        ++first_group_[v + std::size_t{1}];
    }
    for (std::size_t v = 0; v < vertex_count_; ++v) {
        first_group_[v + 1] += first_group_[v];
    }
    groups_.resize(vertices_.size());
    for (std::size_t g = 0; g < count(); ++g) {
        for (const Index v : vertices(g)) {
            groups_[first_group_[v]++] = static_cast<Index>(g);
        }
    }
    for (std::size_t v = vertex_count_; v > 0; --v) { // filling moved each start to its end
        first_group_[v] = first_group_[v - 1];
    }
    first_group_[0] = 0;
}

template<int D>
std::span<const Index> CellGroups<D>::tested_groups_of(Index vertex) const {
    const std::span<const Index> all = groups_of(vertex);
    const auto end = std::lower_bound(all.begin(), all.end(), static_cast<Index>(tested_));
    return all.first(static_cast<std::size_t>(end - all.begin()));
}

template class CellGroups<2>;
template class CellGroups<3>;

} // namespace slabhull
