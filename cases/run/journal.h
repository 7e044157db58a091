// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace slabhull {

/// A file of lines that only grows: the reports of the slabs, which so need no memory and outlive the
/// process. A checkpoint says how many of its bytes count.
class Journal {
public:
    /// Keeps the first `size` bytes of the file, none of a new one. Throws InputError when there are fewer,
    /// OutputError when it cannot be written.
    Journal(const std::filesystem::path& path, std::uint64_t size);
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    /// On disk when it returns. Throws OutputError.
    void append(const std::string& line);
    std::uint64_t size() const { return size_; }
    /// All lines, one at a time.
    void each_line(const std::function<void(const std::string&)>& visit) const;

private:
    [[noreturn]] void fail() const;

    std::filesystem::path path_;
    int descriptor_ = -1;
    std::uint64_t size_;
};

} // namespace slabhull
