// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files_read.h"

#include "slabhull/core/error.h"

#include <algorithm>
#include <atomic>
#include <fmt/format.h>
#include <optional>
#include <sys/stat.h>

namespace slabhull::io {

namespace {

std::atomic<FilesRead*> noting{nullptr};

std::optional<std::pair<dev_t, ino_t>> identity_of(const std::filesystem::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) {
        return std::nullopt;
    }
    return std::pair{status.st_dev, status.st_ino};
}

} // namespace

FilesRead::FilesRead() {
    noting = this;
}

FilesRead::~FilesRead() {
    noting = nullptr;
}

void FilesRead::note(const std::filesystem::path& file) {
    FilesRead* const notes = noting;
    if (notes == nullptr) {
        return;
    }
    if (const auto identity = identity_of(file)) {
        const std::lock_guard lock{notes->guard_};
        notes->files_.push_back(*identity);
    }
}

void FilesRead::require_none(std::span<const std::filesystem::path> outputs) const {
    const std::lock_guard lock{guard_};
    for (const std::filesystem::path& output : outputs) {
        const auto identity = identity_of(output);
        if (identity && std::find(files_.begin(), files_.end(), *identity) != files_.end()) {
            throw UsageError{fmt::format("{}: is read, so it is not written over; give the output another "
                                         "name",
                                         output.string())};
        }
    }
}

} // namespace slabhull::io
