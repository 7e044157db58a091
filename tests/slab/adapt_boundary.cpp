// SPDX-License-Identifier: BSD-3-Clause
#include "slab/adapt/boundary_operations.h"
#include "slab/adapt/cavity_apex.h"
#include "slab/adapt/cavity_maker.h"

#include "core/rounds.h"
#include "slab/swept_grid.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/slab/check_filling.h"
#include "slabhull/slab/fill.h"
#include "slabhull/slab/march.h"
#include "slabhull/slab/slice.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>

using namespace slabhull;

namespace {

/// A grid at rest, its boundary with a patch for each side of the box, and what operations on it need.
template<int D>
struct BoxMesh {
    AdaptMesh<D> mesh;
    Boundary<D> boundary;
    std::vector<double> spacing;
    PatchMotions<D> motions;
    PatchSurfaces<D> surfaces{motions, 0, 1};
    AdaptOptions options;

    BoxMesh(Index divisions, bool one_patch, unsigned seed) {
        IdCounter ids;
        SpatialMesh<D> cap = specimens::as_cap<D>(specimens::full_box<D>(divisions), ids);
        displace(cap, divisions, seed);
        for (std::size_t f = 0; f < cap.boundary_facets.size(); ++f) {
            cap.boundary_patch[f] = one_patch ? 1 : side_of(cap, cap.boundary_facets[f]);
        }
        mesh.cells = cap.cells;
        mesh.neighbors = cap.neighbors;
        mesh.now = mesh.before = cap.points;
        mesh.target.assign(mesh.now.size(), 1);
        mesh.column.resize(mesh.now.size());
        std::iota(mesh.column.begin(), mesh.column.end(), Index{0});
        boundary = boundary_of(cap);
        mesh.boundary.assign(boundary.mesh_vertices().begin(), boundary.mesh_vertices().end());
        mesh.on_boundary.assign(mesh.now.size(), 0);
        for (const Index v : mesh.boundary) {
            mesh.on_boundary[v] = 1;
        }
        mesh.find_cells_of_vertices();
        spacing.assign(boundary.vertex_count(), 1);
    }

    BoundaryOperations<D> operations() const { return {mesh, boundary, spacing, surfaces, {0, 1}, options}; }

private:
    /// Moves vertices at random within their sides, inner ones freely.
    static void displace(SpatialMesh<D>& cap, Index divisions, unsigned seed) {
        std::mt19937 random{seed};
        std::uniform_real_distribution<double> shift{-0.15, 0.15};
        for (Point<D>& place : cap.points) {
            for (double& x : place) {
                x += x == 0 || x == divisions ? 0 : shift(random);
            }
        }
    }

