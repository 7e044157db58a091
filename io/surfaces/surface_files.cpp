// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/files/file_cursor.h"
#include "io/surfaces/surface_guard.h"

#include <OpenMesh/Core/IO/IOManager.hh>
#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/IO/reader/OBJReader.hh>
#include <OpenMesh/Core/IO/reader/OFFReader.hh>
#include <OpenMesh/Core/IO/reader/PLYReader.hh>
#include <OpenMesh/Core/IO/reader/STLReader.hh>
#include <OpenMesh/Core/System/omstream.hh>

#include <algorithm>
#include <fmt/format.h>
#include <mutex>
#include <sstream>

namespace slabhull::io {

namespace {

/// Collects what a reader of OpenMesh finds. Its own importer would build half-edges and drop, without a
/// word, each face that makes the surface non-manifold.
class SoupImporter : public OpenMesh::IO::BaseImporter {
    using Status = OpenMesh::Attributes::StatusInfo;
    using Vertex = OpenMesh::VertexHandle;
    using Halfedge = OpenMesh::HalfedgeHandle;
    using Edge = OpenMesh::EdgeHandle;
    using Face = OpenMesh::FaceHandle;

public:
    Array<Point<3>> points;
    Array<Index> corners;
    bool whole = true; ///< nothing was met but points and triangles that name them

    Vertex add_vertex(const OpenMesh::Vec3f& x) override {
        points.push_back({x[0], x[1], x[2]});
        return Vertex{static_cast<int>(points.size() - 1)};
    }
    Vertex add_vertex() override { return add_vertex(OpenMesh::Vec3f{0, 0, 0}); }
    void set_point(Vertex vertex, const OpenMesh::Vec3f& x) override {
        if (known(vertex)) {
            points[static_cast<std::size_t>(vertex.idx())] = {x[0], x[1], x[2]};
        }
    }
    Face add_face(const VHandles& vertices) override {
        if (vertices.size() != 3) {
            whole = false;
            return Face{};
        }
        for (const Vertex vertex : vertices) {
            corners.push_back(known(vertex) ? static_cast<Index>(vertex.idx()) : no_index);
        }
        return Face{static_cast<int>(n_faces() - 1)};
    }

    size_t n_vertices() const override { return points.size(); }
    size_t n_faces() const override { return corners.size() / 3; }
    size_t n_edges() const override { return 0; }
    bool is_triangle_mesh() const override { return true; }

