// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/scratch.h"

#include <catch2/catch.hpp>

#include <random>

using namespace slabhull;
using Catch::Contains;

namespace {

io::CsvTable table(const std::string& text) {
    const scratch::Folder folder;
    return io::read_motion_table(scratch::put(folder / "table.csv", text));
}

std::string table_refusal(const std::string& text) {
    return scratch::refusal(io::read_motion_table, "table.csv", text);
}

void check_same(const io::CsvTable& a, const io::CsvTable& b) {
    CHECK(a.columns == b.columns);
    CHECK(a.values == b.values);
}

const std::string two_rows = "time,x,angle_deg\n0,1.5,-90\n2,2.5e-3,45\n";

/// OpenFOAM's own layout.
const std::string foam = "2\n(\n(0 ((0.25 0.50 1.0) (1.0 2.0 1.5)))\n(0.5 ((0 -1 2) (10 20 30)))\n)\n";

} // namespace

TEST_CASE("A table has named columns of numbers, and knows the line of each row", "[io]") {
    const io::CsvTable read = table(two_rows);
    CHECK(read.columns == std::vector<std::string>{"time", "x", "angle_deg"});
    CHECK(read.values == Array<double>{0, 1.5, -90, 2, 2.5e-3, 45});
    CHECK(read.rows() == 2);
    CHECK(read.lines == Array<std::size_t>{2, 3});
    CHECK(read.at(1, 2) == 45);
    CHECK(read.find("x") == 1);
    CHECK_FALSE(read.find("y").has_value());
}

TEST_CASE("Separators, quotes, blanks, comments, line ends and byte order marks do not matter", "[io]") {
    for (const char* text :
         {"time;x;angle_deg\r\n0;1.5;-90\r\n2;2.5e-3;45", "# time x angle_deg\n0 1.5 -90\n2\t2.5e-3  45\n",
          "\xEF\xBB\xBF\n\"time\", \"x\", \"angle_deg\"\n\n# first\n 0 , +1.5, -90.0 "
          "\n\"2\",0.0025,4.5e1\n\n",
          "time\tx\tangle_deg\n0\t1.5\t-90\n2\t25e-4\t45\n"}) {
        CAPTURE(text);
        check_same(table(text), table(two_rows));
    }
    CHECK(table("time\n0\n").values == Array<double>{0});
    CHECK(table("time,x\n").rows() == 0);
}

TEST_CASE("OpenFOAM's list of six degrees of freedom is the table of its rows", "[io]") {
    const io::CsvTable read = table(foam);
    check_same(read,
               table("time,x,y,z,roll_deg,pitch_deg,yaw_deg\n0,0.25,0.5,1,1,2,1.5\n0.5,0,-1,2,10,20,30\n"));
    CHECK(read.lines == Array<std::size_t>{3, 4});
    check_same(
        table("// made by a script /* \n/* two\nrows */((0((.25 .5 1)(1 2 1.5)))(0.5((0 -1 2)(10 20 30))));"),
        read);
}

TEST_CASE("A damaged table is refused with its line and column", "[io]") {
    CHECK_THAT(table_refusal(""), Contains("table.csv: line 1") && Contains("empty"));
    CHECK_THAT(table_refusal("\n\n#\n"), Contains("empty"));
    CHECK_THAT(table_refusal("0,1,2\n3,4,5\n"),
               Contains("line 1") && Contains("column 1") && Contains("\"0\""));
    CHECK_THAT(table_refusal("time,,x\n"), Contains("line 1") && Contains("column 2"));
    CHECK_THAT(table_refusal("time,x,x\n"), Contains("two columns \"x\""));
    CHECK_THAT(table_refusal("time,x\n0,1\n1,abc\n"),
               Contains("line 3") && Contains("\"x\"") && Contains("\"abc\""));
    CHECK_THAT(table_refusal("time,x\n0,1\n1,\n"), Contains("line 3") && Contains("\"x\""));
    CHECK_THAT(table_refusal("time,x,y\n0,,1\n"), Contains("line 2") && Contains("\"x\""));
    for (const char* number :
         {"nan", "inf", "-infinity", "1e999", "0x10", "1.5.2", "1,5", "--1", "+-1", "1e", "1 2"}) {
        CAPTURE(number);
        CHECK_THAT(table_refusal("time,x\n0," + std::string{number} + "\n"), Contains("table.csv: line 2"));
    }
    CHECK_THAT(table_refusal("time,x,y\n0,1,2\n1,2"),
               Contains("line 3") && Contains("\"y\"") && Contains("2 values"));
    CHECK_THAT(table_refusal("time,x\n0,1,2\n"), Contains("line 2") && Contains("more than the 2 values"));
    CHECK_THAT(scratch::refusal(io::read_csv, "/nowhere/at.all"), Contains("No such file"));
}

TEST_CASE("A damaged list of OpenFOAM's is refused with its line", "[io]") {
    CHECK_THAT(table_refusal("3" + foam.substr(1)), Contains("2 rows, where 3 are announced"));
    CHECK_THAT(table_refusal("(\n(0 ((1 2 3) (1 2)))\n)"), Contains("line 2") && Contains("\"yaw_deg\""));
    CHECK_THAT(table_refusal("(\n(0 ((1 2 3) (1 2 3 4)))\n)"), Contains("line 2") && Contains("\"4\""));
    CHECK_THAT(table_refusal("(\n(0 ((1 2 nan) (1 2 3)))\n)"), Contains("line 2") && Contains("\"z\""));
    CHECK_THAT(table_refusal("((0 ((1 2 3) (1 2 3)))) more"), Contains("\"more\""));
    CHECK_THAT(table_refusal("(0 1)"), Contains("line 1"));
    for (std::size_t length = 2; length < foam.size() - 1; ++length) { // torn anywhere
        CHECK_THAT(table_refusal(foam.substr(0, length)), Contains("table.csv: line"));
    }
}

TEST_CASE("A table torn anywhere is refused, or is a shorter table", "[io]") {
    for (std::size_t length = 0; length < two_rows.size(); ++length) {
        const std::string text = two_rows.substr(0, length);
        try {
            const io::CsvTable read = table(text);
            CHECK(read.values.size() == read.rows() * read.columns.size());
        } catch (const InputError& error) {
            CHECK_THAT(error.what(), Contains("table.csv: line"));
        }
    }
}

TEST_CASE("Garbage of any size is refused with a short message fit for a terminal", "[io]") {
    std::mt19937_64 random{7};
    std::string noise(20'000'000, '\0');
    for (char& c : noise) {
        c = static_cast<char>(random());
    }
    for (const std::string& text :
         {noise, "time,x\n" + noise, "(" + noise, std::string(20'000'000, ','), std::string(20'000'000, 'a'),
          std::string(20'000'000, '('), std::string(20'000'000, '\0'),
          "a" + std::string(20'000'000, ' ') + "\n\x1b[2J"}) {
        const std::string message = table_refusal(text);
        CHECK_THAT(message, Contains("table.csv: line"));
        CHECK(message.size() < 300);
        CHECK(std::all_of(message.begin(), message.end(),
                          [](unsigned char c) { return c >= ' ' && c < 0x7F; }));
    }
    std::string wide = "c0";
    for (int i = 1; i <= 1000; ++i) {
        wide += ",c" + std::to_string(i);
    }
    CHECK_THAT(table_refusal(wide + "\n"), Contains("1000 columns at most"));
}
