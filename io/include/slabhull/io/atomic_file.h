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
/// commit() syncs to disk and renames. Without commit() the temporary file is removed and an existing file
/// stays. Symbolic links are followed; permissions are those of a new file. All failures are OutputErrors
/// naming the path. Up to 24 MiB are buffered, so the failure of a write() may be thrown by a later one, at
/// the latest by finish().
class AtomicFile {
public:
    explicit AtomicFile(const std::filesystem::path& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(const void* bytes, std::size_t size);
    void write(std::string_view text) { write(text.data(), text.size()); }
    /// Buffer space, at least a byte, for writing bytes in place; call advance() with their number.
    std::span<char> room();
    void advance(std::size_t size);
    /// Syncs to disk, so that commit() only has to rename. Nothing may be written after it.
    void finish();
    /// Gives the file its name, durably: the folder is synced, too.
    void commit();
    /// The folder of the final file.
    std::filesystem::path folder() const { return target_.parent_path(); }
    const std::filesystem::path& target() const { return target_; }
    /// The temporary file, for libraries that write to a path. The checksum does not include what they write.
    const std::filesystem::path& temporary() const { return temporary_; }
    /// Starts a checksum of all that is written from now on.
    void keep_checksum() { checksum_.emplace(); }
    std::uint32_t checksum() const { return checksum_ ? checksum_->value() : 0; }

private:
    [[noreturn]] void fail(const char* doing) const;
    void check_blocks() const;

    std::filesystem::path path_;      ///< as the caller names it
    std::filesystem::path target_;    ///< `path_` with links followed
    std::filesystem::path temporary_; ///< empty once committed
    int descriptor_ = -1;
    std::unique_ptr<BlockWriter> blocks_;
    std::optional<Checksum> checksum_;
};

/// Files that get their names together: all that is likely to fail is done for all of them before the first
/// rename.
class AtomicFiles {
public:
    /// Opens another file; the reference stays valid. Throws OutputError, also for a path that is open
    /// already.
    AtomicFile& open(const std::filesystem::path& path);
    /// Syncs all files opened so far to disk. Nothing may be written to them after it.
    void finish();
    void commit();
    /// The paths in the order of opening.
    const std::vector<std::filesystem::path>& paths() const { return paths_; }

private:
    std::vector<std::filesystem::path> paths_;
    std::vector<std::unique_ptr<AtomicFile>> files_;
};

/// Makes a folder and those above it, if they are missing. Throws OutputError.
void make_folder(const std::filesystem::path& folder);

/// Removes the temporary files that killed processes left in a folder.
void remove_stale_parts(const std::filesystem::path& folder);

} // namespace slabhull::io
