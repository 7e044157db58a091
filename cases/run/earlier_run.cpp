// SPDX-License-Identifier: BSD-3-Clause
#include "cases/run/earlier_run.h"

#include <fstream>
#include <regex>
#include <string>
#include <system_error>
#include <vector>

namespace slabhull {

namespace {

/// Slabs that a journal tells of: a line for each, after one for the initial cap. The last may have been
/// written without a line.
std::size_t slabs_of(const std::filesystem::path& journal) {
    std::ifstream lines{journal};
    std::string line;
    std::size_t count = 0;
    while (std::getline(lines, line)) {
        ++count;
    }
    return count;
}

/// Whether a file is one of a slab below `slabs`, of its terminating cap, or a piece of one.
bool is_of_slab(const std::string& name, std::size_t slabs) {
    static const std::regex pattern{R"((slab|cap|fill)_(\d{4,9})(_\d+)?\.(vtu|pvtu|msh|mfem|getfem|h5))"};
    std::smatch match;
    return std::regex_match(name, match, pattern) &&
           std::stoul(match[2]) < slabs + (match[1] == "cap" ? 1 : 0);
}

} // namespace

void remove_earlier_run(const std::filesystem::path& folder) {
    std::error_code ignored; // what cannot be removed will be told when it cannot be replaced
    std::filesystem::remove(folder / checkpoint_name, ignored);
    const std::size_t slabs = slabs_of(folder / journal_name);
    if (slabs == 0) {
        return;
    }
    std::vector<std::filesystem::path> stale;
    for (const auto& entry : std::filesystem::directory_iterator{folder, ignored}) {
        if (is_of_slab(entry.path().filename().string(), slabs)) {
            stale.push_back(entry.path());
        }
    }
    for (const char* name : {report_name, slabs_series_name, caps_series_name}) {
        stale.push_back(folder / name);
    }
    for (const std::filesystem::path& path : stale) {
        std::filesystem::remove(path, ignored);
    }
}

} // namespace slabhull
