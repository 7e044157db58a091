// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/slab/check.h"
#include "slabhull/topology/filling.h"
#include "view/scene.h"

#include <cstddef>
#include <string>
#include <vector>

namespace slabhull {

/// The share of one slab.
struct SceneLimits {
    std::size_t side_cells = 0;
    std::size_t inside_cells = 0;
};

/// Adds a slab to the scene, and to `notes` what is not shown as it is. Throws InputError as
/// ViewPage::add().
template<int D>
void add_slab(Scene& scene, const std::string& name, const HullColumns<D>& hull, const SceneLimits& limits,
              std::vector<std::string>& notes);
template<int D>
void add_slab(Scene& scene, const std::string& name, const Filling<D>& filling, const SceneLimits& limits,
              std::vector<std::string>& notes);

} // namespace slabhull
