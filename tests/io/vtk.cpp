// SPDX-License-Identifier: BSD-3-Clause
#include "io/scratch.h"
#include "io/soups.h"
#include "io/specimens.h"
#include "slabhull/core/parallel.h"
#include "slabhull/io/files.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace slabhull;
using scratch::fixture;
using soups::is_consistent;
using soups::values;

namespace {

const std::string head = "# vtk DataFile Version 3.0\na title\nASCII\n";
const std::string small = head + "DATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0 1 0 0 0 1 0\n0 0 1\n"
                                 "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n";
const std::string mixed = head + "DATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n"
                                 "CELLS 4 14\n3 0 1 2\n4 0 1 2 3\n2 1 3\n1 2\nCELL_TYPES 4\n5 10 3 1\n"
                                 "CELL_DATA 4\nSCALARS kind char 1\nLOOKUP_TABLE default\n5 10 -3 1\n";
const std::string surface = head + "DATASET POLYDATA\nPOINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 1\n"
                                   "LINES 1 3\n2 0 1\nPOLYGONS 2 8\n3 0 1 2\n3 0 1 3\n"
                                   "CELL_DATA 3\nFIELD f 1\nnumber 2 3 unsigned_long\n1 2 3 4 5 6\n";

io::Soup read_text(const std::string& text) {
    const scratch::Folder folder;
    return io::read_vtk(scratch::put(folder / "a.vtk", text));
}

std::string text_refusal(const std::string& text) {
    return scratch::refusal(io::read_vtk, "a.vtk", text);
}

std::string text_refusal(const std::string& from, const std::string& to) {
    return text_refusal(scratch::replaced(small, from, to));
}

std::string written(const io::MeshColumns& mesh) {
    const scratch::Folder folder;
    io::AtomicFile file{folder / "a.vtk"};
    io::write_vtk(file, mesh);
    file.commit();
    return scratch::bytes_of(folder / "a.vtk");
}

const char* const fixtures[] = {"vtk_42_ascii.vtk",    "vtk_42_binary.vtk",   "vtk_51_ascii.vtk",
                                "vtk_51_binary.vtk",   "meshio_42_ascii.vtk", "meshio_42_binary.vtk",
                                "meshio_51_ascii.vtk", "meshio_51_binary.vtk"};

} // namespace

TEST_CASE("VTK's and meshio's legacy files hold the same mesh in each version and encoding", "[io]") {
    const io::Soup gmsh = io::read_msh(fixture("coarse_41_binary.msh"));
    for (const char* name : fixtures) {
        CAPTURE(name);
        const io::Soup soup = io::read_vtk(fixture(name));
        CHECK(soups::volume(soup) == Approx(1));
        CHECK(soup.simplices[3].vertices == gmsh.simplices[3].vertices);
        soups::check_point_data(soup);
        CHECK(values<Array<std::int64_t>>(soup.find_cell_data("number")).at(5) == 5);
        CHECK(is_consistent(soup));
    }
}

TEST_CASE("VTK's strings, attributes, names with blanks and 64-bit integers are read", "[io]") {
    for (const char* name : {fixtures[0], fixtures[1], fixtures[2], fixtures[3]}) {
        CAPTURE(name);
        const io::Soup soup = io::read_vtk(fixture(name));
        CHECK(values<std::vector<std::string>>(soup.find_field_data("patch_name")) ==
              std::vector<std::string>{"in let", "", std::string(100, 'w')});
        CHECK(values<Array<std::int64_t>>(soup.find_point_data("long ids")).at(3) == 1000000000003);
        CHECK(values<Array<std::int64_t>>(soup.find_point_data("signed")).at(3) == -3);
        CHECK(soup.find_cell_data("tensor")->components == 9);
        CHECK(values<Array<double>>(soup.find_point_data("after")).at(1) == 0.5);
    }
}

TEST_CASE("VTK's triangles as POLYDATA are read", "[io]") {
    const io::Soup gmsh = io::read_msh(fixture("coarse_41_binary.msh"));
    for (const char* name : {"vtk_poly_42.vtk", "vtk_poly_51.vtk"}) {
        CAPTURE(name);
        const io::Soup soup = io::read_vtk(fixture(name));
        CHECK(soup.top_dimension() == 2);
        CHECK(soup.simplices[2].vertices == gmsh.simplices[2].vertices);
    }
}

