// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <set>

using namespace slabhull;

namespace {

using Corners = std::array<Index, 3>;

/// Awkward coordinates that single precision cannot hold, and a face that three others share an edge with.
const std::vector<Point<3>> points{{0.1, 0, 0}, {1.123456789012345, 0, 0}, {0, 1, 0}, {0, 1.0 / 3, -1e-20}};
const std::vector<Corners> faces{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 2}};

std::string off(const std::string& comment = "") {
    std::string text = fmt::format("OFF\n{}{} {} 0\n", comment, points.size(), faces.size());
    for (const auto& p : points) {
        text += fmt::format("{} {} {}\n", p[0], p[1], p[2]);
    }
    for (const auto& f : faces) {
        text += fmt::format("3 {} {} {}\n", f[0], f[1], f[2]);
    }
    return text;
}

std::string obj(const char* corner = "{}") {
    std::string text = "mtllib none.mtl\no body\n";
    for (const auto& p : points) {
        text += fmt::format("v {} {} {} # vertex\nvn 0 0 1\nvt 0 0\n", p[0], p[1], p[2]);
    }
    text += "usemtl red\n";
    for (const auto& f : faces) {
        text += 'f';
        for (const Index v : f) {
            text += ' ' + fmt::format(fmt::runtime(corner), v + 1);
        }
        text += '\n';
    }
    return text;
}

std::string ply_head(const std::string& format) {
    return fmt::format(
        "ply\nformat {} 1.0\ncomment by hand\nelement vertex {}\nproperty double x\nproperty double y\n"
        "property double z\nproperty uchar red\nelement face {}\nproperty uchar flag\n"
        "property list uchar int vertex_indices\nend_header\n",
        format, points.size(), faces.size());
}

std::string ascii_ply() {
    std::string text = ply_head("ascii");
    for (const auto& p : points) {
        text += fmt::format("{} {} {} 255\n", p[0], p[1], p[2]);
    }
    for (const auto& f : faces) {
        text += fmt::format("0 3 {} {} {}\n", f[0], f[1], f[2]);
    }
    return text;
}

std::string ordered(std::string bytes, bool big) {
    return big ? std::string{bytes.rbegin(), bytes.rend()} : bytes;
}

std::string binary_ply(bool big) {
    std::string text = ply_head(big ? "binary_big_endian" : "binary_little_endian");
    for (const auto& p : points) {
        for (const double x : p) {
            text += ordered(scratch::binary(x), big);
        }
        text += '\xff';
    }
    for (const auto& f : faces) {
        text += std::string{'\0', '\3'};
        for (const Index v : f) {
            text += ordered(scratch::binary(v), big);
        }
    }
    return text;
}

std::string facet(const Corners& face) {
    std::string text = " facet normal 0 0 1\n  outer loop\n";
    for (const Index v : face) {
        text += fmt::format("   vertex {} {} {}\n", points[v][0], points[v][1], points[v][2]);
    }
    return text + "  endloop\n endfacet\n";
}

std::string ascii_stl() {
    std::string text = "solid outer facet of the body\n";
    for (std::size_t i = 0; i < faces.size(); ++i) {
        text += i == 2 ? "endsolid outer\nsolid\n" : "";
        text += facet(faces[i]);
    }
    return text + "endsolid\n";
}

std::string binary_stl() {
    std::string text = "solid, but binary";
    text.resize(80, ' ');
    text += scratch::binary(static_cast<std::uint32_t>(faces.size()));
    for (const auto& f : faces) {
        text += std::string(12, '\0');
        for (const Index v : f) {
            for (const double x : points[v]) {
                text += scratch::binary(static_cast<float>(x));
            }
        }
        text += std::string(2, '\0');
    }
    return text;
}

io::Soup surface(const std::string& name, const std::string& bytes) {
    const scratch::Folder folder;
    return io::read_surface(scratch::put(folder / name, bytes));
}

std::string refusal(const std::string& name, const std::string& bytes) {
    return scratch::refusal(io::read_surface, name, bytes);
}

Array<Index> all_corners() {
    Array<Index> corners;
    for (const auto& f : faces) {
        corners.insert(corners.end(), f.begin(), f.end());
    }
    return corners;
}

struct Sample {
    std::string name;
    std::string bytes;
};

std::vector<Sample> samples() {
    return {{"a.off", off()},
            {"a.obj", obj()},
            {"a.ply", ascii_ply()},
            {"a.ply", binary_ply(false)},
            {"a.ply", binary_ply(true)},
            {"a.stl", ascii_stl()},
            {"a.stl", binary_stl()}};
}

} // namespace

