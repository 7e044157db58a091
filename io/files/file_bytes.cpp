// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/file_bytes.h"

#include "io/files/file_cursor.h"
#include "slabhull/core/progress.h"
#include "slabhull/io/files_read.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace slabhull::io {

namespace {
constexpr std::size_t page = std::size_t{2} << 20;  // a huge page
constexpr std::size_t chunk = std::size_t{4} << 20; // read at once

std::size_t whole_pages(std::size_t bytes) {
    return (bytes + page - 1) / page * page;
}
} // namespace

FileBytes::FileBytes(const std::filesystem::path& path) : path_{path} {
    FilesRead::note(path);
    struct stat status {};
    // Non-regular files may have content without a size; small files are not worth huge pages.
    if (::stat(path.c_str(), &status) == 0 &&
        (!S_ISREG(status.st_mode) || status.st_size < static_cast<off_t>(chunk))) {
        all_ = read_bytes(path);
        data_ = all_.data();
        size_ = loaded_end_ = all_.size();
        return;
    }
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
        fail(std::strerror(errno));
    }
    size_ = static_cast<std::size_t>(status.st_size);
    // One huge page more, for aligning the first one.
    void* place = ::mmap(nullptr, whole_pages(size_) + page, PROT_READ | PROT_WRITE,
                         MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (place == MAP_FAILED) {
        ::close(descriptor_);
        throw std::bad_alloc{};
    }
    base_ = static_cast<char*>(place);
    ::madvise(place, whole_pages(size_) + page, MADV_HUGEPAGE); // only advice: small pages also work
    const auto address = reinterpret_cast<std::uintptr_t>(place);
    data_ = base_ + (whole_pages(address) - address);
}

FileBytes::~FileBytes() {
    if (base_ != nullptr) {
        ::munmap(base_, whole_pages(size_) + page);
    }
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
}

void FileBytes::load(std::size_t begin, std::size_t end) {
    end = std::min(end, size_);
    if (base_ == nullptr) {
        return;
    }
    if (begin < loaded_begin_ || begin > loaded_end_) {
        release(loaded_begin_, whole_pages(loaded_end_));
        loaded_begin_ = loaded_end_ = begin / page * page;
    } else if (begin / page * page > loaded_begin_) {
        release(loaded_begin_, begin / page * page);
        loaded_begin_ = begin / page * page;
    }
    if (end > loaded_end_) {
        const std::size_t last = std::min(size_, std::max(end, loaded_end_ + chunk));
        copy(loaded_end_, last, data_ + loaded_end_);
        loaded_end_ = last;
    }
}

void FileBytes::copy(std::size_t begin, std::size_t end, char* out) const {
    if (base_ == nullptr) {
        std::copy(data_ + begin, data_ + end, out);
    } else if (read(out, begin, end) != end - begin) {
        fail("it has become shorter meanwhile");
    }
}

std::size_t FileBytes::count_lines(std::size_t end) const {
    end = std::min(end, size_);
    if (base_ == nullptr) {
        return static_cast<std::size_t>(std::count(data_, data_ + end, '\n'));
    }
    std::vector<char> block(std::min(end, chunk));
    std::size_t lines = 0;
    for (std::size_t at = 0; at < end;) {
        const std::size_t got = read(block.data(), at, std::min(end, at + chunk));
        if (got == 0) {
            break;
        }
        lines += static_cast<std::size_t>(
            std::count(block.begin(), block.begin() + static_cast<std::ptrdiff_t>(got), '\n'));
        at += got;
    }
    return lines;
}

/// Returns the number of bytes read.
std::size_t FileBytes::read(char* out, std::size_t begin, std::size_t end) const {
    std::size_t at = begin;
    while (at < end) {
        go_on();
        const ssize_t got = ::pread(descriptor_, out + (at - begin), end - at, static_cast<off_t>(at));
        if (got < 0 && errno != EINTR) {
            fail(std::strerror(errno));
        }
        if (got == 0) {
            break;
        }
        at += static_cast<std::size_t>(std::max<ssize_t>(0, got));
    }
    return at - begin;
}

/// Releases the memory; the addresses stay reserved.
void FileBytes::release(std::size_t begin, std::size_t end) {
    if (end > begin) {
        ::madvise(data_ + begin, end - begin, MADV_DONTNEED);
    }
}

void FileBytes::fail(const char* why) const {
    throw InputError(fmt::format("{}: cannot be read: {}", path_.string(), why));
}

} // namespace slabhull::io
