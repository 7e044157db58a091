// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/slab/check.h"
#include "slabhull/slab/slice.h"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace slabhull {

/// A report as a JSON object: counts, measures, angles, findings by kind with their entities.
/// Keys are in docs/formats.md.
nlohmann::ordered_json as_json(const HullReport& report);
nlohmann::ordered_json as_json(const MeshReport& report);

/// A section as a JSON object: counts, length or area by patch, enclosed measure. `patches` gives the names.
nlohmann::ordered_json as_json(const SectionReport& report, const PatchList& patches);

/// The findings as lines for a person, kind by kind, with what was left out counted.
std::string findings_as_text(const CheckResult& result);

} // namespace slabhull
