// SPDX-License-Identifier: BSD-3-Clause
#include "slab/adapt/adapt_mesh.h"

#include "slab/adapt/replace_cells.h"
#include "slabhull/core/index.h"

#include <algorithm>
namespace slabhull {

template<int D>
void AdaptMesh<D>::find_cells_of_vertices() {
    cell_of_.assign(now.size(), no_index);
    for (std::size_t c = cells.size(); c-- > 0;) {
        for (const Index v : cells[c]) {
            cell_of_[v] = static_cast<Index>(c);
        }
    }
}

template<int D>
void AdaptMesh<D>::gather_star(Index vertex, std::vector<Index>& star) const {
    star.assign(1, cell_of_[vertex]);
    for (std::size_t next = 0; next < star.size(); ++next) {
        const Index cell = star[next];
        for (std::size_t i = 0; i <= D; ++i) {
            const Index across = neighbors[cell][i];
            if (cells[cell][i] != vertex && across != no_index &&
                std::find(star.begin(), star.end(), across) == star.end()) {
                star.push_back(across);
            }
        }
    }
}

template<int D>
bool AdaptMesh<D>::gather_edge_star(Index a, Index b, std::vector<Index>& star) const {
    gather_star(a, star);
    std::erase_if(star, [&](Index cell) { return place_in<D>(cells[cell], b) > D; });
    return std::none_of(star.begin(), star.end(), [&](Index cell) {
        for (std::size_t i = 0; i <= D; ++i) {
            if (neighbors[cell][i] == no_index && cells[cell][i] != a && cells[cell][i] != b) {
                return true;
            }
        }
        return false;
    });
}

template<int D>
void AdaptMesh<D>::add_vertices(std::span<const Cavity<D>> cavities, Index& next_column,
                                std::vector<Simplex<D>>& added) {
    for (const Cavity<D>& cavity : cavities) {
        const auto vertex = static_cast<Index>(now.size());
        if (cavity.has_new_vertex) {
            now.push_back(cavity.new_place);
            before.push_back(cavity.new_place);
            target.push_back(cavity.new_target);
            column.push_back(next_column++);
            on_boundary.push_back(cavity.on_boundary() ? 1 : 0);
            cell_of_.push_back(no_index);
        }
        for (Simplex<D> cell : cavity.added) {
            std::replace(cell.begin(), cell.end(), Cavity<D>::new_vertex, vertex);
            added.push_back(cell);
        }
    }
}

template<int D>
void AdaptMesh<D>::note(std::span<const Cavity<D>> cavities, const std::vector<Simplex<D>>& added,
                        AdaptLog<D>& log) const {
    std::size_t added_end = log.added.size();
    for (const Cavity<D>& cavity : cavities) {
        log.removed.insert(log.removed.end(), cavity.removed.begin(), cavity.removed.end());
        added_end += cavity.added.size();
        log.operations.push_back(
            {cavity.kind, log.removed.size(), added_end, cavity.apex, cavity.on_boundary()});
    }
    for (Simplex<D> cell : added) {
        for (Index& v : cell) {
            v = column[v];
        }
        log.added.push_back(cell);
    }
    log.layer_end.push_back(log.operations.size());
}

template<int D>
void AdaptMesh<D>::apply(std::span<const Cavity<D>> cavities, Index& next_column, AdaptLog<D>& log) {
    std::vector<Simplex<D>> added;
    add_vertices(cavities, next_column, added);
    note(cavities, added, log);
    std::vector<Index> removed;
    for (const Cavity<D>& cavity : cavities) {
        removed.insert(removed.end(), cavity.removed.begin(), cavity.removed.end());
    }
    replace(removed, added);
    drop_vertices(cavities);
}

/// A facet with ascending vertices, whose cell on the other side is sought.
template<int D>
struct AdaptMesh<D>::OpenFacet {
    Facet<D> vertices;
    Index cell;
    std::uint8_t place;

