// SPDX-License-Identifier: BSD-3-Clause
// The reports of cases/report.h as JSON objects, for sources that make documents of several.
#pragma once

#include "slabhull/slab/check.h"
#include "slabhull/slab/check_embedding.h"
#include "slabhull/slab/check_filling.h"
#include "slabhull/slab/filling_quality.h"
#include "slabhull/slab/slice.h"

#include <nlohmann/json_fwd.hpp>

namespace slabhull {

nlohmann::ordered_json as_json(const HullReport& report);
nlohmann::ordered_json as_json(const MeshReport& report);
nlohmann::ordered_json as_json(const FillingReport& report);
/// What report.json says of a slab's filling.
template<int D>
nlohmann::ordered_json as_json(const FillingReport& report, const Filling<D>& filling,
                               const FillingQuality& quality, double seconds);
nlohmann::ordered_json as_json(const SectionReport& report, const PatchList& patches);
nlohmann::ordered_json as_json(const EmbeddingSummary& summary);

} // namespace slabhull
