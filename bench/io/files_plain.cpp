// SPDX-License-Identifier: BSD-3-Clause
// As many bytes as our VTU file has in its arrays, made once, to the disk by write() and fdatasync(): what
// `dd conv=fdatasync` does, and with `oflag=direct`. And meshio, in a process of its own.
#include "file_peers.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <unistd.h>

namespace slabhull::bench {

namespace {

constexpr std::size_t block_bytes = std::size_t{8} << 20;

/// What stands in the appended section for each point and cell; see docs/formats.md.
std::size_t array_bytes(const HullSoup& soup) {
    constexpr std::size_t point_bytes = 3 * 8 + 4 * 8;
    constexpr std::size_t cell_bytes = 4 * 4 + 4 + 1 + 3 * 4 + 4 * 8;
    return soup.point_count() * point_bytes + soup.cell_count() * cell_bytes;
}

void write_plain(const std::string& file, const char* block, std::size_t size, int flags) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | flags, 0666);
    bool done = descriptor >= 0;
    for (; done && size > 0; size -= block_bytes) {
        done = ::write(descriptor, block, block_bytes) == static_cast<ssize_t>(block_bytes);
    }
    done = done && ::fdatasync(descriptor) == 0;
    if (::close(descriptor) != 0 || !done) {
        throw std::runtime_error{file + ": " + std::strerror(errno)};
    }
}

template<int flags>
Run writing_plain(const HullSoup& soup) {
    const auto free_block = [](char* block) { std::free(block); };
    const std::shared_ptr<char> block{static_cast<char*>(std::aligned_alloc(4096, block_bytes)), free_block};
    std::memset(block.get(), 'x', block_bytes);
    const std::size_t size = array_bytes(soup) / block_bytes * block_bytes;
    return [block, size](const std::string& file) {
        write_plain(file, block.get(), size, flags);
        return Outcome{[] { return true; }};
    };
}

template<class Rows>
void dump(const std::string& file, std::size_t count, const Rows& row) {
    std::ofstream out{file, std::ios::binary};
    for (std::size_t i = 0; i < count; ++i) {
        const auto values = row(i);
        out.write(reinterpret_cast<const char*>(values.data()), sizeof values);
    }
    if (!out.flush()) {
        throw std::runtime_error{file + " cannot be written"};
    }
}

/// The arrays that meshio starts from, in files that go away with it.
struct Dumps {
    std::string points;
    std::string cells;
    explicit Dumps(const std::string& stem) : points{stem + ".points"}, cells{stem + ".cells"} {}
    ~Dumps() {
        ::unlink(points.c_str());
        ::unlink(cells.c_str());
    }
};

double run_meshio(const Dumps& dumps, const std::string& file) {
    const std::string command =
        std::string{SLABHULL_WRITE_MESHIO} + " '" + dumps.points + "' '" + dumps.cells + "' '" + file + "'";
    std::FILE* const child = ::popen(command.c_str(), "r");
    double seconds = 0;
    const bool printed = child != nullptr && std::fscanf(child, "%lf", &seconds) == 1;
    if (child == nullptr || ::pclose(child) != 0 || !printed) {
        throw std::runtime_error{"meshio has not written"};
    }
    return seconds;
}

Run writing_meshio(const HullSoup& soup) {
    const auto dumps = std::make_shared<Dumps>("/tmp/slabhull-meshio-" + std::to_string(::getpid()));
    dump(dumps->points, soup.point_count(), [&](std::size_t v) { return soup.point(v); });
    dump(dumps->cells, soup.cell_count(), [&](std::size_t c) { return soup.vertices(c); });
    return [dumps](const std::string& file) { return Outcome{{}, run_meshio(*dumps, file)}; };
}

const bool added =
    add_contestant({"write_vtu", "dd_fdatasync", writing_plain<0>}) &&
    add_contestant({"write_vtu", "dd_direct", writing_plain<O_DIRECT>}) &&
    (std::string{SLABHULL_WRITE_MESHIO}.empty() || add_contestant({"write_msh", "meshio", writing_meshio}));

} // namespace

} // namespace slabhull::bench
