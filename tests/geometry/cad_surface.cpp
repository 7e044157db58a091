// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/cad_surface.h"

#include "geometry/random_points.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

using namespace slabhull;
using tests::random_points;

namespace {

const std::filesystem::path samples = SLABHULL_CAD_SAMPLES;

/// Says so once for each test case that cannot run; ctest looks for the words.
bool no_samples() {
    const bool missing = !has_cad_surfaces() || !std::filesystem::exists(samples / "sphere.step");
    if (missing) {
        WARN("no CAD samples, or built without OpenCASCADE");
    }
    return missing;
}

ProjectionSurfacePointer<3> read_sample(const std::string& name) {
    std::ifstream in{samples / name};
    return cad_surface(in, name.ends_with(".step") ? CadFormat::step : CadFormat::brep, name);
}

Point<3> nearest(const Point<3>& x, const std::vector<Point<3>>& candidates) {
    return *std::min_element(
        candidates.begin(), candidates.end(),
        [&x](const Point<3>& a, const Point<3>& b) { return distance(a, x) < distance(b, x); });
}

/// (x, y) put at `radius` from the z axis, on the side where it is.
Point<3> at_radius(const Point<3>& x, double radius, double z) {
    const double r = std::hypot(x[0], x[1]);
    return r > 0 ? Point<3>{radius * x[0] / r, radius * x[1] / r, z} : Point<3>{radius, 0, z};
}

// The closest points of the models of cad_samples.py.

Point<3> on_sphere(const Point<3>& x) {
    return sphere_surface<3>({0.1, 0.2, 0.3}, 1)->closest(x);
}

Point<3> on_cylinder(const Point<3>& x) {
    const double r = std::hypot(x[0], x[1]);
    const double z = std::clamp(x[2], -1.0, 1.0);
    const auto lid = [&](double height) {
        return r <= 0.5 ? Point<3>{x[0], x[1], height} : at_radius(x, 0.5, height);
    };
    return nearest(x, {at_radius(x, 0.5, z), lid(-1), lid(1)});
}

Point<3> on_torus(const Point<3>& x) {
    const Point<3> ring = at_radius(x, 1, 0);
    return sphere_surface<3>(ring, 0.25)->closest(x);
}

/// A box with all edges rounded is what lies within 0.2 of a smaller box.
Point<3> on_rounded_box(const Point<3>& x) {
    const Point<3> core{1.3, 0.8, 0.3};
    Point<3> inner;
    std::vector<Point<3>> sides;
    for (std::size_t k = 0; k < 3; ++k) {
        inner[k] = std::clamp(x[k], -core[k], core[k]);
        sides.push_back(x);
        sides.back()[k] = std::copysign(core[k] + 0.2, x[k]);
    }
    return inner == x ? nearest(x, sides) : sphere_surface<3>(inner, 0.2)->closest(x);
}

/// A square plate of half width 1 with a round hole of radius 0.5.
Point<3> on_plate(const Point<3>& x) {
    const double r = std::hypot(x[0], x[1]);
    std::vector<Point<3>> candidates{at_radius(x, 0.5, std::clamp(x[2], -0.25, 0.25))};
    const Point<3> inner{std::clamp(x[0], -1.0, 1.0), std::clamp(x[1], -1.0, 1.0),
                         std::clamp(x[2], -0.25, 0.25)};
    for (const double z : {-0.25, 0.25}) {
        candidates.push_back(r < 0.5 ? at_radius(x, 0.5, z) : Point<3>{inner[0], inner[1], z});
    }
    for (const double side : {-1.0, 1.0}) {
        candidates.push_back({side, inner[1], inner[2]});
        candidates.push_back({inner[0], side, inner[2]});
    }
    return nearest(x, candidates);
}

Point<3> on_ellipsoid(const Point<3>& x) {
    return ellipsoid_surface<3>({}, {1, 3, 2})->closest(x);
}

/// Random points near and far, on the axes, and `near` the surface.
std::vector<Point<3>> queries(const std::function<Point<3>(const Point<3>&)>& exact) {
    std::vector<Point<3>> all = random_points<3>(300, 2);
    const std::vector<Point<3>> far = random_points<3>(50, 50, 2);
    all.insert(all.end(), far.begin(), far.end());
    for (const double reach : {0.0, 1e-9, 1e-4, 0.02}) {
        const std::vector<Point<3>> places = random_points<3>(100, 1.5, 3);
        const std::vector<Point<3>> steps = random_points<3>(100, reach, 4);
        for (std::size_t i = 0; i < places.size(); ++i) {
            Point<3> x = exact(places[i]);
            for (std::size_t k = 0; k < 3; ++k) {
                x[k] += steps[i][k];
            }
            all.push_back(x);
        }
    }
    for (const double z : {-1.7, -0.3, 0.0, 0.2, 0.9}) {
        all.push_back({0, 0, z});
    }
    return all;
}

void require_closest(const std::string& name, const std::function<Point<3>(const Point<3>&)>& exact,
                     double precision = 1e-14) {
    const auto surface = read_sample(name);
    for (const Point<3>& x : queries(exact)) {
        const Point<3> y = surface->closest(x);
        const double size = 4 + distance(x, Point<3>{});
        // So near an edge of the model OpenCASCADE does not say on which side a point is.
        const double allowed = distance(x, exact(x)) < 1e-8 ? 2e-9 : precision * size;
        CAPTURE(name, x, y, exact(x), distance(y, exact(x)));
        REQUIRE(distance(y, exact(y)) <= allowed);
        REQUIRE(distance(x, y) == Approx(distance(x, exact(x))).margin(allowed).epsilon(0));
    }
}

} // namespace

