// SPDX-License-Identifier: BSD-3-Clause
#include "io/scratch.h"
#include "io/soups.h"
#include "io/specimens.h"
#include "slabhull/io/files.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#ifdef TETLIBRARY
#include <tetgen.h>
#endif

using namespace slabhull;

namespace {

const std::string node = "# a cube's corner\n5 3 1 1 # header\n1 0 0 0 0.5 7\n2 1 0 0 1.5 -1\n3 0 1 0 2.5 0\n"
                         "\n4 0 0 1 3.5 2 # last\n5 1 1 1 4.5 2\n# the end\n";
const std::string ele = "2 4 1\n1 1 2 3 4 10\n2 5 2 3 4 20\n";
const std::string neigh = "2 4\n1 2 -1 -1 -1\n2 1 -1 -1 -1\n";
const std::string face = "2 1\n1 1 2 3 4\n2 1 2 4 -9\n";
const std::string smesh = "4 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n2 1\n3 0 1 2 5\n3 0 1 3 -5\n"
                          "1\n0 0.5 0.5 0.5\n2\n0 1 2 3 4 0.25\n1 1 2 3 5\n";
const std::string poly =
    "4 3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n2 1\n2 0 6\n3 1 2 3\n3 1 2 4\n1\n3 2 3 4\n0\n0\n";

/// The files of one mesh, any of which may be changed.
struct Files {
    scratch::Folder folder;
    Files() {
        for (const auto& [extension, text] : {std::pair{"node", node},
                                              {"ele", ele},
                                              {"neigh", neigh},
                                              {"face", face},
                                              {"smesh", smesh},
                                              {"poly", poly}}) {
            put(extension, text);
        }
    }
    std::filesystem::path path(const std::string& extension) const { return folder / ("a." + extension); }
    void put(const std::string& extension, const std::string& text) const {
        scratch::put(path(extension), text);
    }
};

std::string tetgen_refusal(const std::string& changed, const std::string& text,
                           const std::string& read = "ele") {
    const Files files;
    files.put(changed, text);
    return scratch::refusal(io::read_tetgen, files.path(read));
}

std::string tetgen_refusal(const std::string& changed, const std::string& text, const std::string& from,
                           const std::string& to, const std::string& read) {
    return tetgen_refusal(changed, scratch::replaced(text, from, to), read);
}

template<class T>
using Values = std::conditional_t<std::is_integral_v<T>, IntegerList, Array<T>>;

template<class T>
const Values<T>& values_of(const io::DataArray* array) {
    return soups::values<Values<T>>(array);
}

using Integers = IntegerList;
using Reals = Array<double>;

} // namespace

TEST_CASE("The files of a stem are read together, whatever they start to count from", "[io]") {
    const Files files;
    for (const char* name : {"node", "ele"}) {
        const io::Soup soup = io::read_tetgen(files.path(name));
        REQUIRE(soup.points.size() == 5);
        CHECK(soup.points[3] == Point<3>{0, 0, 1});
        CHECK(soup.point_tag(3) == 4);
        CHECK(soup.simplices[3].vertices == Array<Index>{0, 1, 2, 3, 4, 1, 2, 3});
        CHECK(soup.simplices[3].tag(1) == 2);
        CHECK(soup.simplices[2].vertices == Array<Index>{0, 1, 2, 0, 1, 3});
        CHECK(soup.simplices[2].physical == std::vector<PatchNumber>{4, 0});
        CHECK(soup.groups[2] == PatchList{{4, ""}});
        CHECK(values_of<double>(soup.find_point_data("attribute_0")) == Reals{0.5, 1.5, 2.5, 3.5, 4.5});
        CHECK(values_of<std::int64_t>(soup.find_point_data("marker")) == Integers{7, -1, 0, 2, 2});
        CHECK(values_of<double>(soup.find_cell_data("attribute_0")) == Reals{10, 20});
        CHECK(values_of<std::int64_t>(soup.find_cell_data("neighbors")) ==
              Integers{1, -1, -1, -1, 0, -1, -1, -1});
    }
    const io::Soup faces = io::read_tetgen(files.path("face"));
    CHECK(faces.top_dimension() == 2);
    CHECK(values_of<std::int64_t>(faces.find_cell_data("marker")) == Integers{4, -9});
}

