// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/files/file_cursor.h"
#include "io/mesh/content_advice.h"
#include "io/surfaces/surface_readers.h"

#include <fmt/format.h>

namespace slabhull::io {

namespace {

using Reader = void (*)(FileBytes&, SurfaceBuilder&);

Reader reader_of(const std::filesystem::path& path, std::string_view extension) {
    if (extension == ".stl") {
        return read_stl;
    }
    if (extension == ".off") {
        return read_off;
    }
    if (extension == ".obj") {
        return read_obj;
    }
    if (extension == ".ply") {
        return read_ply;
    }
    throw InputError(fmt::format("{}: a surface file .stl, .off, .obj or .ply, or a mesh of triangles (.msh, "
                                 ".vtu ..), was expected; export one",
                                 path.string()));
}

} // namespace

Soup read_surface(const std::filesystem::path& path) {
    return read_surface_as(path, lower_extension(path));
}

Soup read_surface_as(const std::filesystem::path& path, std::string_view extension) {
    const Reader read = reader_of(path, extension);
    FileBytes file{path};
    SurfaceBuilder surface;
    try {
        read(file, surface);
    } catch (const InputError& error) {
        const std::string advice = content_advice(path, extension.substr(1));
        throw InputError(error.what() + advice, error.entities);
    }
    if (surface.triangles() == 0) {
        throw InputError(fmt::format("{}: there are no triangles", path.string()));
    }
    return surface.finish(path.string());
}

} // namespace slabhull::io
