// SPDX-License-Identifier: BSD-3-Clause
// VTU files in every variant that VTK and meshio write (mesh_samples.py), held against numpy's numbers; and
// packed data that lie about what they hold.
#include "io/mesh_samples.h"
#include "io/scratch.h"
#include "slabhull/io/files.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <map>
#include <set>
#include <utility>
#include <zlib.h>

using namespace slabhull;
using Catch::Contains;

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const std::string& folder) {
    return mesh_samples::files(folder, ".vtu");
}

template<class T>
Array<T> numbers(const std::string& name) {
    return mesh_samples::numbers<T>("vtu/" + name);
}

Array<double> flat(const Array<Point<3>>& points) {
    Array<double> values;
    for (const Point<3>& x : points) {
        values.insert(values.end(), x.begin(), x.end());
    }
    return values;
}

/// Bit for bit, or as near as text comes: VTK writes 11 digits, of single precision 5.
void check_values(const Array<double>& got, const Array<double>& expected, double tolerance) {
    REQUIRE(got.size() == expected.size());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < got.size(); ++i) {
        wrong += std::abs(got[i] - expected[i]) <= tolerance * std::abs(expected[i]) ? 0 : 1;
    }
    CHECK(wrong == 0);
}

void check_data(const std::vector<io::DataArray>& arrays, double tolerance) {
    for (const io::DataArray& array : arrays) {
        CAPTURE(array.name);
        if (const auto* integers = std::get_if<Array<std::int64_t>>(&array.values)) {
            CHECK(*integers == numbers<std::int64_t>(array.name + ".i64"));
        } else {
            check_values(std::get<Array<double>>(array.values), numbers<double>(array.name + ".f64"),
                         tolerance);
        }
    }
}

/// Number in the whole mesh of each point of the soup, by its random datum.
std::vector<std::size_t> numbers_in_whole(const io::Soup& soup) {
    std::map<std::int64_t, std::size_t> number;
    for (const std::int64_t id : numbers<std::int64_t>("int64.i64")) {
        number.emplace(id, number.size());
    }
    std::vector<std::size_t> result;
    for (const std::int64_t id : std::get<Array<std::int64_t>>(soup.find_point_data("int64")->values)) {
        result.push_back(number.at(id));
    }
    return result;
}

/// For each cell the numbers in the whole mesh of its corners, and its datum.
std::map<std::array<std::size_t, 4>, double> cells_in_whole(const io::Soup& soup) {
    const std::vector<std::size_t> number = numbers_in_whole(soup);
    std::map<std::array<std::size_t, 4>, double> cells;
    const auto& data = std::get<Array<double>>(soup.find_cell_data("float32")->values);
    const auto& vertices = soup.simplices[3].vertices;
    for (std::size_t i = 0; i < vertices.size(); i += 4) {
        cells[{number[vertices[i]], number[vertices[i + 1]], number[vertices[i + 2]],
               number[vertices[i + 3]]}] = data[i / 4];
    }
    return cells;
}

// --- files made by hand ---

std::string words(const std::vector<std::uint64_t>& values) {
    std::string bytes;
    for (const std::uint64_t value : values) {
        bytes += scratch::binary(value);
    }
    return bytes;
}

std::string deflated(const std::string& bytes) {
    uLongf size = ::compressBound(bytes.size());
    std::string packed(size, '\0');
    ::compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                bytes.size(), 9);
    packed.resize(size);
    return packed;
}

/// A tetrahedron with one packed array of bytes, "p".
std::string packed_file(const std::string& appended, std::uint64_t points = 4, int copies = 1) {
    std::string arrays;
    for (int i = 0; i < copies; ++i) {
        arrays += "<DataArray type=\"UInt8\" Name=\"p\" format=\"appended\" offset=\"0\"/>";
    }
    return fmt::format(
        "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
        "compressor=\"vtkZLibDataCompressor\"><UnstructuredGrid><FieldData>{}</FieldData>"
        "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">"
        "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 "
        "1"
        "</DataArray></Points><Cells><DataArray type=\"Int32\" Name=\"connectivity\">0 1 2 3</DataArray>"
        "<DataArray type=\"Int32\" Name=\"offsets\">4</DataArray>"
        "<DataArray type=\"UInt8\" Name=\"types\">10</DataArray></Cells>"
        "</Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_{}</AppendedData></VTKFile>",
        scratch::replaced(arrays, "Name", fmt::format("NumberOfTuples=\"{}\" Name", points)), appended);
}