    // Half-edges and attributes, which no file that passed the guard has.
    Halfedge add_edge(Vertex, Vertex) override { return Halfedge{}; }
    Face add_face(Halfedge) override { return Face{}; }
    void add_face_texcoords(Face, Vertex, const std::vector<OpenMesh::Vec2f>&) override {}
    void add_face_texcoords(Face, Vertex, const std::vector<OpenMesh::Vec3f>&) override {}
    void add_texture_information(int, std::string) override {}
    void request_face_texcoords2D() override {}
    void set_color(Edge, const OpenMesh::Vec3f&) override {}
    void set_color(Edge, const OpenMesh::Vec3uc&) override {}
    void set_color(Edge, const OpenMesh::Vec4f&) override {}
    void set_color(Edge, const OpenMesh::Vec4uc&) override {}
    void set_color(Face, const OpenMesh::Vec3f&) override {}
    void set_color(Face, const OpenMesh::Vec3uc&) override {}
    void set_color(Face, const OpenMesh::Vec4f&) override {}
    void set_color(Face, const OpenMesh::Vec4uc&) override {}
    void set_color(Vertex, const OpenMesh::Vec3f&) override {}
    void set_color(Vertex, const OpenMesh::Vec3uc&) override {}
    void set_color(Vertex, const OpenMesh::Vec4f&) override {}
    void set_color(Vertex, const OpenMesh::Vec4uc&) override {}
    void set_face(Halfedge, Face) override {}
    void set_face_texindex(Face, int) override {}
    void set_halfedge(Vertex, Halfedge) override {}
    void set_next(Halfedge, Halfedge) override {}
    void set_normal(Face, const OpenMesh::Vec3d&) override {}
    void set_normal(Face, const OpenMesh::Vec3f&) override {}
    void set_normal(Vertex, const OpenMesh::Vec3d&) override {}
    void set_normal(Vertex, const OpenMesh::Vec3f&) override {}
    void set_status(Edge, const Status&) override {}
    void set_status(Face, const Status&) override {}
    void set_status(Halfedge, const Status&) override {}
    void set_status(Vertex, const Status&) override {}
    void set_texcoord(Halfedge, const OpenMesh::Vec2f&) override {}
    void set_texcoord(Halfedge, const OpenMesh::Vec3f&) override {}
    void set_texcoord(Vertex, const OpenMesh::Vec2f&) override {}
    void set_texcoord(Vertex, const OpenMesh::Vec3f&) override {}

private:
    bool known(Vertex vertex) const {
        return vertex.idx() >= 0 && static_cast<std::size_t>(vertex.idx()) < points.size();
    }
};

using Guard = GuardedSurface (*)(std::string_view, const std::string&);

struct SurfaceFormat {
    Guard guard;
    OpenMesh::IO::BaseReader& reader;
};

SurfaceFormat format_of(const std::filesystem::path& path, std::string_view extension) {
    if (extension == ".stl") {
        return {guard_stl, OpenMesh::IO::STLReader()};
    }
    if (extension == ".off") {
        return {guard_off, OpenMesh::IO::OFFReader()};
    }
    if (extension == ".obj") {
        return {guard_obj, OpenMesh::IO::OBJReader()};
    }
    if (extension == ".ply") {
        return {guard_ply, OpenMesh::IO::PLYReader()};
    }
    throw InputError(fmt::format("{}: a surface file .stl, .off, .obj or .ply was expected", path.string()));
}

bool import(SoupImporter& importer, OpenMesh::IO::BaseReader& reader, GuardedSurface& guarded) {
    static std::mutex one_at_a_time; // the readers are singletons with a state
    const std::lock_guard lock{one_at_a_time};
    omlog().disable();
    omerr().disable();
    OpenMesh::IO::Options options{guarded.binary ? OpenMesh::IO::Options::Binary
                                                 : OpenMesh::IO::Options::Default};
    std::istringstream stream{std::move(guarded.text)};
    return reader.read(stream, importer, options);
}

/// An STL's facets may collapse when equal vertices are welded; OpenMesh leaves those out.
bool is_as_guarded(const SoupImporter& found, const GuardedSurface& guarded) {
    const bool has_points = !guarded.points.empty();
    const bool complete =
        has_points ? found.n_vertices() == guarded.points.size() && found.n_faces() == guarded.faces
                   : found.n_faces() > 0 && found.n_faces() <= guarded.faces;
    return complete && found.whole &&
           std::find(found.corners.begin(), found.corners.end(), no_index) == found.corners.end();
}

} // namespace

Soup read_surface(const std::filesystem::path& path) {
    return read_surface_as(path, lower_extension(path));
}

Soup read_surface_as(const std::filesystem::path& path, std::string_view extension) {
    const SurfaceFormat format = format_of(path, extension);
    GuardedSurface guarded;
    {
        const Array<char> bytes = read_bytes(path);
        guarded = format.guard({bytes.data(), bytes.size()}, path.string());
    }
    if (guarded.faces == 0) {
        throw InputError(fmt::format("{}: there are no triangles", path.string()));
    }
    SoupImporter found;
    if (!import(found, format.reader, guarded) || !is_as_guarded(found, guarded)) {
        throw InputError(fmt::format("{}: OpenMesh cannot make triangles of it", path.string()));
    }
    Soup soup;
    soup.path = path.string();
    soup.points = guarded.points.empty() ? std::move(found.points) : std::move(guarded.points);
    soup.simplices[2].vertices = std::move(found.corners);
    return soup;
}

} // namespace slabhull::io
