// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/io/checksum.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slabhull::io {

class BlockWriter;

/// A file that appears under its name complete or not at all: bytes go to a temporary file beside it, which
/// commit() syncs to disk and renames. Without commit() the temporary file is removed and whatever stood
/// under the name stays. A symbolic link is followed, permissions are those of a new file. All failures are
/// OutputErrors naming the path; what is written waits in blocks (24 MiB at most), so the failure of one
/// write() may be told by a later one, at the latest by finish().
class AtomicFile {
public:
    explicit AtomicFile(const std::filesystem::path& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(const void* bytes, std::size_t size);
    void write(std::string_view text) { write(text.data(), text.size()); }
    /// Place for bytes that are to be made where they leave from, at least one; advance() by as many as are
    /// made.
    std::span<char> room();
    void advance(std::size_t size);
    /// Syncs to disk, for a commit() that then only renames. Nothing may be written after it.
    void finish();
    /// Gives the file its name, for good: the folder is synced, too.
    void commit();
    /// Where the file will stand.
    std::filesystem::path folder() const { return target_.parent_path(); }
    const std::filesystem::path& target() const { return target_; }
    /// Where its bytes stand meanwhile, for libraries that write to a name. The checksum misses what they
    /// write.
    const std::filesystem::path& temporary() const { return temporary_; }
    /// Sums up what is written from now on.
    void keep_checksum() { checksum_.emplace(); }
    std::uint32_t checksum() const { return checksum_ ? checksum_->value() : 0; }

private:
    [[noreturn]] void fail(const char* doing) const;
    void check_blocks() const;

    std::filesystem::path path_;      ///< as the caller names it
    std::filesystem::path target_;    ///< where it points
    std::filesystem::path temporary_; ///< empty once committed
    int descriptor_ = -1;
    std::unique_ptr<BlockWriter> blocks_;
    std::optional<Checksum> checksum_;
};

/// Files that get their names together: what can fail has been done for all of them before the first does.
class AtomicFiles {
public:
    /// Begins a further one; the reference stays good. Throws OutputError, also for a path that is among
    /// them.
    AtomicFile& open(const std::filesystem::path& path);
    /// Syncs all that are open so far to disk. Nothing may be written to them after it.
    void finish();
    void commit();
    /// In the order in which they were opened.
    const std::vector<std::filesystem::path>& paths() const { return paths_; }

private:
    std::vector<std::filesystem::path> paths_;
    std::vector<std::unique_ptr<AtomicFile>> files_;
};

/// Makes a folder and those above it, where they are missing. Throws OutputError.
void make_folder(const std::filesystem::path& folder);

/// Removes the temporary files that processes left in a folder which were killed while writing there.
void remove_stale_parts(const std::filesystem::path& folder);

} // namespace slabhull::io
