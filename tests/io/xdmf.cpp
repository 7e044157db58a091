// SPDX-License-Identifier: BSD-3-Clause
// With HDF5's own library as the independent writer of what may be in a file.
#include "core/rounds.h"
#include "io/scratch.h"
#include "io/soups.h"
#include "io/specimens.h"
#include "slabhull/core/parallel.h"
#include "slabhull/io/files.h"
#include "slabhull/io/formats.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <fmt/format.h>
#include <hdf5.h>
#include <thread>

using namespace slabhull;

using soups::is_consistent;
using soups::size_of;
using soups::values;

namespace {

const std::string text_file =
    "<Xdmf Version=\"3.0\"><Domain><Grid Name=\"g\">\n"
    "<Topology TopologyType=\"Triangle\" NumberOfElements=\"2\">\n"
    "<DataItem Dimensions=\"2 3\" NumberType=\"Int\" Precision=\"8\" Format=\"XML\">0 1 2\n2 1 "
    "3</DataItem></Topology>\n"
    "<Geometry GeometryType=\"XY\"><DataItem Dimensions=\"4 2\" Precision=\"8\" Format=\"XML\">0 0 1 0 0 1 1 "
    "1.5"
    "</DataItem></Geometry>\n"
    "<Attribute Name=\"a\" Center=\"Node\"><DataItem Dimensions=\"4\" DataType=\"Int\" Format=\"XML\">5 6 7 8"
    "</DataItem></Attribute>\n"
    "<Attribute Name=\"b\" Center=\"Cell\"><DataItem Dimensions=\"2 2\" Format=\"XML\">1 2 3 4.5"
    "</DataItem></Attribute>\n"
    "<Attribute Name=\"c\" Center=\"Grid\"><DataItem Dimensions=\"1\" "
    "Format=\"XML\">0.25</DataItem></Attribute>\n"
    "<Time Value=\"3\"/></Grid></Domain></Xdmf>\n";

io::Soup read_text(const std::string& text) {
    const scratch::Folder folder;
    return io::read_xdmf(scratch::put(folder / "a.xdmf", text));
}

std::string text_refusal(const std::string& from, const std::string& to) {
    return scratch::refusal(io::read_xdmf, "a.xdmf", scratch::replaced(text_file, from, to));
}

/// How a dataset of an independent writer is made.
struct Making {
    hid_t type = H5T_IEEE_F64LE;
    std::vector<hsize_t> chunk{};
    bool shuffle = false;
    unsigned deflate = 0;
    bool filled = true;
    bool scaled = false; ///< a filter that we do not read
    const char* elsewhere = nullptr;
};

void put_dataset(hid_t file, const char* name, const std::vector<hsize_t>& extents,
                 const std::vector<double>& values, const Making& making) {
    const hid_t space = H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    if (!making.chunk.empty()) {
        H5Pset_chunk(creation, static_cast<int>(making.chunk.size()), making.chunk.data());
    }
    if (making.shuffle) {
        H5Pset_shuffle(creation);
        H5Pset_fletcher32(creation);
    }
    if (making.deflate > 0) {
        H5Pset_deflate(creation, making.deflate);
    }
    if (making.scaled) {
        H5Pset_scaleoffset(creation, H5Z_SO_INT, 0);
    }
    if (making.elsewhere != nullptr) {
        H5Pset_external(creation, making.elsewhere, 0, H5F_UNLIMITED);
    }
    const hid_t data = H5Dcreate2(file, name, making.type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    REQUIRE(data >= 0);
    if (making.filled) {
        REQUIRE(H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
    }
    H5Dclose(data);
    H5Pclose(creation);
    H5Sclose(space);
}

/// A tetrahedron with one value at each point, by HDF5 itself; `making` is that of the values.
struct Specimen {
    scratch::Folder folder;
    std::filesystem::path path = folder / "a.xdmf";

    explicit Specimen(const Making& making, const std::vector<double>& values = {1, 2, 3, 4},
                      const Making& cells = {H5T_STD_I64BE},
                      const std::vector<double>& vertices = {0, 1, 2, 3}) {
        const hid_t file = H5Fcreate((folder / "a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
        put_dataset(file, "x", {4, 3}, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {H5T_IEEE_F32BE});
        put_dataset(file, "cells", {1, 4}, vertices, cells);
        put_dataset(file, "v", {values.size()}, values, making);
        H5Lcreate_external("b.h5", "/x", file, "far", H5P_DEFAULT, H5P_DEFAULT);
        H5Lcreate_soft("/x", file, "near", H5P_DEFAULT, H5P_DEFAULT);
        H5Fclose(file);
        put_xml("x", values.size());
    }
    void put_xml(const std::string& points, std::size_t values, const std::string& file = "a.h5") const {
        const auto item = [&](const std::string& extents, const std::string& name) {
            return fmt::format(
                "<DataItem Dimensions=\"{}\" NumberType=\"Float\" Precision=\"4\" Format=\"HDF\">"
                "\n{}:/{}\n</DataItem>",
                extents, file, name);
        };
        scratch::put(
            path, fmt::format("<Xdmf Version=\"2.0\"><Domain><Grid><Geometry Type=\"XYZ\">{}</Geometry>"
                              "<Topology Type=\"tetrahedron\">{}</Topology>"
                              "<Attribute Name=\"v\">{}</Attribute></Grid></Domain></Xdmf>",
                              item("4 3", points), item("1 4", "cells"), item(std::to_string(values), "v")));
    }
    std::string refusal() const { return scratch::refusal(io::read_xdmf, path); }
};

} // namespace

TEST_CASE("What is written as XDMF comes back bit for bit", "[io]") {
    for (const specimens::Grid& grid :
         {specimens::Grid{1, 1}, specimens::Grid{1, 9}, specimens::Grid{2, 1}, specimens::Grid{2, 9},
          specimens::Grid{3, 1}, specimens::Grid{3, 6}}) {
        const scratch::Folder folder;
        io::write_xdmf(folder / "a & b.xdmf", grid.columns());
        const io::Soup soup = io::read_xdmf(folder / "a & b.xdmf");
        const auto top = static_cast<std::size_t>(grid.dimension);
        CHECK(soup.top_dimension() == grid.dimension);
        CHECK(soup.points == Array<Point<3>>(grid.points.begin(), grid.points.end()));
        CHECK(soup.simplices[top].vertices == Array<Index>(grid.cells.begin(), grid.cells.end()));
        CHECK(soup.point_data.size() == 2);
        CHECK(values<Array<double>>(soup.find_point_data("t")) ==
              Array<double>(grid.time.begin(), grid.time.end()));
        CHECK(values<IntegerList>(soup.find_point_data("vertex_id")) ==
              Array<std::int64_t>(grid.ids.begin(), grid.ids.end()));
        CHECK(soup.find_cell_data("pair")->components == 2);
        CHECK(values<IntegerList>(soup.find_cell_data("pair")) ==
              Array<std::int64_t>(grid.pairs.begin(), grid.pairs.end()));
        CHECK(values<Array<double>>(soup.find_field_data("time")) == Array<double>{0.1, 1.0 / 3});
        CHECK(values<IntegerList>(soup.find_field_data("slab")) == Array<std::int64_t>{7});
        CHECK(values<std::vector<std::string>>(soup.find_field_data("patch_name")) ==
              std::vector<std::string>{"walls & doors", "", "fan <1>"});
    }
}

TEST_CASE("Names that HDF5 or others would take apart, or that come twice, survive", "[io]") {
    const scratch::Folder folder;
    specimens::Grid grid{3, 1};
    grid.ids.front() = std::numeric_limits<std::int64_t>::max(); // wide integers are exact
    grid.ids.back() = std::numeric_limits<std::int64_t>::min();
    io::MeshColumns mesh = grid.columns();
    const io::DataColumn ids = mesh.point_data.at(1);
    mesh.point_data.clear();
    const std::vector<std::string> names{"a/b:c", "a.b.c", "", "..", "a/b:c", "xyzt", "\"<é>"};
    for (const std::string& name : names) {
        mesh.point_data.push_back({name, ids.type, ids.values});
    }
    io::write_xdmf(folder / "a.xdmf", mesh);
    const io::Soup soup = io::read_xdmf(folder / "a.xdmf");
    REQUIRE(soup.point_data.size() == names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
        CHECK(soup.point_data[i].name == names[i]);
        CHECK(std::get<IntegerList>(soup.point_data[i].values) ==
              Array<std::int64_t>(grid.ids.begin(), grid.ids.end()));
    }
}

TEST_CASE("Tetrahedra with times have their points of four columns beside the geometry", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{3, 2};
    io::write_xdmf(folder / "a.xdmf", grid.columns());
    const hid_t file = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t data = H5Dopen2(file, "/xyzt", H5P_DEFAULT);
    std::vector<std::array<double, 4>> rows(grid.points.size());
    REQUIRE(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) >= 0);
    H5Dclose(data);
    H5Fclose(file);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Point<3>& x = grid.points[i];
        CHECK(rows[i] == std::array<double, 4>{x[0], x[1], x[2], grid.time[i]});
    }
    CHECK(io::read_xdmf(folder / "a.xdmf").find_point_data("xyzt") == nullptr);
}

TEST_CASE("The same mesh gives the same XDMF bytes at any time and with any number of threads", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{3, 20};
    const auto written = [&](unsigned threads) {
        set_thread_count(threads);
        io::write_xdmf(folder / "a.xdmf", grid.columns());
        set_thread_count(0);
        return scratch::bytes_of(folder / "a.xdmf") + scratch::bytes_of(folder / "a.h5");
    };
    const std::string first = written(1);
    std::this_thread::sleep_for(std::chrono::milliseconds{1100}); // HDF5 could note the second
    CHECK(written(4) == first);
}

TEST_CASE("Both files appear, or neither and what was there stays", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{2, 2};
    scratch::put(folder / "a.h5", "old");
    {
        io::AtomicFiles files;
        io::write_xdmf(files, folder / "a.xdmf", grid.columns());
    }
    CHECK(scratch::bytes_of(folder / "a.h5") == "old");
    CHECK(folder.file_count() == 1);
    io::write_xdmf(folder / "a.xdmf", grid.columns());
    CHECK(folder.file_count() == 2);
    CHECK_THROWS_AS(io::write_xdmf(folder / "b.h5", grid.columns()), UsageError);
    CHECK(folder.file_count() == 2);
    std::filesystem::create_directory(folder / "c.h5");
    CHECK_THROWS_AS(io::write_xdmf(folder / "c.xdmf", grid.columns()), OutputError);
    CHECK(folder.file_count() == 3);
}

TEST_CASE("XDMF with its values as text is read: XY, attributes of each centre, both versions' words",
          "[io]") {
    const io::Soup soup = read_text(text_file);
    CHECK(soup.points == Array<Point<3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1.5, 0}});
    CHECK(soup.simplices[2].vertices == Array<Index>{0, 1, 2, 2, 1, 3});
    CHECK(values<IntegerList>(soup.find_point_data("a")) == Array<std::int64_t>{5, 6, 7, 8});
    CHECK(soup.find_cell_data("b")->components == 2);
    CHECK(values<Array<double>>(soup.find_field_data("c")) == Array<double>{0.25});
}

