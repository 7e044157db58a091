// SPDX-License-Identifier: BSD-3-Clause
#include "cases/run/earlier_run.h"

#include <algorithm>
#include <fstream>
#include <optional>
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

/// The number of the slab that a file is of, or a piece of it; a cap counts to the slab that it ends.
std::optional<long> slab_of_file(const std::string& name) {
    static const std::regex pattern{R"((slab|cap|fill)_(\d{4,9})(_\d+)?\.(vtu|pvtu|msh|mfem|getfem|h5))"};
    std::smatch match;
    if (!std::regex_match(name, match, pattern)) {
        return std::nullopt;
    }
    return std::stol(match[2]) - (match[1] == "cap" ? 1 : 0);
}

/// The files of slabs in a folder for whose numbers `is_stale` holds.
template<class Predicate>
std::vector<std::filesystem::path> files_of_slabs(const std::filesystem::path& folder,
                                                  const Predicate& is_stale) {
    std::error_code ignored;
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator{folder, ignored}) {
        const std::optional<long> slab = slab_of_file(entry.path().filename().string());
        if (slab && is_stale(*slab)) {
            found.push_back(entry.path());
        }
    }
    return found;
}

/// What cannot be removed will be told when it cannot be replaced.
void remove_all(const std::vector<std::filesystem::path>& files) {
    std::error_code ignored;
    for (const std::filesystem::path& path : files) {
        std::filesystem::remove(path, ignored);
    }
}

} // namespace

bool is_name_of_run(const std::string& name) {
    const auto beside = {checkpoint_name, journal_name, report_name, slabs_series_name, caps_series_name};
    return slab_of_file(name) || std::find(beside.begin(), beside.end(), name) != beside.end();
}

void remove_earlier_run(const std::filesystem::path& folder) {
    remove_all({folder / checkpoint_name});
    const auto slabs = static_cast<long>(slabs_of(folder / journal_name));
    if (slabs == 0) {
        return;
    }
    remove_all(files_of_slabs(folder, [slabs](long slab) { return slab < slabs; }));
    remove_all({folder / report_name, folder / slabs_series_name, folder / caps_series_name});
}

void remove_unfinished_slab(const std::filesystem::path& folder, int next) {
    remove_all(files_of_slabs(folder, [next](long slab) { return slab == next; }));
}

} // namespace slabhull
