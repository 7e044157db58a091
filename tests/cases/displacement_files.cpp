// SPDX-License-Identifier: BSD-3-Clause
#include "cases/tables/displacement_files.h"
#include "geometry/basics/point_finder.h"

#include "geometry/random_points.h"
#include "io/scratch.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/shapes.h"
#include "slabhull/io/files.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <string>
#include <vector>

using namespace slabhull;
using tests::random_points;

namespace {

constexpr PatchNumber plate = 2;

/// A plate-like body in a box, its tracks, and which vertices are the plate's.
template<int D>
struct Domain {
    Surface<D> surface;
    std::vector<TrackId> tracks;
    std::vector<Index> vertices;

    Domain() {
        Point<D> low, high, axes, centre{};
        low.fill(-2);
        high.fill(2);
        axes.fill(0.5);
        axes[0] = 0.1;
        centre[1] = 0.25;
        const std::array pieces{box_surface<D>(low, high, 2, {1, "walls"}),
                                ellipsoid_body<D>(centre, axes, D == 2 ? 14 : 3, {plate, "plate"})};
        surface = join<D>(pieces);
        for (Index v = 0; v < surface.points.size(); ++v) {
            tracks.push_back(100 + 3 * v);
            if (v >= pieces[0].points.size()) {
                vertices.push_back(v);
            }
        }
    }

    std::pair<double, double> range_along(std::size_t axis) const {
        std::pair<double, double> range{9, -9};
        for (const Index v : vertices) {
            const double x = surface.points[v][axis];
            range = {std::min(range.first, x), std::max(range.second, x)};
        }
        return range;
    }

    double longest_side() const {
        double longest = 0;
        for (std::size_t k = 0; k < D; ++k) {
            longest = std::max(longest, range_along(k).second - range_along(k).first);
        }
        return longest;
    }

    std::vector<TrackId> plate_tracks() const {
        std::vector<TrackId> of_plate;
        for (const Index v : vertices) {
            of_plate.push_back(tracks[v]);
        }
        return of_plate;
    }
};

/// A bending that grows with t^2.
template<int D>
Point<D> bent(const Point<D>& x, double t) {
    Point<D> u{};
    u[0] = 0.3 * t * t * x[1] * x[1];
    u[D - 1] += 0.1 * t * x[0];
    return u;
}

struct Writing {
    double noise = 0;       ///< added to the positions
    bool displaced = false; ///< positions are those at the time
    bool positions = true;
    bool tracks = false;
    std::function<void(std::vector<std::string>& lines)> spoil = [](auto&) {};
};

/// Rows for the plate and some others, in an order of their own.
template<int D>
std::string csv_of(const Domain<D>& domain, double t, const Writing& how = {}) {
    std::vector<std::string> lines;
    for (Index v = 0; v < domain.surface.points.size(); ++v) {
        const Point<D> x = domain.surface.points[v];
        const Point<D> u = bent<D>(x, t);
        std::string line = how.tracks ? fmt::format("{},", domain.tracks[v]) : "";
        for (std::size_t k = 0; k < D && how.positions; ++k) {
            line += fmt::format("{:.17g},", x[k] + (how.displaced ? u[k] : 0) + (k == 1 ? how.noise : 0));
        }
        for (std::size_t k = 0; k < D; ++k) {
            line += fmt::format("{}{:.17g}", k == 0 ? "" : ",", u[k]);
        }
        lines.push_back(line);
    }
    how.spoil(lines);
    std::stable_sort(lines.begin(), lines.end(), [](const std::string& a, const std::string& b) {
        return std::hash<std::string>{}(a) < std::hash<std::string>{}(b);
    });
    std::string header = how.tracks ? "track_id," : "";
    const std::string axes = "xyz";
    for (std::size_t k = 0; k < D && how.positions; ++k) {
        header += fmt::format("{},", axes[k]);
    }
    std::string text = header + (D == 2 ? "dx,dy" : "dx,dy,dz");
    for (const std::string& line : lines) {
        text += "\n" + line;
    }
    return text + "\n";
}

/// A series of CSV files for t = 0, 0.25 .. 1.
template<int D>
DisplacementSpec csv_series(const scratch::Folder& folder, const Domain<D>& domain, const Writing& how = {}) {
    DisplacementSpec spec;
    for (int i = 0; i <= 4; ++i) {
        spec.times.push_back(0.25 * i);
        spec.files.push_back(
            scratch::put(folder / fmt::format("d_{}.csv", i), csv_of<D>(domain, spec.times.back(), how)));
    }
    return spec;
}

template<int D>
DisplacementFiles<D> read(const DisplacementSpec& spec, const Domain<D>& domain, TimeInterval span = {0, 1}) {
    return read_displacement_files<D>(spec, domain.surface, domain.tracks, std::array{plate}, span);
}

/// The largest distance of the plate's vertices from where the bending has them.
template<int D>
double error_at(const NodalMotion<D>& motion, const Domain<D>& domain, double t) {
    std::vector<Point<D>> x(domain.vertices.size());
    motion.positions(domain.plate_tracks(), t, x);
    double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const Point<D>& start = domain.surface.points[domain.vertices[i]];
        Point<D> wanted = bent<D>(start, t);
        for (std::size_t k = 0; k < D; ++k) {
            wanted[k] += start[k];
        }
        worst = std::max(worst, distance(x[i], wanted));
    }
    return worst;
}

