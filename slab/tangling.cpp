// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/tangling.h"

#include "boundary_mover.h"
#include "slabhull/geometry/embedding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <optional>
#include <utility>

namespace slabhull {

namespace {

/// How closely the time of tangling is bracketed, in durations of the slab.
constexpr double bracket = 1e-3;

constexpr std::size_t most_crossings = 1000;
constexpr std::size_t most_partners = 8;

template<int D>
std::optional<GeometryError> fault_of(const Surface<D>& surface, double time) {
    try {
        require_domain_boundary(surface, {fmt::format("moved boundary at t = {:.9g}", time), {}}, false);
        return std::nullopt;
    } catch (const GeometryError& error) {
        return error;
    }
}

/// Crossing facets of two patches, told by the first of them and those that it crosses.
template<int D>
struct PatchCrossing {
    Index facet;
    std::vector<Index> partners;
    Point<D> near;
};

template<int D>
std::map<std::pair<PatchNumber, PatchNumber>, PatchCrossing<D>>
crossings_by_patches(const Surface<D>& surface) {
    std::map<std::pair<PatchNumber, PatchNumber>, PatchCrossing<D>> found;
    for (const Crossing<D>& crossing : find_crossings(surface, most_crossings)) {
        const std::pair patches{surface.patch[crossing.first], surface.patch[crossing.second]};
        auto& of_pair =
            found.try_emplace(patches, PatchCrossing<D>{crossing.first, {}, crossing.near}).first->second;
        if (of_pair.facet == crossing.first && crossing.first != crossing.second) {
            of_pair.partners.push_back(crossing.second);
        }
    }
    return found;
}

/// "patches rotor and casing cross at t = 0.4183 near (1, 0, 2), facets 812 and 90, 14"
template<int D>
std::string crossings_in_words(const Surface<D>& surface, double time) {
    std::string text;
    for (auto& [patches, crossing] : crossings_by_patches(surface)) {
        const std::string first = patch_name(surface.patches, patches.first);
        const std::string second = patch_name(surface.patches, patches.second);
        const std::string who = first == second ? fmt::format("patch {}", first)
                                                : fmt::format("patches {} and {}", first, second);
        if (crossing.partners.empty()) {
            text += fmt::format("{} collapses at t = {:.9g} near ({:.6g}), facet {}\n", who, time,
                                fmt::join(crossing.near, ", "), crossing.facet);
            continue;
        }
        const bool more = crossing.partners.size() > most_partners;
        crossing.partners.resize(std::min(crossing.partners.size(), most_partners));
        text += fmt::format("{} cross{} at t = {:.9g} near ({:.6g}), facets {} and {}{}\n", who,
                            first == second ? "es itself" : "", time, fmt::join(crossing.near, ", "),
                            crossing.facet, fmt::join(crossing.partners, ", "), more ? " ..." : "");
    }
    return text;
}

/// Brackets the time of tangling between a good level and a bad one.
template<int D>
class Bisection {
public:
    Bisection(const Sweep<D>& sweep, BoundaryMover<D>& mover, std::size_t bad_level, GeometryError fault)
        : sweep_{sweep}, mover_{mover}, good_places_{sweep.positions[bad_level - 1]},
          bad_places_{sweep.positions[bad_level]}, good_{sweep.times[bad_level - 1]},
          bad_{sweep.times[bad_level]}, fault_{std::move(fault)} {}

    [[noreturn]] void run() {
        const double begin = sweep_.times.front();
        const double duration = sweep_.times.back() - begin;
        while (bad_ - good_ > bracket * duration) {
            halve();
        }
        const std::string crossings = crossings_in_words(at(bad_places_), bad_);
        throw TangledBoundary(
            fmt::format(
                "{}\nThe boundary is good until t = {:.9g}, {:.4g} % of the slab from {:.9g} to {:.9g}: "
                "end the slab there ([time] adapt = true does), or change the motion.",
                crossings.empty() ? fault_.what() : crossings.substr(0, crossings.size() - 1), good_,
                100 * (good_ - begin) / duration, begin, sweep_.times.back()),
            fault_.entities, good_, bad_);
    }

private:
    void halve() {
        const double middle = 0.5 * (good_ + bad_);
        Array<Point<D>> places = mover_.move(good_places_, good_, middle);
        if (auto fault = fault_of<D>(at(places), middle)) {
            fault_ = std::move(*fault);
            bad_ = middle;
            bad_places_ = std::move(places);
        } else {
            good_ = middle;
            good_places_ = std::move(places);
        }
    }

    Surface<D> at(const Array<Point<D>>& places) const {
        Surface<D> surface = sweep_.surface;
        surface.points = places;
        return surface;
    }

    const Sweep<D>& sweep_;
    BoundaryMover<D>& mover_;
    Array<Point<D>> good_places_;
    Array<Point<D>> bad_places_;
    double good_;
    double bad_;
    GeometryError fault_; ///< at bad_
};

} // namespace

template<int D>
void require_embedded_levels(const Sweep<D>& sweep, const PatchMotions<D>& motions, double motion_start,
                             const TrajectoryOptions& options) {
    for (std::size_t level = 1; level < sweep.times.size(); ++level) {
        if (auto fault = fault_of<D>(sweep.at(level), sweep.times[level])) {
            BoundaryMover<D> mover{sweep, motions, motion_start, options};
            Bisection<D>{sweep, mover, level, std::move(*fault)}.run();
        }
    }
}

template void require_embedded_levels<2>(const Sweep<2>&, const PatchMotions<2>&, double,
                                         const TrajectoryOptions&);
template void require_embedded_levels<3>(const Sweep<3>&, const PatchMotions<3>&, double,
                                         const TrajectoryOptions&);

} // namespace slabhull
