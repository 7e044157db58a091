// SPDX-License-Identifier: BSD-3-Clause
#include "io/scratch.h"
#include "io/specimens.h"
#include "slabhull/io/files.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <limits>
#include <pugixml.hpp>

using namespace slabhull;

namespace {

struct DataSet {
    double time;
    int part;
    std::string file;
    friend bool operator==(const DataSet&, const DataSet&) = default;
};

/// The data sets of a .pvd, read as XML.
std::vector<DataSet> data_sets_of(const std::filesystem::path& path) {
    pugi::xml_document document;
    REQUIRE(document.load_file(path.c_str()));
    const pugi::xml_node file = document.child("VTKFile");
    CHECK(std::string{file.attribute("type").value()} == "Collection");
    std::vector<DataSet> sets;
    for (const pugi::xml_node set : file.child("Collection").children("DataSet")) {
        sets.push_back({set.attribute("timestep").as_double(), set.attribute("part").as_int(),
                        set.attribute("file").value()});
    }
    return sets;
}

} // namespace

TEST_CASE("A series names every file with its time, to the last bit", "[io]") {
    const scratch::Folder folder;
    const std::vector<io::SeriesEntry> entries{{0, "slab_0000.vtu"},
                                               {0.1, "a & b/<c> \"d\".vtu"},
                                               {1.0 / 3, "/tmp/it's.vtu"},
                                               {-1e-300, "später.vtu"}};
    io::write_pvd(folder / "a.pvd", entries);
    const auto sets = data_sets_of(folder / "a.pvd");
    REQUIRE(sets.size() == entries.size());
    for (std::size_t k = 0; k < sets.size(); ++k) {
        CHECK(sets[k] == DataSet{entries[k].time, 0, entries[k].file.string()});
    }
    CHECK(folder.file_count() == 1);
}

TEST_CASE("Files of a series at one time are its parts", "[io]") {
    const scratch::Folder folder;
    const std::vector<io::SeriesEntry> entries{{0, "a0"}, {0, "b0"}, {1, "a1"}, {1, "b1"}, {1, "c1"}};
    io::write_pvd(folder / "a.pvd", entries);
    CHECK(data_sets_of(folder / "a.pvd") ==
          std::vector<DataSet>{{0, 0, "a0"}, {0, 1, "b0"}, {1, 0, "a1"}, {1, 1, "b1"}, {1, 2, "c1"}});
}

TEST_CASE("Each file of a series opens from the series' own folder", "[io]") {
    const scratch::Folder folder;
    std::vector<io::SeriesEntry> entries;
    for (std::int64_t k = 1; k < 4; ++k) {
        entries.push_back({static_cast<double>(k), fmt::format("mesh {}.vtu", k)});
        io::write_vtu(folder / entries.back().file.string(), specimens::Grid{3, k}.columns());
    }
    io::write_pvd(folder / "a.pvd", entries);
    for (const DataSet& set : data_sets_of(folder / "a.pvd")) {
        CHECK(static_cast<double>(io::read_vtu(folder / set.file).points.size()) ==
              std::pow(set.time + 1, 3));
    }
}

TEST_CASE("An empty series is a series", "[io]") {
    const scratch::Folder folder;
    io::write_pvd(folder / "a.pvd", {});
    CHECK(data_sets_of(folder / "a.pvd").empty());
}

TEST_CASE("What XML cannot hold is refused, and the series before it stays", "[io]") {
    const scratch::Folder folder;
    const std::vector<io::SeriesEntry> good{{0, "a.vtu"}};
    io::write_pvd(folder / "a.pvd", good);
    for (const io::SeriesEntry& bad :
         {io::SeriesEntry{0, "a\nb.vtu"}, io::SeriesEntry{std::numeric_limits<double>::quiet_NaN(), "a.vtu"},
          io::SeriesEntry{std::numeric_limits<double>::infinity(), "a.vtu"}}) {
        CHECK_THROWS_AS(io::write_pvd(folder / "a.pvd", {&bad, 1}), UsageError);
    }
    CHECK(data_sets_of(folder / "a.pvd") == std::vector<DataSet>{{0, 0, "a.vtu"}});
    CHECK_THROWS_AS(io::write_pvd(folder / "no/a.pvd", good), OutputError);
}

TEST_CASE("A series that was written is read again, its files from the series' folder", "[io]") {
    const scratch::Folder folder;
    const std::vector<io::SeriesEntry> entries{{0.1, "a & b/<c> \"d\".vtu"}, {1.0 / 3, "/tmp/it's.vtu"}};
    io::write_pvd(folder / "a.pvd", entries);
    const std::vector<io::SeriesEntry> read = io::read_pvd(folder / "a.pvd");
    REQUIRE(read.size() == 2);
    CHECK(read[0].time == 0.1);
    CHECK(read[0].file == folder / "a & b/<c> \"d\".vtu");
    CHECK(read[1].time == 1.0 / 3);
    CHECK(read[1].file == "/tmp/it's.vtu");
}

TEST_CASE("What is no series is refused", "[io]") {
    const scratch::Folder folder;
    const std::string text =
        GENERATE(as<std::string>{}, "", "<VTKFile>",
                 "<VTKFile><Collection><DataSet file=\"a\"/></Collection></VTKFile>",
                 "<VTKFile><Collection><DataSet timestep=\"nan\" file=\"a\"/></Collection></VTKFile>",
                 "<VTKFile><Collection><DataSet timestep=\"0\"/></Collection></VTKFile>");
    io::write_text(folder / "a.pvd", text);
    CHECK_THROWS_AS(io::read_pvd(folder / "a.pvd"), InputError);
    CHECK_THROWS_AS(io::read_pvd(folder / "none.pvd"), InputError);
}