template<class Thrown, class Refused>
std::string complaint(Refused&& refused) {
    try {
        refused();
    } catch (const Thrown& error) {
        return error.what();
    }
    return "accepted";
}

bool holds(const std::string& text, const std::vector<std::string>& words) {
    return std::all_of(words.begin(), words.end(), [&text](const std::string& word) {
        INFO(text << " lacks " << word);
        CHECK(text.find(word) != std::string::npos);
        return text.find(word) != std::string::npos;
    });
}

/// The box's and the plate's triangles with displacements, as ParaView would write them.
void write_displaced_vtu(const std::filesystem::path& path, const Domain<3>& domain, double t,
                         const std::string& array, const std::string& time_name) {
    const Surface<3>& surface = domain.surface;
    io::MeshColumns mesh;
    mesh.dimension = 2;
    const auto rows = [&surface](auto value) {
        return Column<double>{surface.points.size(), 3,
                              [value](std::size_t begin, std::size_t end, double* out) {
                                  for (std::size_t row = begin; row < end; ++row) {
                                      out = std::ranges::copy(value(row), out).out;
                                  }
                              }};
    };
    mesh.points = rows([&surface](std::size_t row) { return surface.points[row]; });
    mesh.cells = {surface.facets.size(), 3,
                  [&surface](std::size_t begin, std::size_t end, std::int64_t* out) {
                      for (std::size_t row = begin; row < end; ++row) {
                          out = std::ranges::copy(surface.facets[row], out).out;
                      }
                  }};
    mesh.point_data.push_back({array, io::Scalar::float64, rows([&surface, t](std::size_t row) {
                                   return bent<3>(surface.points[row], t);
                               })});
    if (!time_name.empty()) {
        mesh.field_data.push_back({time_name, 1, Array<double>{t}});
    }
    io::write_vtu(path, mesh);
}

} // namespace

TEMPLATE_TEST_CASE_SIG(
    "a series of CSV files moves the plate's vertices, rows in any order and of others, too", "",
    ((int D), D), 2, 3) {
    const scratch::Folder folder;
    const Domain<D> domain;
    const auto [motion, match] = read<D>(csv_series<D>(folder, domain), domain);
    for (const double t : {0.0, 0.1, 0.5, 0.9, 1.0}) {
        CHECK(error_at<D>(*motion, domain, t) < 1e-15);
    }
    CHECK(match.files == 5);
    CHECK(match.vertices == domain.vertices.size());
    CHECK(match.largest == 0);
    CHECK(match.where.empty());
    CHECK(match.tolerance == Approx(1e-6 * domain.longest_side()));
    CHECK_THROWS_AS(error_at<D>(*motion, domain, 1.1), GeometryError);
}

