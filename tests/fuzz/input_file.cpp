// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/input_file.h"

#include <cstdlib>
#include <fcntl.h>
#include <stdexcept>
#include <unistd.h>

namespace fuzz {

namespace {

std::filesystem::path new_folder() {
    const std::filesystem::path memory{"/dev/shm"};
    const auto base = std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
    std::string name = (base / "slabhull-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
        throw std::runtime_error{"no folder for files to read"};
    }
    return name;
}

} // namespace

InputFolder::InputFolder() {
    const char* given = std::getenv("SLABHULL_FUZZ_FOLDER");
    is_own_ = given == nullptr;
    path_ = is_own_ ? new_folder() : std::filesystem::path{given};
}

InputFolder::~InputFolder() {
    if (is_own_) {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
}

std::filesystem::path InputFolder::put(const std::string& name, std::string_view bytes) const {
    std::filesystem::path path = path_ / name;
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    ::close(file);
    if (written != static_cast<ssize_t>(bytes.size())) {
        throw std::runtime_error{path.string() + " cannot be written"};
    }
    return path;
}

void InputFolder::remove(const std::string& name) const {
    ::unlink((path_ / name).c_str());
}

} // namespace fuzz
