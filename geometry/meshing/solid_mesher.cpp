// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/solid_mesher.h"

#include "slabhull/core/error.h"
#include "slabhull/topology/adjacency.h"

#include <fmt/format.h>

#include <csignal>
#include <system_error>

namespace slabhull {

namespace {

bool receive_mesh(const Receive& receive, MesherHeading& heading, CapMesh<3>& mesh) {
    if (!receive(&heading, sizeof heading)) {
        return false;
    }
    mesh.points.resize(static_cast<std::size_t>(heading.points));
    mesh.cells.resize(static_cast<std::size_t>(heading.cells));
    mesh.neighbors.resize(static_cast<std::size_t>(heading.neighbors));
    const auto fill = [&](auto& array) { return receive(array.data(), array.size() * sizeof array[0]); };
    return fill(mesh.points) && fill(mesh.cells) && fill(mesh.neighbors);
}

ChildEnd started(const RunMesher& run, const std::function<bool(const Receive&)>& receive) {
    try {
        return run(receive);
    } catch (const std::system_error& error) {
        throw GeometryError{fmt::format("cannot start a child process for the mesher: {}", error.what())};
    }
}

std::string end_in_words(const ChildEnd& end) {
    if (end.signal == SIGKILL) {
        return "was killed, most likely for want of memory (it needs about 300 bytes per tetrahedron; mesh "
               "the "
               "cap in more blocks)";
    }
    const std::string how =
        end.signal != 0 ? fmt::format("signal {}", end.signal) : fmt::format("exit code {}", end.exit_code);
    return fmt::format("crashed ({}); it does so on a surface that crosses, touches or nearly touches itself",
                       how);
}

} // namespace

bool has_mesher(SolidMesher mesher) {
    return mesher == SolidMesher::hxt ? has_hxt() : has_tetgen();
}

CapMesh<3> fill_solid(const Boundary<3>& boundary, const Surface<3>& surface, const SizeField<3>& size,
                      const CapOptions& options) {
    return options.mesher == SolidMesher::hxt ? fill_with_hxt(boundary, surface, size, options)
                                              : fill_with_tetgen(boundary, surface, size, options);
}

CapMesh<3> fill_in_child(const Surface<3>& surface, const RunMesher& run,
                         const std::function<std::string(const MesherHeading&)>& words) {
    CapMesh<3> mesh;
    MesherHeading heading;
    const ChildEnd end =
        started(run, [&](const Receive& receive) { return receive_mesh(receive, heading, mesh); });
    if (!end.received || heading.status != 0) {
        throw GeometryError{fmt::format("the 3D mesher, given a surface of {} triangles and {} points, {}",
                                        surface.facets.size(), surface.points.size(),
                                        end.received ? words(heading) : end_in_words(end))};
    }
    if (mesh.neighbors.size() != mesh.cells.size()) {
        mesh.neighbors = build_adjacency<3>(mesh.cells, mesh.points.size()).neighbors;
    }
    return mesh;
}

} // namespace slabhull
