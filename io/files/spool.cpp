// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/spool.h"

#include "slabhull/core/error.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <unistd.h>
#include <vector>

namespace slabhull::io {

Spool::Spool(const std::filesystem::path& folder) : folder_{folder.empty() ? "." : folder} {
    std::string name = (folder_ / ".slabhull-XXXXXX").string();
    descriptor_ = ::mkstemp(name.data());
    if (descriptor_ < 0) {
        fail();
    }
    ::unlink(name.c_str());
}

Spool::~Spool() {
    ::close(descriptor_);
}

void Spool::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno != EINTR) {
            fail();
        }
        const auto step = static_cast<std::size_t>(std::max<ssize_t>(0, written));
        bytes.remove_prefix(step);
        size_ += step;
    }
}

void Spool::copy(std::uint64_t begin, std::uint64_t size, AtomicFile& to) const {
    constexpr std::uint64_t block_bytes = std::uint64_t{4} << 20;
    std::vector<char> block(std::min(size, block_bytes));
    const std::uint64_t end = begin + size;
    while (begin < end) {
        const ssize_t got =
            ::pread(descriptor_, block.data(), std::min<std::uint64_t>(end - begin, block.size()),
                    static_cast<off_t>(begin));
        if (got == 0 || (got < 0 && errno != EINTR)) {
            fail();
        }
        const auto step = static_cast<std::size_t>(std::max<ssize_t>(0, got));
        to.write(block.data(), step);
        begin += step;
    }
}

void Spool::fail() const {
    throw OutputError(fmt::format("{}: a temporary file cannot be written or read: {}", folder_.string(),
                                  std::strerror(errno)));
}

} // namespace slabhull::io
