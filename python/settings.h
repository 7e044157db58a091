// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/slab/slab.h"

#include <pybind11/pybind11.h>

namespace slabhull::python {

/// Changes the settings that are named, such as split="A" or cap_size=0.1. Throws UsageError for a name that
/// there is not, listing those that there are, and for values of another kind.
template<int D>
void change_settings(SlabSettings<D>& settings, const pybind11::kwargs& named);

} // namespace slabhull::python