TEST_CASE("Mixed cells are parted by dimension, keep their numbers, and data go with the largest", "[io]") {
    const io::Soup soup = read_text(mixed);
    CHECK(soup.simplices[3].vertices == Array<Index>{0, 1, 2, 3});
    CHECK(soup.simplices[2].vertices == Array<Index>{0, 1, 2});
    CHECK(soup.simplices[1].vertices == Array<Index>{1, 3});
    CHECK(soup.simplices[0].vertices == Array<Index>{2});
    CHECK(soup.simplices[1].tag(0) == 2);
    CHECK(values<Array<std::int64_t>>(soup.find_cell_data("kind")) == Array<std::int64_t>{10});
    const io::Soup skin = read_text(surface);
    CHECK(skin.simplices[2].vertices == Array<Index>{0, 1, 2, 0, 1, 3});
    CHECK(values<Array<std::int64_t>>(skin.find_cell_data("number")) == Array<std::int64_t>{3, 4, 5, 6});
}

TEST_CASE("Colours and metadata are passed over, plain SCALARS need no table", "[io]") {
    const io::Soup soup = read_text(scratch::replaced(small, "CELLS", "METADATA\nINFORMATION 0\n\nCELLS") +
                                    "POINT_DATA 4\nCOLOR_SCALARS c 2\n0 0 0 0 0 0 0 0\nLOOKUP_TABLE t 1\n"
                                    "0 0 0 1\nSCALARS s int\n1 2 3 4\nTEXTURE_COORDINATES u 2 float\n"
                                    "0 1 2 3 4 5 6 7\nGLOBAL_IDS g vtkIdType\n4 3 2 1\n");
    REQUIRE(soup.point_data.size() == 3);
    CHECK(values<Array<std::int64_t>>(soup.find_point_data("s")).at(3) == 4);
    CHECK(soup.find_point_data("u")->components == 2);
    CHECK(values<Array<std::int64_t>>(soup.find_point_data("g")).at(0) == 4);
}

TEST_CASE("A legacy file that we do not read is refused by name", "[io]") {
    using Catch::Contains;
    CHECK(text_refusal(small).empty());
    CHECK_THAT(text_refusal("junk"), Contains("no VTK file"));
    CHECK_THAT(text_refusal("3.0", "6.1"), Contains("version 6.1"));
    CHECK_THAT(text_refusal("ASCII", "HEX"), Contains("BINARY was expected") && Contains("line 3"));
    CHECK_THAT(text_refusal("UNSTRUCTURED_GRID", "STRUCTURED_POINTS"), Contains("structured_points"));
    CHECK_THAT(text_refusal("\n10", "\n12"), Contains("cell 0 is a hexahedron"));
    CHECK_THAT(text_refusal("\n10", "\n5"), Contains("cell 0, a triangle, has not 3 vertices"));
    CHECK_THAT(text_refusal("double", "bit"), Contains("\"bit\""));
    CHECK_THAT(text_refusal(scratch::replaced(surface, "2 8\n3 0 1 2\n3 ", "2 9\n4 0 1 2 3\n3 ")),
               Contains("cell 1, a triangle"));
    CHECK_THAT(text_refusal(scratch::replaced(surface, "POLYGONS", "TRIANGLE_STRIPS")), Contains("strips"));
    CHECK_THAT(text_refusal(surface + "LINES 1 3\n2 0 1\n"), Contains("\"lines\""));
}

