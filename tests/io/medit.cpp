// SPDX-License-Identifier: BSD-3-Clause
#include "io/scratch.h"
#include "io/soups.h"
#include "io/specimens.h"
#include "slabhull/io/files.h"

#include <catch2/catch.hpp>

using namespace slabhull;
using scratch::fixture;
using soups::says;

namespace {

const std::string small_medit =
    "MeshVersionFormatted 2\n# a comment\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n"
    "0 1 0 0\n0 0 1 0\nTriangles\n1\n1 2 3 5\nTetrahedra\n1\n1 2 3 4 7\nEnd\n";

std::string medit_refusal(const std::string& from, const std::string& to) {
    return scratch::refusal(io::read_medit, "a.mesh", scratch::replaced(small_medit, from, to));
}

/// Checks that what the columns say is what the soup says, but for time and names.
void check_same(const io::Soup& soup, const specimens::Grid& grid) {
    const auto top = static_cast<std::size_t>(grid.dimension);
    CHECK(soup.points == Array<Point<3>>(grid.points.begin(), grid.points.end()));
    CHECK(soup.simplices[top].vertices == Array<Index>(grid.cells.begin(), grid.cells.end()));
    CHECK(soup.groups[top] == PatchList{{2, ""}, {5, ""}, {9, ""}});
    for (const auto& group : grid.columns().groups) {
        for (std::size_t cell = group.begin; cell < group.end; ++cell) {
            CHECK(soup.simplices[top].physical[cell] == group.number);
        }
    }
}

} // namespace

TEST_CASE("Gmsh's and meshio's Medit files of the cube have its volume, its areas and its groups", "[io]") {
    for (const char* name : {"coarse_gmsh.mesh", "coarse_meshio.mesh"}) {
        CAPTURE(name);
        const io::Soup soup = io::read_medit(fixture(name));
        CHECK(soup.top_dimension() == 3);
        CHECK(soups::volume(soup) == Approx(1));
        CHECK(soups::area(soup, 3) == Approx(1));
        CHECK(soups::area(soup, 4) == Approx(5));
        CHECK(soup.groups[3] == PatchList{{7, ""}});
    }
    const io::Soup copy = io::read_medit(fixture("coarse_meshio.mesh")); // Gmsh numbers anew, meshio does not
    const io::Soup msh = io::read_msh(fixture("coarse_22_ascii.msh"));
    CHECK(copy.points == msh.points);
    CHECK(copy.simplices[3].vertices == msh.simplices[3].vertices);
    CHECK(copy.simplices[2].physical == msh.simplices[2].physical);
}

TEST_CASE("What is written as Medit comes back bit for bit, with groups", "[io]") {
    const scratch::Folder folder;
    for (const specimens::Grid& grid :
         {specimens::Grid{1, 3}, specimens::Grid{1, 3000}, specimens::Grid{2, 9}, specimens::Grid{2, 70},
          specimens::Grid{3, 6}}) {
        io::write_medit(folder / "a.mesh", grid.columns());
        const io::Soup soup = io::read_medit(folder / "a.mesh");
        check_same(soup, grid);
        CHECK(soup.point_data.empty());
    }
}

TEST_CASE("The four-dimensional dialect keeps the time bit for bit", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{3, 12};
    io::write_medit(folder / "a.mesh", grid.columns(), {.four_dimensional = true});
    CHECK(scratch::bytes_of(folder / "a.mesh").starts_with("MeshVersionFormatted 2\nDimension 4\n"));
    const io::Soup soup = io::read_medit(folder / "a.mesh");
    check_same(soup, grid);
    REQUIRE(soup.find_point_data("t") != nullptr);
    CHECK(std::get<Array<double>>(soup.find_point_data("t")->values) ==
          Array<double>(grid.time.begin(), grid.time.end()));
}

TEST_CASE("The dialect without times is refused, and no file appears", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{3, 1};
    io::MeshColumns mesh = grid.columns();
    mesh.point_data.clear();
    CHECK_THROWS_AS(io::write_medit(folder / "a.mesh", mesh, {.four_dimensional = true}), UsageError);
    CHECK(folder.file_count() == 0);
}

TEST_CASE("References of vertices survive", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{2, 40};
    io::MeshColumns mesh = grid.columns();
    mesh.point_data = {{"medit:ref", io::Scalar::int64, Column<std::int64_t>::over(std::span{grid.ids})}};
    io::write_medit(folder / "a.mesh", mesh);
    const io::Soup soup = io::read_medit(folder / "a.mesh");
    REQUIRE(soup.find_point_data("medit:ref") != nullptr);
    CHECK(std::get<IntegerList>(soup.find_point_data("medit:ref")->values) ==
          Array<std::int64_t>(grid.ids.begin(), grid.ids.end()));
}