TEST_CASE("Piecewise linear complexes of triangles are read, with holes and regions", "[io]") {
    const Files files;
    const io::Soup flat = io::read_tetgen(files.path("smesh"));
    CHECK(flat.simplices[2].vertices == Array<Index>{0, 1, 2, 0, 1, 3});
    CHECK(flat.simplices[2].physical == std::vector<PatchNumber>{5, 0});
    CHECK(values_of<double>(flat.find_field_data("holes")) == Reals{0.5, 0.5, 0.5});
    CHECK(values_of<double>(flat.find_field_data("regions")) == Reals{1, 2, 3, 4, 0.25, 1, 2, 3, 5, -1});
    const io::Soup nested = io::read_tetgen(files.path("poly"));
    CHECK(nested.simplices[2].vertices == Array<Index>{0, 1, 2, 0, 1, 3, 1, 2, 3});
    CHECK(nested.simplices[2].physical == std::vector<PatchNumber>{6, 6, 0});
    files.put("smesh", "0 3\n1 0\n3 1 2 5\n0\n");
    CHECK(io::read_tetgen(files.path("smesh")).points.size() == 5); // from the .node file
}

TEST_CASE("Triangle's planar files are read", "[io]") {
    const scratch::Folder folder;
    scratch::put(folder / "a.node", "3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n");
    scratch::put(folder / "a.ele", "1 3 0\n0 0 1 2\n");
    const io::Soup soup = io::read_tetgen(folder / "a.ele");
    CHECK(soup.simplices[2].vertices == Array<Index>{0, 1, 2});
    CHECK(soup.points[2] == Point<3>{0, 1, 0});
}

TEST_CASE("Faults in TetGen's files are refused with file, line and entity", "[io]") {
    using Catch::Contains;
    CHECK_THAT(tetgen_refusal("ele", ele, "1 1 2 3 4", "1 1 2 3 6", "ele"),
               Contains("cell 1 names point 6") && Contains("line 2"));
    CHECK_THAT(tetgen_refusal("ele", ele, "1 1 2 3 4", "1 1 2 3 0", "ele"), Contains("point 0"));
    CHECK_THAT(tetgen_refusal("ele", ele, "1 1 2 3 4", "1 1 2 nan 4", "ele"), Contains("\"nan\""));
    CHECK_THAT(tetgen_refusal("ele", ele, "2 5", "3 5", "ele"), Contains("cell 2 was expected, not 3"));
    CHECK_THAT(tetgen_refusal("ele", ele, "2 4 1", "2 10 1", "ele"), Contains("10 nodes"));
    CHECK_THAT(tetgen_refusal("ele", ele, "2 4 1", "2 7 1", "ele"), Contains("7 corners"));
    CHECK_THAT(tetgen_refusal("ele", ele, "4 10", "4 10 11", "ele"), Contains("more values"));
    CHECK_THAT(tetgen_refusal("ele", ele, "4 20", "4", "ele"), Contains("an attribute was expected"));
    CHECK_THAT(tetgen_refusal("ele", ele + "3 1 2 3 5 1\n"), Contains("more rows"));
    CHECK_THAT(tetgen_refusal("node", node, "2 1 0 0", "2 1 inf 0", "ele"), Contains("point 2 has"));
    CHECK_THAT(tetgen_refusal("node", node, "\n1 0", "\n7 0", "ele"), Contains("not 0 or 1"));
    CHECK_THAT(tetgen_refusal("node", node, "5 3 1 1", "5 4 1 1", "ele"), Contains("4 dimensions"));
    CHECK_THAT(tetgen_refusal("node", "junk"), Contains("counts were expected"));
    CHECK_THAT(tetgen_refusal("neigh", neigh, "1 2 -1", "1 -1 2", "ele"),
               Contains("no neighbor of cell 1 opposite to its corner 1"));
    CHECK_THAT(tetgen_refusal("neigh", neigh, "1 2 -1", "1 3 -1", "ele"), Contains("cell 3 is no neighbor"));
    CHECK_THAT(tetgen_refusal("neigh", "1 4\n1 -1 -1 -1 -1\n"),
               Contains("1 rows of 4 neighbors for 2 cells"));
    CHECK_THAT(tetgen_refusal("smesh", smesh, "3 0 1 2 5", "4 0 1 2 3 5", "smesh"),
               Contains("facet 0") && Contains("4 corners"));
    CHECK_THAT(tetgen_refusal("poly", poly, "2 0 6", "2 1 6", "poly"), Contains("facet 1 has holes"));
    CHECK_THAT(scratch::refusal(io::read_tetgen, "/nowhere/a.ele"), Contains("No such file"));
    CHECK_THAT(scratch::refusal(io::read_tetgen, "/nowhere/a.vtu"), Contains(".node"));
}

