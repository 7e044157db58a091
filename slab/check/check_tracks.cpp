// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/boundary_changes.h"
#include "slab/check/hull_view.h"
#include "slab/check/part_exchange.h"
#include "slab/check/part_stars.h"
#include "slabhull/topology/spatial_mesh.h"

#include <fmt/format.h>

#include <atomic>
#include <limits>
#include <optional>
#include <tuple>

namespace slabhull {

namespace {

struct TrackPoint {
    TrackId track;
    double time;
    Index vertex;
    friend auto operator<=>(const TrackPoint&, const TrackPoint&) = default;
};

/// Calls visit(index, id) for each id of a list.
template<class Visit>
void each_id(const IntegerList& ids, const Visit& visit) {
    constexpr std::size_t batch = 1 << 12;
    std::array<std::int64_t, batch> values;
    for (std::size_t begin = 0; begin < ids.size(); begin += batch) {
        const std::size_t end = std::min(ids.size(), begin + batch);
        ids.copy(begin, end, values.data());
        for (std::size_t k = begin; k < end; ++k) {
            visit(k, values[k - begin]);
        }
    }
}

/// Divides the range of tracks into parts, first and last of each, so that few are listed at once.
std::vector<std::array<TrackId, 2>> parts_of_range(const IntegerList& tracks) {
    constexpr TrackId count = 8;
    TrackId first = std::numeric_limits<TrackId>::max();
    TrackId last = no_track;
    each_id(tracks, [&](std::size_t, TrackId track) {
        first = track >= 0 ? std::min(first, track) : first;
        last = std::max(last, track);
    });
    std::vector<std::array<TrackId, 2>> parts;
    if (last >= 0) {
        const TrackId width = (last - first) / count + 1;
        for (; last - first >= width; first += width) {
            parts.push_back({first, first + width - 1});
        }
        parts.push_back({first, last});
    }
    return parts;
}

template<int D>
std::vector<TrackPoint> sorted_track_points(const HullView<D>& view, const std::array<TrackId, 2>& part) {
    const auto wanted = [&](TrackId track) { return part[0] <= track && track <= part[1]; };
    std::size_t count = 0;
    each_id(view.track, [&](std::size_t, TrackId track) { count += wanted(track) ? 1 : 0; });
    std::vector<TrackPoint> on_tracks;
    on_tracks.reserve(count);
    each_id(view.track, [&](std::size_t v, TrackId track) {
        if (wanted(track)) {
            const auto vertex = static_cast<Index>(v);
            on_tracks.push_back({track, view.time_of(vertex), vertex});
        }
    });
    std::sort(on_tracks.begin(), on_tracks.end(), [](const TrackPoint& a, const TrackPoint& b) {
        return std::tie(a.track, a.time, a.vertex) < std::tie(b.track, b.time, b.vertex);
    });
    return on_tracks;
}

std::vector<Entity> track_entities(TrackId track, std::span<const Index> vertices, const Findings& findings) {
    std::vector<Entity> entities{{"track", track, {}}};
    for (Entity& vertex : findings.vertex_entities(vertices)) {
        entities.push_back(std::move(vertex));
    }
    return entities;
}

/// Whether a track spans the slab and repeats no time. `track`: its points, by time.
bool is_whole(std::span<const TrackPoint> track, const std::array<double, 2>& slab) {
    const auto same_time = [](const TrackPoint& a, const TrackPoint& b) { return a.time == b.time; };
    return track.front().time == slab[0] && track.back().time == slab[1] &&
           std::adjacent_find(track.begin(), track.end(), same_time) == track.end();
}

/// Calls visit(points) for each track.
template<class Visit>
void each_track(const std::vector<TrackPoint>& points, const Visit& visit) {
    for (auto run = points.begin(); run != points.end();) {
        const auto end =
            std::find_if(run, points.end(), [&](const TrackPoint& p) { return p.track != run->track; });
        visit(std::span<const TrackPoint>{run, end});
        run = end;
    }
}

/// `track`: the points of a track, by time. A track that is never on the side (`inside`) may begin or end in
/// the slab, as a cap meshed anew has new inner vertices; so may others at `ends`.
void report_track(std::span<const TrackPoint> track, const std::array<double, 2>& slab, bool inside,
                  const TrackEnds& ends, Findings& findings) {
    for (std::size_t k = 1; k < track.size(); ++k) {
        if (track[k].time == track[k - 1].time) {
            const std::array<Index, 2> both{track[k - 1].vertex, track[k].vertex};
            findings.other(Defect::track_repeats_time, track_entities(track[k].track, both, findings),
                           fmt::format("track {}: two vertices at t = {}", track[k].track, track[k].time));
        }
    }
    const auto is_among = [](Index vertex, const std::vector<Index>& vertices) {
        return std::binary_search(vertices.begin(), vertices.end(), vertex);
    };
    const bool begins = track.front().time == slab[0] || is_among(track.front().vertex, ends.begun);
    const bool stops = track.back().time == slab[1] || is_among(track.back().vertex, ends.ended);
    if (!inside && (!begins || !stops)) {
        const std::array<Index, 2> both{track.front().vertex, track.back().vertex};
        findings.other(Defect::track_incomplete, track_entities(track.front().track, both, findings),
                       fmt::format("track {}: leads from t = {} to {}, not from {} to {}",
                                   track.front().track, track.front().time, track.back().time, slab[0],
                                   slab[1]));
    }
}

/// How cap vertices are used.
enum : std::uint8_t { in_a_cap = 1, on_its_boundary = 2 };

template<int D>
BoundaryFacet<D> boundary_facet(const HullView<D>& view, Index cell, std::size_t i) {
    BoundaryFacet<D> facet{{},
                           false,
                           outward_facet<D>(view.cells()[cell], static_cast<int>(i)),
                           cell,
                           view.adjacency.neighbors[cell][i]};
    if (view.region_of(cell) == Region::initial) {
        std::swap(facet.vertices[0], facet.vertices[1]); // an initial cell is negative in space
    }
    set_tracks(view, facet);
    return facet;
}

template<int D>
bool before(const BoundaryFacet<D>& a, const BoundaryFacet<D>& b) {
    return std::tie(a.tracks, a.vertices) < std::tie(b.tracks, b.vertices);
}

template<int D>
void report(Defect what, const BoundaryFacet<D>& facet, const char* detail, Findings& findings) {
    findings.vertices(what, facet.vertices, {&facet.cap_cell, 1}, detail);
}

/// Marks the vertices of all cells for which wanted(cell) holds.
template<int D, class Wanted>
std::vector<std::uint8_t> mark_vertices(const HullView<D>& view, std::uint8_t mark, const Wanted& wanted) {
    std::vector<std::uint8_t> use(view.points().size(), 0);
    parallel_for(view.cells().size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            for (std::size_t i = 0; wanted(c) && i <= D; ++i) {
                std::atomic_ref{use[view.cells()[c][i]]}.store(mark, std::memory_order_relaxed);
            }
        }
    });
    return use;
}

