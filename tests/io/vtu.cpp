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

namespace {

io::Soup read_any(const std::filesystem::path& path) {
    return io::read_mesh(path);
}

const std::string small_vtu =
    "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><UnstructuredGrid>\n"
    "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">\n"
    "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 "
    "1</DataArray>"
    "</Points>\n<Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>\n"
    "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4</DataArray>\n"
    "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray></Cells>\n"
    "<PointData><DataArray type=\"Int8\" Name=\"p\" format=\"ascii\">-1 2 3 4</DataArray></PointData>\n"
    "</Piece></UnstructuredGrid></VTKFile>\n";

std::string vtu_refusal(const std::string& from, const std::string& to) {
    return scratch::refusal(io::read_vtu, "a.vtu", scratch::replaced(small_vtu, from, to));
}

} // namespace

TEST_CASE("meshio's and VTK's files hold the same mesh in each encoding", "[io]") {
    const io::Soup gmsh = io::read_msh(fixture("coarse_41_binary.msh"));
    for (const char* name : {"meshio_ascii.vtu", "meshio_base64.vtu", "meshio_zlib.vtu", "vtk_ascii.vtu",
                             "vtk_base64.vtu", "vtk_base64_32.vtu", "vtk_raw.vtu", "vtk_raw_32.vtu",
                             "vtk_appended_base64.vtu", "vtk_zlib.vtu", "vtk_big_endian.vtu"}) {
        CAPTURE(name);
        const io::Soup soup = io::read_vtu(fixture(name));
        CHECK(soups::volume(soup) == Approx(1));
        CHECK(soup.simplices[3].vertices == gmsh.simplices[3].vertices);
        soups::check_point_data(soup);
        REQUIRE(soup.find_cell_data("number") != nullptr);
        CHECK(std::get<IntegerList>(soup.find_cell_data("number")->values).at(5) == 5);
    }
}

TEST_CASE("VTK's string, id and signed character arrays are read", "[io]") {
    for (const char* name : {"vtk_ascii.vtu", "vtk_base64.vtu", "vtk_base64_32.vtu", "vtk_raw.vtu",
                             "vtk_raw_32.vtu", "vtk_appended_base64.vtu"}) {
        CAPTURE(name);
        const io::Soup soup = io::read_vtu(fixture(name));
        REQUIRE(soup.find_field_data("patch_name") != nullptr);
        CHECK(std::get<std::vector<std::string>>(soup.find_field_data("patch_name")->values) ==
              std::vector<std::string>{"in let", "walls"});
        REQUIRE(soup.find_point_data("ids") != nullptr);
        CHECK(std::get<IntegerList>(soup.find_point_data("ids")->values).at(3) == 1000000000003);
        REQUIRE(soup.find_point_data("signed") != nullptr);
        CHECK(std::get<IntegerList>(soup.find_point_data("signed")->values).at(3) == -3);
    }
}

TEST_CASE("A grid of triangles is read", "[io]") {
    const io::Soup soup = io::read_mesh(fixture("triangles.vtu"));
    const io::Soup gmsh = io::read_msh(fixture("coarse_41_binary.msh"));
    CHECK(soup.top_dimension() == 2);
    CHECK(soup.simplices[2].vertices == gmsh.simplices[2].vertices);
}

TEST_CASE("Cells of several dimensions are parted, and keep their numbers as tags", "[io]") {
    const io::Soup soup =
        io::read_vtu(fixture("mixed.vtu")); // 24 tetrahedra and the 24 triangles around them
    CHECK(soup.simplices[3].size(3) == 24);
    CHECK(soup.simplices[2].size(2) == 24);
    CHECK(soup.simplices[3].tags.front() == 0);
    CHECK(soup.simplices[2].tags.front() == 24);
    CHECK(soup.simplices[2].physical.empty());
}

