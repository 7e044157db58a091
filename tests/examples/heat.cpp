// SPDX-License-Identifier: BSD-3-Clause
// The example of a solver: patch test and orders of convergence, several slabs of a moving domain.
#include "examples/heat/heat.h"

#include "io/scratch.h"
#include "slab/swept_grid.h"
#include "slabhull/cases/hull_files.h"
#include "slabhull/io/files.h"
#include "slabhull/slab/fill.h"
#include "slabhull/slab/march.h"

#include <catch2/catch.hpp>

#include <unordered_map>

using namespace slabhull;

namespace {

/// A unit box of n cells along each edge, whose boundary bends, turns and grows.
template<int D>
March<D> march_of_box(Index n, Split split, CapReuse reuse = CapReuse::move) {
    specimens::Grid<D> grid = specimens::full_box<D>(n);
    for (Point<D>& point : grid.points) {
        point = times(1.0 / n, point);
    }
    IdCounter ids;
    SpatialMesh<D> cap = specimens::as_cap<D>(grid, ids);
    Index next = 0; // tracks of the boundary from 0
    for (TrackId& track : cap.track_ids) {
        track = track == no_track ? no_track : TrackId{next++};
    }
    SlabSettings<D> settings;
    settings.motions[1].motion = velocity_field<D>([](const Point<D>& x, double t) {
        Point<D> v = times(0.2, x);
        v[0] += 0.3 * std::sin(3 * x[1]) - 0.4 * x[1];
        v[1] += 0.4 * x[0] + 0.2 * t * std::cos(2 * x[0]);
        return v;
    });
    settings.side.split = split;
    settings.reuse = reuse;
    settings.adapt.size = 1.2 / n; // cells of one size, and something to do
    settings.adapt.longest = D == 2 ? 1.5 : 1.6;
    settings.adapt.angle = 12;
    return {march_from<D>(std::move(cap), 0, ids), std::move(settings)};
}

/// Square roots of the errors over two slabs of `layers` layers, from t = 0 to 0.5.
template<int D>
heat::Errors solved(Index n, int layers, Split split, const heat::Problem<D>& problem,
                    CapReuse reuse = CapReuse::move) {
    March<D> march = march_of_box<D>(n, split, reuse);
    std::unordered_map<PersistentId, double> terminating;
    heat::Errors total;
    for (int k = 0; k < 2; ++k) {
        std::vector<double> levels;
        for (int l = 0; l <= layers; ++l) {
            levels.push_back(0.25 * k + 0.25 * l / layers);
        }
        Slab<D> slab = march.propose(levels);
        REQUIRE(slab.cap_moved);
        REQUIRE((reuse == CapReuse::move || !slab.adapted->log.operations.empty()));
        const Filling<D> filling = fill_slab(slab);
        const auto known = heat::known_values(filling, problem, terminating);
        const std::vector<double> u = heat::solve(filling, known, problem.source);
        const heat::Errors error = heat::errors(filling, u, problem);
        total.value += error.value;
        total.gradient += error.gradient;
        terminating.clear();
        for (std::size_t v = slab.hull.terminating_points_begin(); v < filling.hull_points; ++v) {
            terminating[filling.vertex_ids[v]] = u[v];
        }
        march.accept(std::move(slab));
    }
    return {std::sqrt(total.value), std::sqrt(total.gradient)};
}

} // namespace

TEST_CASE("a solution that is linear in space and time is found to rounding, whatever the split", "[heat]") {
    for (const CapReuse reuse : {CapReuse::move, CapReuse::adapt}) {
        for (const Split split : {Split::diagonal, Split::centre}) {
            const heat::Errors error = solved<2>(5, 2, split, heat::patch_test<2>(), reuse);
            CHECK(error.value < 1e-10);
            CHECK(error.gradient < 1e-10);
        }
        for (const Split split : {Split::A, Split::B, Split::C, Split::D, Split::E}) {
            const heat::Errors error = solved<3>(3, 2, split, heat::patch_test<3>(), reuse);
            CHECK(error.value < 1e-10);
            CHECK(error.gradient < 1e-10);
        }
    }
}

TEMPLATE_TEST_CASE_SIG("the error is of order two, that of the gradient of order one", "[heat][long]",
                       ((int D), D), 2, 3) {
    const Split split = D == 2 ? Split::diagonal : Split::A;
    const CapReuse reuse = GENERATE(CapReuse::move, CapReuse::adapt);
    INFO((reuse == CapReuse::adapt ? "adapted" : "moved"));
    std::vector<heat::Errors> found;
    for (const int level : {2, 3, 4}) {
        found.push_back(
            solved<D>(static_cast<Index>(4 * level), level, split, heat::decaying_wave<D>(), reuse));
    }
    for (std::size_t k = 1; k < found.size(); ++k) {
        const double refined = std::log((2.0 + static_cast<double>(k)) / (1.0 + static_cast<double>(k)));
        const double value = std::log(found[k - 1].value / found[k].value) / refined;
        const double gradient = std::log(found[k - 1].gradient / found[k].gradient) / refined;
        INFO("orders " << value << " and " << gradient);
        CHECK(std::abs(value - 2) < 0.15);
        CHECK(std::abs(gradient - 1) < 0.15);
    }
}

TEMPLATE_TEST_CASE_SIG("u is written with the sections that it is cut with", "[heat]", ((int D), D), 2, 3) {
    const scratch::Folder folder;
    const heat::Problem<D> problem = heat::patch_test<D>();
    March<D> march = march_of_box<D>(3, D == 2 ? Split::centre : Split::C);
    const Filling<D> filling = fill_slab(march.propose({0, 0.125, 0.25}).hull);
    const std::unordered_map<PersistentId, double> none;
    const std::vector<double> u =
        heat::solve(filling, heat::known_values(filling, problem, none), problem.source);
    for (const double time : {0.1, 0.125, 0.25}) { // inside a layer, on a level, at the end
        const FillingSection<D> section = slice_filling<D>(columns_of(filling), time);
        const VertexValues solution[]{{"u", u}};
        io::AtomicFile file{folder / "u.vtu"};
        write_section<D>(file, section, solution);
        file.commit();
        const io::Soup read = io::read_vtu(folder / "u.vtu");
        REQUIRE(read.find_point_data("u") != nullptr);
        const auto& values = std::get<Array<double>>(read.find_point_data("u")->values);
        REQUIRE(values.size() == section.points.size());
        for (std::size_t v = 0; v < values.size(); ++v) {
            Point<D + 1> place{};
            std::copy_n(read.points[v].begin(), D, place.begin());
            place[D] = time;
            REQUIRE(std::abs(values[v] - problem.solution(place)) < 1e-10);
        }
    }
}

TEST_CASE("a warm body warms what is beside it, and its values follow it", "[heat]") {
    const heat::Problem<2> problem = heat::warm_body<2>();
    March<2> march = march_of_box<2>(6, Split::diagonal); // one patch, all around
    const Filling<2> filling = fill_slab(march.propose({0, 0.125, 0.25}).hull);
    const std::unordered_map<PersistentId, double> none;
    const auto u = heat::solve(filling, heat::known_values(filling, problem, none), problem.source);
    double least = 1;
    for (std::size_t f = 0; f < filling.facets.size(); ++f) {
        for (const Index v : filling.facets[f]) {
            if (filling.facet_attribute[f] == 3) {
                REQUIRE(u[v] == 1);
            } else if (filling.facet_attribute[f] == 2) {
                least = std::min(least, u[v]);
            }
        }
    }
    CHECK(least > 0.5); // the box is warm after this time: exp(-2 pi^2 / 4) is 0.007
}
