// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/formats.h"
#include "io/scratch.h"
#include "io/soups.h"
#include "io/specimens.h"

#include "slabhull/core/error.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <set>

using namespace slabhull;

namespace {

io::Soup written_and_read(const io::Format& format, const std::filesystem::path& path, const io::Soup& soup,
                          const io::WriteOptions& options) {
    io::AtomicFiles files;
    format.write(files, path, io::columns_of(soup), options);
    files.commit();
    return format.read(path);
}

io::WriteOptions way(std::string_view encoding, std::string_view version = "",
                     bool four_dimensional = false) {
    return {std::string{encoding}, std::string{version}, four_dimensional};
}

/// Every way in which a format is written.
std::vector<io::WriteOptions> ways_of(const io::Format& format) {
    const auto some = [](std::vector<std::string_view> names) {
        names.push_back(""); // the default
        return names;
    };
    std::vector<io::WriteOptions> ways;
    for (const std::string_view encoding : some(format.variants.encodings)) {
        for (const std::string_view version : some(format.variants.versions)) {
            ways.push_back(way(encoding, version));
        }
    }
    if (format.variants.four_dimensional) {
        ways.push_back(way("", "", true));
    }
    return ways;
}

/// Numbers that no format may round, with every third cell in no group.
Array<double> awkward_numbers(std::size_t count) {
    Array<double> values;
    for (std::size_t i = 0; i < count; ++i) {
        values.push_back(std::sin(static_cast<double>(i)) * std::pow(10.0, static_cast<double>(i % 40) - 20));
    }
    return values;
}
Array<std::int64_t> counted(std::size_t count, std::int64_t step) {
    Array<std::int64_t> values;
    for (std::size_t i = 0; i < count; ++i) {
        values.push_back(static_cast<std::int64_t>(i) * step - 5);
    }
    return values;
}

/// The simplices 0 1 .. d, 1 2 .. d + 1, ..., in groups by turns.
io::SimplexBlock strip(std::size_t dimension, std::size_t count) {
    io::SimplexBlock block;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k <= dimension; ++k) {
            block.vertices.push_back(static_cast<Index>(i + k));
        }
        block.physical.push_back(static_cast<PatchNumber>(i % 3 == 0 ? 0 : i % 2 == 0 ? 4 : 11));
    }
    return block;
}

/// Everything that a soup can hold.
io::Soup rich_soup(int dimension) {
    const specimens::Grid grid{dimension, 4};
    io::Soup soup;
    soup.points.assign(grid.points.begin(), grid.points.end());
    const auto top = static_cast<std::size_t>(dimension);
    soup.simplices[top].vertices.assign(grid.cells.begin(), grid.cells.end());
    const std::size_t cells = grid.cell_count();
    soup.simplices[top].physical = strip(top, cells).physical;
    soup.groups[top] = {{4, "the room"}, {11, "door & lock"}};
    for (std::size_t d = 0; d < top; ++d) {
        soup.simplices[d] = strip(d, 4);
        soup.groups[d] = {{4, "wall"}, {11, "inlet"}};
    }
    const std::size_t points = soup.points.size();
    soup.point_data = {{"t", 1, awkward_numbers(points)},
                       {"v", 3, awkward_numbers(3 * points)},
                       {"two words", 2, awkward_numbers(2 * points)},
                       {"id", 1, counted(points, 7)},
                       {"wide", 1, counted(points, (std::int64_t{1} << 53) + 1)},
                       {"medit:ref", 1, counted(points, 2)},
                       {"marker", 1, counted(points, 3)}};
    soup.cell_data = {
        {"number", 1, counted(cells, 3)}, {"marker", 1, IntegerList{}}, {"w", 9, awkward_numbers(9 * cells)}};
    const auto& physical = soup.simplices[top].physical;
    soup.cell_data[1].values = IntegerList{Array<std::int64_t>(physical.begin(), physical.end())};
    soup.field_data = {{"time", 1, Array<double>{0.1, 1.0 / 3}},
                       {"slab", 1, Array<std::int64_t>{7}},
                       {"holes", 3, Array<double>{0.5, 1.0 / 3, -2}},
                       {"patch_name", 1, std::vector<std::string>{"walls & doors", "", "fan <1>"}}};
    return soup;
}

