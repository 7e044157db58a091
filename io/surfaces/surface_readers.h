// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/files/file_bytes.h"
#include "io/surfaces/surface_builder.h"

namespace slabhull::io {

// Each reads its file once and throws InputError with the line (or byte) and the face at fault.

void read_stl(FileBytes& file, SurfaceBuilder& surface);
void read_off(FileBytes& file, SurfaceBuilder& surface);
void read_obj(FileBytes& file, SurfaceBuilder& surface);
void read_ply(FileBytes& file, SurfaceBuilder& surface);

} // namespace slabhull::io