TEST_CASE("Mixed cells of XDMF are parted by dimension, keep their numbers, and data go with the largest",
          "[io]") {
    const std::string mixed = scratch::replaced(
        scratch::replaced(text_file, "Triangle\" NumberOfElements=\"2", "Mixed\" NumberOfElements=\"4"),
        "\"2 3\" NumberType=\"Int\" Precision=\"8\" Format=\"XML\">0 1 2\n2 1 3",
        "\"15\" NumberType=\"Int\" Format=\"XML\">2 2 1 3 4 0 1 2 1 1 3 4 2 1 3");
    const io::Soup soup = read_text(scratch::replaced(mixed, "\"2 2\" Format=\"XML\">1 2 3 4.5",
                                                      "\"4 2\" Format=\"XML\">1 1 2 2 3 3 4 4.5"));
    CHECK(soup.simplices[2].vertices == Array<Index>{0, 1, 2, 2, 1, 3});
    CHECK(soup.simplices[1].vertices == Array<Index>{1, 3});
    CHECK(soup.simplices[0].vertices == Array<Index>{3});
    CHECK(soup.simplices[2].tag(1) == 3);
    CHECK(values<Array<double>>(soup.find_cell_data("b")) == Array<double>{2, 2, 4, 4.5});
}

TEST_CASE("HDF5's own files are read: chunks, deflate, checksums, byte orders, narrow numbers, links",
          "[io]") {
    for (const Making& making :
         {Making{H5T_IEEE_F32BE}, Making{H5T_IEEE_F64LE, {3}}, Making{H5T_IEEE_F64BE, {2}, true, 9},
          Making{H5T_STD_I16BE, {4}, false, 1}, Making{H5T_STD_U64LE}, Making{H5T_STD_I8LE}}) {
        const Specimen specimen{making};
        specimen.put_xml("near", 4);
        const io::Soup soup = io::read_xdmf(specimen.path);
        CHECK(soup.points.at(3) == Point<3>{0, 0, 1});
        CHECK(soup.simplices[3].vertices == Array<Index>{0, 1, 2, 3});
        if (H5Tget_class(making.type) == H5T_INTEGER) {
            CHECK(values<IntegerList>(soup.find_point_data("v")) == Array<std::int64_t>{1, 2, 3, 4});
        } else {
            CHECK(values<Array<double>>(soup.find_point_data("v")) == Array<double>{1, 2, 3, 4});
        }
    }
}

