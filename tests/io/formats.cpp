// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/formats.h"
#include "io/scratch.h"
#include "io/soups.h"

#include <catch2/catch.hpp>
#include <set>

using namespace slabhull;

TEST_CASE("Each format has a name of its own and can be found by it and by an extension", "[io]") {
    std::set<std::string_view> names;
    for (const io::Format& format : io::formats()) {
        CHECK(names.insert(format.name).second);
        CHECK(io::format_named(format.name) == &format);
        CHECK((format.read != nullptr || format.write != nullptr));
    }
    CHECK(io::format_of_extension("a/ROOM.MSH") == io::format_named("msh"));
    CHECK(io::format_of_extension("a/room.xyz") == nullptr);
    CHECK(io::format_named("xyz") == nullptr);
}

TEST_CASE("A soup of several dimensions comes back from MSH, and VTU's losses are told", "[io]") {
    const scratch::Folder folder;
    const io::Soup soup = io::format_named("msh")->read(scratch::fixture("cube_41_binary.msh"));
    REQUIRE(!soup.simplices[2].vertices.empty());
    {
        io::AtomicFile file{folder / "a.msh"};
        io::format_named("msh")->write(file, io::columns_of(soup));
        file.commit();
    }
    const io::Soup again = io::format_named("msh")->read(folder / "a.msh");
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
