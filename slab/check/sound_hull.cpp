// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/sound_hull.h"

#include "slabhull/core/error.h"

#include <fmt/format.h>

namespace slabhull {

namespace {

void require_clean(const HullReport& report, const std::string& name) {
    if (report.clean()) {
        return;
    }
    std::vector<Entity> entities;
    for (const Finding& finding : report.findings) {
        entities.insert(entities.end(), finding.entities.begin(), finding.entities.end());
    }
    const bool crosses = report.count(Defect::self_crossing) == report.total();
    const std::string what =
        crosses ? "crosses itself between two levels" : fmt::format("has {} defects", report.total());
    const char* advice = crosses ? "Layers that are shorter in time, or another split of the side, may help: "
                                   "without time.layers and time.spacing, layers follow from the motion"
                                 : "";
    throw GeometryError{
        fmt::format("{} {} and was not written:\n{}{}", name, what, findings_as_text(report), advice),
        entities};
}

CheckOptions options_of_messages() {
    CheckOptions options;
    options.most_findings = 5; // the program's check lists more
    return options;
}

} // namespace

template<int D>
SoundHull require_sound_hull(const Hull<D>& hull, const std::string& name, bool embedding,
                             StageClock& clock) {
    const HullColumns<D> columns = columns_of(hull);
    const CheckOptions options = options_of_messages();
    SoundHull sound{check_hull<D>(columns, options), {}};
    clock.book("checking");
    require_clean(sound.report, name);
    if (embedding) {
        sound.embedding = check_embedding<D>(columns, options, sound.report);
        clock.book("embedding");
        require_clean(sound.report, name);
    }
    return sound;
}

template<int D>
SoundHull require_sound_parts(const HullPart<D>& part, const HullOrder<D>& order, Communicator& ranks,
                              const std::string& name, bool embedding, StageClock& clock) {
    const CheckOptions options = options_of_messages();
    SoundHull sound{check_parts<D>(part, order, ranks, options), {}};
    clock.book("checking");
    together(ranks, [&] { require_clean(sound.report, name); }); // the first rank's message has the findings
    if (embedding) {
        sound.embedding = check_embedding_of_parts(part, order, ranks, options, sound.report);
        clock.book("embedding");
        together(ranks, [&] { require_clean(sound.report, name); });
    }
    return sound;
}

template SoundHull require_sound_parts<2>(const HullPart<2>&, const HullOrder<2>&, Communicator&,
                                          const std::string&, bool, StageClock&);
template SoundHull require_sound_parts<3>(const HullPart<3>&, const HullOrder<3>&, Communicator&,
                                          const std::string&, bool, StageClock&);
template SoundHull require_sound_hull<2>(const Hull<2>&, const std::string&, bool, StageClock&);
template SoundHull require_sound_hull<3>(const Hull<3>&, const std::string&, bool, StageClock&);

} // namespace slabhull