TEST_CASE("linear interpolation is linear between the files") {
    const scratch::Folder folder;
    const Domain<2> domain;
    DisplacementSpec spec = csv_series<2>(folder, domain);
    spec.interpolation = TimeInterpolation::linear;
    const auto motion = read<2>(spec, domain).motion;
    CHECK(error_at<2>(*motion, domain, 0.75) < 1e-15);
    // A chord of t^2 over 1/4 is off by 1/64 in its middle.
    CHECK(error_at<2>(*motion, domain, 0.625) ==
          Approx(0.3 * std::pow(domain.range_along(1).second, 2) / 64));
}

TEMPLATE_TEST_CASE_SIG("rows are found by track, with or without positions at the start or displaced", "",
                       ((int D), D), 2, 3) {
    const scratch::Folder folder;
    const Domain<D> domain;
    for (const bool positions : {false, true}) {
        for (const bool displaced : {false, true}) {
            Writing how;
            how.tracks = true;
            how.positions = positions;
            how.displaced = displaced;
            const auto series = read<D>(csv_series<D>(folder, domain, how), domain);
            CHECK(error_at<D>(*series.motion, domain, 0.4) < 1e-15);
        }
    }
}

TEST_CASE("the largest distance between vertices and rows is reported with its file") {
    const scratch::Folder folder;
    const Domain<3> domain;
    DisplacementSpec spec = csv_series<3>(folder, domain);
    Writing shifted;
    shifted.noise = 3e-7;
    scratch::put(spec.files[3], csv_of<3>(domain, 0.75, shifted));
    const auto match = read<3>(spec, domain).match;
    CHECK(match.largest == Approx(3e-7).epsilon(1e-6));
    CHECK(match.where == spec.files[3]);
}

TEST_CASE("a vertex without a row is named with file, place and the nearest row's distance") {
    const scratch::Folder folder;
    const Domain<2> domain;
    DisplacementSpec spec = csv_series<2>(folder, domain);
    Writing shifted;
    shifted.noise = 1e-3;
    scratch::put(spec.files[2], csv_of<2>(domain, 0.5, shifted));
    const auto read_it = [&] { read<2>(spec, domain); };
    const Index first = domain.vertices.front();
    const auto count = domain.vertices.size();
    CHECK(holds(complaint<InputError>(read_it),
                {"d_2.csv", "plate", fmt::format("track {}", domain.tracks[first]), "0.001 away", "line ",
                 fmt::format("{} of {}", count, count)}));
    spec.tolerance = 2e-3;
    CHECK(read<2>(spec, domain).match.largest == Approx(1e-3));
}

TEST_CASE("one vertex without a row is enough, by position and by track") {
    const scratch::Folder folder;
    const Domain<3> domain;
    for (const bool tracks : {false, true}) {
        DisplacementSpec spec = csv_series<3>(folder, domain, {.tracks = tracks});
        Writing gap{.tracks = tracks};
        gap.spoil = [&](auto& lines) { lines.erase(lines.begin() + domain.vertices[5]); };
        scratch::put(spec.files[4], csv_of<3>(domain, 1, gap));
        CHECK(holds(complaint<InputError>([&] { read<3>(spec, domain); }),
                    {"d_4.csv", fmt::format("track {}", domain.tracks[domain.vertices[5]]),
                     fmt::format("1 of {}", domain.vertices.size())}));
    }
}

TEST_CASE("two rows for a vertex are refused unless they say the same at the same place") {
    const scratch::Folder folder;
    const Domain<2> domain;
    const Index v = domain.vertices[3];
    const auto doubled = [&](const std::string& last, bool tracks) {
        DisplacementSpec spec = csv_series<2>(folder, domain, {.tracks = tracks});
        Writing twice{.tracks = tracks};
        twice.spoil = [&](auto& lines) {
            std::string again = lines[v];
            again += last;
            lines.push_back(again);
        };
        scratch::put(spec.files[1], csv_of<2>(domain, 0.25, twice));
        return complaint<InputError>([&] { read<2>(spec, domain); });
    };
    CHECK(doubled("", false) == "accepted"); // a point on a seam, written twice
    CHECK(holds(doubled("e1", false), {"d_1.csv", "both", "line "}));
    CHECK(holds(doubled("", true), {"d_1.csv", "both", "line "}));
}