/// Tracks of the vertices where caps meet the side, ascending.
template<int D>
std::vector<TrackId> boundary_tracks(const HullView<D>& view, const std::vector<std::uint8_t>& use) {
    std::vector<TrackId> tracks;
    each_id(view.track, [&](std::size_t v, TrackId track) {
        if ((use[v] & on_its_boundary) != 0 && track >= 0) {
            tracks.push_back(track);
        }
    });
    std::sort(tracks.begin(), tracks.end());
    return tracks;
}

/// Checks that boundary vertices of caps have tracks, and that no inner vertex is on one of these.
template<int D>
void check_cap_vertices(const HullView<D>& view, const std::vector<std::uint8_t>& use, Findings& findings) {
    std::optional<std::vector<TrackId>> of_boundary; // seldom needed
    each_id(view.track, [&](std::size_t v, TrackId track) {
        const auto vertex = static_cast<Index>(v);
        if ((use[v] & on_its_boundary) != 0 && track < 0) {
            findings.vertex(Defect::untracked_boundary, vertex,
                            "a cap meets the side there, but it has no track");
        } else if (use[v] == in_a_cap && track >= 0) {
            if (!of_boundary) {
                of_boundary = boundary_tracks(view, use);
            }
            if (std::binary_search(of_boundary->begin(), of_boundary->end(), track)) {
                findings.vertex(Defect::stray_track, vertex,
                                fmt::format("inside a cap, but on track {} of the boundary", track));
            }
        }
    });
}

/// Cells of caps with neighbours on the side, ascending.
template<int D>
std::vector<Index> cap_cells_at_side(const HullView<D>& view) {
    return select(view.cells().size(), [&](std::size_t c) {
        const Neighbors<D>& across = view.adjacency.neighbors[c];
        return view.in_cap(c) &&
               std::any_of(across.begin(), across.end(), [&](Index n) { return !view.in_cap(n); });
    });
}

} // namespace

