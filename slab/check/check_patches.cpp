// SPDX-License-Identifier: BSD-3-Clause
#include "core/hash.h"
#include "slab/check/hull_view.h"

#include "core/pieces.h"
#include "slabhull/core/communicator.h"

#include <fmt/format.h>

#include <map>
#include <mutex>
#include <utility>

namespace slabhull {

namespace {

/// Distinct tracks in ascending order, padded with no_track.
template<int D>
using TrackSet = std::array<TrackId, D>;

/// The tracks of a cell's vertices, at most D in a prism's cell. `size` receives their number.
template<int D>
TrackSet<D> tracks_of(const Simplex<D>& cell, const Array<TrackId>& track, std::size_t& size) {
    std::array<TrackId, D + 1> tracks;
    for (std::size_t i = 0; i <= D; ++i) {
        tracks[i] = track[cell[i]];
        for (std::size_t k = i; k > 0; --k) { // branch-free, other than a search for the place
            const TrackId low = std::min(tracks[k - 1], tracks[k]);
            tracks[k] = std::max(tracks[k - 1], tracks[k]);
            tracks[k - 1] = low;
        }
    }
    TrackSet<D> set;
    set.fill(no_track);
    size = 0;
    TrackId before = no_track;
    for (const TrackId one : tracks) {
        if (one >= 0 && one != before) {
            if (size < D) {
                set[size] = one;
            }
            ++size;
            before = one;
        }
    }
    return set;
}

/// The patch that a side cell claims for the boundary facet that swept it.
template<int D>
struct PatchClaim {
    TrackSet<D> tracks;
    PatchNumber patch;
    Index cell;
    friend auto operator<=>(const PatchClaim&, const PatchClaim&) = default;
};

/// The patch of a facet or a part of one, by its tracks.
template<int D>
struct FacetPatch {
    TrackSet<D> tracks;
    PatchNumber patch;
    friend auto operator<=>(const FacetPatch&, const FacetPatch&) = default;
};

template<int D>
using FacetPatches = std::vector<FacetPatch<D>>;

/// The track of each vertex, to be asked for often: a list in runs would have to be searched.
template<int D>
Array<TrackId> all_tracks(const HullView<D>& view) {
    Array<TrackId> tracks(view.track.size());
    parallel_for(tracks.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        view.track.copy(begin, end, tracks.data() + begin);
    });
    return tracks;
}

/// Calls full(claim) for side cells that have all tracks of a facet, and partial(claim) for the others, in
/// [begin, end). Cells of a side that is not made of prisms may have no claim.
template<int D, class Full, class Partial>
void for_each_claim(const HullView<D>& view, const Array<TrackId>& track, std::size_t begin, std::size_t end,
                    const Full& full, const Partial& partial) {
    Array<std::int64_t> patch(end - begin); // not cleared first
    view.hull.patch.fill(begin, end, patch.data());
    for (std::size_t c = begin; c < end; ++c) {
        if (view.in_cap(c) || patch[c - begin] <= 0) {
            continue; // invalid patch numbers are reported separately
        }
        std::size_t size = 0;
        const TrackSet<D> tracks = tracks_of<D>(view.cells()[c], track, size);
        const PatchClaim<D> claim{tracks, static_cast<PatchNumber>(patch[c - begin]), static_cast<Index>(c)};
        if (size == D) {
            full(claim);
        } else if (size >= 1 && size < D) {
            partial(claim);
        }
    }
}

constexpr std::size_t cells_per_reading = 1 << 14;

/// What cells claim of facets, or of parts of them, without the claiming cells; each once, sorted. Parts that
/// stand beside a facet which they are parts of, in the same patch, may be left out.
template<int D>
struct DistinctClaims {
    FacetPatches<D> facets;
    FacetPatches<D> parts;

    void add(const DistinctClaims& more) {
        facets.insert(facets.end(), more.facets.begin(), more.facets.end());
        parts.insert(parts.end(), more.parts.begin(), more.parts.end());
    }
    void sort() {
        sort_out(facets);
        sort_out(parts);
    }
};

/// Tells which facets were seen lately, as consecutive cells have the same few.
template<int D>
class SeenFacets {
public:
    SeenFacets() : seen_(1 << 10) {}

    /// False when it was seen before. May be true again later.
    bool is_new(const FacetPatch<D>& facet) {
        FacetPatch<D>& seen = seen_[hash(facet) % seen_.size()];
        if (seen == facet) {
            return false;
        }
        seen = facet;
        return true;
    }

private:
    static std::size_t hash(const FacetPatch<D>& facet) {
        return hash_of_all(facet.tracks, static_cast<std::uint64_t>(facet.patch));
    }

    FacetPatches<D> seen_; ///< starts with patch 0, which no claim has
};

/// Takes the claims of consecutive cells. The cells of a prism are consecutive: a part waits for the next
/// facet, which is nearly always the one that it is a part of, or belongs to the last.
template<int D>
class ClaimList {
public:
    explicit ClaimList(DistinctClaims<D>& claims) : claims_{claims} {}

