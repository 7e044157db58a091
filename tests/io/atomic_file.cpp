// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/atomic_file.h"

#include "io/scratch.h"
#include "slabhull/io/files.h"

#include <catch2/catch.hpp>
#include <csignal>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

using namespace slabhull;
using io::AtomicFile;

namespace {

/// While it lives, no file may grow beyond `bytes`: writes fail as on a full disk.
class FullDisk {
public:
    explicit FullDisk(rlim_t bytes) : handler_{std::signal(SIGXFSZ, SIG_IGN)} {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FullDisk() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;

private:
    rlimit before_{};
    void (*handler_)(int);
};

} // namespace

TEST_CASE("A committed file holds what was written, and nothing else is left", "[io]") {
    const scratch::Folder folder;
    AtomicFile file{folder / "a.txt"};
    file.write("one ");
    file.write("two");
    CHECK_FALSE(std::filesystem::exists(folder / "a.txt"));
    file.commit();
    CHECK(scratch::bytes_of(folder / "a.txt") == "one two");
    CHECK(folder.file_count() == 1);
}

TEST_CASE("Without commit the file that was there stays as it was", "[io]") {
    const scratch::Folder folder;
    scratch::put(folder / "a.txt", "old");
    {
        AtomicFile file{folder / "a.txt"};
        file.write("new");
    }
    CHECK(scratch::bytes_of(folder / "a.txt") == "old");
    CHECK(folder.file_count() == 1);
    io::write_text(folder / "a.txt", "newer");
    CHECK(scratch::bytes_of(folder / "a.txt") == "newer");
}

TEST_CASE("A full disk is an OutputError that names the file, and loses nothing", "[io]") {
    const scratch::Folder folder;
    const auto path = folder / "a.txt";
    scratch::put(path, "old");
    {
        const FullDisk full{4096};
        CHECK_THROWS_AS(io::write_text(path, std::string(5000, 'x')), OutputError);
        CHECK_THROWS_WITH(io::write_text(path, std::string(5000, 'x')), Catch::Contains(path.string()));
    }
    CHECK(scratch::bytes_of(path) == "old");
    CHECK(folder.file_count() == 1);
}

TEST_CASE("Files of many blocks hold every byte in order, written in pieces of any size", "[io]") {
    const scratch::Folder folder;
    std::string bytes(50'000'001, ' ');
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        bytes[i] = static_cast<char>(i * 2654435761U >> 24U);
    }
    AtomicFile file{folder / "a.bin"};
    for (std::size_t at = 0, size = 1; at < bytes.size(); at += size, size = 1 + size * 7 % 3'000'017) {
        file.write(std::string_view{bytes}.substr(at, size));
    }
    file.commit();
    CHECK((scratch::bytes_of(folder / "a.bin") == bytes));
}

TEST_CASE("A disk that fills up while blocks are on their way is an OutputError, and loses nothing", "[io]") {
    const scratch::Folder folder;
    const auto path = folder / "a.txt";
    scratch::put(path, "old");
    for (const rlim_t room : {rlim_t{12} << 20, rlim_t{49} << 20}) {
        const FullDisk full{room};
        CHECK_THROWS_AS(io::write_text(path, std::string(50 << 20, 'x')), OutputError);
        AtomicFile abandoned{path};
        abandoned.write(std::string(10 << 20, 'x'));
    }
    CHECK(scratch::bytes_of(path) == "old");
    CHECK(folder.file_count() == 1);
}

TEST_CASE("A missing folder, a folder and a device are refused by name", "[io]") {
    const scratch::Folder folder;
    CHECK_THROWS_WITH(AtomicFile{folder / "none/a.txt"},
                      Catch::Contains("none/a.txt") && Catch::Contains("No such file"));
    std::filesystem::create_directory(folder / "sub");
    CHECK_THROWS_AS(AtomicFile{folder / "sub"}, OutputError);
    CHECK_THROWS_AS(AtomicFile{"/dev/null"}, OutputError);
}

TEST_CASE("A folder without permission is refused by name", "[io]") {
    const scratch::Folder folder;
    std::filesystem::create_directory(folder / "locked");
    ::chmod((folder / "locked").c_str(), 0500);
    if (::geteuid() != 0) { // root may write everywhere
        CHECK_THROWS_WITH(AtomicFile{folder / "locked/a.txt"}, Catch::Contains("Permission denied"));
    }
    ::chmod((folder / "locked").c_str(), 0700);
}

TEST_CASE("what killed processes left half-written is removed, and nothing else", "[io]") {
    const scratch::Folder folder;
    const pid_t ended = ::fork();
    if (ended == 0) {
        ::_exit(0);
    }
    ::waitpid(ended, nullptr, 0);
    const std::string stale = "slab_0000.vtu." + std::to_string(ended) + "-3.part";
    const std::string live = "slab_0000.vtu." + std::to_string(::getpid()) + "-3.part";
    const std::vector<std::string> kept{live,           "slab_0000.vtu", "mine.part", "a-b.part",
                                        "x.12y-3.part", ".part",         "-.part"};
    scratch::put(folder / stale, "half");
    for (const std::string& name : kept) {
        scratch::put(folder / name, "whole");
    }
    io::remove_stale_parts(folder / "");
    CHECK_FALSE(std::filesystem::exists(folder / stale));
    for (const std::string& name : kept) {
        CHECK(std::filesystem::exists(folder / name));
    }
}

TEST_CASE("A symbolic link keeps pointing at the file that is written", "[io]") {
    const scratch::Folder folder;
    scratch::put(folder / "real.txt", "old");
    std::filesystem::create_symlink("real.txt", folder / "link.txt");
    io::write_text(folder / "link.txt", "new");
    CHECK(std::filesystem::is_symlink(folder / "link.txt"));
    CHECK(scratch::bytes_of(folder / "real.txt") == "new");
}
