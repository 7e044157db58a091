// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace slabhull::io {

/// The bytes of a file that is read once from front to back. Each byte has an address, but only a window is
/// in memory, so that even a large file takes little. (A mapping would do the same, but truncating the file
/// meanwhile would kill us.) A file that is not a regular one is read at once. All functions throw InputError
/// when the file cannot be read.
class FileBytes {
public:
    explicit FileBytes(const std::filesystem::path& path);
    ~FileBytes();
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::size_t size() const { return size_; }
    /// The whole file, of which only [begin, loaded_end()) of the last load() may be accessed.
    std::string_view view() const { return {data_, size_}; }
    std::size_t loaded_end() const { return loaded_end_; }
    /// Loads at least [begin, end) as far as the file goes, and releases the bytes before it.
    void load(std::size_t begin, std::size_t end);
    /// Copies [begin, end) to `out`, whatever is loaded; safe from several threads. Throws if the file has
    /// become shorter.
    void copy(std::size_t begin, std::size_t end, char* out) const;
    /// Number of line ends before a byte, for messages; reads the file anew.
    std::size_t count_lines(std::size_t end) const;

private:
    [[noreturn]] void fail(const char* why) const;
    void release(std::size_t begin, std::size_t end);
    std::size_t read(char* out, std::size_t begin, std::size_t end) const;

    std::filesystem::path path_;
    int descriptor_ = -1;
    char* base_ = nullptr; ///< the reserved addresses; nullptr: all was read at once
    char* data_ = nullptr; ///< the first reserved address that begins a huge page
    std::size_t size_ = 0;
    std::size_t loaded_begin_ = 0; ///< a multiple of a page's size
    std::size_t loaded_end_ = 0;
    Array<char> all_; ///< content if it was read at once
};

} // namespace slabhull::io
