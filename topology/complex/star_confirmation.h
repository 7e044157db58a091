// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/pieces.h"
#include "core/scratch_pool.h"
#include "slabhull/core/array.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/progress.h"
#include "slabhull/topology/partial_stars.h"
#include "topology/complex/facet_pairing.h"
#include "topology/complex/repeated_vertex.h"
#include "topology/complex/star_counter.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <optional>

namespace slabhull {

/// Confirms that the star of every wanted vertex of a mesh is that of a closed oriented manifold; see
/// confirm_stars(). `Mesh`: PartialMesh or WholeMesh.
template<int D, class Mesh>
class StarConfirmation {
public:
    explicit StarConfirmation(const Mesh& mesh) : mesh_{mesh}, pairing_{mesh} {}

    /// Empty where it is not so. Needs: neighbours for all cells.
    std::optional<StarCounts> run() { return facets_are_paired() ? count_stars() : std::nullopt; }

private:
    using Counter = StarCounter<D, Mesh>;

    /// What is counted of some cells.
    struct Facets {
        bool sound = true;        ///< no cell names a vertex twice
        std::size_t corners = 0;  ///< wanted ones
        std::size_t in_stars = 0; ///< facets with a wanted vertex, seen from each side
        std::size_t pairs = 0;    ///< of those that are two sides of one
    };

    /// Whether each facet in the stars is paired off, seen once: two pairs have no side in common, so that
    /// twice their number is that of the sides if all are paired. Also finds a cell at each wanted vertex.
    bool facets_are_paired() {
        constexpr std::size_t grain = 1 << 15;
        one_.assign(mesh_.vertex_count(), no_index);
        const auto pieces = parallel_pieces<Facets>(mesh_.size(), grain,
                                                    [&](std::size_t begin, std::size_t end, Facets& here) {
                                                        for (std::size_t c = begin; c < end; ++c) {
                                                            look_at(static_cast<Index>(c), here);
                                                        }
                                                    });
        Facets all;
        for (const Facets& piece : pieces) {
            all.sound = all.sound && piece.sound;
            all.corners += piece.corners;
            all.in_stars += piece.in_stars;
            all.pairs += piece.pairs;
        }
        corners_ = all.corners;
        return all.sound && 2 * all.pairs == all.in_stars;
    }

    void look_at(Index c, Facets& here) {
        const Simplex<D>& cell = mesh_.cell(c);
        here.sound = here.sound && !repeats_a_vertex(cell);
        std::size_t corners = 0;
        for (const Index v : cell) {
            if (mesh_.is_wanted(v)) {
                std::atomic_ref{one_[v]}.store(c, std::memory_order_relaxed);
                ++corners;
            }
        }
        if (corners == 0) {
            return;
        }
        here.corners += corners;
        here.in_stars += corners == 1 ? D : D + 1;
        here.pairs +=
            pairing_.pairs_of(c, [&](std::size_t i) { return corners > 1 || !mesh_.is_wanted(cell[i]); });
    }

    /// The cells of stars that are walked whole add up to the wanted corners of all cells.
    std::optional<StarCounts> count_stars() {
        constexpr std::size_t vertices_per_walk = 1 << 11;
        std::atomic<bool> sound{true};
        std::atomic<std::size_t> vertices{0};
        std::atomic<std::size_t> cells{0};
        std::atomic<std::size_t> link_vertices{0};
        parallel_for(mesh_.vertex_count(), vertices_per_walk, [&](std::size_t begin, std::size_t end) {
            auto counter = counters_.take([&] { return Counter{mesh_}; });
            const Stars here = count_stars(begin, end, *counter);
            counters_.give_back(std::move(counter));
            if (!here.sound) {
                sound = false;
            }
            vertices += here.counts.vertices;
            cells += here.cells;
            link_vertices += here.counts.link_vertices;
            work_done(end - begin);
        });
        return sound && cells == corners_ ? std::optional{StarCounts{vertices, link_vertices}} : std::nullopt;
    }

    struct Stars {
        bool sound = true;
        std::size_t cells = 0;
        StarCounts counts;
    };

    Stars count_stars(std::size_t begin, std::size_t end, Counter& counter) const {
        constexpr std::size_t ahead = 4;
        Stars here;
        for (std::size_t v = begin; v < end && here.sound; ++v) {
            const Index soon = one_[std::min(v + ahead, end - 1)];
            counter.prefetch(soon == no_index ? 0 : soon);
            if (!mesh_.is_wanted(static_cast<Index>(v))) {
                continue;
            }
            if (one_[v] == no_index) {
                here.sound = false;
                break;
            }
            const auto star = counter.count(static_cast<Index>(v), one_[v]);
            ++here.counts.vertices;
            here.counts.link_vertices += star.vertices;
            here.cells += star.cells;
            here.sound = !star.facet_twice && (D == 2 || 2 * star.vertices == star.cells + 4);
        }
        return here;
    }

    Mesh mesh_;
    FacetPairing<D, Mesh> pairing_;
    Array<Index> one_;        ///< a cell at each wanted vertex
    std::size_t corners_ = 0; ///< wanted ones, of all cells
    ScratchPool<Counter> counters_;
};

} // namespace slabhull
