// SPDX-License-Identifier: BSD-3-Clause
#include "python/motions.h"

#include "python/arrays.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/motion.h"
#include "slabhull/geometry/nodal_motion.h"
#include "slabhull/geometry/projection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace slabhull::python {

namespace {

/// A function of Python that C++ may drop without the interpreter's lock.
using Function = std::shared_ptr<const py::object>;

Function shared_function(const py::object& function) {
    return {new py::object{function}, [](const py::object* dropped) {
                const py::gil_scoped_acquire lock;
                delete dropped;
            }};
}

template<int D>
bool is_finite(const Point<D>& x) {
    return std::all_of(x.begin(), x.end(), [](double part) { return std::isfinite(part); });
}

/// Whether all are finite. Without a branch in the loop, so that it runs on vectors.
template<int D>
bool all_finite(std::span<const Point<D>> x) {
    bool finite = true;
    for (const Point<D>& point : x) {
        for (const double part : point) {
            finite &= std::abs(part) <= std::numeric_limits<double>::max();
        }
    }
    return finite;
}

/// A copy for Python, which may keep it.
template<int D>
py::array_t<double> copy_of(std::span<const Point<D>> x) {
    py::array_t<double> copy{{static_cast<py::ssize_t>(x.size()), static_cast<py::ssize_t>(D)}};
    std::copy_n(x.data()->data(), x.size() * D, copy.mutable_data());
    return copy;
}

/// Takes an (n, D) array that a function returned; `what` is what messages call it.
template<int D>
void take(const py::object& returned, const std::string& what, std::span<Point<D>> out) {
    const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(returned);
    if (!array) {
        throw UsageError{fmt::format("{} is no array of numbers but a {}", what,
                                     py::str(py::type::of(returned).attr("__name__")).cast<std::string>())};
    }
    if (array.ndim() != 2 || array.shape(0) != static_cast<py::ssize_t>(out.size()) || array.shape(1) != D) {
        throw UsageError{fmt::format("{} must have the shape ({}, {}), not ({})", what, out.size(), D,
                                     fmt::join(array.shape(), array.shape() + array.ndim(), ", "))};
    }
    std::copy_n(array.data(), array.size(), out.data()->data());
}

/// The velocity field of a function of Python.
template<int D>
class CallableMotion final : public Motion<D> {
public:
    CallableMotion(const py::object& function, const std::string& patch)
        : function_{shared_function(function)}, what_{fmt::format("the velocity of patch \"{}\"", patch)} {}

    void velocity(std::span<const Point<D>> x, double t, std::span<Point<D>> v) const override {
        if (x.empty()) {
            return;
        }
        call(x, t, v);
        if (!all_finite<D>(v)) {
            refuse(x, t, v);
        }
    }
    std::optional<AffineMap<D>> map(double, double) const override { return std::nullopt; }
    bool in_one_call() const override { return true; }

private:
    [[noreturn]] void refuse(std::span<const Point<D>> x, double t, std::span<const Point<D>> v) const {
        const auto bad = std::find_if_not(v.begin(), v.end(), is_finite<D>);
        const Point<D>& place = x[static_cast<std::size_t>(bad - v.begin())];
        throw GeometryError{fmt::format("{} is ({}) at the point ({}) at t = {}", what_,
                                        fmt::join(*bad, ", "), fmt::join(place, ", "), t)};
    }
    void call(std::span<const Point<D>> x, double t, std::span<Point<D>> v) const {
        const py::gil_scoped_acquire lock;
        take<D>((*function_)(copy_of<D>(x), t), what_, v);
    }

    Function function_;
    std::string what_;
};

/// The motion of tracks of a function of Python.
template<int D>
class CallableTracks final : public NodalMotion<D> {
public:
    CallableTracks(const py::object& function, const std::string& patch)
        : function_{shared_function(function)}, what_{fmt::format("the positions of patch \"{}\"", patch)} {}

    void positions(std::span<const TrackId> tracks, double t, std::span<Point<D>> x) const override {
        if (tracks.empty()) {
            return;
        }
        call(tracks, t, x);
        const auto bad = std::find_if_not(x.begin(), x.end(), is_finite<D>);
        if (bad != x.end()) {
            throw GeometryError{fmt::format("{} are ({}) for track {} at t = {}", what_,
                                            fmt::join(*bad, ", "), tracks[std::size_t(bad - x.begin())], t)};
        }
    }

private:
    void call(std::span<const TrackId> tracks, double t, std::span<Point<D>> x) const {
        const py::gil_scoped_acquire lock;
        py::array_t<TrackId> numbers{static_cast<py::ssize_t>(tracks.size())};
        std::copy(tracks.begin(), tracks.end(), numbers.mutable_data());
        take<D>((*function_)(numbers, t), what_, x);
    }

