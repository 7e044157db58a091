// SPDX-License-Identifier: BSD-3-Clause
// Work in C++ without the interpreter's lock, which Ctrl-C and Python's progress function can stop.
#pragma once

#include "slabhull/core/message.h"
#include "slabhull/core/progress.h"
#include "slabhull/core/stopwatch.h"

#include <pybind11/pybind11.h>

#include <atomic>
#include <exception>
#include <utility>

namespace slabhull::python {

namespace py = pybind11;

/// What is asked while C++ works: Python's signals, and a function of Python that is told what goes on.
class Watch {
public:
    /// `told` is called with a RunProgress; it stops the work by returning False or by an exception. None:
    /// nobody is told.
    explicit Watch(py::object told) : told_{std::move(told)} {}

    // Called without the lock, from any thread.
    /// Tells how far the work has come.
    void tell(const RunProgress& run);
    void tell(const WorkState& work);
    /// Whether to go on: Python had no signal, and whoever was told did not stop the work.
    bool goes_on();

    /// Throws what Python threw, if it did.
    void rethrow() const {
        if (failure_) {
            std::rethrow_exception(failure_);
        }
    }

private:
    py::object told_;
    std::exception_ptr failure_;
    bool stopped_ = false;
    Stopwatch since_begin_;
};

/// Runs `work` without the interpreter's lock, watched by `progress`. What Python threw meanwhile comes out
/// unchanged.
template<class Work>
auto long_call(const Watch& watch, Progress progress, const Work& work) {
    try {
        const py::gil_scoped_release released;
        const ProgressScope scope{std::move(progress)};
        return work();
    } catch (const Interrupted&) {
        watch.rethrow();
        throw;
    }
}
/// The same, with `told` hearing of the stages.
template<class Work>
auto long_call(const py::object& told, const Work& work) {
    Watch watch{told};
    const auto tell = [&watch](const WorkState& state) {
        watch.tell(state);
        return watch.goes_on();
    };
    return long_call(watch, tell, work);
}
template<class Work>
auto long_call(const Work& work) {
    return long_call(py::none(), work);
}

} // namespace slabhull::python
