// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/file_cursor.h"

#include "slabhull/core/missing_file.h"
#include "slabhull/core/progress.h"
#include "slabhull/core/text.h"
#include "slabhull/io/files_read.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace slabhull::io {

namespace {

class Descriptor {
public:
    explicit Descriptor(const std::filesystem::path& path)
        : number_{::open(path.c_str(), O_RDONLY | O_CLOEXEC)} {}
    ~Descriptor() {
        if (number_ >= 0) {
            ::close(number_);
        }
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int number() const { return number_; }

private:
    int number_;
};

[[noreturn]] void fail_reading(const std::filesystem::path& path) {
    const int why = errno;
    throw InputError(
        fmt::format("{}: cannot be read: {}{}", path.string(), std::strerror(why), look_again(path, why)));
}

} // namespace

Array<char> read_bytes(const std::filesystem::path& path) {
    FilesRead::note(path);
    const Descriptor file{path};
    struct stat status {};
    if (file.number() < 0 || ::fstat(file.number(), &status) != 0) {
        fail_reading(path);
    }
    constexpr std::size_t least = 65536; // pipes have no size
    Array<char> bytes(std::max(least, static_cast<std::size_t>(std::max<off_t>(0, status.st_size)) + 1));
    std::size_t size = 0;
    while (true) {
        go_on();
        const ssize_t got = ::read(file.number(), bytes.data() + size, bytes.size() - size);
        if (got < 0 && errno != EINTR) {
            fail_reading(path);
        }
        if (got == 0) {
            break;
        }
        size += static_cast<std::size_t>(std::max<ssize_t>(0, got));
        if (size == bytes.size()) {
            bytes.resize(2 * size);
        }
    }
    bytes.resize(size);
    return bytes;
}

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

std::string_view FileCursor::line() {
    std::size_t end = bytes_.substr(0, loaded_end_).find('\n', offset_);
    for (std::size_t before = loaded_end_; end == std::string_view::npos && load_more(offset_);
         before = loaded_end_) {
        end = bytes_.substr(0, loaded_end_).find('\n', before);
    }
    end = std::min(end, bytes_.size());
    std::string_view text = bytes_.substr(offset_, end - offset_);
    offset_ = std::min(end + 1, bytes_.size());
    if (!text.empty() && text.back() == '\r') {
        text.remove_suffix(1);
    }
    return text;
}

std::string_view FileCursor::word() {
    skip_blanks();
    const std::size_t begin = offset_;
    do {
        while (offset_ < loaded_end_ && !is_blank(bytes_[offset_])) {
            ++offset_;
        }
    } while (offset_ == loaded_end_ && load_more(begin));
    return bytes_.substr(begin, offset_ - begin);
}

bool FileCursor::seek_text(std::string_view text) {
    while (true) {
        const std::size_t found = bytes_.substr(0, loaded_end_).find(text, offset_);
        if (found != std::string_view::npos) {
            offset_ = found;
            return true;
        }
        // the text may begin at the end of the loaded bytes
        offset_ = std::max(offset_, loaded_end_ - std::min(loaded_end_, text.size()));
        if (!load_more(offset_)) {
            return false;
        }
    }
}

std::string FileCursor::quoted() {
    const std::size_t start = offset_;
    const std::string_view text = line();
    const std::size_t first = text.find('"');
    const std::size_t last = text.rfind('"');
    if (first == std::string_view::npos || first == last) {
        fail_at(start, "a name in double quotes was expected");
    }
    return std::string{text.substr(first + 1, last - first - 1)};
}

std::size_t FileCursor::plausible(std::uint64_t count, std::size_t least_size, const char* what) const {
    if (count > remaining() / std::max<std::size_t>(1, least_size)) {
        fail(fmt::format("{} {} are claimed, but only {} bytes follow", count, what, remaining()));
    }
    return static_cast<std::size_t>(count);
}

void FileCursor::fail_at(std::size_t offset, const std::string& text) const {
    if (binary_) {
        throw InputError(fmt::format("{}: byte {}: {}", path_, offset, readable(text)),
                         {Entity{"byte", static_cast<std::int64_t>(offset), {}}});
    }
    const auto end = static_cast<std::ptrdiff_t>(std::min(offset, bytes_.size()));
    const auto line = 1 + (file_ != nullptr ? static_cast<std::ptrdiff_t>(file_->count_lines(offset))
                                            : std::count(bytes_.begin(), bytes_.begin() + end, '\n'));
    throw InputError(fmt::format("{}: line {}: {}", path_, line, readable(text)), {Entity{"line", line, {}}});
}

void FileCursor::fail_word(std::string_view word, const char* what) const {
    if (word.empty()) {
        fail(std::string{what} + " was expected, but nothing follows");
    }
    constexpr std::size_t shown = 40;
    fail(fmt::format("{} was expected, not \"{}\"", what, word.substr(0, shown)));
}

} // namespace slabhull::io