    Function function_;
    std::string what_;
};

// --- the library's motions, their dimension that of the numbers given

template<int D>
Point<D> point_of(const std::vector<double>& numbers, const char* name) {
    if (numbers.size() != D) {
        throw UsageError{fmt::format("{} must have {} numbers, not {}", name, D, numbers.size())};
    }
    Point<D> point{};
    std::copy(numbers.begin(), numbers.end(), point.begin());
    return point;
}

template<class Make>
FieldMotion motion_in(std::size_t dimension, const Make& make) {
    return with_dimension(static_cast<int>(dimension),
                          [&](auto d) -> FieldMotion { return {MotionPointer<d()>{make(d)}}; });
}

FieldMotion make_rotation(const std::vector<double>& centre, double rate, const std::vector<double>& axis) {
    return motion_in(centre.size(), [&](auto d) {
        constexpr int D = d();
        const Point<D> turned_about = D == 3 ? point_of<D>(axis, "axis") : Point<D>{};
        return rotation<D>(turned_about, point_of<D>(centre, "centre"), rate);
    });
}

FieldMotion make_translation(const std::vector<double>& velocity) {
    return motion_in(velocity.size(),
                     [&](auto d) { return translation<d()>(point_of<d()>(velocity, "velocity")); });
}

FieldMotion make_expansion(const std::vector<double>& centre, double rate, double start) {
    return motion_in(centre.size(),
                     [&](auto d) { return expansion<d()>(point_of<d()>(centre, "centre"), rate, start); });
}

FieldMotion make_formula(const std::vector<std::string>& formulas,
                         const std::map<std::string, double>& constants) {
    return motion_in(formulas.size(), [&](auto d) {
        std::array<std::string, d()> parts;
        std::copy(formulas.begin(), formulas.end(), parts.begin());
        return formula_velocity<d()>(parts, constants);
    });
}

/// Steps in a domain of dimension D; the first may be a function.
template<int D>
MotionPointer<D> sequence_of(const std::vector<py::object>& steps, double start) {
    std::vector<MotionPointer<D>> motions;
    for (const py::object& step : steps) {
        motions.push_back(
            moving_patch<D>(step, py::none(), fmt::format("step {}", motions.size() + 1)).motion);
    }
    return sequence<D>(std::move(motions), start);
}

FieldMotion make_sequence(const std::vector<py::object>& steps, double start) {
    const auto known = std::find_if(steps.begin(), steps.end(),
                                    [](const py::object& step) { return py::isinstance<FieldMotion>(step); });
    if (known == steps.end()) {
        throw UsageError{"a sequence needs a step that is no function, such as a rotation"};
    }
    const int dimension = dimension_of(known->cast<const FieldMotion&>().motion);
    return motion_in(static_cast<std::size_t>(dimension),
                     [&](auto d) { return sequence_of<d()>(steps, start); });
}

// --- surfaces

template<class Make>
Projection surface_in(std::size_t dimension, const Make& make) {
    return with_dimension(static_cast<int>(dimension),
                          [&](auto d) -> Projection { return {ProjectionSurfacePointer<d()>{make(d)}}; });
}

Projection make_sphere(const std::vector<double>& centre, double radius) {
    return surface_in(centre.size(),
                      [&](auto d) { return sphere_surface<d()>(point_of<d()>(centre, "centre"), radius); });
}

Projection make_ellipsoid(const std::vector<double>& centre, const std::vector<double>& semi_axes) {
    return surface_in(centre.size(), [&](auto d) {
        return ellipsoid_surface<d()>(point_of<d()>(centre, "centre"), point_of<d()>(semi_axes, "semi_axes"));
    });
}

Projection make_cylinder(const std::vector<double>& centre, const std::vector<double>& axis, double radius) {
    return {cylinder_surface(point_of<3>(centre, "centre"), point_of<3>(axis, "axis"), radius)};
}

Projection make_plane(const std::vector<double>& point, const std::vector<double>& normal) {
    return surface_in(point.size(), [&](auto d) {
        return plane_surface<d()>(point_of<d()>(point, "point"), point_of<d()>(normal, "normal"));
    });
}

void bind_surfaces(py::module_& module) {
    py::class_<Projection>(module, "Projection", "A surface that the vertices of a patch are projected onto.")
        .def_property_readonly(
            "dimension", [](const Projection& self) { return dimension_of(self.surface); },
            "D, that of space.");
    module.def("sphere", make_sphere, py::arg("centre"), py::arg("radius"), "A sphere, in 2D a circle.");
    module.def("ellipsoid", make_ellipsoid, py::arg("centre"), py::arg("semi_axes"),
               "An ellipsoid or ellipse with its axes along the coordinate axes.");
    module.def("cylinder", make_cylinder, py::arg("centre"), py::arg("axis"), py::arg("radius"),
               "An infinite circular cylinder.");
    module.def("plane", make_plane, py::arg("point"), py::arg("normal"), "A plane, in 2D a line.");
}

} // namespace