TEST_CASE("OFF, OBJ and PLY keep every face and every bit of the coordinates", "[io]") {
    const std::vector<Sample> files{{"a.off", off()},
                                    {"a.OFF", off("# a comment\n\n")},
                                    {"a.obj", obj()},
                                    {"a.obj", obj("{}/1/1")},
                                    {"a.obj", obj("{}//1")},
                                    {"a.ply", ascii_ply()},
                                    {"a.ply", binary_ply(false)},
                                    {"a.ply", binary_ply(true)}};
    for (const Sample& file : files) {
        CAPTURE(file.bytes);
        const io::Soup soup = surface(file.name, file.bytes);
        CHECK(soup.points == Array<Point<3>>(points.begin(), points.end()));
        CHECK(soup.simplices[2].vertices == all_corners());
    }
}

TEST_CASE("A byte order mark before the first statement does not hide it", "[io]") {
    CHECK(surface("a.obj", "\xEF\xBB\xBF" + obj().substr(obj().find("v "))).points.size() == points.size());
    CHECK(surface("a.off", "\xEF\xBB\xBF" + off()).points.size() == points.size());
}

TEST_CASE("OBJ numbers that count from the last vertex are understood", "[io]") {
    CHECK(surface("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n").simplices[2].vertices ==
          Array<Index>{0, 1, 2});
}

TEST_CASE("STL vertices that are equal become one", "[io]") {
    for (const std::string& bytes : {ascii_stl(), binary_stl()}) {
        const io::Soup soup = surface("a.stl", bytes);
        REQUIRE(soup.points.size() == points.size());
        REQUIRE(soup.simplices[2].vertices.size() == 3 * faces.size());
        for (std::size_t i = 0; i < 3 * faces.size(); ++i) {
            const Point<3>& found = soup.points[soup.simplices[2].vertices[i]];
            for (std::size_t k = 0; k < 3; ++k) {
                CHECK(found[k] == static_cast<double>(static_cast<float>(points[all_corners()[i]][k])));
            }
        }
    }
}

TEST_CASE("A surface file without triangles is refused", "[io]") {
    for (const Sample& file : std::vector<Sample>{{"a.off", "OFF\n0 0 0\n"},
                                                  {"a.obj", "v 0 0 0\n"},
                                                  {"a.stl", "solid\nendsolid\n"},
                                                  {"a.stl", std::string(84, '\0')},
                                                  {"a.off", ""},
                                                  {"a.obj", ""},
                                                  {"a.ply", ""},
                                                  {"a.stl", ""},
                                                  {"a.xyz", off()}}) {
        CAPTURE(file.name, file.bytes);
        CHECK(!refusal(file.name, file.bytes).empty());
    }
}

TEST_CASE("A polygon that is not planar is refused with the face's number", "[io]") {
    const auto bent = [](const std::string& text) { return scratch::replaced(text, "-1e-20", "-0.01"); };
    CHECK_THAT(refusal("a.off", scratch::replaced(bent(off()), "3 1 2 3", "4 1 2 3 0")),
               Catch::Contains("line 9") && Catch::Contains("face 2 has 4 vertices") &&
                   Catch::Contains("not in one plane"));
    CHECK_THAT(refusal("a.obj", bent(obj()) + "f 1 2 3 4\n"), Catch::Contains("face 6 has 4 vertices"));
    CHECK_THAT(refusal("a.ply", scratch::replaced(bent(ascii_ply()), "0 3 1 2 3", "0 4 1 2 3 0")),
               Catch::Contains("face 2 has 4 vertices"));
}

namespace {

/// A face of the given outline in the plane z = x / 2 and a triangle beside it.
std::string off_of(const std::vector<std::array<double, 2>>& outline) {
    std::string text = fmt::format("OFF {} 2 0\n", outline.size() + 1);
    for (const auto& [x, y] : outline) {
        text += fmt::format("{} {} {}\n", x, y, x / 2);
    }
    text += fmt::format("9 9 9\n{}", outline.size());
    for (std::size_t i = 0; i < outline.size(); ++i) {
        text += fmt::format(" {}", i);
    }
    return text + fmt::format("\n3 0 1 {}\n", outline.size());
}

double flat_area(const io::Soup& soup, std::size_t triangle) {
    const auto corner = [&](std::size_t k) {
        return soup.points[soup.simplices[2].vertices[3 * triangle + k]];
    };
    const Point<3> a = corner(0);
    const Point<3> b = corner(1);
    const Point<3> c = corner(2);
    return ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
}

/// The sides of some triangles that no other one has the other way round.
std::set<std::pair<Index, Index>> outline_of(const io::Soup& soup, std::size_t triangles) {
    std::set<std::pair<Index, Index>> sides;
    for (std::size_t i = 0; i < triangles; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Index a = soup.simplices[2].vertices[3 * i + k];
            const Index b = soup.simplices[2].vertices[3 * i + (k + 1) % 3];
            if (sides.erase({b, a}) == 0) {
                sides.emplace(a, b);
            }
        }
    }
    return sides;
}