/// Points as the cells come to them first, those that no cell uses left out, in few digits.
void make_points_of_cells(io::Soup& soup) {
    std::map<Index, Index> fresh;
    Array<Point<3>> points;
    for (Index& vertex : soup.simplices[static_cast<std::size_t>(soup.top_dimension())].vertices) {
        const auto [found, added] = fresh.try_emplace(vertex, static_cast<Index>(points.size()));
        if (added) {
            points.push_back(soup.points[vertex]);
            for (double& x : points.back()) {
                x = std::round(x * 1024) / 1024;
            }
        }
        vertex = found->second;
    }
    soup.points = std::move(points);
}

/// Takes away what losses() says that the format has no place for.
void take_away_losses(const io::Format& format, io::Soup& soup, const io::WriteOptions& options) {
    const io::FormatFeatures& features = format.features;
    const int top = soup.top_dimension();
    for (int d = 0; d < top; ++d) {
        if (d < features.min_lower_dimension.value_or(top) || (features.only_facets && d != top - 1)) {
            soup.simplices[static_cast<std::size_t>(d)] = {};
            soup.groups[static_cast<std::size_t>(d)].clear();
        }
    }
    for (std::size_t d = 0; d < 4; ++d) {
        for (PatchNumber& number : soup.simplices[d].physical) {
            number = !features.groups ? 0 : number == 0 && !features.ungrouped_cells ? 11 : number;
        }
        for (Patch& group : soup.groups[d]) {
            group.name = features.group_names ? group.name : "";
        }
        if (!features.groups) {
            soup.groups[d].clear();
        }
    }
    const auto thin_out = [&](std::vector<io::DataArray>& arrays, io::ArrayAssociation over) {
        std::erase_if(arrays, [&](const io::DataArray& array) {
            return !io::stores(format, soup, over, array, options) ||
                   (!features.wide_integers && array.name == "wide") ||
                   (!features.any_components && array.components == 2);
        });
    };
    thin_out(soup.point_data, io::ArrayAssociation::points);
    thin_out(soup.cell_data, io::ArrayAssociation::cells);
    thin_out(soup.field_data, io::ArrayAssociation::field);
    if (!features.shared_points) {
        make_points_of_cells(soup);
    }
}

/// The same numbers, those of Gmsh's files whole or not.
bool same_values(const io::DataArray& a, const io::DataArray& b, bool as_reals) {
    const auto* integers = std::get_if<IntegerList>(&a.values);
    if (as_reals && integers != nullptr) {
        const auto& reals = std::get<Array<double>>(b.values);
        return std::equal(integers->begin(), integers->end(), reals.begin(), reals.end(),
                          [](std::int64_t x, double y) { return static_cast<double>(x) == y; });
    }
    return a.values == b.values;
}

void check_arrays(const std::vector<io::DataArray>& before, const std::vector<io::DataArray>& after,
                  bool as_reals) {
    std::map<std::string, const io::DataArray*> found;
    for (const io::DataArray& array : after) {
        found[array.name] = &array;
    }
    found.erase("padding"); // the VTU writer's own
    CHECK(found.size() == before.size());
    for (const io::DataArray& array : before) {
        CAPTURE(array.name);
        REQUIRE(found.contains(array.name));
        CHECK(found[array.name]->components == array.components);
        CHECK(same_values(array, *found[array.name], as_reals));
    }
}

void check_same(const io::Soup& soup, const io::Soup& again, bool as_reals) {
    REQUIRE(again.points.size() == soup.points.size());
    CHECK(std::memcmp(again.points.data(), soup.points.data(), soup.points.size() * sizeof(Point<3>)) == 0);
    for (std::size_t d = 0; d < 4; ++d) {
        CAPTURE(d);
        CHECK(again.simplices[d].vertices == soup.simplices[d].vertices);
        std::vector<PatchNumber> physical = again.simplices[d].physical;
        physical.resize(soup.simplices[d].physical.size()); // none stands for no groups
        CHECK(physical == soup.simplices[d].physical);
        CHECK(again.groups[d] == soup.groups[d]);
    }
    check_arrays(soup.point_data, again.point_data, as_reals);
    check_arrays(soup.cell_data, again.cell_data, as_reals);
    check_arrays(soup.field_data, again.field_data, false);
}

} // namespace

