// SPDX-License-Identifier: BSD-3-Clause
#include "python/long_call.h"

namespace slabhull::python {

bool Watch::goes_on(const std::string& stage, std::optional<double> share) {
    const py::gil_scoped_acquire lock;
    if (failure_) {
        return false;
    }
    try {
        if (PyErr_CheckSignals() != 0) {
            throw py::error_already_set{};
        }
        if (told_.is_none() || stage.empty()) {
            return true;
        }
        const py::object answer = told_(stage, share ? py::object{py::float_(*share)} : py::none());
        return answer.ptr() != Py_False;
    } catch (const py::error_already_set&) {
        failure_ = std::current_exception();
        return false;
    }
}

} // namespace slabhull::python
