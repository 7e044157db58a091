// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The one place that says the version: CMake reads it here.
#define SLABHULL_VERSION_MAJOR 0
#define SLABHULL_VERSION_MINOR 2
#define SLABHULL_VERSION_PATCH 0

#define SLABHULL_TEXT_OF(number) #number
#define SLABHULL_DOTTED(major, minor, patch)                                                                 \
    SLABHULL_TEXT_OF(major) "." SLABHULL_TEXT_OF(minor) "." SLABHULL_TEXT_OF(patch)
#define SLABHULL_VERSION                                                                                     \
    SLABHULL_DOTTED(SLABHULL_VERSION_MAJOR, SLABHULL_VERSION_MINOR, SLABHULL_VERSION_PATCH)
