// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace slabhull::io {

/// The bytes of a file that is read once from front to back: each has its place in memory, but only those
/// last asked for are there, so that a file takes no memory to speak of, whatever its size. (A mapping would
/// do the same, but a file cut short meanwhile would kill us.) What is not a regular file is read at once.
/// All functions throw InputError when the file cannot be read.
class FileBytes {
public:
    explicit FileBytes(const std::filesystem::path& path);
    ~FileBytes();
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::size_t size() const { return size_; }
    /// The whole file, of which only [begin, loaded_end()) of the last load() may be looked at.
    std::string_view view() const { return {data_, size_}; }
    std::size_t loaded_end() const { return loaded_end_; }
    /// Brings at least [begin, end) of the file, or what of it there is, and lets go of what stands before.
    void load(std::size_t begin, std::size_t end);
    /// Copies [begin, end) to `out`, whatever is loaded; from several threads, too. Throws where the file has
    /// become shorter.
    void copy(std::size_t begin, std::size_t end, char* out) const;
    /// Line ends before that byte; reads the file anew, for messages.
    std::size_t count_lines(std::size_t end) const;

private:
    [[noreturn]] void fail(const char* why) const;
    void release(std::size_t begin, std::size_t end);
    std::size_t read(char* out, std::size_t begin, std::size_t end) const;

    std::filesystem::path path_;
    int descriptor_ = -1;
    char* base_ = nullptr; ///< the addresses set aside; nullptr: all was read at once
    char* data_ = nullptr; ///< the first of them that begins a huge page
    std::size_t size_ = 0;
    std::size_t loaded_begin_ = 0; ///< a multiple of a page's size
    std::size_t loaded_end_ = 0;
    Array<char> all_; ///< of what is not a regular file
};

} // namespace slabhull::io
