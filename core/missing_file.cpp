// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/missing_file.h"

#include "slabhull/core/text.h"

#include <cerrno>
#include <fmt/format.h>
#include <vector>

namespace slabhull {

namespace {

/// The names in a folder, as far as it can be read.
std::vector<std::string> names_in(const std::filesystem::path& folder) {
    constexpr std::size_t most = 10'000;
    std::vector<std::string> names;
    std::error_code failure;
    for (std::filesystem::directory_iterator entry{folder, failure}, end; !failure && entry != end;
         entry.increment(failure)) {
        names.push_back(entry->path().filename().string());
        if (names.size() == most) {
            break;
        }
    }
    return names;
}

} // namespace

std::string look_again(const std::filesystem::path& path, int why) {
    std::error_code ignored;
    if (why == EISDIR) {
        return "; give a file in it";
    }
    if (why != ENOENT) {
        return "";
    }
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    if (!std::filesystem::is_directory(folder, ignored)) {
        return fmt::format("; there is no folder {}: check the path", folder.string());
    }
    const std::string nearest = nearest_name(path.filename().string(), names_in(folder));
    if (!nearest.empty()) {
        return fmt::format("; did you mean {}?", (path.parent_path() / nearest).string());
    }
    return fmt::format("; there is none of nearly this name in {}: check the path",
                       path.has_parent_path() ? folder.string()
                                              : std::filesystem::current_path(ignored).string());
}

} // namespace slabhull
