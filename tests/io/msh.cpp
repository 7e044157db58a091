// SPDX-License-Identifier: BSD-3-Clause
#include "io/scratch.h"
#include "io/soups.h"
#include "io/specimens.h"
#include "slabhull/core/parallel.h"
#include "slabhull/io/files.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <set>

using namespace slabhull;
using scratch::fixture;

namespace {

const std::string small_text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
                               "$PhysicalNames\n1\n3 7 \"room\"\n$EndPhysicalNames\n"
                               "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
                               "$Elements\n2\n1 2 2 5 1 1 2 3\n2 4 2 7 1 1 2 3 4\n$EndElements\n";

std::string text_refusal(const std::string& from, const std::string& to) {
    return scratch::refusal(io::read_msh, "a.msh", scratch::replaced(small_text, from, to));
}

PatchList walls_and_inlet() {
    return {{3, "inlet"}, {4, "walls"}};
}

} // namespace

TEST_CASE("Gmsh's unit cube is read from each of its formats: volume, patch areas and names are right",
          "[io]") {
    for (const char* name :
         {"cube_41_ascii.msh", "cube_41_binary.msh", "cube_41_parametric.msh", "coarse_41_binary.msh",
          "coarse_22_ascii.msh", "coarse_22_binary.msh", "views.msh", "cube_partitioned.msh"}) {
        CAPTURE(name);
        const io::Soup soup = io::read_msh(fixture(name));
        CHECK(soup.top_dimension() == 3);
        CHECK(soups::volume(soup) == Approx(1));
        CHECK(soups::area(soup, 3) == Approx(1));
        CHECK(soups::area(soup, 4) == Approx(5));
        CHECK(soup.groups[3] == PatchList{{7, "room"}});
        CHECK(patch_name(soup.groups[2], 3) == "inlet");
        CHECK(std::set<PatchNumber>(soup.simplices[3].physical.begin(), soup.simplices[3].physical.end()) ==
              std::set<PatchNumber>{7});
    }
}

TEST_CASE("A number that the reader's window cuts in two anywhere is read whole", "[io]") {
    const scratch::Folder folder;
    const std::string row = "-1.25e-05 -7 +2.5E+01\n"; // 4 MiB are in memory at once
    constexpr std::size_t nodes = 250'000;
    std::string text;
    for (std::size_t k = 1; k <= nodes; ++k) {
        text += fmt::format("{} {}", k, row);
    }
    for (std::size_t shift = 0; shift < row.size() + 7; ++shift) {
        CAPTURE(shift);
        const io::Soup soup = io::read_msh(
            scratch::put(folder / "a.msh",
                         fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\n{}\n$EndComments\n"
                                     "$Nodes\n{}\n{}$EndNodes\n$Elements\n1\n1 2 2 5 1 1 2 3\n$EndElements\n",
                                     std::string(shift, 'x'), nodes, text)));
        REQUIRE(soup.points.size() == nodes);
        REQUIRE(std::all_of(soup.points.begin(), soup.points.end(), [](const Point<3>& point) {
            return point == Point<3>{-1.25e-5, -7, 25};
        }));
    }
}

TEST_CASE("The same mesh in several formats gives the same soup", "[io]") {
    const auto check = [](const char* a, const char* b) {
        CAPTURE(a, b);
        CHECK(soups::same_mesh(io::read_msh(fixture(a)), io::read_msh(fixture(b))));
    };
    check("cube_41_ascii.msh", "cube_41_binary.msh");
    check("cube_41_ascii.msh", "cube_41_parametric.msh");
    check("coarse_22_ascii.msh", "coarse_22_binary.msh");
    check("coarse_22_ascii.msh", "coarse_41_binary.msh");
    CHECK_FALSE(soups::same_mesh(io::read_msh(fixture("cube_41_ascii.msh")),
                                 io::read_msh(fixture("coarse_41_binary.msh"))));
}

TEST_CASE("An entity in several groups counts for its first, and a group needs no name", "[io]") {
    const io::Soup several = io::read_msh(fixture("cube_41_binary.msh"));
    CHECK(several.groups[2] == walls_and_inlet());
    CHECK(soups::area(several, 12) == 0);
    const scratch::Folder folder;
    const io::Soup unnamed = io::read_msh(scratch::put(folder / "a.msh", small_text));
    CHECK(unnamed.groups[2] == PatchList{{5, ""}});
}