namespace {

/// A square of two triangles with its four sides, of which `array` says the parts.
std::string square(const std::string& array, const std::string& more = "") {
    return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" "
           "NumberOfCells=\"6\">"
           "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\">0 0 0 1 0 0 1 1 0 0 1 "
           "0</DataArray></Points>"
           "<Cells><DataArray type=\"Int64\" Name=\"connectivity\">0 1 0 1 2 1 2 2 3 0 2 3 3 0</DataArray>"
           "<DataArray type=\"Int64\" Name=\"offsets\">2 5 7 9 12 14</DataArray>"
           "<DataArray type=\"UInt8\" Name=\"types\">3 5 3 3 5 3</DataArray></Cells><CellData>" +
           more + "<DataArray type=\"Int32\" Name=\"" + array +
           "\">4 9 0 5 -1 5</DataArray><DataArray type=\"Float64\" Name=\"h\">0 1 2 3 4 5</DataArray>"
           "</CellData></Piece></UnstructuredGrid></VTKFile>";
}

} // namespace

TEST_CASE("Arrays that others call so say the groups of mixed cells, or one that is asked for", "[io]") {
    const scratch::Folder folder;
    const auto check = [](const io::Soup& soup) {
        CHECK(soup.simplices[1].vertices == Array<Index>{0, 1, 1, 2, 2, 3, 3, 0});
        CHECK(soup.simplices[1].physical == std::vector<PatchNumber>{4, 0, 5, 5});
        CHECK(soup.simplices[2].physical == std::vector<PatchNumber>{9, 0});
        CHECK(soup.groups[1] == PatchList{{4, ""}, {5, ""}});
        REQUIRE(soup.find_cell_data("h") != nullptr);
        CHECK(std::get<Array<double>>(soup.find_cell_data("h")->values) == Array<double>{1, 4});
    };
    for (const std::string name : {"gmsh:physical", "medit:ref", "patch"}) {
        CAPTURE(name);
        check(io::read_vtu(scratch::put(folder / "a.vtu", square(name))));
    }
    const std::string other = "<DataArray type=\"Int32\" Name=\"patch\">1 1 1 1 1 1</DataArray>";
    const auto path = scratch::put(folder / "a.vtu", square("zone", other));
    check(io::read_mesh(path, {false, "zone"}));
    CHECK(io::read_vtu(path).simplices[1].physical == std::vector<PatchNumber>{1, 1, 1, 1});
    try {
        io::read_mesh(path, {false, "h"});
        FAIL("an array of reals is no array of groups");
    } catch (const InputError& error) {
        CHECK_THAT(error.what(), Catch::Contains("\"h\"") && Catch::Contains("patch, zone, h"));
    }
}

TEST_CASE("Of quadratic cells, the corners are taken where that is asked for", "[io]") {
    const scratch::Folder folder;
    const auto path =
        scratch::put(folder / "a.vtu",
                     "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"7\" "
                     "NumberOfCells=\"2\">"
                     "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\">0 0 0  .5 -.1 0  1 0 0  "
                     ".6 .5 0  0 1 0  0 .5 0"
                     "  2 0 0</DataArray></Points><PointData><DataArray type=\"Int32\" Name=\"i\">0 1 2 3 4 "
                     "5 6</DataArray></PointData>"
                     "<Cells><DataArray type=\"Int64\" Name=\"connectivity\">0 2 4 1 3 5 0 2 1</DataArray>"
                     "<DataArray type=\"Int64\" Name=\"offsets\">6 9</DataArray>"
                     "<DataArray type=\"UInt8\" Name=\"types\">22 "
                     "21</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>");
    CHECK_THAT(scratch::refusal(io::read_vtu, path),
               Catch::Contains("cell 0 is a quadratic triangle") && Catch::Contains("linear"));
    const io::Soup soup = io::read_mesh(path, {true, ""});
    CHECK(soup.points == Array<Point<3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}});
    CHECK(soup.point_tags == Array<std::int64_t>{0, 2, 4, 6});
    CHECK(soup.simplices[2].vertices == Array<Index>{0, 1, 2});
    CHECK(soup.simplices[1].vertices == Array<Index>{0, 1});
    CHECK(std::get<IntegerList>(soup.point_data[0].values) == Array<std::int64_t>{0, 2, 4, 6});
    REQUIRE(soup.remarks.size() == 1);
    CHECK_THAT(soup.remarks[0], Catch::Contains("2 curved elements") && Catch::Contains("3 points"));
}

