// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include <unistd.h>

namespace scratch {

/// A folder that goes away with its test.
class Folder {
public:
    Folder() {
        const std::filesystem::path memory{"/dev/shm"}; // tests write thousands of small files
        const auto base = std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
        std::string name = (base / "slabhull-XXXXXX").string();
        path_ = ::mkdtemp(name.data());
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    std::size_t file_count() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator{path_}, {}));
    }

private:
    std::filesystem::path path_;
};

inline std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file{path, std::ios::binary};
    return {std::istreambuf_iterator<char>{file}, {}};
}

inline std::filesystem::path put(const std::filesystem::path& path, const std::string& bytes) {
    std::filesystem::remove(path); // writing over a file makes some file systems wait for the disk
    std::ofstream{path, std::ios::binary} << bytes;
    return path;
}

inline std::filesystem::path fixture(const std::string& name) {
    return std::filesystem::path{SLABHULL_TEST_DATA} / "io" / name;
}

template<class T>
std::string binary(T value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) {
        throw std::logic_error{"nothing to replace: " + from};
    }
    return text.replace(at, from.size(), to);
}

/// What the reader says when it refuses; empty if it reads. Anything but an InputError gets out.
template<class Read>
std::string refusal(const Read& read, const std::filesystem::path& path) {
    try {
        read(path);
    } catch (const slabhull::InputError& error) {
        return error.what();
    }
    return {};
}

/// The same of a file of that name with these bytes.
template<class Read>
std::string refusal(const Read& read, const std::string& name, const std::string& bytes) {
    const Folder folder;
    return refusal(read, put(folder / name, bytes));
}

/// Reads the file with random bytes changed, `rounds` times: whatever comes, it is a soup or an InputError.
/// Returns how many were refused.
template<class Read>
int survive_damage(const Read& read, const std::string& bytes, const std::filesystem::path& path,
                   int rounds) {
    std::mt19937 random{12345};
    int refused = 0;
    for (int round = 0; round < rounds; ++round) {
        std::string damaged = bytes;
        const auto flips = 1 + random() % 4;
        for (unsigned k = 0; k < flips; ++k) {
            damaged[random() % damaged.size()] = static_cast<char>(random());
        }
        refused += refusal(read, put(path, damaged)).empty() ? 0 : 1;
    }
    return refused;
}

} // namespace scratch