TEST_CASE("Each format has a name of its own and can be found by it and by an extension", "[io]") {
    std::set<std::string_view> names;
    for (const io::Format& format : io::formats()) {
        CHECK(names.insert(format.name).second);
        CHECK(io::format_named(format.name) == &format);
        CHECK(format.built);
        CHECK(format.read);
        CHECK(format.write != nullptr);
    }
    CHECK(io::format_of_extension("a/ROOM.MSH") == io::format_named("msh"));
    CHECK(io::format_of_extension("a/room.xyz") == nullptr);
    CHECK(io::format_named("xyz") == nullptr);
}

TEST_CASE("A soup of several dimensions comes back from MSH, and VTU's losses are told", "[io]") {
    const scratch::Folder folder;
    const io::Soup soup = io::format_named("msh")->read(scratch::fixture("cube_41_binary.msh"));
    REQUIRE(!soup.simplices[2].vertices.empty());
    const io::Soup again = written_and_read(*io::format_named("msh"), folder / "a.msh", soup, {});
    CHECK(again.points == soup.points);
    for (std::size_t d = 0; d < 4; ++d) {
        CHECK(again.simplices[d].vertices == soup.simplices[d].vertices);
        CHECK(again.simplices[d].physical == soup.simplices[d].physical);
        CHECK(again.groups[d] == soup.groups[d]);
    }
    CHECK(io::losses(*io::format_named("msh"), soup).empty());
    const auto lost = io::losses(*io::format_named("vtu"), soup);
    REQUIRE(lost.size() == 2);
    CHECK_THAT(lost[0], Catch::Contains("triangles"));
    CHECK(lost[1] == "groups of cells");
}

TEST_CASE("What a format can hold comes back exactly in each way it is written, and the rest is told",
          "[io]") {
    const scratch::Folder folder;
    for (const io::Format& format : io::formats()) {
        for (int dimension = format.features.min_dimension; dimension <= format.features.max_dimension;
             ++dimension) {
            for (const io::WriteOptions& options : ways_of(format)) {
                CAPTURE(format.name, dimension, options.encoding, options.version);
                io::Soup soup = rich_soup(dimension);
                const bool facets = format.name == "tetgen" && dimension == 2;
                const auto path = folder / fmt::format("{}_{}{}", format.name, dimension,
                                                       facets ? ".smesh" : format.extensions.front());
                CHECK_FALSE(io::losses(format, soup, options).empty());
                CHECK_NOTHROW(written_and_read(format, path, soup, options));
                take_away_losses(format, soup, options);
                CHECK(io::losses(format, soup, options) == std::vector<std::string>{});
                check_same(soup, written_and_read(format, path, soup, options), format.name == "msh");
            }
        }
    }
}

TEST_CASE("Each kind of loss is told", "[io]") {
    const auto lost = [](const char* format, int dimension) {
        return fmt::format("{}",
                           fmt::join(io::losses(*io::format_named(format), rich_soup(dimension)), "; "));
    };
    CHECK(lost("msh", 3) == "field data time, slab, holes, patch_name; digits above 2^53 in wide; "
                            "components in one array, as of two words");
    CHECK(lost("vtu", 2) == "4 lines, 4 points; groups of cells");
    CHECK(lost("medit", 3) == "4 points; names of groups: door & lock, inlet, the room, wall; "
                              "point data t, v, two words, id, wide, marker; cell data number, marker, w; "
                              "field data time, slab, holes, patch_name");
    CHECK_THAT(lost("mfem", 2), Catch::Contains("that cells are in no group"));
    CHECK_THAT(lost("tetgen", 2), Catch::Contains("cell data number, w; field data time, slab, patch_name"));
    CHECK_THAT(lost("stl", 2), Catch::Contains("coordinates beyond single precision; the order of points"));
    CHECK_THAT(lost("avro", 3), Catch::Contains("point data v,"));
}

