// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/folder_lock.h"

#include "io/scratch.h"
#include "slabhull/core/child_process.h"
#include "slabhull/core/error.h"

#include <catch2/catch.hpp>
#include <optional>

using namespace slabhull;

TEST_CASE("A folder is locked by one run at a time, and has no file more", "[io]") {
    const scratch::Folder folder;
    std::optional<io::FolderLock> first{folder / ""};
    CHECK_THROWS_WITH(io::FolderLock{folder / ""}, Catch::Contains("another run is at work"));
    CHECK(folder.file_count() == 0);
    first.reset();
    CHECK_NOTHROW(io::FolderLock{folder / ""});
}

TEST_CASE("A folder's lock ends with its process", "[io]") {
    const scratch::Folder folder;
    run_in_child([&](const Send&) { [[maybe_unused]] auto* const kept = new io::FolderLock{folder / ""}; },
                 [](const Receive&) { return true; });
    CHECK_NOTHROW(io::FolderLock{folder / ""});
}

TEST_CASE("A folder that cannot be opened is not locked", "[io]") {
    CHECK_NOTHROW(io::FolderLock{"/no/such/folder"});
}