TEST_CASE("a tolerance beyond the spacing, where two vertices would share a row, is refused") {
    const scratch::Folder folder;
    const Domain<2> domain;
    DisplacementSpec spec = csv_series<2>(folder, domain);
    Writing gap;
    gap.spoil = [&](auto& lines) { // one row left, at the place of one of the vertices
        lines = {lines[domain.vertices[3]]};
    };
    scratch::put(spec.files[0], csv_of<2>(domain, 0, gap));
    spec.tolerance = 100;
    CHECK(holds(complaint<InputError>([&] { read<2>(spec, domain); }), {"d_0.csv", "too", "tolerance"}));
}

TEST_CASE("tracks of another run give themselves away by their positions") {
    const scratch::Folder folder;
    Domain<3> domain;
    const DisplacementSpec spec = csv_series<3>(folder, domain, {.tracks = true});
    std::reverse(domain.tracks.begin(), domain.tracks.end());
    CHECK(holds(complaint<InputError>([&] { read<3>(spec, domain); }), {"d_0.csv", "track", "tolerance"}));
}

TEST_CASE("vertices displaced at the start already are refused") {
    const scratch::Folder folder;
    const Domain<2> domain;
    const DisplacementSpec spec = csv_series<2>(folder, domain);
    CHECK(holds(complaint<InputError>([&] {
                    read<2>(spec, domain, {0.5, 1});
                }),
                {"d_0.csv", "t = 0.5", "track"}));
}

TEST_CASE("times must cover the case, be as many as the files, and ascend") {
    const scratch::Folder folder;
    const Domain<2> domain;
    const DisplacementSpec spec = csv_series<2>(folder, domain);
    CHECK_NOTHROW(read<2>(spec, domain, {0, 1 + 1e-12}));
    CHECK(holds(complaint<UsageError>([&] {
                    read<2>(spec, domain, {0, 1.5});
                }),
                {"from t = 0 to 1", "0 to 1.5"}));
    CHECK(holds(complaint<UsageError>([&] {
                    read<2>(spec, domain, {-1, 1});
                }),
                {"from t = 0 to 1", "-1 to 1"}));
    DisplacementSpec fewer = spec;
    fewer.times.pop_back();
    CHECK(holds(complaint<UsageError>([&] { read<2>(fewer, domain); }), {"4 times", "5 files"}));
    DisplacementSpec swapped = spec;
    std::swap(swapped.times[2], swapped.times[3]);
    CHECK(holds(complaint<UsageError>([&] { read<2>(swapped, domain); }), {"d_3.csv", "0.5", "0.75"}));
    DisplacementSpec timeless = spec;
    timeless.times.clear();
    CHECK(holds(complaint<UsageError>([&] { read<2>(timeless, domain); }), {"d_0.csv", "times"}));
}

TEST_CASE("VTU files of triangles say their own times, and which array displaces may be chosen") {
    const scratch::Folder folder;
    const Domain<3> domain;
    for (const char* time_name : {"time", "TimeValue", ""}) {
        for (const char* array : {"displacement", "U"}) {
            DisplacementSpec spec;
            spec.pattern = folder / "d_*.vtu";
            spec.array = array;
            for (int i = 0; i <= 4; ++i) {
                write_displaced_vtu(folder / fmt::format("d_{}.vtu", 3 * i), domain, 0.25 * i, array,
                                    time_name);
            }
            if (*time_name == '\0') {
                CHECK(holds(complaint<UsageError>([&] { read<3>(spec, domain); }), {"d_0.vtu", "times"}));
                spec.times = {0, 0.25, 0.5, 0.75, 1};
            }
            CHECK(error_at<3>(*read<3>(spec, domain).motion, domain, 0.6) < 1e-15);
        }
    }
    DisplacementSpec spec;
    spec.pattern = folder / "d_*.vtu";
    CHECK(holds(complaint<InputError>([&] { read<3>(spec, domain); }),
                {"d_0.vtu", "\"displacement\"", "\"U\""}));
}

