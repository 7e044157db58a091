// SPDX-License-Identifier: BSD-3-Clause
#include "python/march.h"

#include "python/hull.h"
#include "python/long_call.h"
#include "python/motions.h"
#include "python/settings.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/stretch.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/stl.h>

#include <set>

namespace slabhull::python {

namespace {

/// The numbers of all patches of a name that there must be.
std::vector<PatchNumber> require_patches(const PatchList& patches, const std::string& name) {
    std::vector<PatchNumber> numbers = patch_numbers(patches, name);
    if (numbers.empty()) {
        std::vector<std::string> known;
        for (const Patch& patch : patches) {
            known.push_back(patch_name(patches, patch.number));
        }
        throw UsageError{
            fmt::format("the domain has no patch \"{}\"; its patches are {}", name, fmt::join(known, ", "))};
    }
    return numbers;
}

/// The march after a slab, whose hull stays.
template<int D>
std::shared_ptr<March<D>> march_after(March<D>& march, const Slab<D>& slab) {
    return std::make_shared<March<D>>(state_after(march.state().boundary, slab), march.settings());
}

py::dict seconds_by_stage(const StageClock& clock) {
    py::dict seconds;
    for (const auto& [stage, passed] : clock.stages()) {
        seconds[py::str(stage)] = passed;
    }
    return seconds;
}

py::dict dict_of_fit(const LayerFit& fit) {
    py::dict out;
    out["number"] = fit.layers;
    out["largest_deviation"] = fit.deviation;
    out["largest_turn"] = fit.turn;
    out["sound"] = fit.sound();
    return out;
}

template<int D>
py::object adaptation_of(const Slab<D>& slab) {
    if (!slab.adapted) {
        return py::none();
    }
    const AdaptReport& report = slab.adapted->report;
    py::dict out;
    out["splits"] = report.splits;
    out["collapses"] = report.collapses;
    out["flips"] = report.flips;
    out["moved"] = report.moved;
    out["halvings"] = report.halvings;
    out["refused"] = report.refused;
    out["smallest_angle"] = report.smallest_angle;
    out["edge_length_ratio"] = std::make_pair(report.shortest_ratio, report.longest_ratio);
    return out;
}

/// Counts a proposal while it is made.
class AtWork {
public:
    explicit AtWork(int& count) : count_{count} { ++count_; }
    AtWork(const AtWork&) = delete;
    AtWork& operator=(const AtWork&) = delete;
    ~AtWork() { --count_; }

private:
    int& count_;
};

} // namespace

py::object SharedSlab::hull() {
    if (!hull_) {
        hull_ = std::visit(
            []<int D>(const std::shared_ptr<const Slab<D>>& slab) {
                return py::cast(SharedHull{std::shared_ptr<const Hull<D>>{slab, &slab->hull}});
            },
            slab_);
    }
    return hull_;
}

SharedMarch::SharedMarch(const StartDomain& domain, double time, const py::kwargs& settings)
    : march_{std::visit(
          [&]<int D>(const std::shared_ptr<const Domain<D>>& start) -> AnyMarch {
              SlabSettings<D> changed;
              changed.motion_start = time;
              change_settings<D>(changed, settings);
              return long_call([&] {
                  return std::make_shared<March<D>>(march_from<D>(Domain<D>{*start}, time),
                                                    std::move(changed));
              });
          },
          domain.domain)} {}

double SharedMarch::time() const {
    return std::visit([](const auto& march) { return march->state().time; }, march_);
}

int SharedMarch::slab() const {
    return std::visit([](const auto& march) { return march->state().slab; }, march_);
}

Cap SharedMarch::cap() const {
    return std::visit(
        []<int D>(const std::shared_ptr<March<D>>& march) -> Cap {
            return {std::shared_ptr<const SpatialMesh<D>>{march, &march->state().cap}};
        },
        march_);
}

py::dict SharedMarch::patches() const {
    return std::visit([](const auto& march) { return python::as_dict(march->state().boundary.patches()); },
                      march_);
}

void SharedMarch::require_idle() const {
    if (at_work_ > 0) {
        throw UsageError{"the march is proposing a slab; it cannot be changed meanwhile"};
    }
}

void SharedMarch::move(const std::string& patch, const py::object& motion, const py::object& surface) {
    require_idle();
    std::visit(
        [&]<int D>(const std::shared_ptr<March<D>>& march) {
            const auto numbers = require_patches(march->state().boundary.patches(), patch);
            const MovingPatch<D> moving = moving_patch<D>(motion, surface, patch);
            for (const PatchNumber number : numbers) {
                march->settings().motions[number] = moving;
            }
        },
        march_);
    motions_[py::str(patch)] = motion;
}

void SharedMarch::stretch(const std::vector<std::string>& patches) {
    require_idle();
    std::visit(
        [&]<int D>(const std::shared_ptr<March<D>>& march) {
            std::set<PatchNumber> numbers;
            for (const std::string& name : patches) {
                const auto called = require_patches(march->state().boundary.patches(), name);
                numbers.insert(called.begin(), called.end());
            }
            const StretchPointer<D> together =
                long_call([&] { return harmonic_stretch<D>(march->state().boundary, numbers); });
            for (const PatchNumber number : numbers) {
                march->settings().motions[number] = {nullptr, nullptr, nullptr, together};
            }
        },
        march_);
}

void SharedMarch::configure(const py::kwargs& settings) {
    require_idle();
    std::visit(
        [&]<int D>(const std::shared_ptr<March<D>>& march) {
            change_settings<D>(march->settings(), settings);
        },
        march_);
}

SharedSlab SharedMarch::propose(std::vector<double> times) {
    const AtWork working{at_work_};
    return std::visit(
        [&]<int D>(const std::shared_ptr<March<D>> march) {
            StageClock clock;
            auto slab = long_call(on_progress, [&] {
                return std::make_shared<const Slab<D>>(march->propose(std::move(times), clock));
            });
            return SharedSlab{std::move(slab), march, seconds_by_stage(clock)};
        },
        march_);
}

void SharedMarch::accept(const SharedSlab& slab) {
    require_idle();
    std::visit(
        [&]<int D>(std::shared_ptr<March<D>>& march) {
            if (slab.origin() != march) {
                throw UsageError{
                    fmt::format("the slab was not proposed by this march where it is now, at slab "
                                "{} and t = {}",
                                march->state().slab, march->state().time)};
            }
            const auto& accepted = std::get<D - 2>(slab.any());
            march = long_call([&] { return march_after<D>(*march, *accepted); });
        },
        march_);
}

namespace {

template<class Read>
auto of_slab(Read read) {
    return [read](const SharedSlab& self) {
        return std::visit([&](const auto& slab) { return read(*slab); }, self.any());
    };
}

void bind_slab(py::module_& module) {
    py::class_<SharedSlab>(module, "Slab", "A slab that a march proposed: its hull, and how it was made.")
        .def_property_readonly("hull", &SharedSlab::hull, "The Hull, the boundary of the slab.")
        .def_property_readonly("cap_moved", of_slab([](const auto& slab) { return slab.cap_moved; }),
                               "The terminating cap is the initial one, moved.")
        .def_property_readonly("moved_angle", of_slab([](const auto& slab) { return slab.moved_angle; }),
                               "Smallest angle of the moved cap in degrees, if moving was tried.")
        .def_property_readonly("layers", of_slab([](const auto& slab) { return dict_of_fit(slab.layers); }),
                               "How well the layers follow the motion.")
        .def_property_readonly("layers_enough", of_slab([](const auto& slab) { return slab.layers_enough; }),
                               "A sufficient number of layers if too few were given.")
        .def_property_readonly("adapted", of_slab([](const auto& slab) { return adaptation_of(slab); }),
                               "What was done to the cap with reuse=\"adapt\".")
        .def_property_readonly("seconds", &SharedSlab::seconds, "What each stage took.");
}

py::object step(SharedMarch& march, std::vector<double> times) {
    SharedSlab slab = march.propose(std::move(times));
    march.accept(slab);
    return py::cast(std::move(slab));
}

} // namespace

void bind_march(py::module_& module) {
    bind_slab(module);
    py::class_<SharedMarch>(
        module, "March",
        "Builds slab after slab on a moving domain. Nothing changes until a slab is accepted.")
        .def(py::init([](const StartDomain& domain, double time, const py::dict& motions,
                         const py::object& on_progress, const py::kwargs& settings) {
                 auto march = std::make_unique<SharedMarch>(domain, time, settings);
                 for (const auto& [patch, motion] : motions) {
                     march->move(patch.cast<std::string>(), py::reinterpret_borrow<py::object>(motion),
                                 py::none());
                 }
                 march->on_progress = on_progress;
                 return march;
             }),
             py::arg("domain"), py::arg("time") = 0.0, py::arg("motions") = py::dict{},
             py::arg("on_progress") = py::none(),
             "motions: {patch: motion}, see move(); settings by name, see configure().")
        .def_property_readonly("dimension", &SharedMarch::dimension, "D, that of space.")
        .def_property_readonly("time", &SharedMarch::time, "The time from which the next slab goes.")
        .def_property_readonly("slab", &SharedMarch::slab, "The number of the next slab.")
        .def_property_readonly("cap", &SharedMarch::cap, "The next slab's initial cap.")
        .def_property_readonly("patches", &SharedMarch::patches, "{number: name}")
        .def_property_readonly("motions", &SharedMarch::motions, "The motions as given to move(), by patch.")
        .def_readwrite("on_progress", &SharedMarch::on_progress,
                       "Called as on_progress(text, share) some twenty times a second; False stops the work.")
        .def("move", &SharedMarch::move, py::arg("patch"), py::arg("motion"), py::arg("surface") = py::none(),
             "Says how a patch moves from the next proposal on: a function velocity(x, t) that takes an "
             "(n, D) array of places and returns as many velocities, called once a substep; a Motion; a "
             "TrackMotion; or None. Vertices are projected onto `surface`.")
        .def("stretch", &SharedMarch::stretch, py::arg("patches"),
             "Lets patches stretch between their neighbours.")
        .def("configure", &SharedMarch::configure,
             "Changes settings: split, diagonals, reuse, reuse_angle, adapt_angle, adapt_size, adapt_growth, "
             "cap_size, cap_growth, cap_quality, cap_blocks, cap_mesher, scheme, substeps, tolerance, "
             "motion_start, automatic_layers, layer_tolerance, layer_turn, least_layers, suggest_layers.")
        .def("propose", &SharedMarch::propose, py::arg("times"),
             "Builds the next slab over the levels `times`, the first of which is the march's time.")
        .def("accept", &SharedMarch::accept, py::arg("slab"),
             "Advances to the end of a slab that was proposed from here. The slab stays as it is.")
        .def("step", &step, py::arg("times"), "Proposes a slab and accepts it.");
}

} // namespace slabhull::python
