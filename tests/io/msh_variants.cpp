// SPDX-License-Identifier: BSD-3-Clause
// MSH files in every variant that Gmsh writes, and the binary ones in the opposite byte order
// (mesh_samples.py), held against the numbers that Gmsh gives numpy.
#include "io/mesh_samples.h"
#include "io/scratch.h"
#include "slabhull/io/files.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

using namespace slabhull;

namespace {

namespace fs = std::filesystem;

using Simplices = std::set<std::vector<std::int64_t>>;

/// Number in `expected`, three coordinates each, of each point of the soup; text has 16 digits.
std::vector<std::int64_t> numbers_of(const io::Soup& soup, const Array<double>& expected) {
    std::vector<std::int64_t> numbers;
    for (const Point<3>& x : soup.points) {
        std::int64_t number = -1;
        for (std::size_t i = 0; i < expected.size() / 3; ++i) {
            const double* y = expected.data() + 3 * i;
            if (std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]) < 1e-14) {
                number = static_cast<std::int64_t>(i);
            }
        }
        numbers.push_back(number);
    }
    return numbers;
}

Simplices simplices_of(const io::Soup& soup, std::size_t dimension,
                       const std::vector<std::int64_t>& numbers) {
    Simplices simplices;
    const auto& vertices = soup.simplices[dimension].vertices;
    for (std::size_t i = 0; i < vertices.size(); i += dimension + 1) {
        std::vector<std::int64_t> corners;
        for (std::size_t k = 0; k <= dimension; ++k) {
            corners.push_back(numbers[vertices[i + k]]);
        }
        simplices.insert(corners);
    }
    return simplices;
}

Simplices simplices_in(const std::string& name, std::size_t corners) {
    const Array<std::int64_t> flat = mesh_samples::numbers<std::int64_t>(name);
    Simplices simplices;
    for (auto corner = flat.begin(); corner != flat.end(); corner += static_cast<std::ptrdiff_t>(corners)) {
        simplices.emplace(corner, corner + static_cast<std::ptrdiff_t>(corners));
    }
    return simplices;
}

} // namespace

TEST_CASE("Every variant of Gmsh holds its numbers: parametric, partitioned, with gaps, in both byte orders",
          "[io]") {
    for (const fs::path& path : mesh_samples::files("msh", ".msh")) {
        CAPTURE(path.filename());
        const io::Soup soup = io::read_msh(path);
        const Array<double> expected = mesh_samples::numbers<double>("msh/points.f64");
        const std::vector<std::int64_t> numbers = numbers_of(soup, expected);
        CHECK(numbers.size() == expected.size() / 3);
        CHECK(std::set<std::int64_t>(numbers.begin(), numbers.end()).size() == numbers.size());
        for (const std::size_t dimension : {std::size_t{2}, std::size_t{3}}) {
            const io::SimplexBlock& block = soup.simplices[dimension];
            const auto known =
                simplices_in(dimension == 2 ? "msh/triangles.i64" : "msh/tetrahedra.i64", dimension + 1);
            CHECK(block.size(static_cast<int>(dimension)) == known.size());
            CHECK(simplices_of(soup, dimension, numbers) == known);
            CHECK(std::set<PatchNumber>(block.physical.begin(), block.physical.end()) ==
                  std::set<PatchNumber>{dimension == 2 ? 3 : 7});
            CHECK(std::set<std::int32_t>(block.entity.begin(), block.entity.end()) ==
                  std::set<std::int32_t>{1});
        }
        CHECK(soup.groups[2] == PatchList{{3, "skin"}});
        CHECK(soup.groups[3] == PatchList{{7, "ball"}});
    }
}

TEST_CASE("Numbers with gaps are kept", "[io]") {
    for (const fs::path& path : mesh_samples::files("msh", ".msh")) {
        if (path.filename().string().starts_with("gaps_4.1")) { // Gmsh counts anew in 2.2
            CAPTURE(path.filename());
            const io::Soup soup = io::read_msh(path);
            CHECK(soup.point_tag(2) == 7 * 2 * 2 + 3);
            CHECK(soup.point_tag(soup.points.size() - 1) == 2000000000);
        }
    }
}

TEST_CASE("The same file in both byte orders gives the same soup", "[io]") {
    for (const fs::path& path : mesh_samples::files("msh", "_big.msh")) {
        CAPTURE(path.filename());
        const io::Soup big = io::read_msh(path);
        const io::Soup little = io::read_msh(scratch::replaced(path.string(), "_big", "_binary"));
        CHECK(big.points == little.points);
        CHECK(big.point_tags == little.point_tags);
        for (std::size_t d = 0; d < 4; ++d) {
            CHECK(big.simplices[d].vertices == little.simplices[d].vertices);
            CHECK(big.simplices[d].tags == little.simplices[d].tags);
        }
    }
}

TEST_CASE("Random damage to any variant of MSH never does more than refuse it", "[io]") {
    const scratch::Folder folder;
    for (const fs::path& path : mesh_samples::files("msh", ".msh")) {
        CAPTURE(path.filename());
        CHECK(scratch::survive_damage(io::read_msh, scratch::bytes_of(path), folder / "a.msh", 300) > 0);
    }
}

TEST_CASE("Any variant of MSH cut short is refused", "[io]") {
    const scratch::Folder folder;
    for (const fs::path& path : mesh_samples::files("msh", ".msh")) {
        CAPTURE(path.filename());
        const std::string bytes = scratch::bytes_of(path);
        const std::size_t whole = bytes.find("$EndElements");
        for (std::size_t part = 0; part < 100; ++part) {
            const std::string kept = bytes.substr(0, part * whole / 100);
            CHECK(!scratch::refusal(io::read_msh, scratch::put(folder / "a.msh", kept)).empty());
        }
    }
}