TEST_CASE("A way in which a format is not written is refused by the option's name", "[io]") {
    const auto refusal = [](const char* format, const io::WriteOptions& options) -> std::string {
        try {
            io::require_supported(*io::format_named(format), options, "--");
        } catch (const UsageError& error) {
            return error.what();
        }
        return "";
    };
    CHECK(refusal("msh", way("ascii", "2.2")).empty());
    CHECK(refusal("msh", way("zlib")) == "--encoding: MSH is written as binary, ascii, not as \"zlib\"");
    CHECK(refusal("off", way("ascii")) == "--encoding: OFF is written in one way only");
    CHECK_THAT(refusal("vtu", way("", "2.2")), Catch::Contains("--version"));
    CHECK_THAT(refusal("vtu", way("", "", true)), Catch::Contains("Medit"));
    const auto in_pieces = [](io::WriteOptions options) {
        options.pieces = 2;
        return options;
    };
    CHECK(refusal("msh", in_pieces(way("binary", "4.1"))).empty());
    CHECK(refusal("pvtu", in_pieces(way("zlib"))).empty());
    CHECK(refusal("msh", in_pieces(way("ascii"))) == "--pieces: MSH in pieces is version 4.1, binary");
    CHECK(refusal("msh", in_pieces(way("", "2.2"))) == "--pieces: MSH in pieces is version 4.1, binary");
    CHECK(refusal("vtu", in_pieces(way(""))) == "--pieces: VTU is not written in pieces; .pvtu and MSH are");
}

TEST_CASE("Without a telling extension, a file's first bytes tell its format", "[io]") {
    const scratch::Folder folder;
    for (const char* name : {"msh", "vtu", "vtk", "medit", "mfem", "off", "ply"}) {
        CAPTURE(name);
        const io::Format& format = *io::format_named(name);
        if (!format.built) {
            WARN("left out of this build: " << name);
            continue;
        }
        io::AtomicFiles files;
        format.write(files, folder / name, io::columns_of(rich_soup(2)), {});
        files.commit();
        CHECK(io::format_of_content(folder / name) == &format);
        CHECK(io::read_mesh(folder / name).simplices[2].size(2) == 32);
    }
    CHECK(io::format_of_content(scratch::put(folder / "junk", "Gmsh")) == nullptr);
}

TEST_CASE("A format that was left out of the build is known, and refuses by its name", "[io]") {
    const scratch::Folder folder;
    for (const io::Format& format : io::formats_left_out()) {
        CAPTURE(format.name);
        CHECK(io::format_named(format.name) == &format);
        const auto path = folder / fmt::format("a{}", format.extensions.front());
        CHECK(io::format_of_extension(path) == &format);
        const auto refuses =
            Catch::Contains(std::string{format.title}) && Catch::Contains("SLABHULL_FORMATS");
        CHECK_THROWS_AS(io::require_built(format), io::FormatLeftOut);
        CHECK_THROWS_WITH(format.read(path), refuses);
        CHECK_THROWS_WITH(io::read_mesh(path), refuses);
        io::AtomicFiles files;
        CHECK_THROWS_WITH(format.write(files, path, io::columns_of(rich_soup(2)), {}), refuses);
    }
    CHECK(std::filesystem::is_empty(folder / "."));
}

TEST_CASE("Of several files none gets its name before all are complete", "[io]") {
    const scratch::Folder folder;
    {
        io::AtomicFiles files;
        files.open(folder / "a").write("a");
        CHECK_THROWS_AS(files.open(folder / "a"), OutputError);
        CHECK_THROWS_AS(files.open(folder / "none" / "b"), OutputError);
    }
    CHECK(std::filesystem::is_empty(folder / "."));
    io::AtomicFiles files;
    files.open(folder / "a").write("a");
    files.open(folder / "b").write("b");
    CHECK(std::filesystem::exists(folder / "a") == false);
    files.commit();
    CHECK(scratch::bytes_of(folder / "a") + scratch::bytes_of(folder / "b") == "ab");
}
