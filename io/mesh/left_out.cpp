// SPDX-License-Identifier: BSD-3-Clause
// Readers and writers of the formats that SLABHULL_FORMATS leaves out: all of them throw, so that programs
// that call them link in every build.
#include "io/mesh/left_out.h"

#include "io/mesh/readers.h"
#include "io/space_time/h5_reader.h"
#include "slabhull/io/files.h"

#include <fmt/format.h>

namespace slabhull::io {

using Path = std::filesystem::path;

void refuse_left_out(std::string_view title, std::string_view name) {
    throw FormatLeftOut{fmt::format("this build has no {} files; configure it with -DSLABHULL_FORMATS=ALL, "
                                    "or with a list that has \"{}\"",
                                    title, name)};
}

#if !SLABHULL_FORMAT_VTK
Soup read_vtk(const Path&) {
    refuse_left_out("legacy VTK", "vtk");
}
Soup read_vtk(const Path&, const ReadOptions&) {
    refuse_left_out("legacy VTK", "vtk");
}
void write_vtk(AtomicFile&, const MeshColumns&) {
    refuse_left_out("legacy VTK", "vtk");
}
#endif

#if !SLABHULL_FORMAT_XDMF // its folder has the HDF5 code
SpaceTimeSoup read_h5(const Path&) {
    refuse_left_out("HDF5", "xdmf");
}
void write_h5(AtomicFile&, const SpaceTimeColumns&) {
    refuse_left_out("HDF5", "xdmf");
}
bool has_hdf5() {
    return false;
}
Soup read_xdmf(const Path&) {
    refuse_left_out("XDMF", "xdmf");
}
Soup read_xdmf(const Path&, const ReadOptions&) {
    refuse_left_out("XDMF", "xdmf");
}
void write_xdmf(AtomicFiles&, const Path&, const MeshColumns&) {
    refuse_left_out("XDMF", "xdmf");
}
void write_xdmf(const Path&, const MeshColumns&) {
    refuse_left_out("XDMF", "xdmf");
}
#endif

#if !SLABHULL_FORMAT_TETGEN
Soup read_tetgen(const Path&) {
    refuse_left_out("TetGen", "tetgen");
}
Soup read_tetgen(const Path&, const ReadOptions&) {
    refuse_left_out("TetGen", "tetgen");
}
void write_tetgen(AtomicFiles&, const Path&, const MeshColumns&) {
    refuse_left_out("TetGen", "tetgen");
}
void write_tetgen(const Path&, const MeshColumns&) {
    refuse_left_out("TetGen", "tetgen");
}
#endif

#if !SLABHULL_FORMAT_MEDIT
Soup read_medit(const Path&) {
    refuse_left_out("Medit", "medit");
}
Soup read_medit(const Path&, const ReadOptions&) {
    refuse_left_out("Medit", "medit");
}
void write_medit(AtomicFile&, const MeshColumns&, const MeditOptions&) {
    refuse_left_out("Medit", "medit");
}
void write_medit(const Path&, const MeshColumns&, const MeditOptions&) {
    refuse_left_out("Medit", "medit");
}
#endif

#if !SLABHULL_FORMAT_MFEM
Soup read_mfem(const Path&) {
    refuse_left_out("MFEM", "mfem");
}
void write_mfem(AtomicFile&, const MeshColumns&) {
    refuse_left_out("MFEM", "mfem");
}
void write_mfem(const Path&, const MeshColumns&) {
    refuse_left_out("MFEM", "mfem");
}
#endif

#if !SLABHULL_FORMAT_AVRO
Soup read_avro(const Path&) {
    refuse_left_out("avro", "avro");
}
void write_avro(AtomicFile&, const MeshColumns&) {
    refuse_left_out("avro", "avro");
}
void write_avro(const Path&, const MeshColumns&) {
    refuse_left_out("avro", "avro");
}
#endif

} // namespace slabhull::io
