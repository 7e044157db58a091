// SPDX-License-Identifier: BSD-3-Clause
// Work in C++ without the interpreter's lock, which Ctrl-C and Python's progress function can stop.
#pragma once

#include "slabhull/core/progress.h"

#include <pybind11/pybind11.h>

#include <atomic>
#include <exception>
#include <optional>
#include <string>

namespace slabhull::python {

namespace py = pybind11;

/// What is asked while C++ works: Python's signals, and a function of Python that is told what goes on.
class Watch {
public:
    /// `told` is called as told(text, share), share None where unknown; it stops the work by returning False
    /// or by an exception. None: nobody is told.
    explicit Watch(py::object told) : told_{std::move(told)} {}

    /// The Progress of the work. Called without the lock, from any thread.
    bool goes_on(const std::string& stage, std::optional<double> share = std::nullopt);

    /// Throws what Python threw, if it did.
    void rethrow() const {
        if (failure_) {
            std::rethrow_exception(failure_);
        }
    }

private:
    py::object told_;
    std::exception_ptr failure_;
};

/// Runs `work` without the interpreter's lock. What Python threw meanwhile comes out unchanged.
template<class Work>
auto long_call(const py::object& told, const Work& work) {
    Watch watch{told};
    try {
        const py::gil_scoped_release released;
        const ProgressScope scope{[&watch](const std::string& stage) { return watch.goes_on(stage); }};
        return work();
    } catch (const Interrupted&) {
        watch.rethrow();
        throw;
    }
}
template<class Work>
auto long_call(const Work& work) {
    return long_call(py::none(), work);
}

} // namespace slabhull::python