TEST_CASE("CSV files with columns of no meaning, without those needed, or out of the plane are refused") {
    const scratch::Folder folder;
    const Domain<2> domain;
    const auto refusal = [&](const std::string& text) {
        DisplacementSpec spec;
        spec.files = {scratch::put(folder / "d.csv", text)};
        spec.times = {0};
        return complaint<InputError>([&] { read<2>(spec, domain, {0, 0}); });
    };
    CHECK(holds(refusal("x,y,dx,dy,pressure\n0,0,0,0,0\n"), {"d.csv", "pressure"}));
    CHECK(holds(refusal("x,y,dx\n0,0,0\n"), {"d.csv", "\"dy\""}));
    CHECK(holds(refusal("y,dx,dy\n0,0,0\n"), {"d.csv", "\"x\""}));
    CHECK(holds(refusal("x,y,dx,dy,dz\n0,0,0,0,0.5\n"), {"d.csv", "line 2", "0.5"}));
    CHECK(holds(refusal("id,dx,dy\n0.5,0,0\n"), {"d.csv", "line 2", "0.5"}));
    CHECK(holds(refusal("x,y,dx,dy\n"), {"d.csv"}));
}

TEST_CASE("a pattern finds its files by ascending number, however it is written") {
    const scratch::Folder folder;
    for (const char* name :
         {"d_10.csv", "d_9.csv", "d_0011.csv", "d_0.csv", "d_x.csv", "d_.csv", "e_5.csv", "d_5.vtu"}) {
        scratch::put(folder / name, "");
    }
    std::vector<std::string> names;
    for (const auto& file : files_of_pattern(folder / "d_*.csv")) {
        names.push_back(file.filename().string());
    }
    CHECK(names == std::vector<std::string>{"d_0.csv", "d_9.csv", "d_10.csv", "d_0011.csv"});
    scratch::put(folder / "d_00.csv", "");
    CHECK(
        holds(complaint<UsageError>([&] { files_of_pattern(folder / "d_*.csv"); }), {"d_0.csv", "d_00.csv"}));
    CHECK(holds(complaint<UsageError>([&] { files_of_pattern(folder / "f_*.csv"); }), {"f_*.csv"}));
    CHECK_THROWS_AS(files_of_pattern(folder / "d_0.csv"), UsageError);
    CHECK_THROWS_AS(files_of_pattern(folder / "d_*_*.csv"), UsageError);
    CHECK_THROWS_AS(files_of_pattern(folder / "nowhere/d_*.csv"), UsageError);
}

TEMPLATE_TEST_CASE_SIG("a point finder finds the same points as a look at all of them", "", ((int D), D), 2,
                       3) {
    auto points = random_points<D>(300, 1, 7);
    for (std::size_t i = 0; i < 100; ++i) { // a lattice, where many share coordinates
        points.push_back(points[i]);
        for (double& x : points.back()) {
            x = std::round(4 * x) / 4;
        }
    }
    const PointFinder<D> finder{points};
    for (const Point<D>& x : random_points<D>(50, 1.2, 8)) {
        for (const double radius : {0.0, 0.05, 0.3, 5.0}) {
            std::vector<std::size_t> expected;
            for (std::size_t i = 0; i < points.size(); ++i) {
                if (distance(points[i], x) <= radius) {
                    expected.push_back(i);
                }
            }
            std::stable_sort(expected.begin(), expected.end(), [&](std::size_t a, std::size_t b) {
                return distance(points[a], x) < distance(points[b], x);
            });
            CHECK(finder.within(x, radius) == expected);
        }
        const auto nearest = finder.nearest(x);
        CHECK(std::none_of(points.begin(), points.end(), [&](const Point<D>& other) {
            return distance(other, x) < distance(points[nearest], x);
        }));
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        CHECK(!finder.within(points[i], 0).empty());
    }
}