    OpenFacet(const Simplex<D>& corners, Index of, std::size_t opposite)
        : vertices{}, cell{of}, place{static_cast<std::uint8_t>(opposite)} {
        for (std::size_t k = 0, n = 0; k <= D; ++k) {
            if (k != opposite) {
                vertices[n++] = corners[k];
            }
        }
        std::sort(vertices.begin(), vertices.end());
    }
};

template<int D>
void AdaptMesh<D>::replace(const std::vector<Index>& removed, const std::vector<Simplex<D>>& added) {
    const CellReplacement replacement{cells.size(), removed, added.size()};
    std::vector<std::uint8_t> is_removed(cells.size(), 0);
    for (const Index cell : removed) {
        is_removed[cell] = 1;
    }
    std::vector<OpenFacet> open;
    for (const Index cell : removed) {
        for (const Index across : neighbors[cell]) {
            if (across != no_index && is_removed[across] == 0) {
                const auto place = place_in<D>(neighbors[across], cell);
                open.emplace_back(cells[across], replacement.now_of(across), place);
            }
        }
    }
    for (const auto& move : replacement.moves) {
        for (const Index across : neighbors[move.before]) {
            if (across != no_index) {
                std::replace(neighbors[across].begin(), neighbors[across].end(), move.before, move.now);
            }
        }
        neighbors[move.now] = neighbors[move.before];
    }
    neighbors.resize(replacement.count);
    replacement.apply(cells, std::span{added});
    for (const Index cell : replacement.added) {
        for (std::size_t i = 0; i <= D; ++i) {
            open.emplace_back(cells[cell], cell, i);
        }
    }
    pair(open);
    for (const auto& move : replacement.moves) {
        claim_vertices(move.now);
    }
    for (const Index cell : replacement.added) {
        claim_vertices(cell);
    }
}

template<int D>
void AdaptMesh<D>::claim_vertices(Index cell) {
    for (const Index v : cells[cell]) {
        cell_of_[v] = cell;
    }
}

template<int D>
void AdaptMesh<D>::pair(std::vector<OpenFacet>& open) {
    std::sort(open.begin(), open.end(), [](const OpenFacet& a, const OpenFacet& b) {
        return a.vertices != b.vertices ? a.vertices < b.vertices : a.cell < b.cell;
    });
    for (std::size_t k = 0; k < open.size();) {
        const OpenFacet& one = open[k];
        if (k + 1 < open.size() && open[k + 1].vertices == one.vertices) {
            const OpenFacet& other = open[k + 1];
            neighbors[one.cell][one.place] = other.cell;
            neighbors[other.cell][other.place] = one.cell;
            k += 2;
        } else {
            neighbors[one.cell][one.place] = no_index;
            ++k;
        }
    }
}

template<int D>
void AdaptMesh<D>::drop_vertices(std::span<const Cavity<D>> cavities) {
    std::vector<Index> number(now.size(), 0);
    bool some = false;
    for (const Cavity<D>& cavity : cavities) {
        if (cavity.ended != no_index) {
            number[cavity.ended] = no_index;
            some = true;
        }
    }
    if (!some) {
        return;
    }
    Index next = 0;
    for (Index v = 0; v < number.size(); ++v) {
        if (number[v] == no_index) {
            continue;
        }
        number[v] = next;
        now[next] = now[v];
        target[next] = target[v];
        column[next] = column[v];
        on_boundary[next] = on_boundary[v];
        cell_of_[next] = cell_of_[v];
        ++next;
    }
    now.resize(next);
    before.resize(next);
    target.resize(next);
    column.resize(next);
    on_boundary.resize(next);
    cell_of_.resize(next);
    for (Simplex<D>& cell : cells) {
        for (Index& v : cell) {
            v = number[v];
        }
    }
    std::erase_if(boundary, [&](Index v) { return number[v] == no_index; });
    for (Index& v : boundary) {
        v = number[v];
    }
}

template class AdaptMesh<2>;
template class AdaptMesh<3>;

} // namespace slabhull
