// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/edit/soup_info.h"

#include "edit/soup_cells.h"
#include "edit/soup_rows.h"
#include "slabhull/edit/soup_edit.h"
#include "slabhull/edit/soup_numbers.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace slabhull {

namespace {

using Numbers = IntegerList;

bool is_hull(const io::Soup& soup) {
    return soup.top_dimension() == 3 ? soup_times(soup) != nullptr : has_time_as_coordinate(soup);
}

template<int N>
Array<Point<N>> points_of(const io::Soup& soup) {
    if constexpr (N == 3) {
        return soup.points;
    } else {
        const Array<double>& times = *soup_times(soup);
        Array<Point<4>> points(soup.points.size());
        for (std::size_t v = 0; v < points.size(); ++v) {
            const Point<3>& x = soup.points[v];
            points[v] = {x[0], x[1], x[2], times[v]};
        }
        return points;
    }
}

template<int N>
std::vector<SoupInfo::Bounds> bounds_of(const Array<Point<N>>& points, const char* axes) {
    std::vector<SoupInfo::Bounds> bounds;
    for (std::size_t k = 0; k < N && !points.empty(); ++k) {
        const auto [low, high] = std::minmax_element(
            points.begin(), points.end(), [k](const Point<N>& a, const Point<N>& b) { return a[k] < b[k]; });
        bounds.push_back({axes[k], (*low)[k], (*high)[k]});
    }
    return bounds;
}

// --- measures

template<int D, int N>
Array<double> measures_of(std::span<const Point<N>> points, std::span<const Simplex<D>> cells) {
    Array<double> measures(cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c) {
        measures[c] = simplex_measure<D, N>(corners_of<D, N>(cells[c], points));
    }
    return measures;
}

Array<double> measures_in_space(const io::Soup& soup, int dimension) {
    switch (dimension) {
    case 1:
        return measures_of<1, 3>(soup.points, simplices_of<1>(soup));
    case 2:
        return measures_of<2, 3>(soup.points, simplices_of<2>(soup));
    case 3:
        return measures_of<3, 3>(soup.points, simplices_of<3>(soup));
    default:
        return Array<double>(soup.simplices[0].vertices.size(), 0.0);
    }
}

// --- parts

void add_regions(SoupInfo& info, const Numbers& region, const Array<double>& measures) {
    info.regions = {{"initial"}, {"side"}, {"terminating"}};
    for (std::size_t c = 0; c < region.size(); ++c) {
        if (region[c] >= 0 && region[c] <= 2) {
            SoupInfo::Region& its = info.regions[static_cast<std::size_t>(region[c])];
            ++its.cells;
            its.measure += measures[c];
        }
    }
}

template<class Values>
void add_groups(SoupInfo& info, int dimension, const PatchList& list, const Values& numbers,
                const Array<double>& measures) {
    std::map<std::int64_t, SoupInfo::Group> groups;
    for (const Patch& patch : list) {
        groups[patch.number] = {dimension, patch};
    }
    for (std::size_t c = 0; c < numbers.size(); ++c) {
        if (numbers[c] != 0) {
            const Patch unnamed{static_cast<PatchNumber>(numbers[c]), ""};
            SoupInfo::Group& group =
                groups.try_emplace(numbers[c], SoupInfo::Group{dimension, unnamed}).first->second;
            ++group.cells;
            group.measure += measures[c];
        }
    }
    for (const auto& [number, group] : groups) {
        info.groups.push_back(group);
    }
}

void add_parts(SoupInfo& info, io::Soup& soup, const Array<double>& measures) {
    for (const double measure : measures) {
        info.measure += measure;
    }
    const Numbers* region = detail::whole_numbers(soup.cell_data, "region");
    if (info.hull && region != nullptr) {
        add_regions(info, *region, measures);
    }
    if (const Numbers* patch = detail::whole_numbers(soup.cell_data, "patch")) {
        add_groups(info, info.dimension, listed_patches(soup), *patch, measures);
    }
    for (int d = info.dimension - 1; d >= 0; --d) {
        const auto& physical = soup.simplices[static_cast<std::size_t>(d)].physical;
        const PatchList& list = soup.groups[static_cast<std::size_t>(d)];
        add_groups(info, d, list, physical, measures_in_space(soup, d));
    }
}

template<int D, int N>
void look_at_cells(SoupInfo& info, io::Soup& soup) {
    const Array<Point<N>> points = points_of<N>(soup);
    const std::span<const Simplex<D>> cells = simplices_of<D>(soup);
    info.bounds = bounds_of<N>(points, info.hull && D == 2 ? "xyt" : "xyzt");
    info.angles = angle_histogram<D, N>(points, cells);
    for (const Simplex<D>& cell : cells) {
        const AngleRange range = dihedral_angles<D, N>(corners_of<D, N>(cell, points));
        info.angle.smallest = std::min(info.angle.smallest, range.smallest);
        info.angle.largest = std::max(info.angle.largest, range.largest);
    }
    add_parts(info, soup, measures_of<D, N>(points, cells));
}

} // namespace

SoupInfo soup_info(io::Soup soup) {
    SoupInfo info;
    info.dimension = soup.top_dimension();
    info.hull = is_hull(soup);
    info.points = soup.points.size();
    for (std::size_t d = 0; d < info.simplices.size(); ++d) {
        info.simplices[d] = soup.simplices[d].size(static_cast<int>(d));
    }
    settle_numbers(soup);
    groups_to_arrays(soup);
    if (info.dimension == 3) {
        info.hull ? look_at_cells<3, 4>(info, soup) : look_at_cells<3, 3>(info, soup);
    } else if (info.dimension == 2) {
        look_at_cells<2, 3>(info, soup);
    } else {
        info.bounds = bounds_of<3>(soup.points, "xyz");
        add_parts(info, soup, measures_in_space(soup, info.dimension));
    }
    return info;
}

} // namespace slabhull