TEST_CASE("Faults in HDF5 data are refused with file and dataset", "[io]") {
    using Catch::Contains;
    CHECK(Specimen{{}}.refusal().empty());
    CHECK_THAT((Specimen{{H5T_IEEE_F64LE, {4}, false, 0, false}}.refusal()),
               Contains("a.h5: dataset /v") && Contains("0 bytes"));
    CHECK_THAT((Specimen{{H5T_IEEE_F64LE, {}, false, 0, false, false, "raw.bin"}}.refusal()),
               Contains("/v: its data stand in other files"));
    CHECK_THAT((Specimen{{H5T_STD_I32LE, {4}, false, 0, true, true}}.refusal()),
               Contains("packed otherwise"));
    CHECK_THAT((Specimen{{H5T_STD_U64LE}, {1, 2, 3, 1.5e19}}.refusal()), Contains("/v: it has a number"));
    CHECK_THAT((Specimen{{}, {1, 2, 3, 4}, {H5T_STD_I32LE}, {0, 1, 2, -1}}.refusal()),
               Contains("/cells: it has a number that is negative"));
    CHECK_THAT((Specimen{{}, {1, 2, 3, 4}, {H5T_STD_I64LE}, {0, 1, 2, 4294967296.0}}.refusal()),
               Contains("/cells: it has a number"));
    CHECK_THAT((Specimen{{}, {1, 2, 3, 4}, {H5T_STD_I64LE}, {0, 1, 2, 4}}.refusal()),
               Contains("cell 0 names point 4; there are 4"));
    CHECK_THAT((Specimen{{}, {1, 2, 3, 4}, {H5T_IEEE_F64LE}}.refusal()), Contains("no integers"));
    const Specimen specimen{{}};
    specimen.put_xml("far", 4);
    CHECK_THAT(specimen.refusal(), Contains("a.h5: dataset /far"));
    specimen.put_xml("nothing", 4);
    CHECK_THAT(specimen.refusal(), Contains("dataset /nothing: it cannot be opened"));
    specimen.put_xml("x", 5);
    CHECK_THAT(specimen.refusal(), Contains("5 values are claimed, but a.h5:/v has 4"));
    specimen.put_xml("x", 4, "b.h5");
    CHECK_THAT(specimen.refusal(), Contains("b.h5: cannot be read: No such file"));
    specimen.put_xml("x", 4, "/dev/zero");
    CHECK_THAT(specimen.refusal(), Contains("not a regular file"));
    scratch::put(specimen.folder / "b.h5", "junk");
    specimen.put_xml("x", 4, "b.h5");
    CHECK_THAT(specimen.refusal(), Contains("b.h5: it cannot be read as HDF5"));
}

