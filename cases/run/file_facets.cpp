// SPDX-License-Identifier: BSD-3-Clause
#include "cases/run/file_facets.h"

#include "slabhull/core/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <utility>

namespace slabhull {

namespace {

template<std::size_t N>
std::array<Index, N> ascending(std::array<Index, N> facet) {
    std::sort(facet.begin(), facet.end());
    return facet;
}

/// "fluid", "ball": the groups that cells are in.
std::string regions_of(const io::Soup& soup, std::size_t dimension) {
    const auto& physical = soup.simplices[dimension].physical;
    std::string text;
    for (const PatchNumber number : std::set<PatchNumber>(physical.begin(), physical.end())) {
        if (number != 0) {
            text +=
                fmt::format("{}\"{}\"", text.empty() ? "" : ", ", group_name(soup.groups[dimension], number));
        }
    }
    return text;
}

template<int D>
io::SimplexBlock rows_in_groups(const io::SimplexBlock& all, const std::set<PatchNumber>& groups) {
    io::SimplexBlock chosen;
    for (std::size_t i = 0; i < all.physical.size(); ++i) {
        if (!groups.contains(all.physical[i])) {
            continue;
        }
        const auto first = all.vertices.begin() + static_cast<std::ptrdiff_t>(i * (D + 1));
        chosen.vertices.insert(chosen.vertices.end(), first, first + D + 1);
        chosen.physical.push_back(all.physical[i]);
        chosen.tags.push_back(all.tag(i));
        if (!all.entity.empty()) {
            chosen.entity.push_back(all.entity[i]);
        }
    }
    return chosen;
}

} // namespace

template<int D>
io::SimplexBlock cells_of_regions(const io::Soup& soup, const std::vector<std::string>& regions) {
    const auto& physical = soup.simplices[D].physical;
    const std::set<PatchNumber> in_use(physical.begin(), physical.end());
    std::set<PatchNumber> groups;
    for (const std::string& name : regions) {
        const std::size_t before = groups.size();
        std::copy_if(
            in_use.begin(), in_use.end(), std::inserter(groups, groups.end()),
            [&](PatchNumber number) { return number != 0 && group_name(soup.groups[D], number) == name; });
        if (groups.size() == before) {
            const std::string known = regions_of(soup, D);
            throw UsageError(fmt::format("[initial] regions: {} has no region \"{}\"; {}{}", soup.path, name,
                                         known.empty()
                                             ? "its cells are in no physical group; leave regions out"
                                             : "give of those that it has, ",
                                         known));
        }
    }
    return rows_in_groups<D>(soup.simplices[D], groups);
}

// --- facets of the file

template<int D>
void warn_of_repeated(const io::Soup& soup, const FileFacets<D>& facets, const Domain<D>& domain,
                      const Listener& listener) {
    std::map<std::pair<PatchNumber, PatchNumber>, std::size_t> repeated; // facets by both groups
    for (const auto& [first, again] : domain.repeated_facets) {
        if (facets.group[first] != facets.group[again]) {
            ++repeated[{facets.group[first], facets.group[again]}];
        }
    }
    for (const auto& [groups, count] : repeated) {
        const auto name = [&soup](PatchNumber number) {
            return number == 0 ? "no group" : "\"" + group_name(soup.groups[D - 1], number) + "\"";
        };
        listener.warning(
            fmt::format("{}: {} facets are listed for {} and again for {}; they count in the first",
                        soup.path, count, name(groups.first), name(groups.second)));
    }
}

// --- groups inside

template<int D>
void InnerFacets<D>::collect(const FileFacets<D>& facets, std::span<const std::size_t> inner) {
    std::map<Facet<D>, PatchNumber> groups; // of facets listed twice, the first counts
    for (const std::size_t f : inner) {
        groups.emplace(ascending(facets.vertices[f]), facets.group[f]);
    }
    std::erase_if(groups, [](const auto& each) { return each.second == 0; });
    for (Index c = 0; c < mesh_.cells.size() && !groups.empty(); ++c) {
        for (std::size_t i = 0; i <= D; ++i) {
            const Index across = mesh_.neighbors[c][i];
            if (across == no_index || across < c) {
                continue;
            }
            const auto found = groups.find(ascending(outward_facet<D>(mesh_.cells[c], static_cast<int>(i))));
            if (found != groups.end()) {
                Interface& interface = interfaces_[found->second];
                ++interface.facets;
                interface.regions.insert({region(c), region(across)});
            }
        }
    }
}

template<int D>
std::string InnerFacets<D>::sides(const Interface& interface) const {
    std::vector<std::string> names;
    for (const PatchNumber number : interface.regions) {
        names.push_back(number == 0 ? "cells in no group"
                                    : "\"" + group_name(soup_.groups[D], number) + "\"");
    }
    return interface.regions.size() == 1 ? fmt::format("inside {}", names.front())
                                         : fmt::format("between {}", fmt::join(names, " and "));
}

template<int D>
std::string InnerFacets<D>::way_out() const {
    const std::string known = regions_of(soup_, D);
    return known.empty()
               ? std::string{}
               : fmt::format("; initial.regions = [..] takes only some of {} as the domain, and makes their "
                             "interfaces with the others boundary",
                             known);
}

template<int D>
void InnerFacets<D>::require_still(const DomainOptions& options) const {
    for (const std::string& name : options.moving) {
        for (const auto& [number, interface] : interfaces_) {
            const bool on_boundary = std::find(mesh_.boundary_patch.begin(), mesh_.boundary_patch.end(),
                                               number) != mesh_.boundary_patch.end();
            if (!on_boundary && group_name(soup_.groups[D - 1], number) == name) {
                throw UsageError(fmt::format("[motion.{}]: \"{}\" is an inner interface of {}, {}: inner "
                                             "interfaces cannot move{}",
                                             name, name, soup_.path, sides(interface), way_out()));
            }
        }
    }
}

template<int D>
void InnerFacets<D>::tell(const FileFacets<D>& facets, std::span<const std::size_t> inner,
                          const DomainOptions& options, const Listener& listener) {
    collect(facets, inner);
    if (interfaces_.empty()) {
        return;
    }
    require_still(options);
    std::vector<std::string> words;
    for (const auto& [number, interface] : interfaces_) {
        words.push_back(fmt::format("\"{}\" ({} facets {})", group_name(soup_.groups[D - 1], number),
                                    interface.facets, sides(interface)));
    }
    listener.warning(
        fmt::format("{}: groups that lie inside the domain: {}. Inner interfaces are no boundary and "
                    "cannot move{}",
                    soup_.path, fmt::join(words, ", "), way_out()));
}

template io::SimplexBlock cells_of_regions<2>(const io::Soup&, const std::vector<std::string>&);
template io::SimplexBlock cells_of_regions<3>(const io::Soup&, const std::vector<std::string>&);
template void warn_of_repeated<2>(const io::Soup&, const FileFacets<2>&, const Domain<2>&, const Listener&);
template void warn_of_repeated<3>(const io::Soup&, const FileFacets<3>&, const Domain<3>&, const Listener&);
template class InnerFacets<2>;
template class InnerFacets<3>;

} // namespace slabhull
