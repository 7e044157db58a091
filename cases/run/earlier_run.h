// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace slabhull {

/// Names of the files beside the slabs.
inline constexpr const char* checkpoint_name = "march.state";
inline constexpr const char* journal_name = "slabs.jsonl";
inline constexpr const char* report_name = "report.json";
inline constexpr const char* slabs_series_name = "slabs.pvd";
inline constexpr const char* caps_series_name = "caps.pvd";

/// Whether a run writes, replaces or removes a file of this name in its folder.
bool is_name_of_run(const std::string& name);

/// Removes what an earlier run left in a folder, so that its slabs, caps and fillings do not stand beside
/// those of another: the checkpoint first, for nobody shall go on from it. A file of a slab goes only when
/// the run's journal says that the run made such a slab; where there is no journal, no file goes.
void remove_earlier_run(const std::filesystem::path& folder);

/// Removes what a run that was ended left of slab `next`, the one to go on with: files that got their names
/// before the checkpoint was written. They are made again, and another number of ranks would not replace
/// each piece.
void remove_unfinished_slab(const std::filesystem::path& folder, int next);

} // namespace slabhull