TEST_CASE("Node numbers with gaps, out of order, and comments are understood", "[io]") {
    const io::Soup soup = io::read_msh(fixture("gaps_22.msh"));
    const io::Soup plain = io::read_msh(fixture("coarse_22_ascii.msh"));
    REQUIRE(soup.simplices[3].vertices.size() == plain.simplices[3].vertices.size());
    for (std::size_t i = 0; i < soup.simplices[3].vertices.size(); ++i) {
        CHECK(soup.points[soup.simplices[3].vertices[i]] == plain.points[plain.simplices[3].vertices[i]]);
    }
    CHECK(soup.point_tag(soup.points.size() - 1) == 5);
    CHECK(soup.simplices[3].tag(0) == 7 * static_cast<std::int64_t>(soup.simplices[3].size(3)));
}

TEST_CASE("A size_t of four bytes is understood", "[io]") {
    const io::Soup soup = io::read_msh(fixture("size_t_4.msh"));
    CHECK(soups::volume(soup) == Approx(1));
    CHECK(soup.simplices[3].physical.front() == 7);
}

TEST_CASE("meshio's MSH files and their data are read", "[io]") {
    for (const char* name : {"meshio_41_ascii.msh", "meshio_41_binary.msh", "meshio_22_binary.msh"}) {
        CAPTURE(name);
        const io::Soup soup = io::read_msh(fixture(name));
        CHECK(soups::volume(soup) == Approx(1));
        soups::check_point_data(soup);
        REQUIRE(soup.find_cell_data("number") != nullptr);
        CHECK(std::get<Array<double>>(soup.find_cell_data("number")->values).at(5) == 5);
    }
}

TEST_CASE("Gmsh's views come as data where they cover all nodes or all tetrahedra", "[io]") {
    const io::Soup soup = io::read_msh(fixture("views.msh"));
    REQUIRE(soup.find_point_data("x") != nullptr);
    const auto& x = std::get<Array<double>>(soup.find_point_data("x")->values);
    for (std::size_t i = 0; i < soup.points.size(); ++i) {
        CHECK(x[i] == soup.points[i][0]);
    }
    REQUIRE(soup.find_cell_data("tag") != nullptr);
    const auto& tags = std::get<Array<double>>(soup.find_cell_data("tag")->values);
    for (std::size_t i = 0; i < tags.size(); ++i) {
        CHECK(tags[i] == static_cast<double>(soup.simplices[3].tag(i)));
    }
    CHECK(soup.find_point_data("some") == nullptr);
}

TEST_CASE("What we do not read is refused by name", "[io]") {
    CHECK_THAT(scratch::refusal(io::read_msh, fixture("quads.msh")), Catch::Contains("is a quadrangle"));
    CHECK_THAT(scratch::refusal(io::read_msh, fixture("second_order.msh")),
               Catch::Contains("second-order triangle"));
    CHECK_THAT(scratch::refusal(io::read_msh, fixture("cube_40.msh")), Catch::Contains("MSH version 4"));
    CHECK_THAT(scratch::refusal(io::read_msh, fixture("vtk_ascii.vtu")),
               Catch::Contains("line 1: this is no MSH file"));
    const scratch::Folder folder;
    std::string unmarked = scratch::bytes_of(fixture("coarse_41_binary.msh"));
    unmarked = scratch::replaced(unmarked, scratch::binary(1) + "\n$End", std::string("\0\0\1\0\n$End", 9));
    CHECK_THAT(scratch::refusal(io::read_msh, scratch::put(folder / "a.msh", unmarked)),
               Catch::Contains("byte order") && Catch::Contains("byte "));
}

TEST_CASE("Faults in an MSH file are refused with line and entity", "[io]") {
    using Catch::Contains;
    CHECK_THAT(text_refusal("1 2 3 4\n$EndE", "1 2 3 5\n$EndE"),
               Contains("line 18") && Contains("element 2 names node 5"));
    CHECK_THAT(text_refusal("3 0 1 0", "2 0 1 0"), Contains("node 2 appears twice"));
    CHECK_THAT(text_refusal("3 0 1 0", "3 0 nan 0"), Contains("line 12") && Contains("node 3"));
    CHECK_THAT(text_refusal("3 0 1 0", "3 0 1e999 0"), Contains("line 12"));
    CHECK_THAT(text_refusal("3 0 1 0", "3 0 one 0"), Contains("\"one\""));
    CHECK_THAT(text_refusal("$Nodes\n4", "$Nodes\n5"), Contains("not \"$EndNodes\""));
    CHECK_THAT(text_refusal("$Nodes\n4", "$Nodes\n3"), Contains("$EndNodes was expected"));
    CHECK_THAT(text_refusal("$Nodes\n4", "$Nodes\n1000000000000000000"),
               Contains("1000000000000000000 nodes"));
    CHECK_THAT(text_refusal("$Nodes\n4", "$Nodes\n-4"), Contains("\"-4\""));
    CHECK_THAT(text_refusal("$Elements\n2", "$Elements\n1000000000000000000"),
               Contains("elements are claimed"));
    CHECK_THAT(text_refusal("2 4 2 7", "2 4 4000000000 7"), !Catch::Equals(""));
    CHECK_THAT(text_refusal("2 4 2 7", "2 11 2 7"), Contains("element 2 is a second-order tetrahedron"));
    CHECK_THAT(text_refusal("2.2 0 8", "3.0 0 8"), Contains("3.0"));
    CHECK_THAT(text_refusal("$EndElements\n", ""), Contains("$EndElements was expected"));
    CHECK_THAT(scratch::refusal(io::read_msh, "/nowhere/a.msh"),
               Contains("/nowhere/a.msh") && Contains("No such file"));
    CHECK_THAT(scratch::refusal(io::read_msh, "/tmp"), Contains("/tmp"));
}

