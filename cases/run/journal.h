// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/checksum.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace slabhull {

/// A file of lines that only grows: the reports of the slabs, which so need no memory and outlive the
/// process. A checkpoint says how many of its bytes count, with their checksum.
class Journal {
public:
    /// A new file.
    explicit Journal(const std::filesystem::path& path) : Journal{path, 0, 0} {}
    /// Keeps the first `size` bytes of the file. Throws InputError when there are fewer or their checksum is
    /// another, OutputError when it cannot be written.
    Journal(const std::filesystem::path& path, std::uint64_t size, std::uint32_t checksum);
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    /// On disk when it returns. Throws OutputError.
    void append(const std::string& line);
    std::uint64_t size() const { return size_; }
    std::uint32_t checksum() const { return checksum_.value(); }
    /// All lines, one at a time.
    void each_line(const std::function<void(const std::string&)>& visit) const;

private:
    void require_intact(std::uint32_t checksum);
    [[noreturn]] void refuse(const char* what) const;
    [[noreturn]] void fail() const;

    std::filesystem::path path_;
    int descriptor_ = -1;
    std::uint64_t size_;
    io::Checksum checksum_;
};

} // namespace slabhull
