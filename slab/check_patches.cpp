// SPDX-License-Identifier: BSD-3-Clause
#include "hull_view.h"

#include <fmt/format.h>

#include <map>
#include <utility>

namespace slabhull {

namespace {

/// Distinct tracks, ascending, then no_track.
template<int D>
using TrackSet = std::array<TrackId, D>;

/// The tracks of a cell's vertices; a prism's cell has D at most. `size` receives how many there are.
template<int D>
TrackSet<D> tracks_of(const HullView<D>& view, std::size_t cell, std::size_t& size) {
    std::array<TrackId, D + 1> tracks{};
    size = 0;
    for (const Index v : view.cells()[cell]) {
        const auto end = tracks.begin() + size;
        const auto place = std::lower_bound(tracks.begin(), end, view.track[v]);
        if (view.track[v] >= 0 && (place == end || *place != view.track[v])) {
            std::copy_backward(place, end, end + 1);
            *place = view.track[v];
            ++size;
        }
    }
    TrackSet<D> set;
    set.fill(no_track);
    std::copy_n(tracks.begin(), std::min<std::size_t>(size, D), set.begin());
    return set;
}

/// What a side cell says about the facet it stands on.
template<int D>
struct Vote {
    TrackSet<D> tracks;
    PatchNumber patch;
    Index cell;
    friend auto operator<=>(const Vote&, const Vote&) = default;
};

/// Votes of the cells that have all tracks of a facet, by facet; and of the other side cells. Cells of a side
/// that is not made of prisms may have no vote.
template<int D>
struct Votes {
    std::vector<Vote<D>> full;
    std::vector<Vote<D>> partial;
};

template<int D>
Votes<D> collect_votes(const HullView<D>& view) {
    Votes<D> votes;
    each_row(view.hull.patch, [&](std::size_t c, const std::int64_t* patch) {
        std::size_t size = 0;
        if (view.in_cap(c) || *patch <= 0) {
            return; // a patch that is wrong by itself is reported as such
        }
        const TrackSet<D> tracks = tracks_of(view, c, size);
        if (size >= 1 && size <= D) {
            (size == D ? votes.full : votes.partial)
                .push_back({tracks, static_cast<PatchNumber>(*patch), static_cast<Index>(c)});
        }
    });
    std::sort(votes.full.begin(), votes.full.end());
    return votes;
}

template<int D>
void report_disunity(std::span<const Vote<D>> column, Findings& findings) {
    const PatchNumber first = column.front().patch;
    const PatchNumber last = column.back().patch;
    if (first == last) {
        return;
    }
    std::vector<Index> cells;
    for (const Vote<D>& vote : column) {
        cells.push_back(vote.cell);
    }
    std::string tracks;
    for (const TrackId track : column.front().tracks) {
        tracks += fmt::format("{}{}", tracks.empty() ? "" : ", ", track);
    }
    std::vector<Entity> entities = findings.cell_entities(cells);
    const std::string text = fmt::format(
        "the side over the boundary facet of tracks {} has patches {} and {}", tracks, first, last);
    entities.push_back({"patch", first, {}});
    entities.push_back({"patch", last, {}});
    findings.other(Defect::patch_mismatch, std::move(entities), text);
}

/// The patches of the facets that each set of tracks is part of.
template<int D>
std::vector<std::pair<TrackSet<D>, PatchNumber>> patches_of_parts(const std::vector<Vote<D>>& full) {
    std::vector<std::pair<TrackSet<D>, PatchNumber>> parts;
    for (std::size_t v = 0; v < full.size(); ++v) {
        const Vote<D>& vote = full[v];
        if (v > 0 && vote.tracks == full[v - 1].tracks && vote.patch == full[v - 1].patch) {
            continue;
        }
        for (unsigned chosen = 1; chosen + 1 < 1u << D; ++chosen) {
            TrackSet<D> part;
            part.fill(no_track);
            for (std::size_t k = 0, place = 0; k < D; ++k) {
                if ((chosen >> k & 1u) != 0) {
                    part[place++] = vote.tracks[k];
                }
            }
            parts.emplace_back(part, vote.patch);
        }
    }
    std::sort(parts.begin(), parts.end());
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
    return parts;
}

} // namespace

template<int D>
std::vector<PatchCount> check_patches(const HullView<D>& view, Findings& findings) {
    std::map<PatchNumber, std::size_t> counts;
    const PatchList& patches = view.hull.patches;
    each_row(view.hull.patch, [&](std::size_t c, const std::int64_t* claimed) {
        const auto cell = static_cast<Index>(c);
        if (view.in_cap(c) ? *claimed != 0 : *claimed <= 0) {
            findings.cell(Defect::wrong_patch, cell,
                          fmt::format("patch {} {}", *claimed, view.in_cap(c) ? "in a cap" : "on the side"));
            return;
        }
        if (view.in_cap(c)) {
            return;
        }
        const auto number = static_cast<PatchNumber>(*claimed);
        const bool is_new = ++counts[number] == 1;
        const bool known = std::any_of(patches.begin(), patches.end(),
                                       [&](const Patch& patch) { return patch.number == *claimed; });
        if (is_new && !patches.empty() && !known) {
            findings.other(Defect::unknown_patch, {{"patch", *claimed, {}}},
                           fmt::format("patch {} is not in the list of patches", *claimed));
        }
    });
    std::vector<PatchCount> result;
    for (const auto& [number, cells] : counts) {
        result.push_back({number, cells});
    }
    return result;
}

template<int D>
void check_patch_columns(const HullView<D>& view, Findings& findings) {
    const Votes<D> votes = collect_votes(view);
    for (auto run = votes.full.begin(); run != votes.full.end();) {
        const auto end = std::find_if(run, votes.full.end(),
                                      [&](const Vote<D>& vote) { return vote.tracks != run->tracks; });
        report_disunity<D>({run, end}, findings);
        run = end;
    }
    const auto parts = patches_of_parts<D>(votes.full);
    for (const Vote<D>& vote : votes.partial) {
        if (!std::binary_search(parts.begin(), parts.end(), std::pair{vote.tracks, vote.patch})) {
            findings.cell(Defect::patch_mismatch, vote.cell,
                          fmt::format("in patch {}, which no boundary facet below it has", vote.patch));
        }
    }
}

template std::vector<PatchCount> check_patches<2>(const HullView<2>&, Findings&);
template std::vector<PatchCount> check_patches<3>(const HullView<3>&, Findings&);
template void check_patch_columns<2>(const HullView<2>&, Findings&);
template void check_patch_columns<3>(const HullView<3>&, Findings&);

} // namespace slabhull