std::string packed_refusal(const std::string& file) {
    return scratch::refusal(io::read_vtu, "a.vtu", file);
}

} // namespace

TEST_CASE("Every variant of VTK and meshio holds numpy's numbers", "[io]") {
    for (const fs::path& path : files_in("vtu")) {
        CAPTURE(path.filename());
        const io::Soup soup = io::read_vtu(path);
        const bool by_vtk = path.filename().string().starts_with("vtk_");
        const bool rounded = path.filename().string().find("ascii") != std::string::npos;
        check_values(flat(soup.points), numbers<double>("points.f64"), rounded ? 1e-10 : 0);
        const Array<std::int64_t> cells = numbers<std::int64_t>("cells.i64");
        CHECK(std::equal(cells.begin(), cells.end(), soup.simplices[3].vertices.begin(),
                         soup.simplices[3].vertices.end(), std::cmp_equal<std::int64_t, Index>));
        CHECK(soup.point_data.size() == 9);
        CHECK(soup.cell_data.size() == 2);
        check_data(soup.point_data, rounded ? 1e-10 : 0);
        check_data(soup.cell_data, rounded ? 1e-5 : 0);
        REQUIRE((soup.find_field_data("names") != nullptr) == by_vtk);
        if (by_vtk) {
            CHECK(std::get<std::vector<std::string>>(soup.find_field_data("names")->values) ==
                  std::vector<std::string>{"in let", "", "walls"});
        }
    }
}

