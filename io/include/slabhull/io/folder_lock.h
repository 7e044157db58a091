// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace slabhull::io {

/// While it lives, no other run writes into a folder. No file is added, and the system ends the lock with the
/// process and its children. File systems that cannot lock are written to without.
class FolderLock {
public:
    /// Waits a second for a run that is just ending. Throws UsageError when the folder is still in use by
    /// another process, or by another lock of this one.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int descriptor_ = -1;
};

} // namespace slabhull::io
