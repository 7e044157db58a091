// SPDX-License-Identifier: BSD-3-Clause
#include "io/scratch.h"
#include "io/soups.h"
#include "io/specimens.h"
#include "slabhull/io/files.h"

#include <catch2/catch.hpp>
#include <utility>

using namespace slabhull;
using soups::says;

namespace {

const std::string small_mfem =
    "MFEM mesh v1.0\n\n# SEGMENT = 1, TRIANGLE = 2\n\ndimension\n2\n\nelements\n2\n1 2 0 1 2\n"
    "7 2 0 2 3\n\nboundary\n4\n3 1 0 1\n# a comment\n3 1 1 2\n4 1 2 3\n4 1 3 0\n\nvertices\n4\n"
    "2\n0 0\n1 0\n1 1\n0 1.5\n";

std::string mfem_refusal(const std::string& from, const std::string& to) {
    return scratch::refusal(io::read_mfem, "a.mesh", scratch::replaced(small_mfem, from, to));
}

io::Soup written(const specimens::Grid& grid) {
    const scratch::Folder folder;
    io::write_mfem(folder / "a.mesh", grid.columns());
    return io::read_mfem(folder / "a.mesh");
}

} // namespace

TEST_CASE("An MFEM mesh is read with its boundary elements, attributes and comments", "[io]") {
    const scratch::Folder folder;
    const io::Soup soup = io::read_mfem(scratch::put(folder / "a.mesh", small_mfem));
    CHECK(soup.points == Array<Point<3>>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1.5, 0}});
    CHECK(soup.simplices[2].vertices == Array<Index>{0, 1, 2, 0, 2, 3});
    CHECK(soup.simplices[2].physical == std::vector<PatchNumber>{1, 7});
    CHECK(soup.simplices[1].vertices == Array<Index>{0, 1, 1, 2, 2, 3, 3, 0});
    CHECK(soup.groups[1] == PatchList{{3, ""}, {4, ""}});
    CHECK(soup.groups[2] == PatchList{{1, ""}, {7, ""}});
}

TEST_CASE("What is written for MFEM comes back bit for bit, with groups", "[io]") {
    for (const specimens::Grid& grid : {specimens::Grid{1, 9}, specimens::Grid{2, 1}, specimens::Grid{2, 30},
                                        specimens::Grid{3, 1}, specimens::Grid{3, 8}}) {
        CAPTURE(grid.dimension, grid.cell_count());
        const io::Soup soup = written(grid);
        const auto top = static_cast<std::size_t>(grid.dimension);
        CHECK(soup.points == Array<Point<3>>(grid.points.begin(), grid.points.end()));
        CHECK(soup.simplices[top].vertices == Array<Index>(grid.cells.begin(), grid.cells.end()));
        for (const auto& group : grid.columns().groups) {
            for (std::size_t cell = group.begin; cell < group.end; ++cell) {
                CHECK(soup.simplices[top].physical[cell] == group.number);
            }
        }
    }
}

TEST_CASE("The boundary written for MFEM is the mesh's: ends, sides and faces in number", "[io]") {
    CHECK(written(specimens::Grid{1, 9}).simplices[0].vertices == Array<Index>{0, 9});
    CHECK(written(specimens::Grid{2, 5}).simplices[1].size(1) == 4 * 5);
    CHECK(written(specimens::Grid{3, 4}).simplices[2].size(2) == 6 * 2 * 4 * 4);
}

TEST_CASE("Boundary triangles of tetrahedra of positive volume point outward", "[io]") {
    const scratch::Folder folder;
    const std::vector<Point<3>> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::vector<std::int64_t> cell{0, 1, 2, 3};
    io::MeshColumns mesh;
    mesh.points = Column<double>::over(std::span{points.front().data(), 12}, 3);
    mesh.cells = Column<std::int64_t>::over(std::span{cell}, 4);
    io::write_mfem(folder / "a.mesh", mesh);
    const io::Soup soup = io::read_mfem(folder / "a.mesh");
    const Array<Index>& faces = soup.simplices[2].vertices;
    REQUIRE(faces.size() == 12);
    for (std::size_t i = 0; i < faces.size(); i += 3) {
        const Point<3> n = soups::cross(soups::edge(soup, &faces[i], 1), soups::edge(soup, &faces[i], 2));
        double outward = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            outward += n[k] * (soup.points[faces[i]][k] - 0.25); // from the centroid
        }
        CHECK(outward > 0);
    }
    CHECK(soup.simplices[3].physical == std::vector<PatchNumber>{1});
}