TEST_CASE("The pieces of a file are joined, their cells' vertices shifted", "[io]") {
    const std::vector<fs::path> files = files_in("pieces");
    if (files.empty()) {
        return;
    }
    const auto whole = cells_in_whole(io::read_vtu(mesh_samples::folder / "vtu/vtk_raw_plain_64_little.vtu"));
    const Array<double> expected = numbers<double>("points.f64");
    for (const fs::path& path : files) {
        CAPTURE(path.filename());
        const io::Soup soup = io::read_vtu(path);
        CHECK(soup.simplices[3].size(3) == whole.size());
        const bool rounded = path.filename().string().starts_with("ascii");
        const auto same = [rounded](const auto& a, const auto& b) {
            const double tolerance = rounded ? 1e-5 * std::abs(b.second) : 0;
            return a.first == b.first && std::abs(a.second - b.second) <= tolerance;
        };
        const auto cells = cells_in_whole(soup);
        CHECK(std::equal(cells.begin(), cells.end(), whole.begin(), whole.end(), same));
        const std::vector<std::size_t> number = numbers_in_whole(soup);
        CHECK(std::set<std::size_t>(number.begin(), number.end()).size() == expected.size() / 3);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < 3 * number.size(); ++i) { // VTK's filter rounds to single precision
            const double x = expected[3 * number[i / 3] + i % 3];
            wrong += std::abs(soup.points[i / 3][i % 3] - x) <= 1e-6 * std::abs(x) ? 0 : 1;
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("Random damage to a packed, swapped or parted file never does more than refuse it", "[io]") {
    const scratch::Folder folder;
    std::vector<fs::path> files = files_in("pieces");
    for (const fs::path& path : files_in("vtu")) {
        const std::string name = path.filename().string();
        if (name.starts_with("vtk_") && name.find("_64_big") != std::string::npos) {
            files.push_back(path);
        }
    }
    for (const fs::path& path : files) {
        CAPTURE(path.filename());
        CHECK(scratch::survive_damage(io::read_vtu, scratch::bytes_of(path), folder / "a.vtu", 100) > 0);
    }
}

TEST_CASE("A packed file cut short is refused", "[io]") {
    const scratch::Folder folder;
    for (const fs::path& path : files_in("vtu")) {
        const std::string name = path.filename().string();
        if (name.find("_32_big") == std::string::npos || name.find("plain") != std::string::npos) {
            continue;
        }
        CAPTURE(name);
        const std::string bytes = scratch::bytes_of(path);
        const std::size_t tail = std::min(bytes.find("\n  </AppendedData"), bytes.find("</VTKFile"));
        for (std::size_t part = 0; part < 60; ++part) {
            const std::string kept = bytes.substr(0, part * tail / 60);
            CHECK(!scratch::refusal(io::read_vtu, scratch::put(folder / "a.vtu", kept)).empty());
        }
        const std::string kept = bytes.substr(0, tail - 4);
        CHECK(!scratch::refusal(io::read_vtu, scratch::put(folder / "a.vtu", kept)).empty());
    }
}

TEST_CASE("Packed data that lie about their size are refused before memory is asked for", "[io]") {
    const std::string four = deflated("abcd");
    const std::string good = words({1, 4, 0, four.size()}) + four;
    CHECK(packed_refusal(packed_file(good)).empty());
    CHECK(packed_refusal(packed_file(words({1, 9, 4, four.size()}) + four)).empty());
    CHECK(packed_refusal(packed_file(words({0}), 0)).empty());
    const std::string bomb = deflated(std::string(std::size_t{64} << 20, '\0'));
    REQUIRE(bomb.size() < 100000);
    CHECK_THAT(packed_refusal(packed_file(words({1, 64 << 20, 0, bomb.size()}) + bomb)),
               Contains("array \"p\"") && Contains("more than the 4 that can be"));
    constexpr std::uint64_t huge = std::uint64_t{1} << 60;
    for (const std::vector<std::uint64_t>& head : {std::vector<std::uint64_t>{1, huge, 0, four.size()},
                                                   {1, 4, huge, four.size()},
                                                   {2, ~std::uint64_t{0}, 4, four.size(), 0},
                                                   {3, ~std::uint64_t{0} / 2, 4, four.size(), 0, 0}}) {
        CHECK_THAT(packed_refusal(packed_file(words(head) + four, huge)), Contains("claim to hold more"));
    }
    CHECK_THAT(packed_refusal(packed_file(words({huge, 4, 0, four.size()}) + four, huge)),
               Contains("beyond the end"));
    CHECK_THAT(packed_refusal(packed_file(words({1, 4, 0, huge}) + four)), Contains("beyond the end"));
    CHECK_THAT(packed_refusal(packed_file(words({1, 4, 0, ~std::uint64_t{0}}) + four)),
               Contains("beyond the end"));
    CHECK_THAT(packed_refusal(packed_file(words({1, 3, 0, four.size()}) + four)),
               Contains("packed block 0 is damaged"));
    CHECK_THAT(packed_refusal(packed_file(words({1, 4, 0, four.size() - 1}) + four)),
               Contains("packed block 0 is damaged"));
}

TEST_CASE("Arrays that share their bytes many times over are refused", "[io]") {
    const std::string data = deflated(std::string(10000, 'x') + "abcd");
    const std::string appended = words({1, 10004, 0, data.size()}) + data + std::string(10000, ' ');
    CHECK(packed_refusal(packed_file(appended, 10004, 2)).empty());
    const std::string wide = scratch::replaced(packed_file(std::string(), 0), "vtkZLibDataCompressor", "");
    const std::string array =
        "<DataArray type=\"UInt8\" Name=\"q\" NumberOfTuples=\"9000\" format=\"appended\" offset=\"0\"/>";
    const std::string shared = scratch::replaced(
        scratch::replaced(wide, "_</App", "_" + words({9000}) + std::string(9000, 'y') + "</App"),
        "</FieldData>", array + array + array + "</FieldData>");
    CHECK_THAT(packed_refusal(shared), Contains("overlap"));
}

TEST_CASE("Pieces that do not fit together are refused", "[io]") {
    const std::string file = packed_file(words({0}), 0);
    const std::size_t begin = file.find("<Piece");
    const std::size_t end = file.find("</UnstructuredGrid>");
    const std::string piece = file.substr(begin, end - begin);
    const auto with = [&](const std::string& more) {
        return packed_refusal(std::string{file}.insert(end, more));
    };
    CHECK(with(piece).empty());
    CHECK(with("<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>").empty());
    CHECK_THAT(with(scratch::replaced(piece, ">10<", ">5<")), Contains("cell 0 is a triangle"));
    CHECK_THAT(with(scratch::replaced(piece, "0 1 2 3", "0 1 2 4")), Contains("there are 4"));
    const std::string data = "<CellData><DataArray type=\"Int8\" Name=\"d\">1</DataArray></CellData></Piece>";
    CHECK_THAT(with(scratch::replaced(piece, "</Piece>", data)), Contains("arrays of the pieces differ"));
    CHECK_THAT(with("<Piece/>"), Contains("no count"));
}