TEST_CASE("Data read again and again, or said to be huge, are refused before memory is asked for", "[io]") {
    using Catch::Contains;
    const std::vector<double> many(10000, 1.0);
    const Specimen specimen{{H5T_IEEE_F64LE, {10000}, false, 9}, many};
    std::string xml = scratch::bytes_of(specimen.path);
    const std::string attribute = "<Attribute Name=\"v\" Center=\"Grid\"><DataItem Dimensions=\"10000\" "
                                  "Format=\"HDF\">a.h5:/v</DataItem></Attribute>";
    const std::size_t begin = xml.find("<Attribute");
    xml.replace(begin, xml.find("</Attribute>") + 12 - begin, attribute);
    scratch::put(specimen.path, xml);
    CHECK(size_of(io::read_xdmf(specimen.path).field_data.at(0)) == many.size());
    for (int i = 0; i < 1000; ++i) {
        xml.insert(begin, attribute);
    }
    scratch::put(specimen.path, xml);
    CHECK_THAT(specimen.refusal(), Contains("or were read"));
    const std::string huge = "1000000000000000000";
    CHECK_THAT(text_refusal("\"4 2\"", "\"" + huge + " 2\""), Contains("are claimed"));
    CHECK_THAT(text_refusal("\"4 2\"", "\"" + huge + " " + huge + "\""), Contains("too large"));
    // a dataset that says so of itself: never written
    const hid_t file = H5Fopen((specimen.folder / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    put_dataset(file, "huge", {hsize_t{1} << 50}, {}, {H5T_IEEE_F64LE, {1000}, false, 9, false});
    H5Fclose(file);
    specimen.put_xml("x", 4);
    xml = scratch::replaced(scratch::bytes_of(specimen.path), "a.h5:/v", "a.h5:/huge");
    const std::size_t last = xml.rfind("Dimensions=\"4\"");
    scratch::put(specimen.path,
                 xml.replace(last, 14, fmt::format("Dimensions=\"{}\"", std::int64_t{1} << 50)));
    CHECK_THAT(specimen.refusal(), Contains("dataset /huge") && Contains("claim to hold"));
}

TEST_CASE("An XDMF file that we do not read is refused by name and place", "[io]") {
    using Catch::Contains;
    CHECK(text_refusal("Version", "Version").empty());
    CHECK_THAT(text_refusal("<Domain>", "<Domane>"), Contains("no XDMF file") && Contains("byte "));
    CHECK_THAT(text_refusal("</Grid>", "</Grid><Grid/>"), Contains("more than one Grid"));
    CHECK_THAT(text_refusal("Triangle", "Hexahedron"), Contains("Hexahedron") && Contains("byte "));
    CHECK_THAT(text_refusal("\"Triangle", "\"Tetrahedron"), Contains("has 4 points"));
    CHECK_THAT(text_refusal("2 1 3<", "2 1 4<"), Contains("cell 1 names point 4"));
    CHECK_THAT(text_refusal("2 1 3<", "2 1 -3<"), Contains("negative"));
    CHECK_THAT(text_refusal("2 1 3<", "2 1 3 3<"), Contains("more values"));
    CHECK_THAT(text_refusal("2 1 3<", "2 1         <"), Contains("nothing follows"));
    CHECK_THAT(text_refusal("Elements=\"2\"", "Elements=\"3\""), Contains("3 cells are claimed"));
    CHECK_THAT(text_refusal("1.5", "nan"), Contains("point 3"));
    CHECK_THAT(text_refusal("\"XY\"", "\"VXVYVZ\""), Contains("VXVYVZ"));
    CHECK_THAT(text_refusal("<DataItem Dimensions=\"4 2\"", "<DataItem Reference=\"XML\" Dimensions=\"4 2\""),
               Contains("references"));
    CHECK_THAT(text_refusal("\"4\" DataType", "\"5\" DataType"), Contains("Attribute \"a\""));
    CHECK_THAT(text_refusal("\"2 2\"", "\"4 1\""), Contains("do not fit 2 rows"));
    CHECK_THAT(text_refusal("Center=\"Cell\"", "Center=\"Face\""), Contains("each Face"));
    CHECK_THAT(text_refusal("DataType=\"Int\"", "DataType=\"Complex\""), Contains("Complex"));
    CHECK_THAT(text_refusal("Format=\"XML\">5", "Format=\"Binary\">../no.bin</DataItem><!--"),
               !Catch::Equals(""));
    CHECK_THAT(scratch::refusal(io::read_xdmf, "/nowhere/a.xdmf"), Contains("No such file"));
}

TEST_CASE("XDMF or its HDF5 file damaged or cut short is refused or read as a consistent soup", "[io]") {
    const auto read = [](const std::filesystem::path& path) {
        const io::Soup soup = io::read_xdmf(path); // outside CHECK, which would catch what it throws
        CHECK(is_consistent(soup));
    };
    const int count = std::max(rounds(30), 6); // each file takes a process; some damage is refused
    const auto cuts = static_cast<std::size_t>(rounds(30));
    const Specimen packed{{H5T_IEEE_F64BE, {2}, true, 9}};
    const scratch::Folder folder;
    io::write_xdmf(folder / "a.xdmf", specimens::Grid{3, 2}.columns());
    for (const auto& path : {packed.path, folder / "a.xdmf"}) {
        const std::string xml = scratch::bytes_of(path);
        const auto data = std::filesystem::path{path}.replace_extension(".h5");
        const std::string bytes = scratch::bytes_of(data);
        CHECK(scratch::survive_damage(read, xml, path, 3 * count) > 0);
        scratch::put(path, xml);
        const auto read_beside = [&](const std::filesystem::path&) { read(path); };
        CHECK(scratch::survive_damage(read_beside, bytes, data, count) > 0);
        for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / cuts) {
            CHECK_FALSE(scratch::refusal(read_beside, scratch::put(data, bytes.substr(0, size))).empty());
        }
    }
}

TEST_CASE("Of second-order cells, the corners are taken where that is asked for", "[io]") {
    const scratch::Folder folder;
    const auto path = scratch::put(
        folder / "a.xdmf",
        "<Xdmf Version=\"3.0\"><Domain><Grid><Geometry GeometryType=\"XY\"><DataItem Dimensions=\"6 2\">"
        "0 0 1 0 0 1 .5 0 .5 .5 0 .5</DataItem></Geometry><Topology TopologyType=\"Triangle_6\" "
        "NumberOfElements=\"1\"><DataItem DataType=\"Int\" Dimensions=\"1 6\">0 1 2 3 4 "
        "5</DataItem></Topology>"
        "</Grid></Domain></Xdmf>");
    CHECK_THAT(scratch::refusal([](const auto& file) { return io::read_xdmf(file); }, path),
               Catch::Contains("second order") && Catch::Contains("linear"));
    const io::Soup soup = io::read_mesh(path, {true, ""});
    CHECK(soup.points == Array<Point<3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(soup.simplices[2].vertices == Array<Index>{0, 1, 2});
    REQUIRE(soup.remarks.size() == 1);
    CHECK_THAT(soup.remarks[0], Catch::Contains("1 curved elements"));
}
