// SPDX-License-Identifier: BSD-3-Clause
#include "cases/run/file_facets.h"

#include "cases/run/used_points.h"
#include "slabhull/core/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace slabhull {

std::string group_name(const PatchList& groups, PatchNumber number) {
    const auto found = std::find_if(groups.begin(), groups.end(),
                                    [number](const Patch& group) { return group.number == number; });
    return found == groups.end() || found->name.empty() ? fmt::format("{}", number) : found->name;
}

namespace {

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
        const auto found = std::find_if(in_use.begin(), in_use.end(), [&](PatchNumber number) {
            return number != 0 && group_name(soup.groups[D], number) == name;
        });
        if (found == in_use.end()) {
            const std::string known = regions_of(soup, D);
            throw UsageError(fmt::format("[initial] regions: {} has no region \"{}\"; {}{}", soup.path, name,
                                         known.empty() ? "its cells are in no physical group" : "it has ",
                                         known));
        }
        groups.insert(*found);
    }
    return rows_in_groups<D>(soup.simplices[D], groups);
}

// --- facets of the file

template<int D>
FileFacets<D>::FileFacets(const io::Soup& soup, const std::vector<Index>& number)
    : soup_{soup}, taken_(soup.simplices[D - 1].size(D - 1), false) {
    const auto listed = renumbered<D - 1>(soup.simplices[D - 1], number);
    for (std::size_t f = 0; f < listed.size(); ++f) {
        Facet<D> key = listed[f];
        std::sort(key.begin(), key.end());
        if (key.back() == no_index) {
            continue;
        }
        const auto [first, is_new] = facets_.emplace(key, f);
        if (!is_new && group(f) != group(first->second)) {
            ++repeated_[{group(first->second), group(f)}];
        }
    }
}

template<int D>
std::optional<std::size_t> FileFacets<D>::take(Facet<D> vertices) {
    std::sort(vertices.begin(), vertices.end());
    const auto found = facets_.find(vertices);
    if (found == facets_.end()) {
        return std::nullopt;
    }
    taken_[found->second] = true;
    return found->second;
}

template<int D>
std::optional<std::size_t> FileFacets<D>::find_left(Facet<D> vertices) const {
    std::sort(vertices.begin(), vertices.end());
    const auto found = facets_.find(vertices);
    const bool is_left = found != facets_.end() && !taken_[found->second] && group(found->second) > 0;
    return is_left ? std::optional{found->second} : std::nullopt;
}

template<int D>
bool FileFacets<D>::any_left() const {
    return std::any_of(facets_.begin(), facets_.end(),
                       [this](const auto& each) { return !taken_[each.second] && group(each.second) > 0; });
}

template<int D>
void FileFacets<D>::warn_of_repeated(const Listener& listener) const {
    for (const auto& [groups, count] : repeated_) {
        const auto name = [this](PatchNumber number) {
            return number == 0 ? "no group" : "\"" + group_name(soup_.groups[D - 1], number) + "\"";
        };
        listener.warning(
            fmt::format("{}: {} facets are listed for {} and again for {}; they count in the first",
                        soup_.path, count, name(groups.first), name(groups.second)));
    }
}

// --- groups inside

template<int D>
void InnerFacets<D>::collect(const FileFacets<D>& facets) {
    for (Index c = 0; c < mesh_.cells.size(); ++c) {
        for (std::size_t i = 0; i <= D; ++i) {
            const Index across = mesh_.neighbors[c][i];
            if (across == no_index || across < c) {
                continue;
            }
            if (const auto found = facets.find_left(outward_facet<D>(mesh_.cells[c], static_cast<int>(i)))) {
                Interface& interface = interfaces_[facets.group(*found)];
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
void InnerFacets<D>::tell(const FileFacets<D>& facets, const DomainOptions& options,
                          const Listener& listener) {
    if (!facets.any_left()) {
        return;
    }
    collect(facets);
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
template class FileFacets<2>;
template class FileFacets<3>;
template class InnerFacets<2>;
template class InnerFacets<3>;

} // namespace slabhull
