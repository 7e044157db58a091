// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/tangling.h"

#include "core/listed.h"
#include "core/pieces.h"
#include "core/place_in_words.h"
#include "slab/sweep/boundary_mover.h"
#include "slabhull/core/communicator.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/slab/hull_part.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

/// How closely the time of tangling is bracketed, in durations of the slab.
constexpr double bracket = 1e-3;

constexpr std::size_t most_crossings = 1000;
constexpr std::size_t most_partners = 8;

template<int D>
std::optional<GeometryError> fault_of(const Boundary<D>& boundary, const Surface<D>& surface, double time) {
    try {
        require_domain_boundary(boundary, surface, {fmt::format("moved boundary at t = {:.9g}", time), {}});
        return std::nullopt;
    } catch (const GeometryError& error) {
        return error;
    }
}

/// Crossing facets of two patches: the first one, and as partners those that it crosses. Or collapsed facets
/// of one patch: the first one, and the others as partners.
template<int D>
struct PatchFault {
    Index facet;
    std::vector<Index> partners;
    Point<D> near;
};

/// The patch of lower number, the other one (or the same), and whether facets have collapsed.
using FaultKey = std::tuple<PatchNumber, PatchNumber, bool>;

template<int D>
std::map<FaultKey, PatchFault<D>> faults_by_patches(const Surface<D>& surface) {
    std::map<FaultKey, PatchFault<D>> found;
    for (auto [first, second, near] : find_crossings(surface, most_crossings)) {
        if (surface.patch[second] < surface.patch[first]) {
            std::swap(first, second);
        }
        const bool collapsed = first == second;
        const FaultKey key{surface.patch[first], surface.patch[second], collapsed};
        const auto [fault, fresh] = found.try_emplace(key, PatchFault<D>{first, {}, near});
        if (collapsed ? !fresh : fault->second.facet == first) {
            fault->second.partners.push_back(second);
        }
    }
    return found;
}

/// "patch rotor collapses at t = 0.5 near (1, 0, 2), facets 3, 17"
template<int D>
std::string collapse_in_words(const std::string& patch, const PatchFault<D>& fault, double time) {
    std::vector<Index> facets{fault.facet};
    facets.insert(facets.end(), fault.partners.begin(), fault.partners.end());
    return fmt::format("patch {} collapses at t = {:.9g} near {}, facet{} {}", patch, time,
                       place_in_words(fault.near), facets.size() > 1 ? "s" : "",
                       listed(facets, most_partners));
}

/// "patches rotor and casing cross at t = 0.4183 near (1, 0, 2), facets 812 and 90, 14"
template<int D>
std::string crossing_in_words(const std::string& first, const std::string& second, const PatchFault<D>& fault,
                              double time) {
    const std::string who = first == second ? fmt::format("patch {} crosses itself", first)
                                            : fmt::format("patches {} and {} cross", first, second);
    return fmt::format("{} at t = {:.9g} near {}, facets {} and {}", who, time, place_in_words(fault.near),
                       fault.facet, listed(fault.partners, most_partners));
}

/// A line for each pair of patches; empty when nothing crosses.
template<int D>
std::string crossings_in_words(const Surface<D>& surface, double time) {
    std::vector<std::string> lines;
    for (const auto& [key, fault] : faults_by_patches(surface)) {
        const auto [first, second, collapsed] = key;
        const std::string name = patch_name(surface.patches, first);
        lines.push_back(collapsed
                            ? collapse_in_words(name, fault, time)
                            : crossing_in_words(name, patch_name(surface.patches, second), fault, time));
    }
    return fmt::format("{}", fmt::join(lines, "\n"));
}

