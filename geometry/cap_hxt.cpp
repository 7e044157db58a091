// SPDX-License-Identifier: BSD-3-Clause
// HXT (C. Marot, J. Pellerin, J.-F. Remacle, IJNME 117(9), 2019), the Delaunay mesher in Gmsh, for 3D caps.
// With two threads its meshes are broken now and then, so it gets one. Gmsh is opened in the child process
// that meshes: it brings ninety libraries along, and keeps global state.
#include "solid_mesher.h"

#include "components.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/measures.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <gmshc.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

/// Statuses that the child sends.
constexpr std::int32_t no_library = 1;
constexpr std::int32_t gmsh_failed = 2;

constexpr int triangle_type = 2; // Gmsh's numbers
constexpr int tetrahedron_type = 4;
constexpr int hxt_algorithm = 10;

struct GmshFailed {};

/// Gmsh's C functions by name; the last argument of each, an error, is checked here.
class Gmsh {
public:
    explicit Gmsh(void* library) : library_{library} {}

    template<class Function, class... Arguments>
    auto call(const char* name, Arguments... arguments) const {
        auto* function = reinterpret_cast<Function*>(dlsym(library_, name));
        if (function == nullptr) {
            throw GmshFailed{};
        }
        int error = 0;
        if constexpr (std::is_void_v<decltype(function(arguments..., &error))>) {
            function(arguments..., &error);
            require(error);
        } else {
            const auto result = function(arguments..., &error);
            require(error);
            return result;
        }
    }

    void set(const char* option, double value) const {
        call<decltype(gmshOptionSetNumber)>("gmshOptionSetNumber", option, value);
    }

private:
    static void require(int error) {
        if (error != 0) {
            throw GmshFailed{};
        }
    }
    void* library_;
};

/// The mean edge of HXT's cells is longer than the spacing it is asked for by this factor.
constexpr double stretch = 1.24;

double wanted_size(int, int, double x, double y, double z, void* field) {
    return (*static_cast<const SizeField<3>*>(field))({x, y, z}) / stretch;
}

void set_options(const Gmsh& gmsh, const SizeField<3>& size) {
    for (const auto& [option, value] : {std::pair{"General.Terminal", 0.0},
                                        {"General.NumThreads", 1.0},
                                        {"Mesh.MaxNumThreads3D", 1.0},
                                        {"Mesh.Algorithm3D", 1.0 * hxt_algorithm},
                                        {"Mesh.MeshSizeExtendFromBoundary", 0.0},
                                        {"Mesh.MeshSizeFromPoints", 0.0}}) {
        gmsh.set(option, value);
    }
    gmsh.call<decltype(gmshModelMeshSetSizeCallback)>("gmshModelMeshSetSizeCallback", wanted_size,
                                                      const_cast<SizeField<3>*>(&size));
}

/// Adds one closed component of the surface as a discrete entity, and a loop around or in the volume of it.
int add_component(const Gmsh& gmsh, const Surface<3>& surface, int tag, const std::vector<Index>& facets) {
    gmsh.call<decltype(gmshModelAddDiscreteEntity)>("gmshModelAddDiscreteEntity", 2, tag,
                                                    static_cast<int*>(nullptr), std::size_t{0});
    std::vector<std::size_t> corners;
    for (const Index f : facets) {
        for (const Index v : surface.facets[f]) {
            corners.push_back(v + std::size_t{1});
        }
    }
    std::vector<std::size_t> nodes = corners;
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    std::vector<double> coordinates;
    for (const std::size_t node : nodes) {
        const Point<3>& p = surface.points[node - 1];
        coordinates.insert(coordinates.end(), p.begin(), p.end());
    }
    gmsh.call<decltype(gmshModelMeshAddNodes)>("gmshModelMeshAddNodes", 2, tag, nodes.data(), nodes.size(),
                                               coordinates.data(), coordinates.size(),
                                               static_cast<double*>(nullptr), std::size_t{0});
    gmsh.call<decltype(gmshModelMeshAddElementsByType)>("gmshModelMeshAddElementsByType", tag, triangle_type,
                                                        static_cast<std::size_t*>(nullptr), std::size_t{0},
                                                        corners.data(), corners.size());
    return gmsh.call<decltype(gmshModelGeoAddSurfaceLoop)>("gmshModelGeoAddSurfaceLoop", &tag, std::size_t{1},
                                                           -1);
}