TEST_CASE("Unknown sections are passed over", "[io]") {
    const scratch::Folder folder;
    const std::string more = scratch::replaced(small_text, "$Nodes", "$Odd\n1 2 junk $ \n$EndOdd\n$Nodes");
    CHECK(soups::same_mesh(io::read_msh(scratch::put(folder / "a.msh", more)),
                           io::read_msh(scratch::put(folder / "b.msh", small_text))));
}

TEST_CASE("An MSH file cut short anywhere is refused", "[io]") {
    const scratch::Folder folder;
    for (const char* name :
         {"size_t_4.msh", "coarse_22_binary.msh", "coarse_22_ascii.msh", "meshio_41_binary.msh"}) {
        CAPTURE(name);
        const std::string bytes = scratch::bytes_of(fixture(name));
        for (std::size_t size = 0; size + 1 < bytes.size(); ++size) {
            const std::string kept = bytes.substr(0, size);
            const bool ends_with_section = kept.find("$EndElements") != std::string::npos &&
                                           kept.substr(kept.rfind('$')).starts_with("$End") &&
                                           bytes.substr(kept.rfind('$')).find('\n') <= size - kept.rfind('$');
            if (!ends_with_section &&
                scratch::refusal(io::read_msh, scratch::put(folder / "a.msh", kept)).empty()) {
                FAIL_CHECK("cut to " << size << " bytes");
            }
        }
    }
}

TEST_CASE("Random damage to an MSH file never does more than refuse it", "[io]") {
    const scratch::Folder folder;
    for (const char* name : {"size_t_4.msh", "coarse_22_binary.msh", "coarse_22_ascii.msh",
                             "coarse_41_binary.msh", "meshio_41_ascii.msh", "meshio_41_binary.msh"}) {
        CHECK(scratch::survive_damage(io::read_msh, scratch::bytes_of(fixture(name)), folder / "a.msh",
                                      1000) > 0);
    }
}

TEST_CASE("What is written as MSH comes back bit for bit", "[io]") {
    const scratch::Folder folder;
    for (const specimens::Grid& grid :
         {specimens::Grid{1, 1}, specimens::Grid{1, 9}, specimens::Grid{2, 1}, specimens::Grid{2, 9},
          specimens::Grid{3, 1}, specimens::Grid{3, 6}}) {
        const io::MeshColumns mesh = grid.columns();
        io::write_msh(folder / "a.msh", mesh);
        const io::Soup soup = io::read_mesh(folder / "a.msh");
        const auto top = static_cast<std::size_t>(grid.dimension);
        CHECK(soup.points == Array<Point<3>>(grid.points.begin(), grid.points.end()));
        CHECK(soup.simplices[top].vertices == Array<Index>(grid.cells.begin(), grid.cells.end()));
        CHECK(soup.groups[top] == PatchList{{2, "side a"}, {5, "initial"}, {9, "end"}});
        for (const auto& group : mesh.groups) {
            for (std::size_t cell = group.begin; cell < group.end; ++cell) {
                CHECK(soup.simplices[top].physical[cell] == group.number);
                CHECK(soup.simplices[top].tag(cell) == static_cast<std::int64_t>(cell + 1));
            }
        }
        REQUIRE(soup.find_point_data("t") != nullptr);
        CHECK(std::get<Array<double>>(soup.find_point_data("t")->values) ==
              Array<double>(grid.time.begin(), grid.time.end()));
        REQUIRE(soup.find_cell_data("pair_1") != nullptr);
        const auto& second = std::get<Array<double>>(soup.find_cell_data("pair_1")->values);
        CHECK(second.back() == static_cast<double>(grid.pairs.back()));
    }
}