TEST_CASE("Faults in a legacy file are refused with line and cell, point or array", "[io]") {
    using Catch::Contains;
    CHECK_THAT(text_refusal("4 0 1 2 3", "4 0 1 2 4"),
               Contains("cell 0 names point 4") && Contains("line 9"));
    CHECK_THAT(text_refusal("4 0 1 2 3", "4 0 1 2 -1"), Contains("cell 0 names point -1"));
    CHECK_THAT(text_refusal("4 0 1 2 3", "4 0 1 nan 3"), Contains("\"nan\""));
    CHECK_THAT(text_refusal("4 0 1 2 3", "5 0 1 2 3"), Contains("cell 0 with 5 vertices"));
    CHECK_THAT(text_refusal("4 0 1 2 3", "-4 0 1 2 3"), Contains("cell 0 with -4 vertices"));
    CHECK_THAT(text_refusal("4 0 1 2 3", "3 0 1 2"), Contains("1 more than"));
    CHECK_THAT(text_refusal("0 0 1\n", "0 0 nan\n"), Contains("point 3"));
    CHECK_THAT(text_refusal("0 0 1\n", "0 0 1e999\n"), Contains("1e999"));
    CHECK_THAT(text_refusal("TYPES 1", "TYPES 2"), Contains("2 cell types for 1"));
    CHECK_THAT(text_refusal("CELL_TYPES 1\n10\n", ""), Contains("CELL_TYPES"));
    CHECK_THAT(text_refusal("CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n", ""), Contains("no cells"));
    CHECK_THAT(text_refusal(small + "POINT_DATA 3\n"), Contains("3 points, but there are 4"));
    CHECK_THAT(text_refusal(small + "POINT_DATA 4\nFIELD f 1\np 1 3 int\n1 2 3"), Contains("array \"p\""));
    CHECK_THAT(text_refusal(small + "POINT_DATA 4\nSCALARS p char\n1 2 3 400"), Contains("400 does not fit"));
    CHECK_THAT(text_refusal(small + "CELL_DATA 1\nSCALARS p unsigned_long\n18446744073709551615"),
               Contains("too large"));
    CHECK_THAT(text_refusal(small + "CELL_DATA 1\nVECTORS p int\n1 2"), Contains("\"p\""));
    CHECK_THAT(text_refusal(small + "CELL_DATA 1\nPICTURES p int\n1"), Contains("\"pictures\""));
    CHECK_THAT(scratch::refusal(io::read_vtk, "/nowhere/a.vtk"), Contains("No such file"));
}

TEST_CASE("Huge claimed counts in a legacy file are refused before memory is asked for", "[io]") {
    using Catch::Contains;
    const std::string huge = "1000000000000000000";
    CHECK_THAT(text_refusal("POINTS 4", "POINTS " + huge), Contains(huge + " points are claimed"));
    CHECK_THAT(text_refusal("CELLS 1 5", "CELLS 1 " + huge), Contains(huge));
    CHECK_THAT(text_refusal("CELLS 1 5", "CELLS " + huge + " " + huge), Contains(huge));
    CHECK_THAT(text_refusal("CELLS 1 5", "CELLS 18446744073709551616 5"), Contains("count of cells"));
    CHECK_THAT(text_refusal("TYPES 1", "TYPES " + huge), Contains(huge));
    CHECK_THAT(text_refusal(small + "FIELD f " + huge + "\na 1 1 int\n1\n"), !Catch::Equals(""));
    CHECK_THAT(text_refusal(small + "FIELD f 1\na 1 " + huge + " int\n1\n"), Contains(huge));
    CHECK_THAT(text_refusal(small + "FIELD f 1\na " + huge + " 1 int\n1\n"), Contains(huge));
    CHECK_THAT(text_refusal(small + "FIELD f 1\na 1 " + huge + " string\n1\n"), Contains(huge));
    const std::string offsets = scratch::replaced(small, "3.0", "5.1");
    CHECK_THAT(text_refusal(scratch::replaced(offsets, "CELLS 1 5\n4",
                                              "CELLS 2 " + huge + "\nOFFSETS vtktypeint64\n0 " + huge +
                                                  "\nCONNECTIVITY vtktypeint64\n")),
               Contains(huge));
}

TEST_CASE("A legacy file cut short or damaged anywhere is refused or read as a consistent soup", "[io]") {
    const scratch::Folder folder;
    const auto read = [](const std::filesystem::path& path) {
        const io::Soup soup = io::read_vtk(path); // outside CHECK, which would catch what it throws
        CHECK(is_consistent(soup));
    };
    std::vector<std::string> files{small, mixed, surface, written(specimens::Grid{3, 2}.columns())};
    for (const char* name : fixtures) {
        files.push_back(scratch::bytes_of(fixture(name)));
    }
    for (const std::string& bytes : files) {
        CHECK(scratch::survive_damage(read, bytes, folder / "a.vtk", 1000) > 0);
        for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 500) {
            scratch::refusal(read, scratch::put(folder / "a.vtk", bytes.substr(0, size)));
        }
    }
}

