// SPDX-License-Identifier: BSD-3-Clause
// HXT (C. Marot, J. Pellerin, J.-F. Remacle, IJNME 117(9), 2019), the Delaunay mesher in Gmsh, for 3D caps.
// With two threads its meshes are sometimes broken, so it gets one. Gmsh is opened in the child process that
// meshes, since it loads ninety libraries and keeps global state.
#include "geometry/meshing/solid_mesher.h"

#include "geometry/embedding/components.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <gmshc.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

/// Status codes of the child.
constexpr std::int32_t no_library = 1;
constexpr std::int32_t gmsh_failed = 2;

constexpr int triangle_type = 2; // Gmsh's numbers
constexpr int tetrahedron_type = 4;
constexpr int hxt_algorithm = 10;

struct GmshFailed {
    std::string said;
};

/// Gmsh's C functions by name; their last argument, an error code, is checked here.
class Gmsh {
public:
    explicit Gmsh(void* library) : library_{library} {}

    template<class Function, class... Arguments>
    auto call(const char* name, Arguments... arguments) const {
        auto* function = reinterpret_cast<Function*>(dlsym(library_, name));
        if (function == nullptr) {
            throw GmshFailed{std::string{"it has no "} + name};
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
    void require(int error) const {
        if (error == 0) {
            return;
        }
        char* said = nullptr;
        if (auto* last = reinterpret_cast<decltype(gmshLoggerGetLastError)*>(
                dlsym(library_, "gmshLoggerGetLastError"))) {
            last(&said, &error);
        }
        throw GmshFailed{said != nullptr ? said : "no reason given"};
    }
    void* library_;
};

/// Ratio of the mean edge of HXT's cells to the requested spacing.
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

/// The boundary components of each connected part of the domain, the outer one first.
using Solids = std::vector<std::vector<Index>>;

Solids find_solids(const FacetComponents<3>& components, const Surface<3>& surface) {
    const std::vector<double> enclosed = enclosed_by_components(components, surface);
    Solids solids;
    std::vector<Index> outer; // by size, ascending: the first one around a body bounds its part
    for (Index part = 0; part < enclosed.size(); ++part) {
        if (enclosed[part] > 0) {
            outer.push_back(part);
        }
    }
    std::stable_sort(outer.begin(), outer.end(), [&](Index a, Index b) { return enclosed[a] < enclosed[b]; });
    for (const Index part : outer) {
        solids.push_back({part});
    }
    const BoxTree<3> tree{facet_boxes(surface)};
    for (Index part = 0; part < enclosed.size(); ++part) {
        const Point<3>& place = surface.points[surface.facets[components.first_facet(part)][0]];
        const auto is_in = [&](const std::vector<Index>& solid) {
            return winding_number<3>(surface, tree, place,
                                     [&](Index f) { return components.component(f) == solid[0]; }) > 0;
        };
        if (!(enclosed[part] > 0)) {
            std::find_if(solids.begin(), solids.end(), is_in)->push_back(part);
        }
    }
    return solids;
}

/// The surface as a Gmsh model. Nodes are added in ascending order over all components: Gmsh takes the last
/// node added for the one with the largest tag, and would otherwise reuse tags.
class GmshDomain {
public:
    GmshDomain(const Gmsh& gmsh, const FacetComponents<3>& components, const Surface<3>& surface,
               const Solids& solids)
        : gmsh_{gmsh}, surface_{surface}, tag_(surface.points.size(), 0) {
        gmsh.call<decltype(gmshModelAdd)>("gmshModelAdd", "cap");
        std::vector<int> loops;
        for (const std::vector<Index>& facets : components.facets()) {
            loops.push_back(add_component(static_cast<int>(loops.size()) + 1, facets));
        }
        for (const std::vector<Index>& solid : solids) {
            std::vector<int> bounds;
            std::transform(solid.begin(), solid.end(), std::back_inserter(bounds),
                           [&](Index part) { return loops[part]; });
            gmsh.call<decltype(gmshModelGeoAddVolume)>("gmshModelGeoAddVolume", bounds.data(), bounds.size(),
                                                       -1);
        }
        gmsh.call<decltype(gmshModelGeoSynchronize)>("gmshModelGeoSynchronize");
    }

    /// The mesh: the surface's points first, then those inside, and the cells.
    CapMesh<3> result() const;

private:
    int add_component(int entity, const std::vector<Index>& facets);
    /// Appends the inner points, and sets the number of each of their tags.
    void take_inside(CapMesh<3>& mesh, std::vector<Index>& number) const;

    const Gmsh& gmsh_;
    const Surface<3>& surface_;
    std::vector<std::size_t> tag_; ///< of each point's node, from 1
    std::size_t last_ = 0;
};

/// Adds a closed component as a discrete entity, and a surface loop, the outer or an inner one of a volume.
int GmshDomain::add_component(int entity, const std::vector<Index>& facets) {
    std::vector<std::size_t> nodes;
    std::vector<double> coordinates;
    std::vector<std::size_t> corners;
    for (const Index f : facets) {
        for (const Index v : surface_.facets[f]) {
            if (tag_[v] == 0) {
                tag_[v] = ++last_;
                nodes.push_back(last_);
                coordinates.insert(coordinates.end(), surface_.points[v].begin(), surface_.points[v].end());
            }
            corners.push_back(tag_[v]);
        }
    }
    gmsh_.call<decltype(gmshModelAddDiscreteEntity)>("gmshModelAddDiscreteEntity", 2, entity,
                                                     static_cast<int*>(nullptr), std::size_t{0});
    gmsh_.call<decltype(gmshModelMeshAddNodes)>("gmshModelMeshAddNodes", 2, entity, nodes.data(),
                                                nodes.size(), coordinates.data(), coordinates.size(),
                                                static_cast<double*>(nullptr), std::size_t{0});
    gmsh_.call<decltype(gmshModelMeshAddElementsByType)>("gmshModelMeshAddElementsByType", entity,
                                                         triangle_type, static_cast<std::size_t*>(nullptr),
                                                         std::size_t{0}, corners.data(), corners.size());
    return gmsh_.call<decltype(gmshModelGeoAddSurfaceLoop)>("gmshModelGeoAddSurfaceLoop", &entity,
                                                            std::size_t{1}, -1);
}

void GmshDomain::take_inside(CapMesh<3>& mesh, std::vector<Index>& number) const {
    std::size_t* tags = nullptr;
    std::size_t count = 0;
    double* coordinates = nullptr;
    std::size_t coordinate_count = 0;
    double* parameters = nullptr;
    std::size_t parameter_count = 0;
    gmsh_.call<decltype(gmshModelMeshGetNodes)>("gmshModelMeshGetNodes", &tags, &count, &coordinates,
                                                &coordinate_count, &parameters, &parameter_count, 3, -1, 0,
                                                0);
    for (std::size_t k = 0; k < count; ++k) {
        number.resize(std::max(number.size(), tags[k] + 1), no_index);
        number[tags[k]] = static_cast<Index>(mesh.points.size());
        mesh.points.push_back({coordinates[3 * k], coordinates[3 * k + 1], coordinates[3 * k + 2]});
    }
}

CapMesh<3> GmshDomain::result() const {
    CapMesh<3> mesh;
    mesh.points = surface_.points;
    std::vector<Index> number(last_ + 1, no_index); // of the node with each tag
    for (Index v = 0; v < tag_.size(); ++v) {
        number[tag_[v]] = v;
    }
    take_inside(mesh, number);
    std::size_t* tags = nullptr;
    std::size_t count = 0;
    std::size_t* corners = nullptr;
    std::size_t corner_count = 0;
    gmsh_.call<decltype(gmshModelMeshGetElementsByType)>("gmshModelMeshGetElementsByType", tetrahedron_type,
                                                         &tags, &count, &corners, &corner_count, -1,
                                                         std::size_t{0}, std::size_t{1});
    mesh.cells.resize(corner_count / 4);
    for (std::size_t k = 0; k < corner_count; ++k) {
        mesh.cells[k / 4][k % 4] = corners[k] < number.size() ? number[corners[k]] : no_index;
    }
    return mesh;
}

void send_failure(const Send& send, std::int32_t status, const std::string& said) {
    MesherHeading heading{status, 0, 0, 0, {}};
    said.copy(heading.said.data(), heading.said.size() - 1);
    send(&heading, sizeof heading);
}

void mesh_and_send(const FacetComponents<3>& components, const Surface<3>& surface, const Solids& solids,
                   const SizeField<3>& size, const Send& send) {
    // In its own namespace: Gmsh contains parts of TetGen, would call ours instead, and crash.
    void* library = dlmopen(LM_ID_NEWLM, SLABHULL_GMSH_SONAME, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
        return send_failure(send, no_library, dlerror());
    }
    try {
        const Gmsh gmsh{library};
        std::string program = "slabhull"; // Gmsh reads the program's name
        char* arguments = program.data();
        gmsh.call<decltype(gmshInitialize)>("gmshInitialize", 1, &arguments, 0);
        set_options(gmsh, size);
        const GmshDomain domain{gmsh, components, surface, solids};
        gmsh.call<decltype(gmshModelMeshGenerate)>("gmshModelMeshGenerate", 3);
        const CapMesh<3> mesh = domain.result();
        const MesherHeading heading{0,
                                    static_cast<std::int64_t>(mesh.points.size()),
                                    static_cast<std::int64_t>(mesh.cells.size()),
                                    0,
                                    {}};
        send(&heading, sizeof heading);
        send(mesh.points.data(), mesh.points.size() * sizeof mesh.points[0]);
        send(mesh.cells.data(), mesh.cells.size() * sizeof mesh.cells[0]);
    } catch (const GmshFailed& failure) {
        send_failure(send, gmsh_failed, failure.said);
    }
}

std::string failure_in_words(const MesherHeading& heading) {
    return fmt::format("Gmsh's HXT, {}: {}", heading.status == no_library ? "is not there" : "gave up",
                       heading.said.data());
}

} // namespace

bool has_hxt() {
    return true;
}

CapMesh<3> fill_with_hxt(const Boundary<3>& boundary, const Surface<3>& surface, const SizeField<3>& size,
                         const CapOptions&) {
    const FacetComponents<3>& components = boundary.facet_components();
    const Solids solids = find_solids(components, surface);
    const auto job = [&](const Send& send) {
        fall_silent();
        mesh_and_send(components, surface, solids, size, send);
    };
    return fill_in_child(
        surface, [&](const auto& receive) { return run_in_child(job, receive); }, failure_in_words);
}

} // namespace slabhull
