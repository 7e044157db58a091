// SPDX-License-Identifier: BSD-3-Clause
#include "io/scratch.h"
#include "slabhull/io/space_time_files.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace slabhull;

namespace {

/// Numbers with gaps and out of order, an entry of a whole convex, and a section of another kind.
const std::string small =
    "% GETFEM MESH FILE \n% GETFEM VERSION 5.4.2\n\n\n\nBEGIN POINTS LIST\n\n  POINT COUNT 5\n"
    "  POINT  3  0  0  0\n  POINT  7  1  0  0\n  POINT 8 0 1 0\n  POINT  9 0 0 1e-3\n"
    "  POINT 2 -1.5 0.25 0.1\n\nEND POINTS LIST\n\n\n\nBEGIN MESH STRUCTURE DESCRIPTION\n\n"
    "  CONVEX COUNT 2\n  CONVEX 4    'GT_PK(3,1)'      3  7  8  9\n"
    "  CONVEX 1 'GT_PK(3,1)' 3 9 8 2\n\nEND MESH STRUCTURE DESCRIPTION\n"
    "BEGIN REGION 2\n4/1 4/3 4/2\nEND REGION 2\n% more\nBEGIN MESH_FEM\n\nQDIM 1\nEND MESH_FEM\n"
    "BEGIN REGION 5\n1 1/0 \nEND REGION 5\n";

io::SpaceTimeSoup read(const std::string& text) {
    const scratch::Folder folder;
    return io::read_space_time(scratch::put(folder / "a.getfem", text));
}

void refuses(const std::string& from, const std::string& to, const std::string& message) {
    CHECK_THAT(scratch::refusal(io::read_space_time, "a.getfem", scratch::replaced(small, from, to)),
               Catch::Contains(message));
}

/// Points of which each digit counts, simplices on them, and a facet of each attribute.
struct Written {
    int dimension;
    std::vector<double> points;
    std::vector<std::int64_t> cells;
    std::vector<std::int64_t> facets;
    std::vector<std::int64_t> attribute;
    std::vector<std::int64_t> sides;

    io::SpaceTimeColumns columns() const {
        io::SpaceTimeColumns mesh;
        mesh.dimension = dimension;
        mesh.points = Column<double>::over(std::span<const double>{points}, dimension);
        mesh.cells = Column<std::int64_t>::over(std::span<const std::int64_t>{cells}, dimension + 1);
        mesh.facets = Column<std::int64_t>::over(std::span<const std::int64_t>{facets}, dimension);
        mesh.facet_attribute = Column<std::int64_t>::over(std::span<const std::int64_t>{attribute});
        mesh.facet_side = Column<std::int64_t>::over(std::span<const std::int64_t>{sides});
        return mesh;
    }
};

Written two_simplices(int dimension) {
    Written mesh{dimension, {}, {}, {}, {1, 1, 2, 7}, {}};
    for (int v = 0; v < dimension + 2; ++v) {
        for (int k = 0; k < dimension; ++k) {
            mesh.points.push_back(v == k ? std::nextafter(1.0 / 3, v)
                                         : std::sin(17.0 * v + k) * std::pow(10, v - k));
        }
    }
    mesh.points[0] = std::numeric_limits<double>::denorm_min();
    mesh.points[1] = -std::numeric_limits<double>::max();
    for (int c = 0; c < 2; ++c) {
        for (int i = 0; i <= dimension; ++i) {
            mesh.cells.push_back((c + i) % (dimension + 2));
        }
    }
    for (const int side : {0, 2, dimension + 1, dimension + 2}) { // opposite to corners of both cells
        const int cell = side / (dimension + 1);
        mesh.sides.push_back(side);
        for (int i = 0; i <= dimension; ++i) {
            if (i != side % (dimension + 1)) {
                mesh.facets.push_back(mesh.cells[static_cast<std::size_t>(cell * (dimension + 1) + i)]);
            }
        }
    }
    return mesh;
}

/// Facets as sets of vertices, in order.
template<class Values>
std::vector<std::vector<std::int64_t>> as_sets(const Values& facets, int corners) {
    std::vector<std::vector<std::int64_t>> sets;
    for (std::size_t i = 0; i < facets.size(); i += static_cast<std::size_t>(corners)) {
        const auto begin = facets.begin() + static_cast<std::ptrdiff_t>(i);
        sets.emplace_back(begin, begin + corners);
        std::sort(sets.back().begin(), sets.back().end());
    }
    return sets;
}

} // namespace

TEST_CASE("A GetFEM mesh is read, whatever the numbers of its points and convexes", "[io]") {
    const io::SpaceTimeSoup soup = read(small);
    CHECK(soup.dimension == 3);
    CHECK(soup.points == Array<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1e-3, -1.5, 0.25, 0.1});
    CHECK(soup.cells == Array<Index>{0, 1, 2, 3, 0, 3, 2, 4});
    CHECK(soup.facets == Array<Index>{2, 0, 3, 1, 0, 2, 0, 1, 3, 3, 2, 4}); // outward
    CHECK(soup.facet_attribute == Array<std::int64_t>{2, 2, 2, 5});
}