    void add_facet(const FacetPatch<D>& facet) {
        last_ = facet;
        keep_waiting();
        if (seen_.is_new(facet)) {
            claims_.facets.push_back(facet);
        }
    }
    void add_part(const FacetPatch<D>& part) {
        if (!belongs_to_last(part) && seen_.is_new(part)) {
            waiting_.push_back(part);
        }
    }
    void finish() {
        keep_waiting();
        claims_.sort();
    }

private:
    /// Those that are no part of the last facet either.
    void keep_waiting() {
        for (const FacetPatch<D>& part : waiting_) {
            if (!belongs_to_last(part)) {
                claims_.parts.push_back(part);
            }
        }
        waiting_.clear();
    }

    bool belongs_to_last(const FacetPatch<D>& part) const {
        return part.patch == last_.patch &&
               std::all_of(part.tracks.begin(), part.tracks.end(), [&](TrackId one) {
                   return one == no_track ||
                          std::find(last_.tracks.begin(), last_.tracks.end(), one) != last_.tracks.end();
               });
    }

    DistinctClaims<D>& claims_;
    SeenFacets<D> seen_;
    FacetPatch<D> last_{}; ///< first of patch 0, which no claim has
    FacetPatches<D> waiting_;
};

/// Goes block by block to save memory: many layers repeat the claim for one facet.
template<int D>
DistinctClaims<D> distinct_claims(const HullView<D>& view, const Array<TrackId>& track) {
    constexpr std::size_t block = std::size_t{1} << 20;
    DistinctClaims<D> all;
    for (std::size_t first = 0; first < view.cells().size(); first += block) {
        const std::size_t count = std::min(block, view.cells().size() - first);
        const auto claims_of_piece = [&](std::size_t begin, std::size_t end, DistinctClaims<D>& piece) {
            ClaimList<D> list{piece};
            for_each_claim(
                view, track, first + begin, first + end,
                [&list](const PatchClaim<D>& claim) {
                    list.add_facet({claim.tracks, claim.patch});
                },
                [&list](const PatchClaim<D>& claim) {
                    list.add_part({claim.tracks, claim.patch});
                });
            list.finish();
        };
        for (const DistinctClaims<D>& piece :
             parallel_pieces<DistinctClaims<D>>(count, cells_per_reading, claims_of_piece)) {
            all.add(piece);
        }
        all.sort();
    }
    return all;
}

/// All claims about whole facets, sorted; needed only if a facet has different patches.
template<int D>
std::vector<PatchClaim<D>> full_claims(const HullView<D>& view, const Array<TrackId>& track) {
    std::vector<PatchClaim<D>> claims;
    for_each_claim(
        view, track, 0, view.cells().size(), [&](const PatchClaim<D>& claim) { claims.push_back(claim); },
        [](const PatchClaim<D>&) {});
    std::sort(claims.begin(), claims.end());
    return claims;
}

template<int D>
void report_mismatches(std::span<const PatchClaim<D>> column, Findings& findings) {
    const PatchNumber first = column.front().patch;
    const PatchNumber last = column.back().patch;
    if (first == last) {
        return;
    }
    std::vector<Index> cells;
    for (const PatchClaim<D>& claim : column) {
        cells.push_back(claim.cell);
    }
    std::string tracks;
    for (const TrackId one : column.front().tracks) {
        tracks += fmt::format("{}{}", tracks.empty() ? "" : ", ", one);
    }
    std::vector<Entity> entities = findings.cell_entities(cells);
    const std::string text = fmt::format(
        "the side over the boundary facet of tracks {} has patches {} and {}", tracks, first, last);
    entities.push_back({"patch", first, {}});
    entities.push_back({"patch", last, {}});
    findings.other(Defect::patch_mismatch, std::move(entities), text);
}

/// For each proper subset of a facet's tracks, the patch of the facet.
template<int D>
FacetPatches<D> patches_of_parts(const FacetPatches<D>& facets) {
    FacetPatches<D> parts;
    parts.reserve(facets.size() * ((1u << D) - 2));
    for (const FacetPatch<D>& facet : facets) {
        for (unsigned chosen = 1; chosen + 1 < 1u << D; ++chosen) {
            TrackSet<D> part;
            part.fill(no_track);
            for (std::size_t k = 0, place = 0; k < D; ++k) {
                if ((chosen >> k & 1u) != 0) {
                    part[place++] = facet.tracks[k];
                }
            }
            parts.push_back({part, facet.patch});
        }
    }
    sort_out(parts);
    return parts;
}

/// Cells whose tracks are part of no facet of their patch, ascending; needed only if there are any.
template<int D>
std::vector<PatchClaim<D>> partial_claims_without(const HullView<D>& view, const Array<TrackId>& track,
                                                  const FacetPatches<D>& parts) {
    std::vector<PatchClaim<D>> without;
    for_each_claim(
        view, track, 0, view.cells().size(), [](const PatchClaim<D>&) {},
        [&](const PatchClaim<D>& claim) {
            if (!std::binary_search(parts.begin(), parts.end(), FacetPatch<D>{claim.tracks, claim.patch})) {
                without.push_back(claim);
            }
        });
    return without;
}

template<int D>
bool has_all(const FacetPatches<D>& parts, const FacetPatches<D>& wanted) {
    return std::includes(parts.begin(), parts.end(), wanted.begin(), wanted.end());
}

/// How often each patch is claimed for side cells, and the first such cell.
struct PatchUse {
    std::size_t cells = 0;
    Index first = no_index;
};

template<int D>
std::map<std::int64_t, PatchUse> count_side_patches(const HullView<D>& view) {
    std::map<std::int64_t, PatchUse> all;
    std::mutex lock;
    parallel_for(view.cells().size(), cells_per_reading, [&](std::size_t begin, std::size_t end) {
        Array<std::int64_t> patch(end - begin); // not cleared first
        view.hull.patch.fill(begin, end, patch.data());
        std::map<std::int64_t, PatchUse> found;
        for (std::size_t c = begin; c < end; ++c) {
            if (!view.in_cap(c) && patch[c - begin] > 0) {
                PatchUse& use = found[patch[c - begin]];
                use.first = std::min(use.first, static_cast<Index>(c));
                ++use.cells;
            }
        }
        const std::lock_guard guard{lock};
        for (const auto& [number, use] : found) {
            PatchUse& sum = all[number];
            sum.cells += use.cells;
            sum.first = std::min(sum.first, use.first);
        }
    });
    return all;
}

} // namespace

