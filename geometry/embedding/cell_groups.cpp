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
constexpr std::size_t group_grain = 4096;

/// Distinct vertices, ascending, at most as many as a prism has.
template<int D>
class VertexSet {
public:
    static constexpr std::size_t most = prism_kinds<D>.front().vertices;

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

    std::array<Index, most> vertices_;
    std::size_t size_ = 0;
};

/// Cuts a range of cells into prisms, and into single cells where there are none.
template<int D>
class PrismFinder {
public:
    PrismFinder(std::span<const Simplex<D>> cells, std::span<const CapOf> caps)
        : cells_{cells}, caps_{caps} {}

    /// The number of cells of each group in order; zero for a cell that is not tested.
    std::vector<std::uint8_t> cut(std::size_t begin, std::size_t end) {
        std::vector<std::uint8_t> counts;
        for (std::size_t c = begin; c < end;) {
            const std::size_t count = caps_[c] == CapOf::none ? prism_at(c, end) : 0;
            counts.push_back(static_cast<std::uint8_t>(count));
            c += std::max<std::size_t>(count, 1);
        }
        return counts;
    }

private:
    /// Starts with the kind found last, since prisms of one kind follow each other.
    std::size_t prism_at(std::size_t c, std::size_t end) {
        for (std::size_t turn = 0; turn < prism_kinds<D>.size(); ++turn) {
            const std::size_t kind = (last_ + turn) % prism_kinds<D>.size();
            if (is_prism(prism_kinds<D>[kind], c, end)) {
                last_ = kind;
                return prism_kinds<D>[kind].cells;
            }
        }
        return 1;
    }

    bool is_prism(const PrismKind& kind, std::size_t c, std::size_t end) const {
        VertexSet<D> vertices;
        for (std::size_t k = c; k < c + kind.cells; ++k) {
            if (k >= end || caps_[k] != CapOf::none || !vertices.add(cells_[k])) {
                return false;
            }
        }
        return vertices.size() == kind.vertices;
    }

    std::span<const Simplex<D>> cells_;
    std::span<const CapOf> caps_;
    std::size_t last_ = 0;
};

} // namespace

template<int D>
CellGroups<D>::CellGroups(std::span<const Simplex<D>> cells, std::size_t vertex_count,
                          std::span<const CapOf> caps)
    : all_cells_{cells}, vertex_count_{vertex_count} {
    cells_before_.push_back(0);
    find_prisms(caps);
    tested_ = first_cell_.size();
    first_cell_.push_back(static_cast<Index>(cells.size())); // keeps count() simple
    list_vertices();
    list_groups();
}

template<int D>
void CellGroups<D>::complete(std::span<const Index> at_vertices, std::span<const CapOf> caps) {
    std::vector<bool> wanted(vertex_count_);
    for (const Index v : at_vertices) {
        wanted[v] = true;
    }
    const auto find = [&](std::size_t begin, std::size_t end, std::vector<Index>& found) {
        for (std::size_t c = begin; c < end; ++c) {
            if (caps[c] != CapOf::none && std::any_of(all_cells_[c].begin(), all_cells_[c].end(),
                                                      [&](Index v) { return wanted[v]; })) {
                found.push_back(static_cast<Index>(c));
            }
        }
    };
    const std::vector<Index> found = parallel_gather<Index>(all_cells_.size(), grain, find);
    if (found.empty()) {
        return;
    }
    first_cell_.pop_back();
    for (const Index c : found) {
        add_group(c, 1);
    }
    first_cell_.push_back(static_cast<Index>(all_cells_.size()));
    list_vertices();
    list_groups();
}

template<int D>
void CellGroups<D>::add_group(std::size_t first, std::size_t count) {
    first_cell_.push_back(static_cast<Index>(first));
    cells_before_.push_back(cells_before_.back() + count);
}

template<int D>
void CellGroups<D>::find_prisms(std::span<const CapOf> caps) {
    const auto start = static_cast<std::size_t>(std::find(caps.begin(), caps.end(), CapOf::none) - caps.begin());
    const std::size_t all = caps.size() - start;
    const auto cut = [&](std::size_t begin, std::size_t end, std::vector<std::uint8_t>& counts) {
        counts = PrismFinder<D>{all_cells_, caps}.cut(start + begin, start + end);
    };
    std::size_t c = start;
    for (const std::size_t count : parallel_gather<std::uint8_t>(all, grain, cut)) {
        if (count > 0) {
            add_group(c, count);
        }
        c += std::max<std::size_t>(count, 1);
    }
}

template<int D>
void CellGroups<D>::list_vertices() {
    const auto vertices_of = [&](std::size_t group) {
        VertexSet<D> set;
        for (std::size_t k = 0; k < cell_count(group); ++k) {
            set.add(all_cells_[first_cell_[group] + k]);
        }
        return set;
    };
    first_vertex_.assign(count() + 1, 0);
    parallel_for(count(), group_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g) {
            first_vertex_[g + 1] = vertices_of(g).size();
        }
    });
    for (std::size_t g = 0; g < count(); ++g) {
        first_vertex_[g + 1] += first_vertex_[g];
    }
    vertices_.resize(first_vertex_.back());
    parallel_for(count(), group_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g) {
            const VertexSet<D> set = vertices_of(g);
            std::copy(set.begin(), set.end(),
                      vertices_.begin() + static_cast<std::ptrdiff_t>(first_vertex_[g]));
        }
    });
}

template<int D>
void CellGroups<D>::list_groups() {
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
