// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/atomic_file.h"

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace slabhull::io {

/// Temporary bytes on disk, to be copied into a file later: an unnamed file in a folder, deleted with the
/// object. All failures are OutputErrors naming the folder.
class Spool {
public:
    explicit Spool(const std::filesystem::path& folder);
    ~Spool();
    Spool(const Spool&) = delete;
    Spool& operator=(const Spool&) = delete;

    std::uint64_t size() const { return size_; }
    void write(std::string_view bytes);
    /// Copies `size` bytes from `begin` on.
    void copy(std::uint64_t begin, std::uint64_t size, AtomicFile& to) const;

private:
    [[noreturn]] void fail() const;

    std::filesystem::path folder_;
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
};

} // namespace slabhull::io