template<int D>
std::vector<PatchCount> check_patches(const HullView<D>& view, Findings& findings) {
    const auto wrong = select_rows(view.hull.patch, [&](std::size_t c, const std::int64_t* claimed) {
        return view.in_cap(c) ? *claimed != 0 : *claimed <= 0;
    });
    for (const Index c : wrong) {
        findings.cell(Defect::wrong_patch, c,
                      fmt::format("patch {} {}", row_of(view.hull.patch, c)[0],
                                  view.in_cap(c) ? "in a cap" : "on the side"));
    }
    std::vector<PatchCount> counts;
    std::map<Index, std::int64_t> unknown; // patch by its first cell
    for (const auto& [number, use] : count_side_patches(view)) {
        const PatchList& patches = view.hull.patches;
        const bool known = std::any_of(patches.begin(), patches.end(),
                                       [n = number](const Patch& patch) { return patch.number == n; });
        if (!patches.empty() && !known) {
            unknown.emplace(use.first, number);
        }
        counts.push_back({static_cast<PatchNumber>(number), use.cells});
    }
    for (const auto& [cell, number] : unknown) {
        findings.other(Defect::unknown_patch, {{"patch", number, {}}},
                       fmt::format("patch {} is not in the list of patches", number));
    }
    return counts;
}

template<int D>
void check_patch_columns(const HullView<D>& view, Findings& findings) {
    const Array<TrackId> track = all_tracks(view);
    const DistinctClaims<D> claims = distinct_claims(view, track);
    const FacetPatches<D>& facets = claims.facets;
    const auto same_facet = [](const FacetPatch<D>& a, const FacetPatch<D>& b) {
        return a.tracks == b.tracks;
    };
    if (std::adjacent_find(facets.begin(), facets.end(), same_facet) != facets.end()) {
        const std::vector<PatchClaim<D>> full = full_claims(view, track);
        for (auto run = full.begin(); run != full.end();) {
            const auto end = std::find_if(
                run, full.end(), [&](const PatchClaim<D>& claim) { return claim.tracks != run->tracks; });
            report_mismatches<D>({run, end}, findings);
            run = end;
        }
    }
    if (claims.parts.empty()) {
        return;
    }
    const FacetPatches<D> parts = patches_of_parts<D>(facets);
    if (has_all<D>(parts, claims.parts)) {
        return;
    }
    for (const PatchClaim<D>& claim : partial_claims_without<D>(view, track, parts)) {
        findings.cell(Defect::patch_mismatch, claim.cell,
                      fmt::format("in patch {}, which no boundary facet below it has", claim.patch));
    }
}

template<int D>
bool patch_columns_agree(const HullView<D>& view, Communicator& ranks) {
    const DistinctClaims<D> mine = distinct_claims(view, all_tracks(view));
    const Array<FacetPatch<D>> all = joined(ranks.all_gather<FacetPatch<D>>(mine.facets));
    FacetPatches<D> facets(all.begin(), all.end());
    sort_out(facets);
    const bool differ = std::adjacent_find(facets.begin(), facets.end(), [](const auto& a, const auto& b) {
                            return a.tracks == b.tracks;
                        }) != facets.end();
    const bool agrees = !differ && has_all<D>(patches_of_parts<D>(facets), mine.parts);
    return ranks.min(agrees ? 1 : 0) == 1;
}

template bool patch_columns_agree<2>(const HullView<2>&, Communicator&);
template bool patch_columns_agree<3>(const HullView<3>&, Communicator&);
template std::vector<PatchCount> check_patches<2>(const HullView<2>&, Findings&);
template std::vector<PatchCount> check_patches<3>(const HullView<3>&, Findings&);
template void check_patch_columns<2>(const HullView<2>&, Findings&);
template void check_patch_columns<3>(const HullView<3>&, Findings&);

} // namespace slabhull
