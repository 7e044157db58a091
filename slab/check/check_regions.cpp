// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/hull_view.h"

#include <fmt/format.h>

#include <atomic>
#include <limits>

namespace slabhull {

namespace {

const char* name_of(Region region) {
    constexpr std::array<const char*, 3> names{"initial cap", "side", "terminating cap"};
    return names[static_cast<std::size_t>(region)];
}

template<int D>
std::array<double, 2> time_range(std::span<const Point<D + 1>> points) {
    std::array<double, 2> range{std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity()};
    for (const Point<D + 1>& point : points) {
        range[0] = std::min(range[0], point[D]);
        range[1] = std::max(range[1], point[D]);
    }
    return range;
}

template<int D>
bool any_cell_at(const HullView<D>& view, double time) {
    return std::any_of(view.cells().begin(), view.cells().end(), [&](const Simplex<D>& cell) {
        return std::all_of(cell.begin(), cell.end(), [&](Index v) { return view.time_of(v) == time; });
    });
}

/// The slab's times: the claimed ones if there are caps at them, else the first and last of the vertices.
template<int D>
std::array<double, 2> slab_times(const HullView<D>& view, Findings& findings) {
    const std::array<double, 2> seen = time_range<D>(view.points());
    if (!view.hull.time || *view.hull.time == seen) {
        return seen;
    }
    const std::array<double, 2> claimed = *view.hull.time;
    if (!any_cell_at(view, claimed[0]) || !any_cell_at(view, claimed[1])) {
        findings.other(Defect::wrong_slab_time, {},
                       fmt::format("the slab is said to last from {} to {}, its vertices from {} to {}",
                                   claimed[0], claimed[1], seen[0], seen[1]));
        return seen;
    }
    for (const Index v : select(view.points().size(), [&](std::size_t k) {
             const double t = view.points()[k][D];
             return t < claimed[0] || t > claimed[1];
         })) {
        findings.vertex(
            Defect::time_outside_slab, v,
            fmt::format("t = {} is outside the slab's [{}, {}]", view.time_of(v), claimed[0], claimed[1]));
    }
    return claimed;
}

struct FoundRegions {
    std::array<std::atomic<bool>, 3> any{}; ///< whether each region has a cell
    std::vector<Index> flat;                ///< cells at one instant that are in no cap
};

template<int D>
void find_regions(HullView<D>& view, FoundRegions& found) {
    static_assert(select_grain % RegionList::cells_per_byte == 0, "no two threads write to one byte");
    view.region.reset(view.cells().size() + view.outside);
    found.flat = select(view.cells().size(), [&](std::size_t c) {
        const auto [first, last] = view.span_of(c);
        const Region region = first != last           ? Region::intermediate
                              : first == view.time[0] ? Region::initial
                              : first == view.time[1] ? Region::terminating
                                                      : Region::intermediate;
        view.region.set(c, region);
        if (auto& any = found.any[static_cast<std::size_t>(region)]; !any.load(std::memory_order_relaxed)) {
            any = true;
        }
        return region == Region::intermediate && first == last;
    });
}

template<int D>
void compare_regions(const HullView<D>& view, Findings& findings) {
    const auto bad = select_rows(view.hull.region, [&](std::size_t c, const std::int64_t* claimed) {
        return *claimed != static_cast<std::int64_t>(view.region[c]);
    });
    for (const Index c : bad) {
        const std::int64_t claimed = row_of(view.hull.region, c)[0];
        const bool cap_claimed = claimed == 0 || claimed == 2;
        if (cap_claimed && !view.in_cap(c)) {
            const auto [first, last] = view.span_of(c);
            findings.cell(
                Defect::cap_not_flat, c,
                fmt::format("said to be in the {}, which is at t = {}, but its vertices have t = {} to {}",
                            name_of(static_cast<Region>(claimed)), view.time[claimed == 0 ? 0 : 1], first,
                            last));
        } else {
            findings.cell(Defect::wrong_region, c,
                          fmt::format("said to be in region {}, but its vertices' times put it in the {}",
                                      claimed, name_of(view.region[c])));
        }
    }
}

template<int D>
void report_flat(const HullView<D>& view, std::span<const Index> flat, Findings& findings) {
    for (const Index c : flat) {
        findings.cell(Defect::flat_side_cell, c,
                      fmt::format("a side cell with all its vertices at t = {}", view.span_of(c)[0]));
    }
}

/// V - E + F of a surface mesh with boundary.
std::int64_t euler_of_cap(const HullView<2>& view, Region cap) {
    std::vector<bool> used(view.points().size(), false);
    CapCounts counts;
    for (std::size_t c = 0; c < view.cells().size(); ++c) {
        if (view.region_of(c) != cap) {
            continue;
        }
        ++counts.cells;
        for (std::size_t i = 0; i <= 2; ++i) {
            used[view.cells()[c][i]] = true;
            counts.boundary += view.region_of(view.adjacency.neighbors[c][i]) != cap;
        }
    }
    counts.vertices = std::count(used.begin(), used.end(), true);
    return counts.euler();
}

} // namespace

template<int D>
bool check_regions(HullView<D>& view, Findings& findings) {
    view.time = slab_times(view, findings);
    if (!(view.time[0] < view.time[1])) {
        findings.other(Defect::no_duration, {}, fmt::format("all vertices are at t = {}", view.time[0]));
        return false;
    }
    FoundRegions found;
    find_regions(view, found);
    for (const Region cap : {Region::initial, Region::terminating}) {
        if (!found.any[static_cast<std::size_t>(cap)]) {
            findings.other(Defect::missing_cap, {},
                           fmt::format("no {}: no cell has all its vertices at t = {}", name_of(cap),
                                       view.time[cap == Region::initial ? 0 : 1]));
        }
    }
    if (findings.count(Defect::missing_cap) > 0) {
        return false;
    }
    if (view.hull.region.given()) {
        compare_regions(view, findings);
    }
    report_flat<D>(view, found.flat, findings);
    return true;
}

template<int D>
std::array<bool, 3> check_regions_of_part(HullView<D>& view, Findings& findings) {
    FoundRegions found;
    find_regions(view, found);
    if (view.hull.region.given()) {
        compare_regions(view, findings);
    }
    report_flat<D>(view, found.flat, findings);
    return {found.any[0], found.any[1], found.any[2]};
}

template<int D>
void report_inverted(const HullView<D>& view, std::span<const Index> inverted, Findings& findings) {
    for (const Index c : inverted) {
        findings.cell(Defect::inverted_cell, c,
                      fmt::format("its normal does not point out of the {}", name_of(view.region[c])));
    }
}

template<int D>
void check_euler(const HullView<D>& view, const ManifoldCounts& counts, Findings& findings) {
    // Not for D = 3: a closed 3-manifold has characteristic 0, and a cap half that of its boundary, which is
    // compared elsewhere.
    if constexpr (D == 2) {
        const std::int64_t initial = euler_of_cap(view, Region::initial);
        const std::int64_t terminating = euler_of_cap(view, Region::terminating);
        if (initial != terminating || counts.euler != 2 * terminating) {
            findings.other(
                Defect::euler_mismatch, {},
                fmt::format("Euler characteristic {} of the initial cap, {} of the terminating cap, {} of "
                            "the hull, which should be twice a cap's",
                            initial, terminating, counts.euler));
        }
    }
}

template std::array<bool, 3> check_regions_of_part<2>(HullView<2>&, Findings&);
template std::array<bool, 3> check_regions_of_part<3>(HullView<3>&, Findings&);
template bool check_regions<2>(HullView<2>&, Findings&);
template bool check_regions<3>(HullView<3>&, Findings&);
template void report_inverted<2>(const HullView<2>&, std::span<const Index>, Findings&);
template void report_inverted<3>(const HullView<3>&, std::span<const Index>, Findings&);
template void check_euler<2>(const HullView<2>&, const ManifoldCounts&, Findings&);
template void check_euler<3>(const HullView<3>&, const ManifoldCounts&, Findings&);

} // namespace slabhull
