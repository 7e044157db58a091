// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hull_soup.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

// In C++17, see hull_soup.h.

namespace slabhull::bench {

/// What a run has left: whether a mesh that was read is the soup, without limit on time.
struct Outcome {
    std::function<bool()> right; ///< empty after writing: then the file is read and compared
    double seconds = 0;          ///< where another process has measured them
};

/// Writes or reads the file. This is timed.
using Run = std::function<Outcome(const std::string& file)>;

/// Somebody's way to write or read a file.
struct Contestant {
    std::string bench; ///< write_vtu, read_vtu, write_msh, read_msh, write_msh_ascii, read_msh_ascii
    std::string who;
    /// The soup in the form that the library starts from. This is not timed. The soup stays.
    Run (*prepare)(const HullSoup& soup);
};

/// Gmsh writes text with 16 digits, which do not give each double back.
inline double tolerance_of(const std::string& bench) {
    return bench.find("ascii") == std::string::npos ? 0 : 1e-15;
}

/// Each .cpp of a peer adds its own, where its library is installed.
inline std::vector<Contestant>& contestants() {
    static std::vector<Contestant> all;
    return all;
}

inline bool add_contestant(Contestant contestant) {
    contestants().push_back(std::move(contestant));
    return true;
}

} // namespace slabhull::bench