template<int D>
MovingPatch<D> moving_patch(const py::object& motion, const py::object& surface, const std::string& name) {
    MovingPatch<D> moving;
    if (!surface.is_none()) {
        moving.surface = of_dimension<D>(surface.cast<const Projection&>().surface, "the surface");
    }
    if (motion.is_none()) {
        moving.motion = standing<D>();
    } else if (py::isinstance<FieldMotion>(motion)) {
        moving.motion = of_dimension<D>(motion.cast<const FieldMotion&>().motion, "the motion");
    } else if (py::isinstance<TrackMotion>(motion)) {
        moving.nodal = std::make_shared<CallableTracks<D>>(motion.cast<const TrackMotion&>().positions, name);
    } else if (PyCallable_Check(motion.ptr()) != 0) {
        moving.motion = std::make_shared<CallableMotion<D>>(motion, name);
    } else {
        throw UsageError{
            fmt::format("patch \"{}\": a motion is a function velocity(x, t), one of slabhull.rotation() "
                        "and the like, or None, not a {}",
                        name, py::str(py::type::of(motion).attr("__name__")).cast<std::string>())};
    }
    if (moving.surface != nullptr && moving.motion != nullptr && !moving.motion->map(0, 0)) {
        throw UsageError{fmt::format("patch \"{}\": a surface moves with its patch's motion, and a function "
                                     "or formula does not say how a surface moves",
                                     name)};
    }
    return moving;
}

void bind_motions(py::module_& module) {
    py::class_<FieldMotion>(module, "Motion", "A motion of the library, for March.move().")
        .def_property_readonly(
            "dimension", [](const FieldMotion& self) { return dimension_of(self.motion); },
            "D, that of space.");
    py::class_<TrackMotion>(module, "TrackMotion", "A motion of each track: see track_motion().")
        .def_readonly("positions", &TrackMotion::positions, "The function that was given.");
    module.def("rotation", make_rotation, py::arg("centre"), py::arg("rate"),
               py::arg("axis") = std::vector<double>{0, 0, 1},
               "Turns about the axis through `centre`, right-handed, by `rate` radians per unit of time; "
               "in 2D counter-clockwise.");
    module.def("translation", make_translation, py::arg("velocity"), "Moves along at a constant velocity.");
    module.def("expansion", make_expansion, py::arg("centre"), py::arg("rate"), py::arg("start") = 0.0,
               "Scaling: x0 at `start` is at centre + (1 + rate (t - start)) (x0 - centre) at t.");
    module.def("formula", make_formula, py::arg("formulas"),
               py::arg("constants") = std::map<std::string, double>{},
               "A velocity by a formula for each component, in x, y, (z,) t, as in case files.");
    module.def("sequence", make_sequence, py::arg("steps"), py::arg("start") = 0.0,
               "Motions in moving frames, the innermost first, which alone may be a function.");
    module.def(
        "track_motion", [](const py::function& positions) { return TrackMotion{positions}; },
        py::arg("positions"),
        "The motion of a function positions(tracks, t): the places, (n, D), of vertices by track numbers.");
    bind_surfaces(module);
}

template MovingPatch<2> moving_patch<2>(const py::object&, const py::object&, const std::string&);
template MovingPatch<3> moving_patch<3>(const py::object&, const py::object&, const std::string&);

} // namespace slabhull::python
