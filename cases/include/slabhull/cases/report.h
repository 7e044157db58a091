// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/slab/check.h"
#include "slabhull/slab/check_embedding.h"
#include "slabhull/slab/check_filling.h"
#include "slabhull/slab/slice.h"

#include <string>

namespace slabhull {

/// A report as the text of a JSON object: counts, measures, angles, findings by kind with their entities.
/// Keys are in docs/formats.md.
std::string report_as_json(const HullReport& report);
std::string report_as_json(const MeshReport& report);
std::string report_as_json(const FillingReport& report);

/// A section as the text of a JSON object: counts, length or area by patch, enclosed measure. `patches` gives
/// the names.
std::string report_as_json(const SectionReport& report, const PatchList& patches);

/// A summary as the text of a JSON object; keys are those of the struct.
std::string report_as_json(const EmbeddingSummary& summary);

} // namespace slabhull
