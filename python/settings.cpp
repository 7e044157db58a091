// SPDX-License-Identifier: BSD-3-Clause
#include "python/settings.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/trajectory.h"
#include "slabhull/topology/prism_split.h"

#include <fmt/format.h>

#include <functional>
#include <map>
#include <string>
#include <utility>

namespace slabhull::python {

namespace py = pybind11;

namespace {

template<class T>
T value_of(const std::string& name, const py::handle& value, const char* expected) {
    try {
        return value.cast<T>();
    } catch (const py::cast_error&) {
        throw UsageError{
            fmt::format("{}: expected {}, not {}", name, expected, py::repr(value).cast<std::string>())};
    }
}
double number(const std::string& name, const py::handle& value) {
    return value_of<double>(name, value, "a number");
}
int whole(const std::string& name, const py::handle& value) {
    return value_of<int>(name, value, "a whole number");
}
bool truth(const std::string& name, const py::handle& value) {
    return value_of<bool>(name, value, "True or False");
}
std::string text(const std::string& name, const py::handle& value) {
    return value_of<std::string>(name, value, "a text");
}

template<class T>
T choice(const std::string& name, const py::handle& value, const std::map<std::string, T>& choices) {
    const auto found = choices.find(text(name, value));
    if (found == choices.end()) {
        std::string known;
        for (const auto& [each, meaning] : choices) {
            known += (known.empty() ? "\"" : ", \"") + each + "\"";
        }
        throw UsageError{fmt::format("{}: expected one of {}, not \"{}\"", name, known, text(name, value))};
    }
    return found->second;
}

template<int D>
using Setter =
    std::function<void(SlabSettings<D>& settings, const std::string& name, const py::handle& value)>;

template<int D>
std::map<std::string, Setter<D>> setters_of_motion() {
    using Settings = SlabSettings<D>;
    return {
        {"motion_start", [](Settings& s, const auto& n, const auto& v) { s.motion_start = number(n, v); }},
        {"scheme", [](Settings& s, const auto& n,
                      const auto& v) { s.trajectory.scheme = scheme_from_name(text(n, v)); }},
        {"substeps", [](Settings& s, const auto& n, const auto& v) { s.trajectory.substeps = whole(n, v); }},
        {"tolerance",
         [](Settings& s, const auto& n, const auto& v) { s.trajectory.tolerance = number(n, v); }},
        {"automatic_layers",
         [](Settings& s, const auto& n, const auto& v) { s.layers.automatic = truth(n, v); }},
        {"layer_tolerance",
         [](Settings& s, const auto& n, const auto& v) { s.layers.tolerance = number(n, v); }},
        {"layer_turn", [](Settings& s, const auto& n, const auto& v) { s.layers.turn = number(n, v); }},
        {"least_layers", [](Settings& s, const auto& n, const auto& v) { s.layers.at_least = whole(n, v); }},
        {"suggest_layers", [](Settings& s, const auto& n, const auto& v) { s.layers.suggest = truth(n, v); }},
    };
}

template<int D>
std::map<std::string, Setter<D>> setters_of_mesh() {
    using Settings = SlabSettings<D>;
    return {
        {"split",
         [](Settings& s, const auto& n, const auto& v) { s.side.split = split_from_name(text(n, v), D); }},
        {"diagonals",
         [](Settings& s, const auto& n, const auto& v) {
             s.side.diagonals = choice<Diagonals>(
                 n, v, {{"shape", Diagonals::shape}, {"smallest-id", Diagonals::smallest_id}});
         }},
        {"reuse",
         [](Settings& s, const auto& n, const auto& v) {
             s.reuse = choice<CapReuse>(
                 n, v, {{"none", CapReuse::none}, {"move", CapReuse::move}, {"adapt", CapReuse::adapt}});
         }},
        {"reuse_angle", [](Settings& s, const auto& n, const auto& v) { s.reuse_angle = number(n, v); }},
        {"adapt_angle", [](Settings& s, const auto& n, const auto& v) { s.adapt.angle = number(n, v); }},
        {"adapt_size", [](Settings& s, const auto& n, const auto& v) { s.adapt.size = number(n, v); }},
        {"adapt_growth", [](Settings& s, const auto& n, const auto& v) { s.adapt.growth = number(n, v); }},
        {"cap_size", [](Settings& s, const auto& n, const auto& v) { s.cap.grading.largest = number(n, v); }},
        {"cap_growth",
         [](Settings& s, const auto& n, const auto& v) { s.cap.grading.growth = number(n, v); }},
        {"cap_quality", [](Settings& s, const auto& n, const auto& v) { s.cap.radius_edge = number(n, v); }},
        {"cap_blocks", [](Settings& s, const auto& n, const auto& v) { s.cap.blocks = whole(n, v); }},
        {"cap_mesher",
         [](Settings& s, const auto& n, const auto& v) {
             s.cap.mesher =
                 choice<SolidMesher>(n, v, {{"tetgen", SolidMesher::tetgen}, {"hxt", SolidMesher::hxt}});
         }},
    };
}

template<int D>
const std::map<std::string, Setter<D>>& setters() {
    static const auto all = [] {
        auto both = setters_of_motion<D>();
        both.merge(setters_of_mesh<D>());
        return both;
    }();
    return all;
}

} // namespace

template<int D>
void change_settings(SlabSettings<D>& settings, const py::kwargs& named) {
    SlabSettings<D> changed = settings; // all or nothing
    for (const auto& [key, value] : named) {
        const auto name = key.template cast<std::string>();
        const auto found = setters<D>().find(name);
        if (found == setters<D>().end()) {
            std::string known;
            for (const auto& [each, setter] : setters<D>()) {
                known += (known.empty() ? "" : ", ") + each;
            }
            throw UsageError{fmt::format("there is no setting \"{}\"; there are {}", name, known)};
        }
        found->second(changed, name, value);
    }
    settings = std::move(changed);
}

template void change_settings<2>(SlabSettings<2>&, const py::kwargs&);
template void change_settings<3>(SlabSettings<3>&, const py::kwargs&);

} // namespace slabhull::python
