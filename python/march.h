// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "python/any.h"
#include "python/domain.h"

#include "slabhull/slab/march.h"

#include <pybind11/pybind11.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace slabhull::python {

/// A slab of a march.
class SharedSlab {
public:
    /// `origin` is the march as it was when it proposed the slab.
    SharedSlab(Any<Slab> slab, Owner origin, py::dict seconds)
        : slab_{std::move(slab)}, origin_{std::move(origin)}, seconds_{std::move(seconds)} {}

    const Any<Slab>& any() const { return slab_; }
    const Owner& origin() const { return origin_; }
    const py::dict& seconds() const { return seconds_; }
    /// The SharedHull, always the same one.
    py::object hull();

private:
    Any<Slab> slab_;
    Owner origin_;
    py::dict seconds_;
    py::object hull_;
};

/// A march that Python drives. Its state is shared with views of its cap, so a step makes a new one. Unlike
/// March::accept(), accept() leaves a slab as it is, for Python may look at it as long as it likes.
class SharedMarch {
public:
    template<int D>
    using Pointer = std::shared_ptr<March<D>>;
    using AnyMarch = std::variant<Pointer<2>, Pointer<3>>;

    explicit SharedMarch(AnyMarch march) : march_{std::move(march)} {}
    SharedMarch(const StartDomain& domain, double time, const py::kwargs& settings);

    int dimension() const { return dimension_of(march_); }
    double time() const;
    int slab() const;
    Cap cap() const;
    py::dict patches() const;

    py::dict motions() const { return motions_.attr("copy")(); }
    void move(const std::string& patch, const py::object& motion, const py::object& surface);
    void stretch(const std::vector<std::string>& patches);
    void configure(const py::kwargs& settings);

    SharedSlab propose(std::vector<double> times);
    void accept(const SharedSlab& slab);

    py::object on_progress = py::none();

private:
    void require_idle() const;

    AnyMarch march_;
    py::dict motions_; ///< as given
    int at_work_ = 0;  ///< proposals that other threads, or callers of this one, are making
};

void bind_march(py::module_& module);

} // namespace slabhull::python
