// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/scratch.h"
#include "slabhull/core/array.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

/// What mesh_samples.py has written.
namespace mesh_samples {

inline const std::filesystem::path folder{SLABHULL_MESH_SAMPLES};

/// In order; none, with a warning, where VTK, meshio and Gmsh are not installed.
inline std::vector<std::filesystem::path> files(const std::string& name, const std::string& ending) {
    std::vector<std::filesystem::path> found;
    if (!std::filesystem::exists(folder / name)) {
        WARN("no mesh samples: VTK, meshio or Gmsh is not installed");
        return found;
    }
    for (const auto& entry : std::filesystem::directory_iterator{folder / name}) {
        if (entry.path().filename().string().ends_with(ending)) {
            found.push_back(entry.path());
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

/// An array as numpy left it.
template<class T>
slabhull::Array<T> numbers(const std::string& name) {
    const std::string bytes = scratch::bytes_of(folder / name);
    slabhull::Array<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

} // namespace mesh_samples