    static PatchNumber side_of(const SpatialMesh<D>& cap, const Facet<D>& facet) {
        for (std::size_t k = 0; k < D; ++k) {
            const double x = cap.points[facet[0]][k];
            if (std::all_of(facet.begin(), facet.end(), [&](Index v) { return cap.points[v][k] == x; })) {
                return static_cast<PatchNumber>(1 + 2 * k + (x == 0 ? 0 : 1));
            }
        }
        return 0;
    }
};

template<int D>
using Ridge = std::array<Index, D - 1>;

/// The ridges of facets that no other has the other way round, each with the sign of its facet.
template<int D>
std::map<Ridge<D>, int> rim_of(const std::vector<Facet<D>>& facets) {
    std::map<Ridge<D>, int> rim;
    for (const Facet<D>& facet : facets) {
        for (std::size_t i = 0; i < D; ++i) {
            Ridge<D> ridge;
            int sign = i % 2 == 0 ? 1 : -1;
            for (std::size_t k = 0, n = 0; k < D; ++k) {
                if (k != i) {
                    ridge[n++] = facet[k];
                }
            }
            if (D == 3 && ridge[0] > ridge[1]) {
                std::reverse(ridge.begin(), ridge.end());
                sign = -sign;
            }
            rim[ridge] += sign;
        }
    }
    std::erase_if(rim, [](const auto& entry) { return entry.second == 0; });
    return rim;
}

template<int D>
std::set<Facet<D>> outer_facets(const std::vector<Simplex<D>>& cells) {
    std::map<Facet<D>, int> count;
    for (const Simplex<D>& cell : cells) {
        for (int i = 0; i <= D; ++i) {
            Facet<D> facet = outward_facet<D>(cell, i);
            std::sort(facet.begin(), facet.end());
            REQUIRE(++count[facet] <= 2);
        }
    }
    std::set<Facet<D>> outer;
    for (const auto& [facet, times] : count) {
        if (times == 1) {
            outer.insert(facet);
        }
    }
    return outer;
}

template<int D>
void exchange(const std::vector<Facet<D>>& facets, bool add, std::set<Facet<D>>& among) {
    for (Facet<D> facet : facets) {
        std::sort(facet.begin(), facet.end());
        REQUIRE((add ? among.insert(facet).second : among.erase(facet) == 1));
    }
}

/// Checks that facets of the boundary become others around the same ridges, and the cells' other facets stay.
template<int D>
void require_consistent(const BoxMesh<D>& box, const Cavity<D>& cavity) {
    REQUIRE(rim_of<D>(cavity.side_removed) == rim_of<D>(cavity.side.added));
    std::vector<Simplex<D>> removed;
    for (const Index cell : cavity.removed) {
        removed.push_back(box.mesh.cells[cell]);
    }
    std::set<Facet<D>> expected = outer_facets<D>(removed);
    exchange<D>(cavity.side_removed, false, expected);
    exchange<D>(cavity.side.added, true, expected);
    REQUIRE(outer_facets<D>(cavity.added) == expected);
    for (const Simplex<D>& cell : cavity.added) {
        std::array<Point<D>, D + 1> corners;
        for (std::size_t k = 0; k <= D; ++k) {
            corners[k] = cell[k] == Cavity<D>::new_vertex ? cavity.new_place : box.mesh.now[cell[k]];
        }
        REQUIRE(signed_measure<D>(corners) > 0);
    }
}

template<int D>
std::vector<Cavity<D>> all_on_boundary(const BoxMesh<D>& box, CavityMaker<D>& maker) {
    std::vector<Cavity<D>> all;
    const auto add = [&](std::optional<Cavity<D>>&& cavity) {
        if (cavity) {
            all.push_back(std::move(*cavity));
        }
    };
    std::set<std::array<Index, 2>> edges;
    for (const Facet<D>& facet : box.boundary.facets()) {
        for (const Index v : facet) {
            for (const Index w : facet) {
                if (v != w) {
                    edges.insert({box.mesh.boundary[v], box.mesh.boundary[w]});
                }
            }
        }
    }
    for (const auto& [a, b] : edges) {
        if (a < b) {
            add(maker.split_boundary(a, b));
            add(maker.remove_edge(a, b));
        }
        add(maker.collapse_boundary(a, b));
    }
    for (const Index v : box.mesh.boundary) {
        add(maker.shift_boundary(v));
    }
    return all;
}

/// Whether a vertex may be replaced by another place so that the box stays a box.
template<int D>
bool is_on_same_sides(const Point<D>& vertex, const Point<D>& place, double length) {
    bool same = true;
    for (std::size_t k = 0; k < D; ++k) {
        same = same && ((vertex[k] != 0 && vertex[k] != length) || std::abs(vertex[k] - place[k]) < 1e-12);
    }
    return same;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("operations on the boundary keep its rim, its patches and what is around their cells",
                       "[adapt]", ((int D), D), 2, 3) {
    const Index divisions = 3;
    for (const bool one_patch : {false, true}) {
        std::map<OperationKind, int> found;
        for (unsigned seed = 0; seed < 5; ++seed) {
            const BoxMesh<D> box{divisions, one_patch, seed};
            const BoundaryOperations<D> on_boundary = box.operations();
            CavityMaker<D> maker{box.mesh, nullptr, &on_boundary};
            for (Cavity<D>& cavity : all_on_boundary(box, maker)) {
                ++found[cavity.kind];
                require_consistent(box, cavity);
                REQUIRE(find_apex<D>(box.mesh, {0, 1}, cavity));
                REQUIRE(cavity.side.apex[D] == 0.5);
                for (const Index f : cavity.side.removed) {
                    REQUIRE(box.boundary.patch()[f] == cavity.side.patch);
                }
                if (cavity.ended != no_index) {
                    const Point<D>& instead =
                        cavity.kind == OperationKind::shift ? cavity.new_place : box.mesh.now[cavity.edge[1]];
                    REQUIRE(is_on_same_sides<D>(box.mesh.now[cavity.ended], instead, divisions));
                }
            }
        }
        CHECK(found[OperationKind::split] > 0);
        CHECK(found[OperationKind::collapse] > 0);
        CHECK(found[OperationKind::shift] > 0);
        CHECK((found[OperationKind::flip] > 0) == (D == 3));
    }
}

TEMPLATE_TEST_CASE_SIG("patches that are fixed, or whose vertices have a motion each, keep their facets",
                       "[adapt]", ((int D), D), 2, 3) {
    BoxMesh<D> box{3, true, 1};
    const auto count = [&] {
        const BoundaryOperations<D> on_boundary = box.operations();
        CavityMaker<D> maker{box.mesh, nullptr, &on_boundary};
        return all_on_boundary(box, maker).size();
    };
    REQUIRE(count() > 0);
    box.options.patches[1].fixed = true;
    CHECK(count() == 0);
    box.options.patches.clear();
    box.motions[1].nodal = nodal_motion<D>([](TrackId, double) { return Point<D>{}; });
    CHECK(count() == 0);
}

namespace {

/// A sphere (circle) that grows in a box, its boundary adapted to half of its edges at the start.
template<int D>
March<D> growing_march(Split split) {
    Case the_case = D == 2 ? experiment_at("expanding-circle", 1) : experiment_at("expanding-sphere", 0.3);
    the_case.cap_reuse = CapReuse::adapt;
    the_case.split = split;
    StageClock clock;
    IdCounter ids;
    MarchState<D> state = march_from<D>(initial_cap<D>(the_case, ids, {}, clock), the_case.start, ids);
    SlabSettings<D> settings = settings_of<D>(the_case, state.boundary);
    settings.layers.automatic = false;
    settings.layers.suggest = false;
    settings.adapt.boundary = true;
    for (const auto& [patch, moving] : settings.motions) {
        const std::vector<double> edges = state.boundary.mean_edges(state.boundary.start());
        settings.adapt.patches[patch].size = 0.7 * edges[state.boundary.vertices_of({patch}).front()];
    }
    return {std::move(state), std::move(settings)};
}

template<int D>
std::vector<Split> some_splits() {
    if constexpr (D == 2) {
        return {Split::diagonal, Split::centre};
    } else {
        return rounds(10) == 10 ? std::vector{Split::A, Split::C, Split::E} : std::vector{Split::A};
    }
}

/// Largest distance from the sphere about the origin of radius 1 + t / 4.
template<int D>
double off_sphere(const Hull<D>& hull, const std::set<Index>& vertices) {
    double most = 0;
    for (const Index v : vertices) {
        double square = 0;
        for (std::size_t k = 0; k < D; ++k) {
            square += hull.points[v][k] * hull.points[v][k];
        }
        most = std::max(most, std::abs(std::sqrt(square) - 1 - 0.25 * hull.points[v][D]));
    }
    return most;
}

/// Vertices of the body's side: on levels, and the apexes of changes.
template<int D>
std::set<Index> vertices_on_body(const Hull<D>& hull, PatchNumber patch) {
    std::set<Index> vertices;
    for (std::size_t c = hull.initial_cells; c < hull.terminating_begin(); ++c) {
        for (const Index v : hull.cells[c]) {
            if (hull.patch(c) == patch && hull.track_ids[v] != no_track) {
                vertices.insert(v);
            }
        }
    }
    return vertices;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("a sphere grows with edges of about one length, and every slab is sound and filled",
                       "[adapt]", ((int D), D), 2, 3) {
    for (const Split split : some_splits<D>()) {
        INFO(split_name(split));
        March<D> march = growing_march<D>(split);
        const PatchNumber patch = march.settings().motions.begin()->first;
        std::set<PersistentId> ids;
        std::size_t on_boundary = 0;
        for (int k = 0; k < 2; ++k) {
            const double t = march.state().time;
            const std::vector<double> times{t, t + 0.3, t + 0.6};
            Slab<D> slab = march.propose(times);
            REQUIRE(slab.adapted);
            on_boundary += slab.adapted->report.on_boundary;
            const HullReport report = check_hull<D>(slab.hull);
            INFO(findings_as_text(report));
            REQUIRE(report.clean());
            const Filling<D> filling = fill_slab(slab);
            const FillingReport filled = check_filling<D>(columns_of(filling), &slab.hull);
            INFO(findings_as_text(filled));
            REQUIRE(filled.clean());
            CHECK(filled.volume == Approx(report.enclosed).epsilon(1e-12));
            CHECK(off_sphere<D>(slab.hull, vertices_on_body<D>(slab.hull, patch)) < 1e-12);
            for (std::size_t v = slab.hull.initial_points; v < slab.hull.points.size(); ++v) {
                REQUIRE(ids.insert(slab.hull.vertex_ids[v]).second);
            }
            const Slab<D> again = march.propose(times);
            REQUIRE(again.hull.cells == slab.hull.cells);
            REQUIRE(again.hull.points == slab.hull.points);
            march.accept(std::move(slab));
            CHECK(march.state().boundary.facet_count() == march.state().cap.boundary_facets.size());
            CHECK(march.state().boundary.spacing().size() == march.state().boundary.vertex_count());
        }
        CHECK(on_boundary > 10);
    }
}

TEMPLATE_TEST_CASE_SIG("planted defects beside changes of the boundary are found", "[adapt]", ((int D), D), 2,
                       3) {
    March<D> march = growing_march<D>(some_splits<D>().front());
    const Slab<D> slab = march.propose({0, 0.2, 0.4, 0.6});
    REQUIRE(slab.hull.boundary_changes());
    std::vector<TrackId> tracks(slab.hull.points.size());
    slab.hull.track_ids.copy(0, tracks.size(), tracks.data());
    const auto check = [&](const std::vector<TrackId>& claimed) {
        HullColumns<D> columns = columns_of(slab.hull);
        columns.track_id = Column<std::int64_t>::over(std::span{claimed});
        columns.patch = {};
        return check_hull<D>(columns);
    };
    REQUIRE(check(tracks).clean());
    const auto on_boundary = [&](TrackId track) {
        const auto side = static_cast<std::ptrdiff_t>(slab.hull.initial_points);
        const auto last = static_cast<std::ptrdiff_t>(slab.hull.terminating_points_begin());
        return std::find(tracks.begin() + side, tracks.begin() + last, track) != tracks.begin() + last;
    };

    SECTION("a track that begins without a change") {
        std::vector<TrackId> claimed = tracks;
        for (std::size_t v = slab.hull.initial_points; v < claimed.size(); ++v) {
            if (claimed[v] != no_track && on_boundary(claimed[v])) {
                claimed[v] = 123'456'789; // of one vertex
                break;
            }
        }
        CHECK(check(claimed).count(Defect::track_incomplete) > 0);
    }
    SECTION("two tracks of the terminating boundary exchanged") {
        std::vector<std::size_t> found;
        for (std::size_t v = slab.hull.terminating_points_begin(); v < tracks.size(); ++v) {
            if (on_boundary(tracks[v])) {
                found.push_back(v);
            }
        }
        std::vector<TrackId> claimed = tracks;
        std::swap(claimed[found.front()], claimed[found.back()]);
        CHECK(check(claimed).count(Defect::boundary_facet_lost) > 0);
    }
    SECTION("an apex that claims a track") {
        std::vector<TrackId> claimed = tracks;
        for (std::size_t v = slab.hull.initial_points; v < slab.hull.terminating_points_begin(); ++v) {
            if (claimed[v] == no_track) {
                claimed[v] = 123'456'789;
                break;
            }
        }
        CHECK(check(claimed).count(Defect::track_incomplete) > 0);
    }
}
