// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <mutex>
#include <span>
#include <sys/types.h>
#include <utility>
#include <vector>

namespace slabhull::io {

/// Notes each file that this room reads while it lives, those that belong to a given one among them, so that
/// none is written over. One at a time; any thread may read.
class FilesRead {
public:
    FilesRead();
    ~FilesRead();
    FilesRead(const FilesRead&) = delete;
    FilesRead& operator=(const FilesRead&) = delete;

    /// Throws UsageError if one of the files to be written is one that was read, whatever it is called.
    void require_none(std::span<const std::filesystem::path> outputs) const;

    /// Called where a file is read.
    static void note(const std::filesystem::path& file);

private:
    using Identity = std::pair<dev_t, ino_t>;

    mutable std::mutex guard_;
    std::vector<Identity> files_;
};

} // namespace slabhull::io