TEST_CASE("A binary legacy file of ours cut short within its data is refused", "[io]") {
    const std::string bytes = written(specimens::Grid{2, 2}.columns());
    const std::size_t sections = bytes.find("pair 2"); // before it, a file may end at a section
    for (std::size_t size = sections; size + 1 < bytes.size(); ++size) {
        CAPTURE(size, bytes.size());
        CHECK(text_refusal(bytes.substr(0, size)).find("byte ") != std::string::npos);
    }
}

TEST_CASE("What is written as legacy VTK comes back bit for bit", "[io]") {
    for (const specimens::Grid& grid :
         {specimens::Grid{1, 1}, specimens::Grid{1, 9}, specimens::Grid{2, 1}, specimens::Grid{2, 9},
          specimens::Grid{3, 1}, specimens::Grid{3, 6}}) {
        const io::Soup soup = read_text(written(grid.columns()));
        const auto top = static_cast<std::size_t>(grid.dimension);
        CHECK(soup.points == Array<Point<3>>(grid.points.begin(), grid.points.end()));
        CHECK(soup.simplices[top].vertices == Array<Index>(grid.cells.begin(), grid.cells.end()));
        CHECK(values<Array<double>>(soup.find_point_data("t")) ==
              Array<double>(grid.time.begin(), grid.time.end()));
        CHECK(values<Array<std::int64_t>>(soup.find_point_data("vertex_id")) ==
              Array<std::int64_t>(grid.ids.begin(), grid.ids.end()));
        REQUIRE(soup.cell_data.size() == 2);
        CHECK(soup.find_cell_data("pair")->components == 2);
        CHECK(values<Array<std::int64_t>>(soup.find_cell_data("pair")) ==
              Array<std::int64_t>(grid.pairs.begin(), grid.pairs.end()));
        REQUIRE(soup.field_data.size() == 3);
        CHECK(values<Array<double>>(soup.find_field_data("time")) == Array<double>{0.1, 1.0 / 3});
        CHECK(values<std::vector<std::string>>(soup.find_field_data("patch_name")) ==
              std::vector<std::string>{"walls & doors", "", "fan <1>"});
    }
}

TEST_CASE("Odd values, names and texts survive a legacy file", "[io]") {
    const specimens::Grid grid{3, 1};
    io::MeshColumns mesh = grid.columns();
    const std::vector<double> odd{-0.0, 5e-324, 1e308, std::numeric_limits<double>::quiet_NaN(), 1, 2, 3, 4};
    mesh.point_data = {
        {"a \"b\"\n100%41 \xc3\xa9", io::Scalar::float64, Column<double>::over(std::span{odd})}};
    mesh.field_data = {{"none", 1, std::vector<std::string>{}},
                       {"texts", 1, std::vector<std::string>{"a\nb", ""}}};
    const io::Soup soup = read_text(written(mesh));
    const auto& back = values<Array<double>>(soup.find_point_data(mesh.point_data[0].name));
    CHECK(std::memcmp(back.data(), odd.data(), odd.size() * sizeof(double)) == 0);
    CHECK(values<std::vector<std::string>>(soup.find_field_data("none")).empty());
    CHECK(values<std::vector<std::string>>(soup.find_field_data("texts")) ==
          std::vector<std::string>{"a\nb", ""});
}

TEST_CASE("More cells than a legacy file counts are an error before anything is written", "[io]") {
    io::MeshColumns mesh;
    mesh.points = Column<double>{4, 3, [](auto, auto, double*) {}};
    mesh.cells = Column<std::int64_t>{429496730, 4, [](auto, auto, std::int64_t*) {}};
    CHECK_THROWS_AS(written(mesh), FormatLimit);
}

TEST_CASE("The bytes of a legacy file do not depend on the number of threads", "[io]") {
    const specimens::Grid grid{3, 30};
    set_thread_count(1);
    const std::string one = written(grid.columns());
    set_thread_count(5);
    CHECK(one == written(grid.columns()));
    set_thread_count(0);
}
