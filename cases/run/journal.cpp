// SPDX-License-Identifier: BSD-3-Clause
#include "cases/run/journal.h"

#include "slabhull/core/error.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <unistd.h>

namespace slabhull {

Journal::Journal(const std::filesystem::path& path, std::uint64_t size, std::uint32_t checksum)
    : path_{path}, size_{size} {
    std::error_code missing;
    const auto there = std::filesystem::file_size(path, missing);
    if (size > 0 && (missing || there < size)) {
        refuse("lacks slabs that the checkpoint counts on");
    }
    require_intact(checksum);
    constexpr mode_t for_all = 0666;
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, for_all);
    if (descriptor_ < 0 || ::ftruncate(descriptor_, static_cast<off_t>(size)) != 0 ||
        ::lseek(descriptor_, 0, SEEK_END) < 0) {
        fail();
    }
}

void Journal::require_intact(std::uint32_t checksum) {
    each_line([this](const std::string& line) {
        checksum_.add(line.data(), line.size());
        checksum_.add("\n", 1);
    });
    if (checksum_.value() != checksum) {
        refuse("is damaged: its checksum is wrong");
    }
}

Journal::~Journal() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
}

void Journal::append(const std::string& line) {
    const std::string text = line + '\n';
    for (std::size_t done = 0; done < text.size();) {
        const ssize_t written = ::write(descriptor_, text.data() + done, text.size() - done);
        if (written < 0 && errno != EINTR) {
            fail();
        }
        done += written > 0 ? static_cast<std::size_t>(written) : 0;
    }
    if (::fdatasync(descriptor_) != 0) {
        fail();
    }
    size_ += text.size();
    checksum_.add(text.data(), text.size());
}

void Journal::each_line(const std::function<void(const std::string&)>& visit) const {
    std::ifstream file{path_};
    std::uint64_t read = 0;
    for (std::string line; read < size_ && std::getline(file, line);) {
        read += line.size() + 1;
        visit(line);
    }
}

void Journal::refuse(const char* what) const {
    throw InputError(fmt::format("{}: {}; start the run anew, without --resume", path_.string(), what));
}

void Journal::fail() const {
    throw OutputError(fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
}

} // namespace slabhull
