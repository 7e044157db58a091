// SPDX-License-Identifier: BSD-3-Clause
// All that a solver needs, which links Slabhull::slab: domain and motion to checked hulls. Case files and
// their runs are in slabhull/cases, files in slabhull/io.
#pragma once

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/vector.h"
#include "slabhull/core/version.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/geometry/shapes.h"
#include "slabhull/slab/check.h"
#include "slabhull/slab/check_embedding.h"
#include "slabhull/slab/domain.h"
#include "slabhull/slab/march.h"
#include "slabhull/slab/slice.h"
#include "slabhull/slab/tangling.h"