struct Outline {
    const char* name;
    std::vector<std::array<double, 2>> places;
    double area;
    double least; ///< area of the smallest triangle, at least
};

std::vector<Outline> outlines() {
    std::vector<std::array<double, 2>> comb{{0, 0}, {20, 0}};
    for (int i = 20; i > 0; i -= 2) {
        comb.push_back({i - 0.5, 5});
        comb.push_back({i - 1.5, 1});
    }
    double area = 0;
    for (std::size_t i = 0; i < comb.size(); ++i) {
        const auto& a = comb[i];
        const auto& b = comb[(i + 1) % comb.size()];
        area += (a[0] * b[1] - a[1] * b[0]) / 2;
    }
    return {
        {"a square", {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1, 0.5},
        {"an arrow head, of which one diagonal is outside", {{0, 0}, {4, 2}, {0, 4}, {1, 2}}, 6, 3},
        {"a quadrilateral with a better diagonal", {{0, 0}, {10, 0}, {10, 1}, {0, 4}}, 25, 5},
        {"a triangle with vertices on its sides", {{0, 0}, {1, 0}, {2, 0}, {1, 1}, {0, 2}, {0, 1}}, 2, 0.1},
        {"a vertex that is on a side up to rounding", {{0, 0}, {1, -1e-9}, {2, 0}, {0, 2}}, 2, 0.5},
        {"an L", {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 3, 0.4},
        {"a comb", comb, area, 0.01}};
}

} // namespace

TEST_CASE("A planar polygon becomes triangles that fill it and keep its sides", "[io]") {
    for (const Outline& outline : outlines()) {
        CAPTURE(outline.name);
        const std::size_t n = outline.places.size();
        const io::Soup soup = surface("a.off", off_of(outline.places));
        const io::SimplexBlock& block = soup.simplices[2];
        REQUIRE(block.size(2) == n - 1);
        double area = 0;
        for (std::size_t i = 0; i + 3 <= n; ++i) {
            CHECK(flat_area(soup, i) >= outline.least);
            CHECK(block.tag(i) == 0);
            area += flat_area(soup, i);
        }
        CHECK(block.tag(n - 2) == 1);
        CHECK(area == Approx(outline.area).epsilon(1e-8));
        const auto sides = outline_of(soup, n - 2);
        CHECK(sides.size() == n);
        for (Index i = 0; i < n; ++i) {
            CHECK(sides.contains({i, static_cast<Index>((i + 1) % n)}));
        }
        REQUIRE(soup.remarks.size() == 1);
        CHECK_THAT(soup.remarks[0],
                   Catch::Contains(fmt::format("1 planar polygons are cut into {} triangles", n - 2)));
    }
}

TEST_CASE("Polygons come from OBJ and PLY, too", "[io]") {
    const std::string vertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    const Array<Index> expected =
        surface("a.off", "OFF\n4 1 0\n" + vertices + "4 0 1 2 3\n").simplices[2].vertices;
    CHECK(expected.size() == 6);
    CHECK(surface("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 -3/1 -2//7 4\n").simplices[2].vertices ==
          expected);
    CHECK(surface("a.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                           "property float z\nelement face 1\nproperty list uchar int vertex_index\n"
                           "end_header\n" +
                               vertices + "4 0 1 2 3\n")
              .simplices[2]
              .vertices == expected);
}

TEST_CASE("Polygons that bound no plane area are refused", "[io]") {
    for (const Outline& outline : std::vector<Outline>{
             {"in a line", {{0, 0}, {1, 0}, {2, 0}, {3, 0}}, 0, 0},
             {"two triangles that cross", {{0, 0}, {2, 2}, {2, 0}, {0, 2}}, 0, 0},
             {"a side that goes back on itself", {{0, 0}, {2, 0}, {2, 2}, {2, 0}, {1, 1}}, 0, 0}}) {
        CAPTURE(outline.name);
        CHECK_THAT(refusal("a.off", off_of(outline.places)), Catch::Contains("face 0 has"));
    }
    CHECK_THAT(refusal("a.off", scratch::replaced(off(), "3 1 2 3", "2 1 2")), Catch::Contains("face 2"));
    CHECK_THAT(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n"), Catch::Contains("face 1 has 2"));
}

namespace {

/// The name of the group of each triangle.
std::vector<std::string> names_of_faces(const io::Soup& soup) {
    std::vector<std::string> names;
    for (const PatchNumber number : soup.simplices[2].physical) {
        names.push_back(number == 0 ? "" : patch_name(soup.groups[2], number));
    }
    return names;
}

} // namespace

TEST_CASE("Solids, groups, materials and part numbers are groups by their names", "[io]") {
    using Names = std::vector<std::string>;
    CHECK(names_of_faces(surface("a.stl", ascii_stl())) ==
          Names{"outer facet of the body", "outer facet of the body", "", "", ""});
    CHECK(names_of_faces(surface("a.stl", binary_stl())).empty());
    CHECK(names_of_faces(surface(
              "a.stl", scratch::replaced(ascii_stl(), "outer facet of the body", "k\xF6rper \"1\""))) ==
          Names{"k\xC3\xB6rper '1'", "k\xC3\xB6rper '1'", "", "", ""});
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    CHECK(
        names_of_faces(surface("a.obj", vertices + "o body\ng low\nf 1 3 2\ng top side\nusemtl red\nf 1 2 4\n"
                                                   "f 2 3 4\ng low\nf 3 1 4\n")) ==
        Names{"low", "top side", "top side", "low"});
    INFO("the one that parts the faces counts");
    CHECK(names_of_faces(surface("a.obj", vertices + "g default\nf 1 3 2\nusemtl red\nf 1 2 4\nusemtl blue\n"
                                                     "f 2 3 4\n")) == Names{"", "red", "blue"});
    CHECK(names_of_faces(surface("a.ply", scratch::replaced(ascii_ply(), "uchar flag", "uchar patch"))) ==
          Names(faces.size(), "0"));
}

TEST_CASE("An index one too high is refused with the face's number", "[io]") {
    CHECK_THAT(refusal("a.off", scratch::replaced(off(), "3 1 2 3", "3 1 2 4")),
               Catch::Contains("face 2 names vertex 4"));
    CHECK_THAT(refusal("a.obj", obj() + "f 1 2 5\n"), Catch::Contains("face 6 names vertex 5"));
    CHECK_THAT(refusal("a.obj", obj() + "f 0 1 2\n"), Catch::Contains("face 6 names vertex 0"));
    CHECK_THAT(refusal("a.ply", scratch::replaced(ascii_ply(), "0 3 1 2 3", "0 3 1 2 4")),
               Catch::Contains("face 2"));
    CHECK_THAT(refusal("a.ply", scratch::replaced(ascii_ply(), "0 3 1 2 3", "0 3 1 2 -1")),
               Catch::Contains("face 2"));
}

TEST_CASE("Coordinates that are no finite numbers are refused", "[io]") {
    for (const std::string bad : {"nan", "inf", "1e999", "1e300", "one", "--1"}) {
        CAPTURE(bad);
        CHECK(!refusal("a.off", scratch::replaced(off(), "0.1", bad)).empty());
        CHECK(!refusal("a.obj", scratch::replaced(obj(), "0.1", bad)).empty());
        CHECK(!refusal("a.ply", scratch::replaced(ascii_ply(), "0.1", bad)).empty());
        CHECK(!refusal("a.stl", scratch::replaced(ascii_stl(), "0.1", bad)).empty());
    }
    std::string stl = binary_stl();
    stl.replace(84 + 12, 4, scratch::binary(std::numeric_limits<float>::quiet_NaN()));
    CHECK_THAT(refusal("a.stl", stl), Catch::Contains("facet 0"));
}

TEST_CASE("A surface file cut short anywhere is refused", "[io]") {
    for (Sample file : samples()) {
        if (file.bytes == ascii_stl()) { // which would be whole after its first solid
            file.bytes = scratch::replaced(file.bytes, "endsolid outer\nsolid\n", "");
        }
        CAPTURE(file.name);
        const bool has_counts = file.name != "a.obj";
        const std::size_t whole =
            file.bytes.find_last_not_of("\n0123456789") + 1; // a shorter last number may be right
        for (std::size_t size = 0; size < std::min(whole, file.bytes.size() - 1); ++size) {
            const std::string message = refusal(file.name, file.bytes.substr(0, size));
            if (has_counts && message.empty()) {
                FAIL_CHECK("cut to " << size << " bytes");
            }
        }
    }
}

TEST_CASE("Huge claimed counts are refused at once", "[io]") {
    CHECK(!refusal("a.off", "OFF\n1000000000000000000 1 0\n0 0 0\n").empty());
    CHECK(!refusal("a.off", "OFF\n3 4000000000 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").empty());
    CHECK(
        !refusal("a.ply", scratch::replaced(ascii_ply(), "vertex 4", "vertex 1000000000000000000")).empty());
    CHECK(!refusal("a.ply", scratch::replaced(ascii_ply(), "face 5", "face 4294967295")).empty());
    std::string stl = binary_stl();
    stl.replace(80, 4, "\xff\xff\xff\xff");
    CHECK(!refusal("a.stl", stl).empty());
}

TEST_CASE("Random damage to a surface file never does more than refuse it", "[io]") {
    const scratch::Folder folder;
    for (const Sample& file : samples()) {
        CHECK(scratch::survive_damage(io::read_surface, file.bytes, folder / file.name, 500) > 0);
    }
}
