// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The one place that says the version: CMake reads it here.
#define SLABHULL_VERSION_MAJOR 0
#define SLABHULL_VERSION_MINOR 2
#define SLABHULL_VERSION_PATCH 0
#define SLABHULL_VERSION "0.2.0"