TEST_CASE("A name that MSH cannot quote is refused, and no file appears", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{2, 1};
    for (const char* name : {"a\"b", "a\nb"}) {
        io::MeshColumns mesh = grid.columns();
        mesh.groups = {{0, mesh.cells.rows(), 1, name}};
        CHECK_THROWS_AS(io::write_msh(folder / "a.msh", mesh), FormatLimit);
        CHECK(folder.file_count() == 0);
    }
}

TEST_CASE("A byte order mark before an MSH or STL file is skipped", "[io]") {
    const scratch::Folder folder;
    const std::string mark = "\xEF\xBB\xBF";
    const specimens::Grid grid{2, 1};
    io::write_msh(folder / "a.msh", grid.columns(), {io::MshVersion::v4_1, true});
    scratch::put(folder / "b.msh", mark + scratch::bytes_of(folder / "a.msh"));
    CHECK(io::read_mesh(folder / "b.msh").points == io::read_mesh(folder / "a.msh").points);
    scratch::put(folder / "c.stl", mark +
                                       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                       "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n");
    CHECK(io::read_mesh(folder / "c.stl").points.size() == 3);
}

TEST_CASE("A mesh without groups is one block without a name", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{3, 2};
    io::MeshColumns mesh = grid.columns();
    mesh.groups.clear();
    io::write_msh(folder / "a.msh", mesh);
    const io::Soup soup = io::read_msh(folder / "a.msh");
    CHECK(soup.groups[3].empty());
    CHECK(soup.simplices[3].physical.front() == 0);
    mesh.groups = {{0, 1, 1, "one"}};
    CHECK_THROWS_AS(io::write_msh(folder / "b.msh", mesh), std::invalid_argument);
    CHECK(folder.file_count() == 1);
}

TEST_CASE("Each of thousands of groups comes back with its cells and its name, from one file and from pieces",
          "[io]") {
    const specimens::Grid grid{2, 32};
    io::MeshColumns mesh = grid.columns();
    mesh.groups.clear();
    for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
        const auto number = static_cast<PatchNumber>(cell * 37 % 2000 + 1); // some twice, far apart
        mesh.groups.push_back({cell, cell + 1, number, fmt::format("group {}", number)});
    }
    const auto cells_of = [&](const std::filesystem::path& path) {
        const io::Soup soup = io::read_msh(path);
        const io::SimplexBlock& triangles = soup.simplices[2];
        std::set<std::pair<PatchNumber, std::int32_t>> entities;
        for (std::size_t i = 0; i < triangles.size(2); ++i) {
            const auto& group = mesh.groups.at(static_cast<std::size_t>(triangles.tag(i) - 1));
            REQUIRE(triangles.physical[i] == group.number);
            REQUIRE(patch_name(soup.groups[2], group.number) == group.name);
            entities.emplace(group.number, triangles.entity[i]);
        }
        const auto numbers =
            std::set<PatchNumber>(triangles.physical.begin(), triangles.physical.end()).size();
        CHECK(soup.groups[2].size() == 2000);
        CHECK(entities.size() == numbers); // one entity for each number ...
        CHECK(std::set<std::int32_t>(triangles.entity.begin(), triangles.entity.end()).size() ==
              numbers); // ... of its own
        return triangles.size(2);
    };
    const scratch::Folder folder;
    for (const io::MshOptions& options :
         {io::MshOptions{}, io::MshOptions{.ascii = true}, io::MshOptions{.version = io::MshVersion::v2_2}}) {
        io::write_msh(folder / "whole.msh", mesh, options);
        CHECK(cells_of(folder / "whole.msh") == grid.cell_count());
    }
    io::AtomicFiles files;
    io::write_msh_pieces(files, folder / "piece.msh", mesh, 3);
    files.commit();
    std::size_t cells = 0;
    for (const auto& path : files.paths()) {
        cells += cells_of(path);
    }
    CHECK(cells == grid.cell_count());
}

TEST_CASE("The bytes of an MSH file do not depend on the number of threads", "[io]") {
    const scratch::Folder folder;
    const specimens::Grid grid{3, 30};
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        io::write_msh(folder / fmt::format("{}.msh", threads), grid.columns());
    }
    set_thread_count(0);
    CHECK(scratch::bytes_of(folder / "1.msh") == scratch::bytes_of(folder / "2.msh"));
    CHECK(scratch::bytes_of(folder / "1.msh") == scratch::bytes_of(folder / "5.msh"));
}