/// Brackets the time of tangling between a good level and a bad one, whose places are given: not every rank
/// has them.
template<int D>
class Bisection {
public:
    Bisection(const Sweep<D>& sweep, BoundaryMover<D>& mover, std::size_t bad_level,
              std::array<Array<Point<D>>, 2> places)
        : sweep_{sweep}, mover_{mover}, good_places_{std::move(places[0])},
          bad_places_{std::move(places[1])}, good_{sweep.times[bad_level - 1]}, bad_{sweep.times[bad_level]},
          fault_{fault_of<D>(sweep.boundary, at(bad_places_), bad_).value()} {}

    [[noreturn]] void run() {
        const double begin = sweep_.times.front();
        const double duration = sweep_.times.back() - begin;
        while (bad_ - good_ > bracket * duration) {
            halve();
        }
        const std::string crossings = crossings_in_words(at(bad_places_), bad_);
        throw TangledBoundary(
            fmt::format(
                "{}\nThe boundary is good until t = {:.9g}, {:.4g} % of the slab from {:.9g} to {:.9g}",
                crossings.empty() ? fault_.what() : crossings, good_, 100 * (good_ - begin) / duration, begin,
                sweep_.times.back()),
            "end the slab there ([time] adapt = true does), or change the motion.", fault_.entities, good_,
            bad_);
    }

private:
    void halve() {
        const double middle = 0.5 * (good_ + bad_);
        Array<Point<D>> places = mover_.move(good_places_, good_, middle);
        if (auto fault = fault_of<D>(sweep_.boundary, at(places), middle)) {
            fault_ = std::move(*fault);
            bad_ = middle;
            bad_places_ = std::move(places);
        } else {
            good_ = middle;
            good_places_ = std::move(places);
        }
    }

    Surface<D> at(const Array<Point<D>>& places) const { return sweep_.boundary.at(places); }

    const Sweep<D>& sweep_;
    BoundaryMover<D>& mover_;
    Array<Point<D>> good_places_;
    Array<Point<D>> bad_places_;
    double good_;
    double bad_;
    GeometryError fault_; ///< at bad_
};

/// The first level that is at fault, or the number of levels. Each rank looks at its share.
template<int D>
std::size_t first_at_fault(const Sweep<D>& sweep, Communicator& ranks) {
    const HullRange layers = range_of_rank(sweep.layers(), ranks);
    std::size_t level = layers.first + 1; // the upper one of each layer
    const std::size_t end = layers.end() + 1;
    while (level < end && !fault_of<D>(sweep.boundary, sweep.at(level), sweep.times[level])) {
        ++level;
    }
    return ranks.min(level < end ? level : sweep.times.size());
}

/// The places below and above a layer, from the rank whose share it is.
template<int D>
std::array<Array<Point<D>>, 2> places_around(std::size_t layer, const Sweep<D>& sweep, Communicator& ranks) {
    const bool mine = range_of_rank(sweep.layers(), ranks).contains(layer);
    const auto on_level = [&](std::size_t level) {
        return joined(ranks.all_gather<Point<D>>(mine ? sweep.places(level) : Array<Point<D>>{}));
    };
    return {on_level(layer), on_level(layer + 1)};
}

} // namespace

template<int D>
void require_embedded_levels(const Sweep<D>& sweep, const PatchMotions<D>& motions, double motion_start,
                             const TrajectoryOptions& options, Communicator* ranks) {
    SoleRank alone;
    Communicator& all = ranks != nullptr ? *ranks : alone;
    const std::size_t level = first_at_fault<D>(sweep, all);
    if (level < sweep.times.size()) {
        BoundaryMover<D> mover{sweep, motions, motion_start, options};
        Bisection<D>{sweep, mover, level, places_around(level - 1, sweep, all)}.run();
    }
}

template void require_embedded_levels<2>(const Sweep<2>&, const PatchMotions<2>&, double,
                                         const TrajectoryOptions&, Communicator*);
template void require_embedded_levels<3>(const Sweep<3>&, const PatchMotions<3>&, double,
                                         const TrajectoryOptions&, Communicator*);

} // namespace slabhull
