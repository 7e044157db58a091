// SPDX-License-Identifier: BSD-3-Clause
#include "io/scratch.h"
#include "io/specimens.h"
#include "slabhull/core/parallel.h"
#include "slabhull/io/files.h"

#include <catch2/catch.hpp>

using namespace slabhull;

namespace {

const std::vector<std::int64_t> triangle{0, 1, 2};

/// Of arrays that must outlive it.
io::MeshColumns columns_of(const std::vector<Point<3>>& points, const std::vector<std::int64_t>& cells) {
    io::MeshColumns mesh;
    mesh.dimension = 2;
    mesh.points = Column<double>::over(std::span{points.front().data(), 3 * points.size()}, 3);
    mesh.cells = Column<std::int64_t>::over(std::span{cells}, 3);
    return mesh;
}

Point<3> in_single(const Point<3>& x) {
    const auto single = [](double value) { return static_cast<double>(static_cast<float>(value)); };
    return {single(x[0]), single(x[1]), single(x[2])};
}

} // namespace

TEST_CASE("OFF, OBJ and PLY come back bit for bit", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{2, 50};
    for (const char* name : {"a.off", "a.OBJ", "a.ply"}) {
        CAPTURE(name);
        io::write_surface(folder / name, grid.columns());
        const io::Soup soup = io::read_surface(folder / name);
        CHECK(soup.points == Array<Point<3>>(grid.points.begin(), grid.points.end()));
        CHECK(soup.simplices[2].vertices == Array<Index>(grid.cells.begin(), grid.cells.end()));
    }
}

TEST_CASE("The sign of a zero is kept in text", "[io]") {
    const scratch::Folder folder;
    const std::vector<Point<3>> points{{-0.0, 0.0, 1}, {1, -0.0, 1}, {0, 1, 1}};
    for (const char* name : {"a.off", "a.obj"}) {
        io::write_surface(folder / name, columns_of(points, triangle));
        const io::Soup soup = io::read_surface(folder / name);
        CHECK(std::signbit(soup.points[0][0]));
        CHECK_FALSE(std::signbit(soup.points[0][1]));
    }
}

TEST_CASE("STL comes back as the same triangles in single precision", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{2, 50};
    io::write_surface(folder / "a.stl", grid.columns());
    const io::Soup soup = io::read_surface(folder / "a.stl");
    CHECK(soup.points.size() == grid.points.size());
    REQUIRE(soup.simplices[2].vertices.size() == grid.cells.size());
    for (std::size_t i = 0; i < grid.cells.size(); ++i) {
        CHECK(soup.points[soup.simplices[2].vertices[i]] ==
              in_single(grid.points[static_cast<std::size_t>(grid.cells[i])]));
    }
}

TEST_CASE("The bytes of a surface do not depend on the number of threads", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{2, 300};
    for (const char* name : {"a.stl", "a.off", "a.obj", "a.ply"}) {
        CAPTURE(name);
        std::array<std::string, 2> bytes;
        for (const int threads : {1, 3}) {
            set_thread_count(threads);
            io::write_surface(folder / name, grid.columns());
            bytes[threads == 1 ? 0 : 1] = scratch::bytes_of(folder / name);
        }
        set_thread_count(0);
        CHECK(bytes[0] == bytes[1]);
    }
}

TEST_CASE("A triangle whose corners are in line has the normal zero", "[io]") {
    const scratch::Folder folder;
    const std::vector<Point<3>> points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    io::write_surface(folder / "a.stl", columns_of(points, triangle));
    CHECK(scratch::bytes_of(folder / "a.stl").substr(84, 12) == std::string(12, '\0'));
}

TEST_CASE("What a surface file cannot hold is refused, and no file appears", "[io]") {
    const scratch::Folder folder;
    for (const char* name : {"a.stl", "a.off", "a.obj", "a.ply"}) {
        CHECK_THROWS_AS(io::write_surface(folder / name, specimens::Grid(3, 1).columns()), FormatLimit);
        CHECK_THROWS_AS(io::write_surface(folder / name, specimens::Grid(1, 1).columns()), FormatLimit);
    }
    CHECK_THROWS_AS(io::write_surface(folder / "a.xyz", specimens::Grid(2, 1).columns()), UsageError);
    const std::vector<Point<3>> far{{0, 0, 0}, {1e39, 0, 0}, {0, 1, 0}};
    CHECK_THROWS_WITH(io::write_surface(folder / "a.stl", columns_of(far, triangle)),
                      Catch::Contains("vertex 1 has the coordinate 1e+39"));
    io::MeshColumns many = columns_of(far, triangle);
    many.points = Column<double>{std::size_t{1} << 31, 3, {}};
    CHECK_THROWS_AS(io::write_surface(folder / "a.ply", many), FormatLimit);
    many.cells = Column<std::int64_t>{std::size_t{1} << 32, 3, {}};
    CHECK_THROWS_AS(io::write_surface(folder / "a.stl", many), FormatLimit);
    CHECK(folder.file_count() == 0);
}
