// SPDX-License-Identifier: BSD-3-Clause
#include "python/long_call.h"

namespace slabhull::python {

void Watch::tell(const RunProgress& run) {
    if (told_.is_none() || run.work.stage.empty()) {
        return;
    }
    const py::gil_scoped_acquire lock;
    if (failure_) {
        return;
    }
    try {
        stopped_ = stopped_ || told_(run).ptr() == Py_False;
    } catch (const py::error_already_set&) {
        failure_ = std::current_exception();
    }
}

void Watch::tell(const WorkState& work) {
    RunProgress run;
    run.work = work;
    run.seconds = since_begin_.seconds();
    tell(run);
}

bool Watch::goes_on() {
    const py::gil_scoped_acquire lock;
    if (!failure_ && PyErr_CheckSignals() != 0) {
        failure_ = std::make_exception_ptr(py::error_already_set{});
    }
    return !failure_ && !stopped_;
}

} // namespace slabhull::python