TEST_CASE("Huge claimed counts in TetGen's files are refused before memory is asked for", "[io]") {
    using Catch::Contains;
    const std::string huge = "1000000000000000000";
    CHECK_THAT(tetgen_refusal("node", node, "5 3", huge + " 3", "ele"), Contains(huge));
    CHECK_THAT(tetgen_refusal("node", node, "3 1 1", "3 " + huge + " 1", "ele"), Contains(huge));
    CHECK_THAT(tetgen_refusal("ele", ele, "2 4", huge + " 4", "ele"), Contains(huge));
    CHECK_THAT(tetgen_refusal("neigh", neigh, "2 4", huge + " 4", "ele"), Contains(huge));
    CHECK_THAT(tetgen_refusal("face", face, "2 1", huge + " 1", "face"), Contains(huge));
    CHECK_THAT(tetgen_refusal("smesh", smesh, "2 1", huge + " 1", "smesh"), Contains(huge));
    CHECK_THAT(tetgen_refusal("poly", poly, "2 0 6", huge + " 0 6", "poly"), Contains(huge));
    CHECK_THAT(tetgen_refusal("ele", ele, "2 4", "18446744073709551616 4", "ele"),
               Contains("counts were expected"));
}

TEST_CASE("TetGen's files cut short or damaged anywhere are refused or read as a consistent soup", "[io]") {
    const Files files;
    int refused = 0;
    for (const auto& [extension, text] : {std::pair{"node", node},
                                          {"ele", "# attributes: a:real:1\n" + ele},
                                          {"neigh", neigh},
                                          {"face", face},
                                          {"smesh", smesh},
                                          {"poly", poly}}) {
        const bool alone = extension == std::string{"smesh"} || extension == std::string{"poly"};
        const auto read = [&](const std::filesystem::path& path) {
            const io::Soup soup = io::read_tetgen(alone ? path : files.path("ele"));
            CHECK(soups::is_consistent(soup));
        };
        refused += scratch::survive_damage(read, text, files.path(extension), 2000);
        for (std::size_t size = 0; size < text.size(); ++size) {
            refused +=
                scratch::refusal(read, scratch::put(files.path(extension), text.substr(0, size))).empty() ? 0
                                                                                                          : 1;
        }
        files.put(extension, text);
    }
    CHECK(refused > 1000);
}

TEST_CASE("Tetrahedra written as TetGen's files come back bit for bit", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{3, 5};
    io::MeshColumns mesh = grid.columns();
    const std::vector<double> odd{-0.0, 5e-324, 1e308, 0.1};
    mesh.point_data.push_back(
        {"a b:c", io::Scalar::float64,
         Column<double>{grid.points.size(), 1, [&](std::size_t begin, std::size_t end, double* out) {
                            for (; begin < end; ++begin) {
                                *out++ = odd[begin % odd.size()];
                            }
                        }}});
    mesh.point_data.push_back(
        {"marker", io::Scalar::int32, Column<std::int64_t>::constant(grid.points.size(), -4)});
    io::write_tetgen(folder / "a.b", mesh);
    const io::Soup soup = io::read_tetgen(folder / "a.b.ele");
    CHECK(soup.points == Array<Point<3>>(grid.points.begin(), grid.points.end()));
    CHECK(soup.simplices[3].vertices == Array<Index>(grid.cells.begin(), grid.cells.end()));
    CHECK(values_of<double>(soup.find_point_data("t")) == Reals(grid.time.begin(), grid.time.end()));
    CHECK(values_of<std::int64_t>(soup.find_point_data("vertex_id")) ==
          Array<std::int64_t>(grid.ids.begin(), grid.ids.end()));
    const auto& back = values_of<double>(soup.find_point_data("a b:c"));
    CHECK(std::signbit(back[0]));
    CHECK(std::equal(odd.begin(), odd.end(), back.begin()));
    CHECK(values_of<std::int64_t>(soup.find_point_data("marker")).at(3) == -4);
    CHECK(soup.find_cell_data("pair")->components == 2);
    CHECK(values_of<std::int64_t>(soup.find_cell_data("pair")) ==
          Array<std::int64_t>(grid.pairs.begin(), grid.pairs.end()));
    CHECK(soup.simplices[3].physical.front() == 5);
    CHECK(soup.simplices[3].physical.back() == 9);
    CHECK(soup.groups[3] == PatchList{{2, ""}, {5, ""}, {9, ""}});
    CHECK(soup.cell_data.size() == mesh.cell_data.size());
}