TEST_CASE("Two dimensions, comments between rows and passed sections are understood", "[io]") {
    const scratch::Folder folder;
    const std::string text =
        "MeshVersionFormatted\n1\nDimension\n2\n# comment\nVertices 3\n0 0 1\n# another\n"
        "1 0 1\n0 1 1 # third\nCorners\n2\n1 2\nNormals 1 0 1\nQuadrilaterals 0\n"
        "Edges 1\n1 2 8\nTriangles 1\n1 2 3 0\nEnd\n";
    const io::Soup soup = io::read_medit(scratch::put(folder / "a.mesh", text));
    CHECK(soup.points == Array<Point<3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(soup.simplices[1].vertices == Array<Index>{0, 1});
    CHECK(soup.groups[1] == PatchList{{8, ""}});
    CHECK(soup.groups[2].empty());
}

TEST_CASE("A damaged Medit file is refused with line and entity", "[io]") {
    says(medit_refusal("MeshVersionFormatted", "MeshVersion"), "line 1: this is no Medit file");
    says(medit_refusal("Dimension 3", "Dimension 5"), "line 3: dimension 2, 3 or 4 was expected");
    says(medit_refusal("Vertices\n4", "Vertices\n1000000000000000000"),
         "line 5: 1000000000000000000 vertices are claimed");
    says(medit_refusal("Tetrahedra\n1\n", "Tetrahedra\n1000000000000000000\n"),
         "1000000000000000000 Tetrahedra are claimed");
    says(medit_refusal("1 0 0 0", "1 nan 0 0"), "line 7: vertex 2 has a coordinate that is not a finite");
    says(medit_refusal("1 0 0 0", "1 0x 0 0"), "line 7: a vertex's coordinates was expected, not \"0x\"");
    says(medit_refusal("1 2 3 4 7", "1 2 3 5 7"),
         "line 15: Tetrahedra number 1 has the vertex 5, but vertices go from 1 to 4");
    says(medit_refusal("1 2 3 5", "0 2 3 5"), "line 12: Triangles number 1 has the vertex 0");
    says(medit_refusal("1 2 3 5", "1 2 3 -5"), "line 12: Triangles number 1 has the negative reference -5");
    says(medit_refusal("End\n", ""), "the file ends without End");
    says(medit_refusal("Triangles", "Quadrilaterals"), "Quadrilaterals are not read");
    says(medit_refusal("Triangles", "Triangels"), "\"Triangels\" is no keyword");
    says(medit_refusal("Tetrahedra", "Triangles"), "Triangles appears twice");
    says(medit_refusal("Vertices\n4", "Triangles\n0\nVertices\n4"),
         "Vertices were expected before Triangles");
}

TEST_CASE("A Medit file torn anywhere, or damaged at random, never does more than be refused", "[io]") {
    const scratch::Folder folder;
    for (std::size_t size = 0; size + 1 < small_medit.size(); ++size) {
        CHECK(scratch::refusal(io::read_medit,
                               scratch::put(folder / "a.mesh", small_medit.substr(0, size))) != "");
    }
    for (const char* name : {"coarse_gmsh.mesh", "coarse_meshio.mesh"}) {
        CHECK(scratch::survive_damage(io::read_medit, scratch::bytes_of(fixture(name)), folder / "a.mesh",
                                      2000) > 0);
    }
    CHECK(scratch::survive_damage(io::read_medit, small_medit, folder / "a.mesh", 5000) > 0);
}

TEST_CASE("Of second-order Medit elements the corners are taken where that is asked for", "[io]") {
    const scratch::Folder folder;
    const std::string curved =
        "MeshVersionFormatted 2\nDimension 3\nVertices\n11\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n.5 0 0 0\n"
        ".5 .5 0 0\n0 .5 0 0\n0 0 .5 0\n.5 0 .5 0\n0 .5 .5 0\n1 1 1 0\nTrianglesP2\n1\n1 2 3 5 6 7 5\n"
        "TetrahedraP2\n1\n1 2 3 4 5 6 7 8 9 10 7\nTetrahedra\n1\n2 3 4 11 8\nEnd\n";
    const auto path = scratch::put(folder / "a.mesh", curved);
    CHECK_THAT(scratch::refusal(io::read_medit, path),
               Catch::Contains("TrianglesP2 are of second order") && Catch::Contains("initial.linear"));
    const io::Soup soup = io::read_mesh(path, {true, ""});
    CHECK(soup.points == Array<Point<3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}});
    CHECK(soup.simplices[3].vertices == Array<Index>{0, 1, 2, 3, 1, 2, 3, 4});
    CHECK(soup.simplices[3].physical == std::vector<PatchNumber>{7, 8});
    CHECK(soup.simplices[2].vertices == Array<Index>{0, 1, 2});
    REQUIRE(soup.remarks.size() == 1);
    CHECK_THAT(soup.remarks[0], Catch::Contains("2 curved elements") && Catch::Contains("6 points"));
}