TEST_CASE("closest points of CAD models are those of their formulas") {
    if (no_samples()) {
        return;
    }
    require_closest("sphere.step", on_sphere);
    require_closest("sphere.brep", on_sphere);
    require_closest("cylinder.step", on_cylinder);
    require_closest("torus.step", on_torus);
    require_closest("rounded_box.step", on_rounded_box);
    require_closest("plate.step", on_plate);
    require_closest("ellipsoid.step", on_ellipsoid, 1e-12); // its file has weights of 12 digits
}

TEST_CASE("lengths are as written, whatever the unit") {
    if (no_samples()) {
        return;
    }
    require_closest("sphere_metre.step", on_sphere);
    require_closest("sphere_inch.step", on_sphere);
}

TEST_CASE("CAD surfaces give the same bits for any number of threads") {
    if (no_samples()) {
        return;
    }
    for (const char* name : {"rounded_box.step", "ellipsoid.step"}) {
        const auto surface = read_sample(name);
        std::vector<Point<3>> one = random_points<3>(5000, 2);
        std::vector<Point<3>> many = one;
        set_thread_count(1);
        project<3>(*surface, {}, one);
        set_thread_count(4);
        project<3>(*surface, {}, many);
        set_thread_count(0);
        CHECK(one == many);
    }
}

TEST_CASE("a crease of a CAD model and a plane is met to the model's tolerance, or better") {
    if (no_samples()) {
        return;
    }
    const auto barrel = read_sample("cylinder.step");
    const auto cut = plane_surface<3>({0, 0, 0.5}, {0, 0.6, 0.8});
    const std::vector<PlacedSurface<3>> both{{barrel.get(), {}}, {cut.get(), {}}};
    for (const Point<3>& away : random_points<3>(50, 0.01)) {
        std::vector<Point<3>> x{{0.3 + away[0], 0.4 + away[1], 0.2 + away[2]}};
        project_onto_all<3>(both, x, 2);
        CHECK(std::hypot(x[0][0], x[0][1]) == Approx(0.5).epsilon(1e-14));
        CHECK(0.6 * x[0][1] + 0.8 * (x[0][2] - 0.5) == Approx(0).margin(1e-14));
    }
}

TEST_CASE("files that are no CAD models, and models without faces, are refused by name") {
    if (no_samples()) {
        return;
    }
    const auto refuse = [](const std::string& text, CadFormat format) {
        std::istringstream in{text};
        try {
            cad_surface(in, format, "model.step");
            FAIL("accepted: " << text.substr(0, 40));
        } catch (const InputError& error) {
            CHECK_THAT(error.what(), Catch::StartsWith("model.step: "));
        }
    };
    std::ostringstream whole;
    whole << std::ifstream{samples / "plate.step"}.rdbuf();
    for (const CadFormat format : {CadFormat::step, CadFormat::brep}) {
        refuse("", format);
        refuse("solid cube\nendsolid cube\n", format);
        refuse("ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n", format);
        refuse("CASCADE Topology V1, (c) Matra-Datavision\nLocations 0\n", format);
    }
    refuse(whole.str().substr(0, whole.str().size() / 8), CadFormat::step);
}

TEST_CASE("no point is closest to no point") {
    if (no_samples()) {
        return;
    }
    std::vector<Point<3>> x{{0, std::nan(""), 0}};
    CHECK_THROWS_AS(project<3>(*read_sample("sphere.step"), {}, x), GeometryError);
}

TEST_CASE("without OpenCASCADE, CAD files are refused with a word on how to get it") {
    if (has_cad_surfaces()) {
        return;
    }
    std::istringstream in;
    CHECK_THROWS_WITH(cad_surface(in, CadFormat::step, "x.step"),
                      Catch::Contains("x.step") && Catch::Contains("SLABHULL_OPENCASCADE"));
}
