// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/atomic_file.h"

#include "io/files/block_writer.h"
#include "slabhull/core/error.h"
#include "slabhull/core/progress.h"
#include "slabhull/io/files.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace slabhull::io {

namespace {

std::filesystem::path followed(const std::filesystem::path& path) {
    std::error_code no_such_file;
    const auto target = std::filesystem::canonical(path, no_such_file);
    return no_such_file ? path : target;
}

/// A temporary name beside the target, as rename() does not work between disks; unique by process and count.
std::filesystem::path temporary_beside(const std::filesystem::path& target) {
    static std::atomic<unsigned> count{0};
    auto name = target.filename();
    name += fmt::format(".{}-{}.part", ::getpid(), count++);
    return target.parent_path() / name;
}

/// The process in a name that temporary_beside() made, or 0.
pid_t writer_of(const std::string& name) {
    const std::size_t dash = name.rfind('-');
    const std::size_t dot = name.rfind('.', dash);
    if (!name.ends_with(".part") || dash == std::string::npos || dot == std::string::npos) {
        return 0;
    }
    pid_t process = 0;
    const char* end = name.data() + dash;
    const auto [read, error] = std::from_chars(name.data() + dot + 1, end, process);
    return error == std::errc{} && read == end ? process : 0;
}

/// A new name survives a power cut only if its folder is synced. Errors are ignored, as some file systems
/// cannot sync folders.
void sync_folder(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor >= 0) {
        ::fsync(descriptor);
        ::close(descriptor);
    }
}

} // namespace

AtomicFile::AtomicFile(const std::filesystem::path& path)
    : path_{path}, target_{followed(path)}, temporary_{temporary_beside(target_)} {
    struct stat status {};
    if (::stat(target_.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
        throw OutputError(fmt::format("{}: cannot be written: it is not a regular file", path_.string()));
    }
    constexpr mode_t for_all = 0666; // reduced by the umask
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, for_all);
    if (descriptor_ < 0) {
        const int why = errno;
        const std::filesystem::path folder = target_.parent_path();
        std::error_code ignored;
        throw OutputError(fmt::format("{}: cannot be created: {}; {}", path_.string(), std::strerror(why),
                                      !folder.empty() && !std::filesystem::exists(folder, ignored)
                                          ? fmt::format("make the folder {} first", folder.string())
                                          : "give a place that can be written to"));
    }
    blocks_ = std::make_unique<BlockWriter>(descriptor_);
}

AtomicFile::~AtomicFile() {
    blocks_.reset(); // its thread may still be writing
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
    if (!temporary_.empty()) {
        ::unlink(temporary_.c_str());
    }
}

void AtomicFile::write(const void* bytes, std::size_t size) {
    const auto* next = static_cast<const char*>(bytes);
    while (size > 0) {
        const std::span<char> place = room();
        const std::size_t step = std::min(size, place.size());
        std::memcpy(place.data(), next, step);
        advance(step);
        next += step;
        size -= step;
    }
}

std::span<char> AtomicFile::room() {
    return blocks_->room();
}

void AtomicFile::advance(std::size_t size) {
    if (checksum_) {
        checksum_->add(blocks_->room().data(), size);
    }
    blocks_->advance(size);
    work_done(size);
    check_blocks();
    go_on();
}

void AtomicFile::check_blocks() const {
    if (const int error = blocks_->error(); error != 0) {
        errno = error;
        fail("cannot be written");
    }
}

void AtomicFile::finish() {
    if (descriptor_ < 0) {
        return;
    }
    blocks_->finish();
    check_blocks();
    blocks_.reset();
    if (::fdatasync(descriptor_) != 0 || ::close(std::exchange(descriptor_, -1)) != 0) {
        fail("cannot be written");
    }
}

void AtomicFile::commit() {
    finish();
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
        fail("cannot be put in place");
    }
    temporary_.clear();
    sync_folder(target_.parent_path());
}

void AtomicFile::fail(const char* doing) const {
    throw OutputError(fmt::format("{}: {}: {}", path_.string(), doing, std::strerror(errno)));
}

AtomicFile& AtomicFiles::open(const std::filesystem::path& path) {
    if (std::find(paths_.begin(), paths_.end(), path) != paths_.end()) {
        throw OutputError(fmt::format("{}: two files would get this name", path.string()));
    }
    files_.push_back(std::make_unique<AtomicFile>(path));
    paths_.push_back(path);
    return *files_.back();
}

void AtomicFiles::finish() {
    std::for_each(files_.begin(), files_.end(), [](const auto& file) { file->finish(); });
}

void AtomicFiles::commit() {
    finish();
    std::for_each(files_.begin(), files_.end(), [](const auto& file) { file->commit(); });
}

void make_folder(const std::filesystem::path& folder) {
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) {
        std::error_code ignored;
        const bool is_file =
            std::filesystem::exists(folder, ignored) && !std::filesystem::is_directory(folder, ignored);
        throw OutputError(
            is_file ? fmt::format("{}: this is a file, where a folder is wanted; give another one with --out",
                                  folder.string())
                    : fmt::format("{}: the folder cannot be made: {}; give another one with --out",
                                  folder.string(), failure.message()));
    }
}

void remove_stale_parts(const std::filesystem::path& folder) {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator{folder, ignored}) {
        const pid_t writer = writer_of(entry.path().filename().string());
        if (writer > 0 && ::kill(writer, 0) != 0 && errno == ESRCH) {
            std::filesystem::remove(entry.path(), ignored);
        }
    }
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    AtomicFile file{path};
    file.write(text);
    file.commit();
}

} // namespace slabhull::io
