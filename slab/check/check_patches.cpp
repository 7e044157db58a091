// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/hull_view.h"

#include <fmt/format.h>

#include <map>
#include <mutex>
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
        const TrackId track = view.track[v];
        const auto place = std::lower_bound(tracks.begin(), end, track);
        if (track >= 0 && (place == end || *place != track)) {
            std::copy_backward(place, end, end + 1);
            *place = track;
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

/// The patch of a facet or a part of one, by its tracks.
template<int D>
struct Ruling {
    TrackSet<D> tracks;
    PatchNumber patch;
    friend auto operator<=>(const Ruling&, const Ruling&) = default;
};

template<int D>
using Rulings = std::vector<Ruling<D>>;

/// Calls full(vote) for side cells that have all tracks of a facet, and partial(vote) for the others, in
/// [begin, end). Cells of a side that is not made of prisms may have no vote.
template<int D, class Full, class Partial>
void each_vote(const HullView<D>& view, std::size_t begin, std::size_t end, const Full& full,
               const Partial& partial) {
    std::vector<std::int64_t> patch(end - begin);
    view.hull.patch.fill(begin, end, patch.data());
    for (std::size_t c = begin; c < end; ++c) {
        if (view.in_cap(c) || patch[c - begin] <= 0) {
            continue; // a patch that is wrong by itself is reported as such
        }
        std::size_t size = 0;
        const TrackSet<D> tracks = tracks_of(view, c, size);
        const Vote<D> vote{tracks, static_cast<PatchNumber>(patch[c - begin]), static_cast<Index>(c)};
        if (size == D) {
            full(vote);
        } else if (size >= 1 && size < D) {
            partial(vote);
        }
    }
}

template<class T>
void sort_out(std::vector<T>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

constexpr std::size_t cells_per_ruling = 1 << 14;

/// The patches of facets, without the cells that say so: a block of cells after the other, as there are many
/// layers over one facet.
template<int D>
Rulings<D> patches_of_facets(const HullView<D>& view) {
    constexpr std::size_t block = std::size_t{1} << 20;
    Rulings<D> all;
    for (std::size_t first = 0; first < view.cells().size(); first += block) {
        const std::size_t count = std::min(block, view.cells().size() - first);
        std::vector<Rulings<D>> pieces((count + cells_per_ruling - 1) / cells_per_ruling);
        parallel_for(count, cells_per_ruling, [&](std::size_t begin, std::size_t end) {
            Rulings<D>& piece = pieces[begin / cells_per_ruling];
            each_vote(
                view, first + begin, first + end,
                [&](const Vote<D>& vote) { // a prism has several, one after the other
                    if (const Ruling<D> ruling{vote.tracks, vote.patch};
                        piece.empty() || piece.back() != ruling) {
                        piece.push_back(ruling);
                    }
                },
                [](const Vote<D>&) {});
            sort_out(piece);
        });
        const std::size_t known = all.size();
        for (const Rulings<D>& piece : pieces) {
            all.insert(all.end(), piece.begin(), piece.end());
        }
        if (all.size() > known) {
            sort_out(all);
        }
    }
    return all;
}

/// Where facets have different patches: all votes about facets, sorted.
template<int D>
std::vector<Vote<D>> full_votes(const HullView<D>& view) {
    std::vector<Vote<D>> votes;
    each_vote(
        view, 0, view.cells().size(), [&](const Vote<D>& vote) { votes.push_back(vote); },
        [](const Vote<D>&) {});
    std::sort(votes.begin(), votes.end());
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
Rulings<D> patches_of_parts(const Rulings<D>& facets) {
    Rulings<D> parts;
    parts.reserve(facets.size() * ((1u << D) - 2));
    for (const Ruling<D>& facet : facets) {
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

/// Looks rulings up; remembers some that it found, as many cells in a row ask for the same few.
template<int D>
class RulingFinder {
public:
    explicit RulingFinder(const Rulings<D>& all) : all_{all}, seen_(1 << 10) {}

    bool has(const Ruling<D>& wanted) {
        Ruling<D>& seen = seen_[hash(wanted) % seen_.size()];
        if (seen != wanted) {
            if (!std::binary_search(all_.begin(), all_.end(), wanted)) {
                return false;
            }
            seen = wanted;
        }
        return true;
    }

private:
    static std::size_t hash(const Ruling<D>& ruling) {
        auto sum = static_cast<std::uint64_t>(ruling.patch);
        for (const TrackId track : ruling.tracks) {
            sum = (sum ^ static_cast<std::uint64_t>(track)) * 0x9E3779B97F4A7C15u;
            sum ^= sum >> 32;
        }
        return sum;
    }

    const Rulings<D>& all_;
    Rulings<D> seen_; ///< at first of patch 0, which nobody asks for
};

/// Cells whose tracks are part of no facet of their patch, ascending.
template<int D>
std::vector<Vote<D>> partial_votes_without(const HullView<D>& view, const Rulings<D>& parts) {
    std::vector<std::vector<Vote<D>>> pieces((view.cells().size() + cells_per_ruling - 1) / cells_per_ruling);
    parallel_for(view.cells().size(), cells_per_ruling, [&](std::size_t begin, std::size_t end) {
        RulingFinder<D> finder{parts};
        each_vote(
            view, begin, end, [](const Vote<D>&) {},
            [&](const Vote<D>& vote) {
                if (!finder.has({vote.tracks, vote.patch})) {
                    pieces[begin / cells_per_ruling].push_back(vote);
                }
            });
    });
    std::vector<Vote<D>> all;
    for (const std::vector<Vote<D>>& piece : pieces) {
        all.insert(all.end(), piece.begin(), piece.end());
    }
    return all;
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
    parallel_for(view.cells().size(), cells_per_ruling, [&](std::size_t begin, std::size_t end) {
        std::vector<std::int64_t> patch(end - begin);
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
    std::map<Index, std::int64_t> unknown; // by the first cell
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
    const Rulings<D> facets = patches_of_facets(view);
    const auto same_facet = [](const Ruling<D>& a, const Ruling<D>& b) { return a.tracks == b.tracks; };
    if (std::adjacent_find(facets.begin(), facets.end(), same_facet) != facets.end()) {
        const std::vector<Vote<D>> votes = full_votes(view);
        for (auto run = votes.begin(); run != votes.end();) {
            const auto end = std::find_if(run, votes.end(),
                                          [&](const Vote<D>& vote) { return vote.tracks != run->tracks; });
            report_disunity<D>({run, end}, findings);
            run = end;
        }
    }
    for (const Vote<D>& vote : partial_votes_without<D>(view, patches_of_parts<D>(facets))) {
        findings.cell(Defect::patch_mismatch, vote.cell,
                      fmt::format("in patch {}, which no boundary facet below it has", vote.patch));
    }
}

template std::vector<PatchCount> check_patches<2>(const HullView<2>&, Findings&);
template std::vector<PatchCount> check_patches<3>(const HullView<3>&, Findings&);
template void check_patch_columns<2>(const HullView<2>&, Findings&);
template void check_patch_columns<3>(const HullView<3>&, Findings&);

} // namespace slabhull
