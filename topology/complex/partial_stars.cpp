// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/partial_stars.h"

#include "core/pieces.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/progress.h"
#include "topology/complex/facet_pairing.h"
#include "topology/complex/repeated_vertex.h"
#include "topology/complex/star_counter.h"

#include <atomic>

namespace slabhull {

namespace {

template<int D>
class StarConfirmation {
public:
    explicit StarConfirmation(const PartialMesh<D>& mesh) : mesh_{mesh}, pairing_{mesh} {}

    std::optional<StarCounts> run() {
        if (mesh_.own_neighbors.size() != mesh_.own.size() ||
            mesh_.ghost_neighbors.size() != mesh_.ghosts.size() || !facets_are_paired()) {
            return std::nullopt;
        }
        return count_stars();
    }

private:
    using Counter = StarCounter<D, PartialMesh<D>>;

    bool wanted(Index v) const { return mesh_.wanted[v] != 0; }

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
        one_.assign(mesh_.wanted.size(), no_index);
        Facets all;
        const auto pieces = parallel_pieces<Facets>(mesh_.size(), 1 << 15,
                                                    [&](std::size_t begin, std::size_t end, Facets& here) {
                                                        for (std::size_t c = begin; c < end; ++c) {
                                                            look_at(static_cast<Index>(c), here);
                                                        }
                                                    });
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
            if (wanted(v)) {
                std::atomic_ref{one_[v]}.store(c, std::memory_order_relaxed);
                ++corners;
            }
        }
        if (corners == 0) {
            return;
        }
        here.corners += corners;
        here.in_stars += corners == 1 ? D : D + 1;
        here.pairs += pairing_.pairs_of(c, [&](std::size_t i) { return corners > 1 || !wanted(cell[i]); });
    }

    /// The cells of stars that are walked whole add up to the wanted corners of all cells.
    std::optional<StarCounts> count_stars() const {
        std::atomic<bool> sound{true};
        std::atomic<std::size_t> vertices{0};
        std::atomic<std::size_t> link_vertices{0};
        std::atomic<std::size_t> cells{0};
        parallel_for(mesh_.wanted.size(), 1 << 11, [&](std::size_t begin, std::size_t end) {
            Counter stars{mesh_};
            StarCounts here;
            std::size_t cells_here = 0;
            for (std::size_t v = begin; v < end && sound; ++v) {
                if (!wanted(static_cast<Index>(v))) {
                    continue;
                }
                ++here.vertices;
                const bool used = one_[v] != no_index;
                const auto star =
                    used ? stars.count(static_cast<Index>(v), one_[v]) : typename Counter::Count{};
                here.link_vertices += star.vertices;
                cells_here += star.cells;
                if (!used || star.facet_twice || (D == 3 && 2 * star.vertices != star.cells + 4)) {
                    sound = false;
                }
            }
            vertices += here.vertices;
            link_vertices += here.link_vertices;
            cells += cells_here;
            work_done(end - begin);
        });
        return sound && cells == corners_ ? std::optional{StarCounts{vertices, link_vertices}} : std::nullopt;
    }

    const PartialMesh<D>& mesh_;
    FacetPairing<D, PartialMesh<D>> pairing_;
    Array<Index> one_;        ///< a cell at each wanted vertex
    std::size_t corners_ = 0; ///< wanted ones, of all cells
};

} // namespace

template<int D>
std::optional<StarCounts> confirm_stars(const PartialMesh<D>& mesh) {
    return StarConfirmation<D>{mesh}.run();
}

template std::optional<StarCounts> confirm_stars<2>(const PartialMesh<2>&);
template std::optional<StarCounts> confirm_stars<3>(const PartialMesh<3>&);

} // namespace slabhull
