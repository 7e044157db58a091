// SPDX-License-Identifier: BSD-3-Clause
// What a case says, turned into what a march needs: motions and surfaces of the patches that the domain has.
#include "slabhull/cases/settings.h"

#include "cases/case/patch_motions.h"
#include "cases/tables/displacement_files.h"
#include "slabhull/core/error.h"
#include "slabhull/core/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <numeric>
#include <set>

namespace slabhull {

namespace {

/// What patches that are called by numbers mean.
std::string nameless_groups(const std::vector<std::string>& names) {
    const bool any = std::any_of(names.begin(), names.end(), [](const std::string& name) {
        return name.find_first_not_of("0123456789") == std::string::npos;
    });
    return any ? "; a number is a physical group without a name: use the number, or name the group in the "
                 "mesher"
               : "";
}

bool is_among(const std::string& format, const std::vector<std::string>& formats) {
    return std::find(formats.begin(), formats.end(), format) != formats.end();
}

/// Refuses numbers and names that the files of the case cannot hold: in MSH the caps' groups come after the
/// patches, and attributes of fillings are 2 + the patch.
void require_held(const Case& the_case, const PatchList& patches) {
    constexpr PatchNumber largest = std::numeric_limits<PatchNumber>::max() - 2;
    const bool msh = is_among("msh", the_case.formats);
    const bool msh_of_filling = the_case.fill && is_among("msh", the_case.fill->formats);
    for (const Patch& patch : patches) {
        if (patch.name.find('\0') != std::string::npos) { // which ends texts in VTU
            throw UsageError{
                fmt::format("the name of patch \"{}\" has a NUL character in it; rename the patch",
                            readable(patch.name))};
        }
        if ((msh || the_case.fill) && patch.number > largest) {
            throw FormatLimit{fmt::format(
                "patch \"{}\" has the number {}, but {} up to {}, as two more are for the caps; give it a "
                "smaller number in the mesher{}",
                patch.name, patch.number, msh ? "MSH files of hulls have numbers" : "fillings have patches",
                largest, the_case.fill ? "" : ", or write VTU (output.formats)")};
        }
        if ((msh || msh_of_filling) && patch.name.find_first_of("\"\n\r") != std::string::npos) {
            throw FormatLimit{
                fmt::format("MSH has no place for a double quote or a line end in the name of a "
                            "group, as in {}; rename it in the mesher, or leave \"msh\" out of "
                            "{}.formats",
                            patch.name, msh ? "output" : "fill")};
        }
    }
}

/// All that have the name.
std::vector<PatchNumber> numbers_of(const PatchList& patches, const std::string& name, const char* table) {
    std::vector<PatchNumber> numbers = patch_numbers(patches, name);
    if (numbers.empty()) {
        std::string known;
        std::vector<std::string> names;
        for (const Patch& patch : patches) {
            if (std::find(names.begin(), names.end(), patch.name) == names.end()) {
                names.push_back(patch.name);
                known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", patch.name);
            }
        }
        throw UsageError(fmt::format("[{}.{}]: the domain has no patch \"{}\"; it has {}{}{}", table, name,
                                     name, known, nameless_groups(names), did_you_mean(name, names)));
    }
    return numbers;
}

template<int D>
class SettingsMaker {
public:
    SettingsMaker(const Case& the_case, const Boundary<D>& boundary) : case_{the_case}, boundary_{boundary} {}

