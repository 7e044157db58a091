// SPDX-License-Identifier: BSD-3-Clause
// The fuzzers' seeds, what they found, and damage done in turn to every byte: through the code that is
// fuzzed.
#include "core/rounds.h"
#include "fuzz/memory_meter.h"
#include "fuzz/readers.h"
#include "fuzz/soup_faults.h"
#include "io/scratch.h"
#include "slabhull/io/formats.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace slabhull;

namespace {

namespace fs = std::filesystem;

/// By name, so that the order is the same everywhere.
std::vector<fs::path> files_in(const std::string& folder, std::string_view reader) {
    const fs::path path = fs::path{SLABHULL_FUZZ_DATA} / folder / reader;
    std::vector<fs::path> files;
    if (fs::exists(path)) {
        files.assign(fs::directory_iterator{path}, {});
    }
    std::sort(files.begin(), files.end());
    return files;
}

/// Those seeds that can be read.
std::vector<std::string> valid_files(const fuzz::Reader& reader) {
    std::vector<std::string> valid;
    for (const fs::path& path : files_in("corpus", reader.name)) {
        std::string bytes = scratch::bytes_of(path);
        if (reader.read(bytes) == fuzz::Outcome::read) {
            valid.push_back(std::move(bytes));
        }
    }
    REQUIRE(!valid.empty());
    return valid;
}

io::Soup tetrahedron() {
    io::Soup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    soup.simplices[3].vertices = {0, 1, 2, 3};
    soup.simplices[3].physical = {7};
    soup.groups[3] = {{7, "room"}};
    soup.point_data = {{"t", 1, Array<double>{0, 0, 0, 1}}};
    soup.cell_data = {{"pair", 2, Array<std::int64_t>{1, 2}}};
    return soup;
}

template<class Plant>
std::string fault_after(const Plant& plant) {
    io::Soup soup = tetrahedron();
    plant(soup);
    return fuzz::fault_of(soup);
}

template<class Change>
std::string difference_after(const Change& change) {
    io::Soup soup = tetrahedron();
    change(soup);
    return fuzz::difference(tetrahedron(), soup, {});
}

} // namespace

TEST_CASE("Every seed and every file that once broke a reader is refused, or read and consistent",
          "[readers]") {
    for (const io::Format& format : io::formats_left_out()) {
        WARN("left out of this build, so skipped: " << format.name);
    }
    for (const fuzz::Reader& reader : fuzz::readers()) {
        CAPTURE(reader.name);
        std::size_t read = 0;
        for (const char* folder : {"corpus", "found", "regressions"}) {
            for (const fs::path& path : files_in(folder, reader.name)) {
                CAPTURE(path.filename());
                CHECK_NOTHROW(read += reader.read(scratch::bytes_of(path)) == fuzz::Outcome::read ? 1 : 0);
            }
        }
        CHECK(read > 0);
    }
}

TEST_CASE("Ten thousand bytes of each format's files, changed one at a time, break no reader", "[readers]") {
    const int count = rounds(6000); // the fuzzers have the sanitizers, too
    for (const fuzz::Reader& reader : fuzz::readers()) {
        CAPTURE(reader.name);
        std::vector<std::string> files = valid_files(reader);
        std::mt19937 random{20261122};
        int refused = 0;
        for (int round = 0; round < count; ++round) {
            std::string& bytes = files[static_cast<std::size_t>(round) % files.size()];
            const std::size_t place = random() % bytes.size();
            const char was = bytes[place];
            bytes[place] = static_cast<char>(was ^ static_cast<char>(1 + random() % 255));
            try {
                refused += reader.read(bytes) == fuzz::Outcome::refused ? 1 : 0;
            } catch (const std::exception& problem) {
                FAIL_CHECK("byte " << place << " of file " << round << " as " << int{bytes[place]} << ": "
                                   << problem.what());
            }
            bytes[place] = was;
        }
        CHECK(refused > count / 20);
        CHECK(refused < count);
    }
}

TEST_CASE("Files cut short anywhere break no reader", "[readers]") {
    constexpr std::size_t small = 700;
    for (const fuzz::Reader& reader : fuzz::readers()) {
        CAPTURE(reader.name);
        for (const std::string& bytes : valid_files(reader)) {
            for (std::size_t size = 0; size < bytes.size() && bytes.size() <= small; ++size) {
                CAPTURE(size);
                CHECK_NOTHROW(reader.read(std::string_view{bytes}.substr(0, size)));
            }
        }
    }
}

TEST_CASE("A soup that contradicts itself is found out", "[readers]") {
    const auto says = [](const char* text) { return Catch::Contains(text); };
    CHECK(fuzz::fault_of(tetrahedron()).empty());
    CHECK_THAT(fault_after([](io::Soup& soup) { soup.points[2][1] = std::nan(""); }), says("point 2"));
    CHECK_THAT(fault_after([](io::Soup& soup) { soup.simplices[3].vertices[1] = 4; }), says("vertex 4 of 4"));
    CHECK_THAT(fault_after([](io::Soup& soup) { soup.simplices[3].vertices.pop_back(); }),
               says("3 vertices"));
    CHECK_THAT(fault_after([](io::Soup& soup) { soup.simplices[3].physical.push_back(7); }), says("groups"));
    CHECK_THAT(fault_after([](io::Soup& soup) { soup.simplices[3].physical[0] = 8; }), says("group 8"));
    CHECK_THAT(fault_after([](io::Soup& soup) {
                   soup.groups[3].push_back({7, "again"});
               }),
               says("group number 1 is 7"));
    CHECK_THAT(fault_after([](io::Soup& soup) { soup.point_tags = {1, 2, 3}; }), says("3 tags"));
    CHECK_THAT(fault_after([](io::Soup& soup) { soup.point_data[0].values = Array<double>{1}; }),
               says("\"t\""));
    CHECK_THAT(fault_after([](io::Soup& soup) { soup.cell_data[0].components = 1; }), says("\"pair\""));
    CHECK_THAT(fault_after([](io::Soup& soup) {
                   soup.field_data = {{"f", 0, Array<double>{}}};
               }),
               says("\"f\""));
    io::CsvTable table{"", {"a", "b"}, {1, 2}, {2}};
    CHECK(fuzz::fault_of(table).empty());
    table.values.push_back(3);
    CHECK(!fuzz::fault_of(table).empty());
}

TEST_CASE("What a round trip loses is found out", "[readers]") {
    CHECK(fuzz::difference(tetrahedron(), tetrahedron(), {}).empty());
    CHECK(!difference_after([](io::Soup& soup) { soup.points[0][0] = -0.0; }).empty());
    CHECK(!difference_after([](io::Soup& soup) { soup.simplices[3].vertices[0] = 1; }).empty());
    CHECK(!difference_after([](io::Soup& soup) { soup.simplices[3].physical[0] = 8; }).empty());
    CHECK(!difference_after([](io::Soup& soup) { soup.cell_data.clear(); }).empty());
    CHECK(
        !difference_after([](io::Soup& soup) { soup.point_data[0].values = Array<double>(4, 0.5); }).empty());
}

TEST_CASE("Memory is metered where AddressSanitizer is at work", "[readers]") {
    const fuzz::MemoryMeter meter;
    { const std::vector<char> block(1000000); }
    CHECK((meter.peak() >= 1000000) == fuzz::MemoryMeter::works());
}