template<int D>
void check_tracks(const HullView<D>& view, BoundaryChanges<D>& changes, Findings& findings) {
    const std::vector<std::array<TrackId, 2>> parts = parts_of_range(view.track);
    std::vector<std::vector<TrackPoint>> faulty(parts.size());
    parallel_for(parts.size(), 1, [&](std::size_t part, std::size_t) {
        each_track(sorted_track_points(view, parts[part]), [&](std::span<const TrackPoint> track) {
            if (!is_whole(track, view.time)) {
                faulty[part].insert(faulty[part].end(), track.begin(), track.end());
            }
        });
    });
    std::vector<std::uint8_t> on_side; // by vertex; used only for tracks that are not whole
    TrackEnds ends;
    for (const std::vector<TrackPoint>& points : faulty) {
        if (!points.empty() && on_side.empty()) {
            on_side = mark_vertices(view, 1, [&](std::size_t c) { return !view.in_cap(c); });
            ends = track_ends(view, changes());
        }
        each_track(points, [&](std::span<const TrackPoint> track) {
            const bool inside = std::none_of(track.begin(), track.end(),
                                             [&](const TrackPoint& p) { return on_side[p.vertex] != 0; });
            report_track(track, view.time, inside, ends, findings);
        });
    }
}

template<int D>
BoundaryFacets<D> check_cap_boundaries(const HullView<D>& view, Findings& findings) {
    BoundaryFacets<D> boundary;
    std::vector<std::uint8_t> use =
        mark_vertices(view, in_a_cap, [&](std::size_t c) { return view.in_cap(c); });
    for (const Index c : cap_cells_at_side(view)) {
        for (std::size_t i = 0; i <= D; ++i) {
            if (view.in_cap(view.adjacency.neighbors[c][i])) {
                continue;
            }
            const BoundaryFacet<D> facet = boundary_facet(view, c, i);
            for (const Index v : facet.vertices) {
                use[v] |= on_its_boundary;
            }
            boundary[view.region_of(c) == Region::initial ? 0 : 1].push_back(facet);
        }
    }
    for (auto& facets : boundary) {
        std::sort(facets.begin(), facets.end(), before<D>);
    }
    check_cap_vertices(view, use, findings);
    return boundary;
}

template<int D>
void check_boundary_image(const BoundaryFacets<D>& boundary, BoundaryChanges<D>& changes,
                          Findings& findings) {
    const auto on_same_tracks = [](const BoundaryFacet<D>& a, const BoundaryFacet<D>& b) {
        return a.tracks == b.tracks;
    };
    const bool same = std::equal(boundary[0].begin(), boundary[0].end(), boundary[1].begin(),
                                 boundary[1].end(), on_same_tracks);
    const std::vector<BoundaryFacet<D>> expected =
        same ? boundary[0] : after_changes<D>(boundary[0], changes());
    auto first = expected.begin();
    auto image = boundary[1].begin();
    while (first != expected.end() || image != boundary[1].end()) {
        if (image == boundary[1].end() || (first != expected.end() && first->tracks < image->tracks)) {
            report(Defect::boundary_facet_lost, *first++, "the terminating cap has no facet on its tracks",
                   findings);
        } else if (first == expected.end() || image->tracks < first->tracks) {
            report(Defect::boundary_facet_added, *image++, "the initial cap has no facet on its tracks",
                   findings);
        } else {
            if (first->odd != image->odd) {
                report(Defect::boundary_facet_reversed, *image,
                       "lies the other way round than in the initial cap", findings);
            }
            ++first;
            ++image;
        }
    }
}