TEST_CASE("Triangles with markers, holes and adjacency of tetrahedra survive TetGen's files", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{2, 5};
    io::MeshColumns mesh = grid.columns();
    mesh.field_data = {{"holes", 3, Reals{0.1, 0.2, 0.3}}, {"regions", 5, Reals{1, 2, 3, 4, 5}}};
    io::write_tetgen(folder / "a", mesh);
    for (const char* name : {"a.face", "a.smesh"}) {
        const io::Soup soup = io::read_tetgen(folder / name);
        CHECK(soup.points == Array<Point<3>>(grid.points.begin(), grid.points.end()));
        CHECK(soup.simplices[2].vertices == Array<Index>(grid.cells.begin(), grid.cells.end()));
        CHECK(soup.simplices[2].physical.front() == 5);
        CHECK(soup.groups[2] == PatchList{{2, ""}, {5, ""}, {9, ""}});
    }
    io::AtomicFiles files_of_poly;
    io::write_tetgen(files_of_poly, folder / "p.POLY", mesh);
    files_of_poly.commit();
    CHECK(folder.file_count() == 6); // .node and .face twice, .smesh, .poly
    const io::Soup nested = io::read_tetgen(folder / "p.poly");
    const io::Soup soup = io::read_tetgen(folder / "a.smesh");
    CHECK(nested.points == soup.points);
    CHECK(nested.simplices[2].vertices == soup.simplices[2].vertices);
    CHECK(nested.simplices[2].physical == soup.simplices[2].physical);
    CHECK(values_of<double>(nested.find_field_data("regions")) == Reals{1, 2, 3, 4, 5});
    CHECK(values_of<double>(soup.find_field_data("holes")) == Reals{0.1, 0.2, 0.3});
    CHECK(values_of<double>(soup.find_field_data("regions")) == Reals{1, 2, 3, 4, 5});
    const Files files;
    const io::Soup cells = io::read_tetgen(files.path("ele"));
    const auto& neighbors = values_of<std::int64_t>(cells.find_cell_data("neighbors"));
    io::MeshColumns both;
    both.points = Column<double>::over(std::span{cells.points.front().data(), 3 * cells.points.size()}, 3);
    both.cells = Column<std::int64_t>::over(std::span{cells.simplices[3].vertices}, 4);
    both.cell_data = {{"neighbors", io::Scalar::int64, integer_column(neighbors, 4)}};
    io::write_tetgen(folder / "b", both);
    CHECK(values_of<std::int64_t>(io::read_tetgen(folder / "b.ele").find_cell_data("neighbors")) ==
          neighbors);
}

TEST_CASE("TetGen's files appear all or not at all, and lines are refused", "[io]") {
    const scratch::Folder folder;
    std::filesystem::create_directory(folder / "a.ele"); // which no file can replace
    CHECK_THROWS_AS(io::write_tetgen(folder / "a", specimens::Grid{3, 1}.columns()), OutputError);
    CHECK_THROWS_AS(io::write_tetgen(folder / "b", specimens::Grid{1, 1}.columns()), FormatLimit);
    CHECK(folder.file_count() == 1);
}

TEST_CASE("TetGen files of cells that their name does not fit, or beside those of another mesh, are refused",
          "[io]") {
    const scratch::Folder folder;
    const auto write = [&](const char* name, int dimension) {
        io::AtomicFiles files;
        io::write_tetgen(files, folder / name, specimens::Grid{dimension, 1}.columns());
        files.commit();
    };
    for (const char* name : {"a.face", "a.smesh", "a.poly"}) {
        CHECK_THROWS_AS(write(name, 3), FormatLimit);
    }
    CHECK_THROWS_AS(write("a.ele", 2), FormatLimit);
    CHECK(folder.file_count() == 0);
    write("a.ele", 3);
    CHECK_THROWS_AS(write("a.node", 2), OutputError); // a.ele would be read with its points
    CHECK(io::read_tetgen(folder / "a.node").simplices[3].size(3) == 6);
    CHECK(folder.file_count() == 2);
}

#ifdef TETLIBRARY
TEST_CASE("TetGen reads what we write", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{3, 4};
    io::write_tetgen(folder / "a", grid.columns());
    tetgenio seen;
    std::string stem = folder / "a";
    REQUIRE(seen.load_tetmesh(stem.data(), static_cast<int>(tetgenbehavior::MESH)));
    REQUIRE(static_cast<std::size_t>(seen.numberofpoints) == grid.points.size());
    CHECK(std::equal(seen.pointlist, seen.pointlist + 3 * seen.numberofpoints, grid.points.front().data()));
    REQUIRE(static_cast<std::size_t>(seen.numberoftetrahedra) == grid.cell_count());
    CHECK(std::equal(grid.cells.begin(), grid.cells.end(), seen.tetrahedronlist));
    CHECK(seen.numberofpointattributes == 2);
    CHECK(seen.pointattributelist[2] == grid.time[1]);
    CHECK(seen.numberoftetrahedronattributes == 4); // group, pair, region
    CHECK(seen.tetrahedronattributelist[0] == 5);
}