/// The surface, and the volume that its components bound. Nodes have the points' numbers, from 1.
void add_domain(const Gmsh& gmsh, const Surface<3>& surface, const Components& parts) {
    gmsh.call<decltype(gmshModelAdd)>("gmshModelAdd", "cap");
    std::vector<std::vector<Index>> facets(parts.count());
    for (Index f = 0; f < surface.facets.size(); ++f) {
        facets[parts.of_facet[f]].push_back(f);
    }
    std::vector<int> loops;
    for (std::size_t part = 0; part < facets.size(); ++part) {
        loops.push_back(add_component(gmsh, surface, static_cast<int>(part) + 1, facets[part]));
    }
    gmsh.call<decltype(gmshModelGeoAddVolume)>("gmshModelGeoAddVolume", loops.data(), loops.size(), 1);
    gmsh.call<decltype(gmshModelGeoSynchronize)>("gmshModelGeoSynchronize");
}

/// New points after those of the surface, and cells positively oriented.
CapMesh<3> result_of(const Gmsh& gmsh) {
    std::size_t* tags = nullptr;
    std::size_t tag_count = 0;
    double* coordinates = nullptr;
    std::size_t coordinate_count = 0;
    double* parameters = nullptr;
    std::size_t parameter_count = 0;
    gmsh.call<decltype(gmshModelMeshGetNodes)>("gmshModelMeshGetNodes", &tags, &tag_count, &coordinates,
                                               &coordinate_count, &parameters, &parameter_count, -1, -1, 0,
                                               0);
    CapMesh<3> mesh;
    std::vector<std::pair<std::size_t, std::size_t>> order; // tag, place
    for (std::size_t k = 0; k < tag_count; ++k) {
        order.emplace_back(tags[k], k);
    }
    std::sort(order.begin(), order.end());
    std::vector<Index> number(order.empty() ? 1 : order.back().first + 1, no_index);
    for (const auto& [tag, place] : order) {
        number[tag] = static_cast<Index>(mesh.points.size());
        const double* p = coordinates + 3 * place;
        mesh.points.push_back({p[0], p[1], p[2]});
    }
    std::size_t* corners = nullptr;
    std::size_t corner_count = 0;
    gmsh.call<decltype(gmshModelMeshGetElementsByType)>("gmshModelMeshGetElementsByType", tetrahedron_type,
                                                        &tags, &tag_count, &corners, &corner_count, -1,
                                                        std::size_t{0}, std::size_t{1});
    mesh.cells.resize(corner_count / 4);
    for (std::size_t k = 0; k < corner_count; ++k) {
        mesh.cells[k / 4][k % 4] = number[corners[k]];
    }
    if (!mesh.cells.empty() && signed_measure<3>(corners_of<3, 3>(mesh.cells[0], mesh.points)) < 0) {
        for (Simplex<3>& cell : mesh.cells) {
            std::swap(cell[0], cell[1]);
        }
    }
    return mesh;
}

void send_status(const Send& send, std::int32_t status) {
    const MesherHeading heading{status, 0, 0, 0};
    send(&heading, sizeof heading);
}

void mesh_and_send(const Surface<3>& surface, const Components& parts, const SizeField<3>& size,
                   const Send& send) {
    // Gmsh has an older TetGen inside: without DEEPBIND it would call ours, and crash.
    void* library = dlopen(SLABHULL_GMSH_SONAME, RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
    if (library == nullptr) {
        return send_status(send, no_library);
    }
    try {
        const Gmsh gmsh{library};
        std::string program = "slabhull"; // Gmsh reads its name
        char* arguments = program.data();
        gmsh.call<decltype(gmshInitialize)>("gmshInitialize", 1, &arguments, 0);
        set_options(gmsh, size);
        add_domain(gmsh, surface, parts);
        gmsh.call<decltype(gmshModelMeshGenerate)>("gmshModelMeshGenerate", 3);
        const CapMesh<3> mesh = result_of(gmsh);
        const MesherHeading heading{0, static_cast<std::int64_t>(mesh.points.size()),
                                    static_cast<std::int64_t>(mesh.cells.size()), 0};
        send(&heading, sizeof heading);
        send(mesh.points.data(), mesh.points.size() * sizeof mesh.points[0]);
        send(mesh.cells.data(), mesh.cells.size() * sizeof mesh.cells[0]);
    } catch (const GmshFailed&) {
        send_status(send, gmsh_failed);
    }
}

std::string status_in_words(std::int32_t status) {
    return status == no_library ? "is not there: cannot open " SLABHULL_GMSH_SONAME
                                : "Gmsh's HXT, gave up; it does so on a surface that crosses itself, or for "
                                  "want of memory";
}

} // namespace

bool has_hxt() {
    return true;
}

CapMesh<3> fill_with_hxt(const Surface<3>& surface, const SizeField<3>& size, const CapOptions&) {
    const Components parts =
        find_components(surface, build_adjacency<2>(surface.facets, surface.points.size()));
    return fill_in_child(
        surface, [&](const Send& send) { mesh_and_send(surface, parts, size, send); }, status_in_words);
}

} // namespace slabhull