TEST_CASE("A closed surface has no boundary elements, and cells without a group get a number", "[io]") {
    const scratch::Folder folder;
    const std::vector<Point<3>> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::vector<std::int64_t> cells{0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    io::MeshColumns mesh;
    mesh.dimension = 2;
    mesh.points = Column<double>::over(std::span{points.front().data(), 12}, 3);
    mesh.cells = Column<std::int64_t>::over(std::span{cells}, 3);
    mesh.groups = {{0, 1, 4, "floor"}, {1, 4, 0, ""}};
    io::write_mfem(folder / "a.mesh", mesh);
    const io::Soup soup = io::read_mfem(folder / "a.mesh");
    CHECK(soup.simplices[1].vertices.empty());
    CHECK(soup.simplices[2].physical == std::vector<PatchNumber>{4, 5, 5, 5});
}

TEST_CASE("A mesh in the plane gets two coordinates, unless a zero is negative", "[io]") {
    const scratch::Folder folder;
    std::vector<Point<3>> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<std::int64_t> cells{0, 1, 2};
    for (const double z : {0.0, -0.0}) {
        points[1][2] = z;
        io::MeshColumns mesh;
        mesh.dimension = 2;
        mesh.points = Column<double>::over(std::span{std::as_const(points).front().data(), 9}, 3);
        mesh.cells = Column<std::int64_t>::over(std::span{cells}, 3);
        io::write_mfem(folder / "a.mesh", mesh);
        const bool flat = scratch::bytes_of(folder / "a.mesh").find("vertices\n3\n2\n") != std::string::npos;
        CHECK(flat == !std::signbit(z));
        CHECK(std::signbit(io::read_mfem(folder / "a.mesh").points[1][2]) == std::signbit(z));
    }
}

TEST_CASE("What MFEM cannot count, and a cell that has a vertex twice, are refused", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{2, 1};
    io::MeshColumns mesh = grid.columns();
    mesh.points = Column<double>{std::size_t{1} << 31, 3, {}};
    CHECK_THROWS_AS(io::write_mfem(folder / "a.mesh", mesh), FormatLimit);
    const std::vector<std::int64_t> twice{0, 0, 1};
    mesh = grid.columns();
    mesh.groups.clear();
    mesh.cells = Column<std::int64_t>::over(std::span{twice}, 3);
    CHECK_THROWS_WITH(io::write_mfem(folder / "a.mesh", mesh),
                      Catch::Contains("cell 0 has the vertex 0 twice"));
    CHECK(folder.file_count() == 0);
}

TEST_CASE("A damaged MFEM mesh is refused with line and entity", "[io]") {
    says(mfem_refusal("MFEM mesh", "mesh"), "this is no MFEM mesh");
    says(mfem_refusal("v1.0", "v1.3"), "only \"MFEM mesh v1.0\" is read");
    says(mfem_refusal("dimension\n2", "dimension\n4"), "line 6: dimension 1, 2 or 3 was expected");
    says(mfem_refusal("elements\n2", "elements\n1000000000000000000"),
         "line 9: 1000000000000000000 elements are claimed");
    says(mfem_refusal("vertices\n4", "vertices\n1000000000000000000"),
         "1000000000000000000 vertices are claimed");
    says(mfem_refusal("elements\n2", "elements\n3"), "line 13: an attribute was expected");
    says(mfem_refusal("7 2 0 2 3", "0 2 0 2 3"), "line 11: elements number 1 has the attribute 0");
    says(mfem_refusal("7 2 0 2 3", "7 3 0 2 3"), "line 11: elements number 1 has the geometry type 3");
    says(mfem_refusal("7 2 0 2 3", "7 2 0 2 4"), "element 1 has the vertex 4, but there are 4");
    says(mfem_refusal("4 1 3 0", "4 1 3 9"), "boundary element 3 has the vertex 9");
    says(mfem_refusal("4 1 3 0", "4 1 3 -1"), "line 19: a vertex's number was expected, not \"-1\"");
    says(mfem_refusal("1 1\n0", "1 inf\n0"), "vertex 2 has a coordinate that is not a finite number");
    says(mfem_refusal("4\n2\n0 0", "4\nnodes\n0 0"), "curved meshes");
    says(mfem_refusal("4\n2\n0 0", "4\n1\n0 0"), "2 to 3 coordinates were expected");
    says(mfem_refusal("0 1.5\n", "0 1.5\n7\n"), "the end of the file was expected");
    says(mfem_refusal("0 1.5\n", "0 1.5"), "the file seems to be cut short");
}

TEST_CASE("An MFEM mesh torn anywhere, or damaged at random, never does more than be refused", "[io]") {
    const scratch::Folder folder;
    for (std::size_t size = 0; size < small_mfem.size(); ++size) {
        CHECK(scratch::refusal(io::read_mfem, scratch::put(folder / "a.mesh", small_mfem.substr(0, size))) !=
              "");
    }
    CHECK(scratch::survive_damage(io::read_mfem, small_mfem, folder / "a.mesh", 5000) > 0);
    io::write_mfem(folder / "b.mesh", specimens::Grid(3, 2).columns());
    CHECK(scratch::survive_damage(io::read_mfem, scratch::bytes_of(folder / "b.mesh"), folder / "a.mesh",
                                  5000) > 0);
}
