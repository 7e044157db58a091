// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/scratch.h"

#include <catch2/catch.hpp>

using namespace slabhull;

namespace {

io::Soup curve(const std::string& text) {
    const scratch::Folder folder;
    return io::read_curve(scratch::put(folder / "curve.dat", text));
}

std::string curve_refusal(const std::string& text) {
    return scratch::refusal(io::read_curve, "curve.dat", text);
}

} // namespace

TEST_CASE("A curve is a closed loop of lines in the order of its points", "[io]") {
    const io::Soup soup = curve("0 0\n1 0.5\n0.1 1\n");
    REQUIRE(soup.points.size() == 3);
    CHECK(soup.points[1] == Point<3>{1, 0.5, 0});
    CHECK(soup.points[2] == Point<3>{0.1, 1, 0});
    CHECK(soup.simplices[1].vertices == Array<Index>{0, 1, 1, 2, 2, 0});
    CHECK(soup.top_dimension() == 1);
}

TEST_CASE("Titles, comments, blank lines, line ends and a repeated last point do not matter", "[io]") {
    const io::Soup plain = curve("0 0\n1 0.5\n0.1 1\n");
    for (const char* text :
         {"NACA 0012\n0 0\n1 0.5\n0.1 1\n", "# made by hand\n\n 0 0\n\n1 0.5\n0.1 1",
          "0 0\r\n1 0.5\r\n0.1 1\r\n", "0 0\n1 0.5\n0.1 1\n0 0\n", "0\t+0\n  1   .5\n1e-1 1  \n"}) {
        const io::Soup soup = curve(text);
        CHECK(soup.points == plain.points);
        CHECK(soup.simplices[1].vertices == plain.simplices[1].vertices);
    }
}

TEST_CASE("A damaged curve file is refused with its line", "[io]") {
    CHECK_THAT(curve_refusal("0 0\n1 x\n0 1\n"),
               Catch::Contains("curve.dat: line 2") && Catch::Contains("\"x\""));
    CHECK_THAT(curve_refusal("0 0\n1\n0 1\n"), Catch::Contains("line 2"));
    CHECK_THAT(curve_refusal("0 0\n1 2 3\n0 1\n"), Catch::Contains("line 2"));
    CHECK_THAT(curve_refusal("title\n0 0\n1 nan\n0 1\n"), Catch::Contains("line 3"));
    CHECK_THAT(curve_refusal("0 0\n1 1\nnan 1\n"), Catch::Contains("line 3"));
    CHECK_THAT(curve_refusal("0 0\n1 1e999\n0 1\n"), Catch::Contains("line 2"));
    CHECK_THAT(curve_refusal("0 0\n1 0\n0 0\n"), Catch::Contains("2 points"));
    CHECK_THAT(curve_refusal(""), Catch::Contains("0 points"));
    CHECK_THAT(scratch::refusal(io::read_curve, "/nowhere/at.all"), Catch::Contains("No such file"));
}

namespace {

constexpr const char* lednicer =
    "AIRFOIL\n  4.  3.\n\n 0 0\n 0.2 0.1\n 0.6 0.1\n 1 0.01\n\n 0 0\n 0.5 -0.1\n 1 -0.01\n";

} // namespace

TEST_CASE("An airfoil in Lednicer's order is one curve around both sides", "[io]") {
    const io::Soup soup = curve(lednicer);
    CHECK(soup.points ==
          Array<Point<3>>{
              {1, 0.01, 0}, {0.6, 0.1, 0}, {0.2, 0.1, 0}, {0, 0, 0}, {0.5, -0.1, 0}, {1, -0.01, 0}});
    REQUIRE(soup.remarks.size() == 1);
    CHECK_THAT(soup.remarks[0], Catch::Contains("4 points of an upper and 3 of a lower side"));
    INFO("a common trailing edge is one point");
    CHECK(curve(scratch::replaced(lednicer, "1 -0.01", "1 0.01")).points.size() == 5);
}

TEST_CASE("What only looks like Lednicer's order is told so, and a polygon stays one", "[io]") {
    CHECK_THAT(curve_refusal(scratch::replaced(lednicer, "4.  3.", "4.  4.")),
               Catch::Contains("Lednicer") && Catch::Contains("7 points follow"));
    CHECK_THAT(curve_refusal(scratch::replaced(lednicer, " 0 0\n 0.5", " 0.9 0\n 0.5")),
               Catch::Contains("do not start at one place"));
    CHECK(curve("10 10\n11 10\n11 11\n10.5 12\n10 11\n").points.size() == 5);
    CHECK(curve("3 2\n0 4\n-3 4\n-6 0\n0 -5\n3 -5\n").points.size() == 6);
}