    CaseSettings<D> run() {
        settings_.motion_start = case_.start;
        settings_.trajectory = case_.trajectory;
        settings_.layers.automatic = case_.layers_follow_motion();
        settings_.layers.tolerance = case_.layer_tolerance;
        settings_.side = {case_.split, case_.diagonals};
        settings_.cap = cap_options(case_);
        settings_.reuse = case_.cap_reuse;
        settings_.reuse_angle = case_.cap_reuse_angle;
        settings_.adapt.size = std::min(case_.adapt_size, case_.cap_size);
        settings_.adapt.growth = case_.cap_growth;
        settings_.adapt.angle = case_.adapt_angle;
        settings_.adapt.boundary = case_.adapt_boundary;
        settings_.adapt.feature_angle = case_.adapt_feature_angle;
        settings_.adapt.distance = case_.adapt_distance;
        for (const auto& [patch, wanted] : case_.adapt_patches) {
            for (const PatchNumber number : numbers_of(boundary_.patches(), patch, "adapt")) {
                settings_.adapt.patches[number] = wanted;
            }
        }
        for (const auto& [patch, spec] : case_.motions) {
            const std::vector<PatchNumber> numbers = numbers_of(boundary_.patches(), patch, "motion");
            try {
                add_motion(numbers, spec);
            } catch (const UsageError& error) {
                throw UsageError(fmt::format("[motion.{}]: {}", patch, error.what()));
            }
        }
        stretch();
        for (const auto& [patch, spec] : case_.projections) {
            add_projection(patch, spec);
        }
        return {std::move(settings_), std::move(matches_), std::move(remarks_)};
    }

private:
    void add_motion(const std::vector<PatchNumber>& numbers, const MotionSpec& spec) {
        MovingPatch<D> moving;
        if (spec.is_field()) {
            moving.motion = motion_of<D>(spec, case_);
        } else if (spec.kind == MotionSpec::Kind::stretch) {
            stretching_.insert(numbers.begin(), numbers.end());
        } else {
            std::vector<TrackId> tracks(boundary_.vertex_count());
            std::iota(tracks.begin(), tracks.end(), 0);
            DisplacementFiles<D> files = read_displacement_files<D>(
                spec.displacements, boundary_.start_surface(), tracks, numbers, {case_.start, case_.end});
            moving.nodal = std::move(files.motion);
            matches_[numbers.front()] = std::move(files.match);
        }
        for (const PatchNumber number : numbers) {
            settings_.motions[number] = moving;
        }
    }

    void stretch() {
        if (stretching_.empty()) {
            return;
        }
        const StretchPointer<D> stretch = harmonic_stretch(boundary_, stretching_);
        for (const PatchNumber number : stretching_) {
            settings_.motions[number].stretch = stretch;
        }
    }

    void add_projection(const std::string& patch, const ProjectionSpec& spec) {
        const std::vector<PatchNumber> numbers = numbers_of(boundary_.patches(), patch, "project");
        MovingPatch<D> moving = settings_.motions[numbers.front()]; // all of one name have the same motion
        if (moving.motion == nullptr && moving.stretch == nullptr) {
            moving.motion = standing<D>();
        }
        moving.surface = projection_of<D>(spec, remarks_);
        for (const PatchNumber number : numbers) {
            settings_.motions[number] = moving;
        }
        if (moving.motion != nullptr && !moving.motion->map(case_.start, case_.end)) {
            throw UsageError(fmt::format(
                "[project.{}]: a projection surface moves with its patch's motion, and a velocity "
                "formula does not say how a surface moves",
                patch));
        }
    }

    const Case& case_;
    const Boundary<D>& boundary_;
    SlabSettings<D> settings_;
    std::map<PatchNumber, DisplacementMatch> matches_;
    std::vector<std::string> remarks_;
    std::set<PatchNumber> stretching_;
};

} // namespace

CapOptions cap_options(const Case& the_case) {
    CapOptions options;
    options.grading = {the_case.cap_growth, the_case.cap_size};
    options.radius_edge = the_case.cap_quality;
    options.mesher = the_case.cap_mesher;
    options.blocks = the_case.cap_blocks;
    options.curve_order = the_case.cap_curve_order;
    return options;
}

template<int D>
CaseSettings<D> case_settings(const Case& the_case, const Boundary<D>& boundary) {
    try {
        require_held(the_case, boundary.patches());
        return SettingsMaker<D>{the_case, boundary}.run();
    } catch (const UsageError& error) {
        if (the_case.file.empty()) {
            throw;
        }
        throw UsageError(fmt::format("{}: {}", the_case.file.string(), error.what()), error.entities);
    }
}

template CaseSettings<2> case_settings<2>(const Case&, const Boundary<2>&);
template CaseSettings<3> case_settings<3>(const Case&, const Boundary<3>&);

} // namespace slabhull