TEST_CASE("Of quadratic cells in pieces, the corners are taken where that is asked for", "[io]") {
    const scratch::Folder folder;
    const auto piece = [](const char* points, const char* numbers, const char* zones) {
        return fmt::format(
            "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"6\" "
            "NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\">{}"
            "</DataArray></Points><PointData><DataArray type=\"Int32\" Name=\"GlobalPointIds\">{}"
            "</DataArray></PointData><CellData><DataArray type=\"Int32\" Name=\"zone\">{}"
            "</DataArray></CellData><Cells>"
            "<DataArray type=\"Int64\" Name=\"connectivity\">0 1 2 3 4 5</DataArray>"
            "<DataArray type=\"Int64\" Name=\"offsets\">6</DataArray>"
            "<DataArray type=\"UInt8\" Name=\"types\">22</DataArray></Cells></Piece>"
            "</UnstructuredGrid></VTKFile>",
            points, numbers, zones);
    };
    scratch::put(folder / "0.vtu", piece("0 0 0  1 0 0  0 1 0  .5 0 0  .5 .5 0  0 .5 0", "0 1 2 4 5 6", "7"));
    scratch::put(folder / "1.vtu", piece("1 0 0  1 1 0  0 1 0  1 .5 0  .5 1 0  .5 .5 0", "1 3 2 7 8 5", "9"));
    const auto path = scratch::put(
        folder / "a.pvtu", "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece "
                           "Source=\"0.vtu\"/><Piece Source=\"1.vtu\"/></PUnstructuredGrid></VTKFile>");
    CHECK_THAT(scratch::refusal(io::read_pvtu, path),
               Catch::Contains("quadratic triangle") && Catch::Contains("linear"));
    const io::Soup soup = io::read_mesh(path, {true, "zone"});
    CHECK(soup.points == Array<Point<3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
    CHECK(soup.simplices[2].vertices == Array<Index>{0, 1, 2, 1, 3, 2});
    CHECK(soup.simplices[2].physical == std::vector<PatchNumber>{7, 9});
    CHECK(soup.point_tags.empty());
    CHECK(soup.remarks.size() == 2);
}

TEST_CASE("Integers take 32 bits where they fit, whatever their type, and runs hardly any", "[io]") {
    const scratch::Folder folder;
    constexpr std::size_t count = 3000;
    specimens::Grid grid{3, 2};
    io::MeshColumns mesh = grid.columns();
    const auto add = [&](const char* name, std::int64_t factor, std::int64_t offset) {
        mesh.field_data.push_back({name, 1, IntegerList::generated(count, [=](std::size_t k) {
                                       return static_cast<std::int64_t>(k * k % 1009) * factor + offset;
                                   })});
    };
    add("narrow", 1, -1);
    add("wide", std::int64_t{1} << 40, 7);
    mesh.field_data.push_back({"run", 1, IntegerList::generated(count, [](std::size_t k) {
                                   return static_cast<std::int64_t>(k / 100);
                               })});
    for (const io::VtuEncoding encoding :
         {io::VtuEncoding::raw, io::VtuEncoding::zlib, io::VtuEncoding::ascii}) {
        io::write_vtu(folder / "a.vtu", mesh, encoding);
        const io::Soup soup = io::read_vtu(folder / "a.vtu");
        for (const io::DataArray& array : mesh.field_data) {
            if (const auto* wanted = std::get_if<IntegerList>(&array.values)) {
                const auto& found = std::get<IntegerList>(soup.find_field_data(array.name)->values);
                CHECK(found == *wanted);
                CHECK(found.narrow().size() == (array.name == "narrow" ? count : 0));
            }
        }
    }
}

TEST_CASE("A VTU file that we do not read is refused by name", "[io]") {
    using Catch::Contains;
    CHECK_THAT(vtu_refusal("version", "compressor=\"vtkLZMADataCompressor\" version"),
               Contains("vtkLZMADataCompressor"));
    CHECK_THAT(vtu_refusal("\"LittleEndian", "\"MiddleEndian"), Contains("MiddleEndian"));
    CHECK_THAT(vtu_refusal("version", "header_type=\"UInt16\" version"), Contains("UInt16"));
    CHECK_THAT(scratch::refusal(io::read_vtu, fixture("quads.msh")), Contains("no VTU file"));
    CHECK_THAT(vtu_refusal("UnstructuredGrid\"", "PolyData\""), Contains("PolyData"));
    CHECK_THAT(vtu_refusal(">10<", ">12<"), Contains("cell 0 is a hexahedron"));
    CHECK_THAT(vtu_refusal(">10<", ">3<"), Contains("cell 0 has not 2 vertices"));
    CHECK_THAT(vtu_refusal(">10<", ">1<"), Contains("cell 0 is a vertex, but it has not 1 vertices"));
    CHECK_THAT(vtu_refusal(">10<", ">24<"), Contains("cell 0 is a quadratic tetrahedron"));
    CHECK_THAT(vtu_refusal("\"Int32\" Name=\"c", "\"Bit\" Name=\"c"), Contains("\"Bit\""));
}

TEST_CASE("Faults in a VTU file are refused with array and cell or point", "[io]") {
    using Catch::Contains;
    CHECK_THAT(vtu_refusal("0 1 2 3", "0 1 2 4"),
               Contains("connectivity") && Contains("cell 0") && Contains("byte "));
    CHECK_THAT(vtu_refusal("0 1 2 3", "0 1 2 -1"), Contains("cell 0"));
    CHECK_THAT(vtu_refusal("0 1 2 3", "0 1 2"), Contains("connectivity"));
    CHECK_THAT(vtu_refusal("\"Int32\" Name=\"c", "\"Float64\" Name=\"c"),
               Contains("array \"connectivity\": integers were expected, not reals"));
    CHECK_THAT(vtu_refusal("0 1 2 3", "0 1 two 3"), Contains("\"two\""));
    CHECK_THAT(vtu_refusal("0 0 1<", "0 0 nan<"), Contains("point 3"));
    CHECK_THAT(vtu_refusal("0 0 1<", "0 0 1e999<"), !Catch::Equals(""));
    CHECK_THAT(vtu_refusal("0 0 1<", "0 0<"), Contains("points of 3"));
    CHECK_THAT(vtu_refusal("Points=\"4\"", "Points=\"1000000000000000000\""),
               Contains("1000000000000000000 points"));
    CHECK_THAT(vtu_refusal("Points=\"4\"", "Points=\"-4\""), Contains("no count"));
    CHECK_THAT(vtu_refusal("Cells=\"1\"", "Cells=\"2\""), Contains("2 cells are claimed"));
    CHECK_THAT(vtu_refusal("\"ascii\">4<", "\"ascii\">3<"), Contains("has not 4 vertices"));
    CHECK_THAT(vtu_refusal("-1 2 3 4", "-1 2 3"), Contains("array \"p\""));
    CHECK_THAT(vtu_refusal("-1 2 3 4", "-1 2 3 400"), Contains("400 does not fit"));
    CHECK_THAT(vtu_refusal("Name=\"types\"", "Name=\"kinds\""), Contains("\"types\" is missing"));
    CHECK_THAT(scratch::refusal(io::read_vtu, "/nowhere/a.vtu"), Contains("No such file"));
}

TEST_CASE("A VTU file cut short anywhere is refused", "[io]") {
    const scratch::Folder folder;
    for (const char* name : {"vtk_raw.vtu", "vtk_appended_base64.vtu", "meshio_base64.vtu"}) {
        CAPTURE(name);
        const std::string bytes = scratch::bytes_of(fixture(name));
        const std::size_t tail =
            std::min(bytes.find("\n  </AppendedData"), bytes.size() - 2); // all data before it
        for (std::size_t size = 0; size < tail; ++size) {
            if (scratch::refusal(io::read_vtu, scratch::put(folder / "a.vtu", bytes.substr(0, size)))
                    .empty()) {
                FAIL_CHECK("cut to " << size << " of " << bytes.size() << " bytes");
            }
        }
    }
}

TEST_CASE("A huge claimed size is refused before memory is asked for", "[io]") {
    const scratch::Folder folder;
    std::string bytes = scratch::bytes_of(fixture("vtk_raw.vtu"));
    const std::size_t data = bytes.find('_', bytes.find("<AppendedData")) + 1;
    for (const std::uint64_t size :
         {std::uint64_t{1000000000000000000}, ~std::uint64_t{0}, std::uint64_t{100000}}) {
        bytes.replace(data, sizeof size, scratch::binary(size));
        CHECK_THAT(scratch::refusal(io::read_vtu, scratch::put(folder / "a.vtu", bytes)),
                   Catch::Contains("beyond the end"));
    }
}

TEST_CASE("Random damage to a VTU file never does more than refuse it", "[io]") {
    const scratch::Folder folder;
    for (const char* name :
         {"vtk_raw.vtu", "vtk_raw_32.vtu", "vtk_appended_base64.vtu", "vtk_ascii.vtu", "meshio_base64.vtu"}) {
        CHECK(scratch::survive_damage(io::read_vtu, scratch::bytes_of(fixture(name)), folder / "a.vtu",
                                      1000) > 0);
    }
}

TEST_CASE("What is written as VTU comes back bit for bit", "[io]") {
    const scratch::Folder folder;
    const auto encoding =
        GENERATE(io::VtuEncoding::raw, io::VtuEncoding::zlib, io::VtuEncoding::lz4, io::VtuEncoding::ascii);
    for (const specimens::Grid& grid :
         {specimens::Grid{1, 1}, specimens::Grid{1, 9}, specimens::Grid{2, 1}, specimens::Grid{2, 9},
          specimens::Grid{3, 1}, specimens::Grid{3, 6}, specimens::Grid{2, 150}}) { // several packed blocks
        io::write_vtu(folder / "a.vtu", grid.columns(), encoding);
        CHECK(folder.file_count() == 1);
        const io::Soup soup = io::read_mesh(folder / "a.vtu");
        const auto top = static_cast<std::size_t>(grid.dimension);
        CHECK(soup.points == Array<Point<3>>(grid.points.begin(), grid.points.end()));
        CHECK(soup.simplices[top].vertices == Array<Index>(grid.cells.begin(), grid.cells.end()));
        REQUIRE(soup.point_data.size() == 2);
        CHECK(std::get<Array<double>>(soup.find_point_data("t")->values) ==
              Array<double>(grid.time.begin(), grid.time.end()));
        CHECK(std::get<IntegerList>(soup.find_point_data("vertex_id")->values) ==
              Array<std::int64_t>(grid.ids.begin(), grid.ids.end()));
        REQUIRE(soup.cell_data.size() == 2);
        CHECK(soup.find_cell_data("pair")->components == 2);
        CHECK(std::get<IntegerList>(soup.find_cell_data("pair")->values) ==
              Array<std::int64_t>(grid.pairs.begin(), grid.pairs.end()));
        REQUIRE(soup.field_data.size() == 3);
        CHECK(std::get<Array<double>>(soup.find_field_data("time")->values) == Array<double>{0.1, 1.0 / 3});
        CHECK(std::get<std::vector<std::string>>(soup.find_field_data("patch_name")->values) ==
              std::vector<std::string>{"walls & doors", "", "fan <1>"});
    }
}

TEST_CASE("The bytes of a VTU file do not depend on the number of threads", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{3, 30};
    const auto encoding =
        GENERATE(io::VtuEncoding::raw, io::VtuEncoding::zlib, io::VtuEncoding::lz4, io::VtuEncoding::ascii);
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        io::write_vtu(folder / fmt::format("{}.vtu", threads), grid.columns(), encoding);
    }
    set_thread_count(0);
    CHECK(scratch::bytes_of(folder / "1.vtu") == scratch::bytes_of(folder / "2.vtu"));
    CHECK(scratch::bytes_of(folder / "1.vtu") == scratch::bytes_of(folder / "5.vtu"));
}

TEST_CASE("A mesh file is known by its extension, in any case, or else by its content", "[io]") {
    const scratch::Folder folder;
    for (const char* name : {"a.VTU", "a.data"}) {
        CHECK(io::read_mesh(scratch::put(folder / name, small_vtu)).points.size() == 4);
    }
    CHECK(io::read_mesh(scratch::put(folder / "b", scratch::bytes_of(fixture("size_t_4.msh"))))
              .top_dimension() == 3);
    CHECK_THAT(scratch::refusal(read_any, scratch::put(folder / "c", "junk")), Catch::Contains("neither"));
    CHECK_THAT(scratch::refusal(read_any, folder / "none"), Catch::Contains("No such file"));
}
