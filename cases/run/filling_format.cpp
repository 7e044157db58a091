// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/cases/filling_files.h"

#include "slabhull/core/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <vector>

namespace slabhull {

std::string filling_format(const std::filesystem::path& path, const std::string& name, int dimension) {
    std::vector<std::string> known{"mfem", "getfem", "h5"};
    if (dimension == 2) {
        known.insert(known.end(), {"vtu", "msh"});
    }
    const std::string extension = path.extension().string();
    std::string wanted = !name.empty() ? name : extension.empty() ? "" : extension.substr(1);
    if (std::find(known.begin(), known.end(), wanted) == known.end()) {
        throw UsageError{fmt::format("{}: \"{}\" is no format of a filling in {}D+t; there are {} (--to)",
                                     path.string(), wanted, dimension, fmt::join(known, ", "))};
    }
    return wanted;
}

} // namespace slabhull