namespace {

/// A point of a track as its rank tells of it.
struct TrackUse {
    TrackId track;
    double time;
    std::uint8_t on_side; ///< whether a cell of the side has it
};

/// How the cells around each vertex use it: once an owner's stars are whole, that is how the hull does.
struct VertexUse {
    Array<std::uint8_t> in_cap;
    Array<std::uint8_t> on_side;
};

template<int D>
VertexUse use_of_vertices(const HullView<D>& view, const PartStars<D>& stars) {
    VertexUse use;
    use.in_cap.assign(stars.owned.size(), 0);
    use.on_side.assign(stars.owned.size(), 0);
    stars.each_cell(view, [&](const Simplex<D>& cell, Region region) {
        for (const Index v : cell) {
            (region == Region::intermediate ? use.on_side : use.in_cap)[v] = 1;
        }
    });
    return use;
}

/// Whether tracks are whole, those inside caps apart: the points of each go to one rank.
template<int D>
bool tracks_are_whole(const HullView<D>& view, const PartStars<D>& stars, const VertexUse& use,
                      Communicator& ranks) {
    const auto count = static_cast<std::size_t>(ranks.size());
    std::vector<Array<TrackUse>> to(count);
    each_id(view.track, [&](std::size_t v, TrackId track) {
        if (stars.owned[v] != 0 && track >= 0) {
            to[static_cast<std::size_t>(track) % count].push_back(
                {track, view.time_of(static_cast<Index>(v)), use.on_side[v]});
        }
    });
    Array<TrackUse> uses = joined(ranks.all_to_all(to));
    std::sort(uses.begin(), uses.end(), [](const TrackUse& a, const TrackUse& b) {
        return std::tie(a.track, a.time) < std::tie(b.track, b.time);
    });
    for (auto first = uses.begin(); first != uses.end();) {
        const auto end = std::find_if(first, uses.end(),
                                      [&](const TrackUse& point) { return point.track != first->track; });
        const bool repeats = std::adjacent_find(first, end, [](const TrackUse& a, const TrackUse& b) {
                                 return a.time == b.time;
                             }) != end;
        const bool spans = first->time == view.time[0] && (end - 1)->time == view.time[1];
        const bool inside =
            std::none_of(first, end, [](const TrackUse& point) { return point.on_side != 0; });
        if (repeats || !(spans || inside)) {
            return false;
        }
        first = end;
    }
    return true;
}

/// A boundary facet of a cap as its rank tells of it.
template<int D>
struct FacetOfCap {
    std::int64_t cap;
    std::array<TrackId, D> tracks;
    std::int64_t odd;
    friend auto operator<=>(const FacetOfCap&, const FacetOfCap&) = default;
};

/// The boundary facets of both caps, from all ranks.
template<int D>
Array<FacetOfCap<D>> facets_of_caps(const HullView<D>& view, Communicator& ranks) {
    std::vector<FacetOfCap<D>> mine;
    for (const Index c : cap_cells_at_side(view)) {
        for (std::size_t i = 0; i <= D; ++i) {
            if (!view.in_cap(view.adjacency.neighbors[c][i])) {
                const BoundaryFacet<D> facet = boundary_facet(view, c, i);
                mine.push_back(
                    {view.region_of(c) == Region::initial ? 0 : 1, facet.tracks, facet.odd ? 1 : 0});
            }
        }
    }
    Array<FacetOfCap<D>> all = joined(ranks.all_gather<FacetOfCap<D>>(mine));
    std::sort(all.begin(), all.end());
    return all;
}

/// Whether every facet has tracks, and those of the terminating cap are those of the initial one.
template<int D>
bool are_images(const Array<FacetOfCap<D>>& facets) {
    const auto terminating =
        std::find_if(facets.begin(), facets.end(), [](const FacetOfCap<D>& facet) { return facet.cap == 1; });
    return std::all_of(facets.begin(), facets.end(),
                       [](const FacetOfCap<D>& facet) { return facet.tracks.front() >= 0; }) &&
           std::equal(facets.begin(), terminating, terminating, facets.end(),
                      [](const FacetOfCap<D>& a, const FacetOfCap<D>& b) {
                          return a.tracks == b.tracks && a.odd == b.odd;
                      });
}

/// Whether no vertex inside a cap is on a track of the boundary.
template<int D>
bool none_is_stray(const HullView<D>& view, const PartStars<D>& stars, const VertexUse& use,
                   const Array<FacetOfCap<D>>& facets) {
    std::vector<TrackId> boundary;
    for (const FacetOfCap<D>& facet : facets) {
        boundary.insert(boundary.end(), facet.tracks.begin(), facet.tracks.end());
    }
    std::sort(boundary.begin(), boundary.end());
    bool none = true;
    each_id(view.track, [&](std::size_t v, TrackId track) {
        const bool inside = stars.owned[v] != 0 && use.in_cap[v] != 0 && use.on_side[v] == 0;
        none = none && !(inside && track >= 0 && std::binary_search(boundary.begin(), boundary.end(), track));
    });
    return none;
}

} // namespace

template<int D>
bool tracks_are_sound(const HullView<D>& view, const PartStars<D>& stars, Communicator& ranks) {
    const VertexUse use = use_of_vertices(view, stars);
    const bool whole = tracks_are_whole(view, stars, use, ranks);
    const Array<FacetOfCap<D>> facets = facets_of_caps(view, ranks);
    const bool sound = whole && are_images(facets) && none_is_stray(view, stars, use, facets);
    return ranks.min(sound ? 1 : 0) == 1;
}

template bool tracks_are_sound<2>(const HullView<2>&, const PartStars<2>&, Communicator&);
template bool tracks_are_sound<3>(const HullView<3>&, const PartStars<3>&, Communicator&);
template void check_tracks<2>(const HullView<2>&, BoundaryChanges<2>&, Findings&);
template void check_tracks<3>(const HullView<3>&, BoundaryChanges<3>&, Findings&);
template BoundaryFacets<2> check_cap_boundaries<2>(const HullView<2>&, Findings&);
template BoundaryFacets<3> check_cap_boundaries<3>(const HullView<3>&, Findings&);
template void check_boundary_image<2>(const BoundaryFacets<2>&, BoundaryChanges<2>&, Findings&);
template void check_boundary_image<3>(const BoundaryFacets<3>&, BoundaryChanges<3>&, Findings&);

} // namespace slabhull
