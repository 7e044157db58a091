// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace fuzz {

/// Files in memory for readers that want a path: one folder per process, taken from SLABHULL_FUZZ_FOLDER
/// where that is set, and files that are written over and over.
class InputFolder {
public:
    InputFolder();
    ~InputFolder();
    InputFolder(const InputFolder&) = delete;
    InputFolder& operator=(const InputFolder&) = delete;

    /// The file of that name, with those bytes.
    std::filesystem::path put(const std::string& name, std::string_view bytes) const;
    void remove(const std::string& name) const;
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
    bool is_own_ = false;
};

} // namespace fuzz