TEST_CASE("What is written for GetFEM comes back bit for bit, facets with their attributes", "[io]") {
    const scratch::Folder folder;
    for (const int dimension : {3, 4}) {
        const Written mesh = two_simplices(dimension);
        io::AtomicFile file{folder / "a.getfem"};
        io::write_getfem(file, mesh.columns());
        file.commit();
        CHECK(io::is_space_time_file(folder / "a.getfem"));
        const io::SpaceTimeSoup soup = io::read_space_time(folder / "a.getfem");
        CHECK(soup.dimension == dimension);
        CHECK(soup.points == Array<double>(mesh.points.begin(), mesh.points.end()));
        CHECK(soup.cells == Array<Index>(mesh.cells.begin(), mesh.cells.end()));
        CHECK(as_sets(soup.facets, dimension) == as_sets(mesh.facets, dimension));
        CHECK(soup.facet_attribute == Array<std::int64_t>(mesh.attribute.begin(), mesh.attribute.end()));
    }
}

TEST_CASE("A GetFEM mesh may be without counts and regions", "[io]") {
    std::string text = scratch::replaced(small, "  POINT COUNT 5\n", "");
    text = scratch::replaced(text, "  CONVEX COUNT 2\n", "");
    text = text.substr(0, text.find("BEGIN REGION"));
    const io::SpaceTimeSoup soup = read(text);
    CHECK(soup.cells.size() == 8);
    CHECK(soup.facets.empty());
}

TEST_CASE("Faults of a GetFEM mesh are told with their lines", "[io]") {
    refuses("POINT COUNT 5", "POINT COUNT 6", "6 points were announced, but there are 5");
    refuses("POINT COUNT 5", "POINT COUNT 99999999999", "line 8");
    refuses("POINT COUNT 5", "POINT COUNT five", "line 8");
    refuses("3  0  0  0", "3  0  0", "2 coordinates");
    refuses("3  0  0  0", "3  0  0  0  0", "line 11"); // the next row has fewer
    refuses("7  1  0  0", "7  1  0", "line 11");
    refuses("7  1  0  0", "7  1  0  0  0", "POINT or END was expected");
    refuses("7  1  0  0", "3  1  0  0", "two points have the number 3");
    refuses("7  1  0  0", "-7  1  0  0", "line 10");
    refuses("7  1  0  0", "7  1  nan  0", "vertex 1 has a coordinate that is not a finite number");
    refuses("7  1  0  0", "7  1  1e999  0", "line 10");
    refuses("BEGIN POINTS LIST", "BEGIN POINTS", "LIST was expected");
    refuses("GT_PK(3,1)", "GT_QK(3,1)", "line 22");
    refuses("GT_PK(3,1)", "GT_PK(3,2)", "convex 4 is of the kind");
    refuses("GT_PK(3,1)", "GT_PK(4,1)", "convex 4 is of the kind");
    refuses("3  7  8  9", "3  7  8  10", "convex 4 has the point 10, which does not exist");
    refuses("3  7  8  9", "3  7  8", "line 23");
    refuses("3  7  8  9", "3  7  8  9  2", "CONVEX or END was expected");
    refuses("CONVEX 1", "CONVEX 4", "two convexes have the number 4");
    refuses("CONVEX COUNT 2", "CONVEX COUNT 1", "1 convexes were announced, but there are 2");
    refuses("4/1", "4/4", "region 2 has");
    refuses("4/1", "3/1", "region 2 has");
    refuses("4/1", "4/", "line 27");
    refuses("4/1", "4/1x", "line 27");
    refuses("4/1", "x", "line 27");
    refuses("1/0", "4/3", "in region 2 and again in region 5");
    refuses("END REGION 2", "END REGION 3", "END REGION 2 was expected");
    refuses("BEGIN REGION 2", "BEGIN REGION two", "line 26");
    refuses("END MESH_FEM", "", "END MESH_FEM");
    refuses("BEGIN MESH STRUCTURE DESCRIPTION", "BEGIN ELSE STRUCTURE DESCRIPTION", "END ELSE");
}

TEST_CASE("A GetFEM mesh cut off anywhere is refused, but between regions", "[io]") {
    const std::size_t first_region = small.find("BEGIN REGION 2");
    for (std::size_t size = 18; size < first_region - 1; ++size) {
        CHECK_FALSE(scratch::refusal(io::read_space_time, "a.getfem", small.substr(0, size)).empty());
    }
    for (std::size_t size = first_region + 1; size < small.find("END REGION 2") + 12; ++size) {
        CHECK_FALSE(scratch::refusal(io::read_space_time, "a.getfem", small.substr(0, size)).empty());
    }
    const std::string no_cells = small.substr(0, small.find("BEGIN MESH"));
    CHECK_THAT(scratch::refusal(io::read_space_time, "a.getfem", no_cells), Catch::Contains("without cells"));
}