TEST_CASE("TetGen meshes a surface that we write, and we read all that it saves", "[io]") {
    const scratch::Folder folder;
    const Files files;
    const Array<double> x{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const Integers corners{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    io::MeshColumns mesh;
    mesh.dimension = 2;
    mesh.points = Column<double>::over(std::span<const double>{x}, 3);
    mesh.cells = integer_column(corners, 3);
    mesh.groups = {{0, 3, 8, "sides"}, {3, 4, 6, "slope"}};
    io::AtomicFiles files_of_poly;
    io::write_tetgen(files_of_poly, folder / "p.poly", mesh);
    files_of_poly.commit();
    tetgenio nested;
    std::string poly_stem = folder / "p";
    REQUIRE(nested.load_poly(poly_stem.data()));
    REQUIRE(nested.numberoffacets == 4);
    CHECK(nested.facetmarkerlist[3] == 6);
    CHECK(nested.facetlist[1].polygonlist[0].vertexlist[2] == 3);
    io::write_tetgen(folder / "a", mesh);
    tetgenio surface;
    tetgenio cells;
    std::string stem = folder / "a";
    REQUIRE(surface.load_plc(stem.data(), static_cast<int>(tetgenbehavior::POLY)));
    std::string switches = "pqa0.01nnfQ";
    tetrahedralize(switches.data(), &surface, &cells);
    std::string saved = folder / "b";
    cells.save_nodes(saved.data());
    cells.save_elements(saved.data());
    cells.save_faces(saved.data());
    cells.save_neighbors(saved.data());
    const io::Soup soup = io::read_tetgen(folder / "b.ele");
    CHECK(soups::volume(soup) == Approx(1.0 / 6));
    CHECK(soup.simplices[3].size(3) == static_cast<std::size_t>(cells.numberoftetrahedra));
    CHECK(soup.find_cell_data("neighbors") != nullptr);
    CHECK(soups::area(soup, 8) == Approx(1.5));
    CHECK(soups::area(soup, 6) == Approx(std::sqrt(3.0) / 2));
}
#endif

TEST_CASE("Of second-order TetGen files the corners are taken where that is asked for", "[io]") {
    const Files files;
    std::string nodes = "10 3\n";
    for (int k = 0; k < 10; ++k) { // corners first, then the middles of 12 13 14 23 24 34
        const std::array<double, 10> x{0, 1, 0, 0, .5, 0, 0, .5, .5, 0};
        const std::array<double, 10> y{0, 0, 1, 0, 0, .5, 0, .5, 0, .5};
        const std::array<double, 10> z{0, 0, 0, 1, 0, 0, .5, 0, .5, .5};
        const auto i = static_cast<std::size_t>(k);
        nodes += fmt::format("{} {} {} {}\n", k + 1, x[i], y[i], z[i]);
    }
    files.put("node", nodes);
    files.put("ele", "1 10 1\n1 1 2 3 4 5 6 7 8 9 10 3\n");
    files.put("neigh", "1 4\n1 -1 -1 -1 -1\n");
    files.put("face", "2 1\n1 1 2 3 5 8 6 4\n2 1 2 4 5 9 7 -9\n");
    CHECK_THAT(scratch::refusal(io::read_tetgen, files.path("ele")),
               Catch::Contains("10 nodes") && Catch::Contains("initial.linear"));
    CHECK_THAT(scratch::refusal(io::read_tetgen, files.path("face")),
               Catch::Contains("6 nodes") && Catch::Contains("initial.linear"));
    const io::Soup soup = io::read_mesh(files.path("ele"), {true, ""});
    CHECK(soup.points == Array<Point<3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    CHECK(soup.simplices[3].vertices == Array<Index>{0, 1, 2, 3});
    CHECK(soup.simplices[2].vertices == Array<Index>{0, 1, 2, 0, 1, 3});
    CHECK(soup.simplices[2].physical == std::vector<PatchNumber>{4, 0}); // markers, not middle nodes
    REQUIRE(soup.remarks.size() == 1);
    CHECK_THAT(soup.remarks[0], Catch::Contains("3 curved elements") && Catch::Contains("6 points"));
    files.put("face", "1 1\n1 1 2 3 5 8 4 4 4 4 4\n");
    CHECK_THAT(scratch::refusal(io::read_tetgen, files.path("face")), Catch::Contains("has 11 values"));
}
