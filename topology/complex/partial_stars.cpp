// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/partial_stars.h"

#include "slabhull/core/parallel.h"
#include "slabhull/core/progress.h"
#include "topology/complex/facet_pairing.h"
#include "topology/complex/repeated_vertex.h"
#include "topology/complex/star_counter.h"

#include <algorithm>
#include <atomic>

namespace slabhull {

namespace {

template<int D>
class StarConfirmation {
public:
    explicit StarConfirmation(const PartialMesh<D>& mesh) : mesh_{mesh}, pairing_{mesh} {}

    std::optional<StarCounts> run() {
        if (mesh_.own_neighbors.size() != mesh_.own.size() ||
            mesh_.ghost_neighbors.size() != mesh_.ghosts.size() || !cells_are_sound()) {
            return std::nullopt;
        }
        find_usage();
        return count_stars();
    }

private:
    using Counter = StarCounter<D, PartialMesh<D>>;

    bool wanted(Index v) const { return mesh_.wanted[v] != 0; }

    bool cells_are_sound() const {
        std::atomic<bool> sound{true};
        parallel_for(mesh_.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end && sound; ++c) {
                if (!is_sound(static_cast<Index>(c))) {
                    sound = false;
                }
            }
        });
        return sound;
    }

    bool is_sound(Index c) const {
        const Simplex<D>& cell = mesh_.cell(c);
        if (repeats_a_vertex(cell)) {
            return false;
        }
        const auto wanted_here = std::count_if(cell.begin(), cell.end(), [&](Index v) { return wanted(v); });
        for (std::size_t i = 0; i <= D; ++i) {
            const bool in_a_star = wanted_here > (wanted(cell[i]) ? 1 : 0);
            if (in_a_star && (!pairing_.is_paired(c, i) || is_double(c, i))) {
                return false;
            }
        }
        return true;
    }

    /// Whether the cell across has the same vertices.
    bool is_double(Index c, std::size_t i) const {
        const Simplex<D>& across = mesh_.cell(mesh_.neighbor(c, i));
        return std::find(across.begin(), across.end(), mesh_.cell(c)[i]) != across.end();
    }

    /// How many cells each wanted vertex has, and one of them.
    void find_usage() {
        one_.assign(mesh_.wanted.size(), no_index);
        uses_.assign(mesh_.wanted.size(), 0);
        parallel_for(mesh_.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                for (const Index v : mesh_.cell(static_cast<Index>(c))) {
                    std::atomic_ref{one_[v]}.store(static_cast<Index>(c), std::memory_order_relaxed);
                    std::atomic_ref{uses_[v]}.fetch_add(1, std::memory_order_relaxed);
                }
            }
        });
    }

    std::optional<StarCounts> count_stars() const {
        std::atomic<bool> sound{true};
        std::atomic<std::size_t> vertices{0};
        std::atomic<std::size_t> link_vertices{0};
        parallel_for(mesh_.wanted.size(), 1 << 11, [&](std::size_t begin, std::size_t end) {
            Counter stars{mesh_};
            StarCounts here;
            for (std::size_t v = begin; v < end && sound; ++v) {
                if (!wanted(static_cast<Index>(v))) {
                    continue;
                }
                ++here.vertices;
                const bool used = one_[v] != no_index;
                const auto star =
                    used ? stars.count(static_cast<Index>(v), one_[v]) : typename Counter::Count{};
                here.link_vertices += star.vertices;
                if (!used || star.cells != uses_[v] || star.facet_twice ||
                    (D == 3 && 2 * star.vertices != star.cells + 4)) {
                    sound = false;
                }
            }
            vertices += here.vertices;
            link_vertices += here.link_vertices;
            work_done(end - begin);
        });
        return sound ? std::optional{StarCounts{vertices, link_vertices}} : std::nullopt;
    }

    const PartialMesh<D>& mesh_;
    FacetPairing<D, PartialMesh<D>> pairing_;
    Array<Index> one_;
    Array<Index> uses_;
};

} // namespace

template<int D>
std::optional<StarCounts> confirm_stars(const PartialMesh<D>& mesh) {
    return StarConfirmation<D>{mesh}.run();
}

template std::optional<StarCounts> confirm_stars<2>(const PartialMesh<2>&);
template std::optional<StarCounts> confirm_stars<3>(const PartialMesh<3>&);

} // namespace slabhull
