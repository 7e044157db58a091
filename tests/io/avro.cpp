// SPDX-License-Identifier: BSD-3-Clause
#include "io/scratch.h"
#include "io/soups.h"
#include "io/specimens.h"
#include "slabhull/io/files.h"

#include <catch2/catch.hpp>

using namespace slabhull;
using soups::says;

namespace {

const std::string small_avro =
    "{ \"dim\": 4, \"number\":3, \"nb_ghost\":0, \"type\":\"simplex\",\n\"vertices\":\n [\n  0, 0, 0, 0.5,\n"
    "  1, 0, 0, 0.5, 0,1,0,1e-3,\n 0, 0, 1, -2 ],\n\"normals\": [[1, {\"a]\\\"\": \"}\"}], true],\n"
    "\"elements\":\n[ 0, 1, 2, 3 ]\n}\n";

std::string avro_refusal(const std::string& from, const std::string& to) {
    return scratch::refusal(io::read_avro, "a.avro", scratch::replaced(small_avro, from, to));
}

} // namespace

TEST_CASE("An avro mesh is read, the fourth coordinate as time, other keys passed over", "[io]") {
    const scratch::Folder folder;
    const io::Soup soup = io::read_avro(scratch::put(folder / "a.avro", small_avro));
    CHECK(soup.points == Array<Point<3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    CHECK(soup.simplices[3].vertices == Array<Index>{0, 1, 2, 3});
    REQUIRE(soup.find_point_data("t") != nullptr);
    CHECK(std::get<Array<double>>(soup.find_point_data("t")->values) == Array<double>{0.5, 0.5, 1e-3, -2});
}

TEST_CASE("Keys of an avro mesh come in any order, and two coordinates make a plane", "[io]") {
    const scratch::Folder folder;
    const std::string text =
        "{\"elements\":[0,1,2],\"type\":\"simplex\",\"vertices\":[0,0,1,0,0,1],\"number\":2,"
        "\"dim\":2}";
    const io::Soup soup = io::read_avro(scratch::put(folder / "a.avro", text));
    CHECK(soup.points == Array<Point<3>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(soup.simplices[2].vertices == Array<Index>{0, 1, 2});
    CHECK(soup.point_data.empty());
}

TEST_CASE("What is written for avro comes back bit for bit", "[io]") {
    const scratch::Folder folder;
    for (const specimens::Grid& grid :
         {specimens::Grid{1, 9}, specimens::Grid{2, 50}, specimens::Grid{3, 1}, specimens::Grid{3, 12}}) {
        io::write_avro(folder / "a.avro", grid.columns());
        const io::Soup soup = io::read_avro(folder / "a.avro");
        const auto top = static_cast<std::size_t>(grid.dimension);
        CHECK(soup.points == Array<Point<3>>(grid.points.begin(), grid.points.end()));
        CHECK(soup.simplices[top].vertices == Array<Index>(grid.cells.begin(), grid.cells.end()));
        CHECK((soup.find_point_data("t") != nullptr) == (grid.dimension == 3));
        if (grid.dimension == 3) {
            CHECK(std::get<Array<double>>(soup.find_point_data("t")->values) ==
                  Array<double>(grid.time.begin(), grid.time.end()));
        }
    }
}

TEST_CASE("Tetrahedra without times are written with three coordinates", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{3, 2};
    io::MeshColumns mesh = grid.columns();
    mesh.point_data.clear();
    io::write_avro(folder / "a.avro", mesh);
    CHECK(scratch::bytes_of(folder / "a.avro").starts_with("{\"dim\": 3, \"number\": 3,"));
    CHECK(io::read_avro(folder / "a.avro").points == Array<Point<3>>(grid.points.begin(), grid.points.end()));
}

TEST_CASE("A damaged avro mesh is refused with line and entity", "[io]") {
    says(avro_refusal("{ \"dim\"", "\"dim\""), "line 1: '{' was expected at the start");
    says(avro_refusal("\"dim\": 4", "\"dim\": 5"), "line 1: dimension 2, 3 or 4 was expected");
    says(avro_refusal("\"dim\": 4", "\"dim\": 3"), "line 3: 16 coordinates are not 3 for each vertex");
    says(avro_refusal("\"number\":3", "\"number\":4"), "simplices of dimension 1, 2 or 3");
    says(avro_refusal("\"number\":3", "\"number\":2"),
         "line 9: 4 vertices' numbers are not 3 for each element");
    says(avro_refusal("\"nb_ghost\":0", "\"nb_ghost\":1"), "ghost vertices are not read");
    says(avro_refusal("simplex", "polytope"), "only the type \"simplex\"");
    says(avro_refusal("1e-3", "nan"), "line 3: vertex 2 has a coordinate that is not a finite number");
    says(avro_refusal("1e-3", "1e-3x"), "line 5");
    says(avro_refusal("0, 1, 2, 3 ]\n", "0, 1, 2, 4 ]\n"),
         "line 9: element 0 has the vertex 4, but there are 4");
    says(avro_refusal("0, 1, 2, 3 ]\n", "0, 1, 2, -3 ]\n"), "was expected, not \"-3\"");
    says(avro_refusal("0, 1, 2, 3 ]\n", "0, 1, 2, 1000000000000000000 ]\n"), "line 9");
    says(avro_refusal("\"elements\"", "\"vertices\""), "\"vertices\" appears twice");
    says(avro_refusal("\"elements\"", "\"Elements\""), "there is no \"elements\"");
    says(avro_refusal(" ]\n}\n", " ]\n} ]\n"), "the end of the file was expected");
}

TEST_CASE("Brackets nested a million deep are passed over or refused, without a deep stack", "[io]") {
    const std::size_t deep = 1000000;
    CHECK(avro_refusal("true]", std::string(deep, '[') + std::string(deep, ']') + "]") == "");
    says(avro_refusal("true]", std::string(deep, '[')), "the file ends within a value");
}

TEST_CASE("An avro mesh torn anywhere, or damaged at random, never does more than be refused", "[io]") {
    const scratch::Folder folder;
    for (std::size_t size = 0; size + 1 < small_avro.size(); ++size) {
        CHECK(scratch::refusal(io::read_avro, scratch::put(folder / "a.avro", small_avro.substr(0, size))) !=
              "");
    }
    io::write_avro(folder / "b.avro", specimens::Grid(3, 2).columns());
    CHECK(scratch::survive_damage(io::read_avro, scratch::bytes_of(folder / "b.avro"), folder / "a.avro",
                                  5000) > 0);
    CHECK(scratch::survive_damage(io::read_avro, small_avro, folder / "a.avro", 5000) > 0);
}
