// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/cap_mesher.h"

#include "core/pieces.h"

#include "geometry/basics/predicates.h"
#include "geometry/embedding/facet_names.h"

#include "slabhull/core/communicator.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/geometry/measures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

/// A facet's vertices in ascending order, and whether sorting them changed its orientation.
template<int D>
struct OrientedFacet {
    explicit OrientedFacet(const Facet<D>& facet) : vertices{facet} {
        for (std::size_t end = D - 1; end > 0; --end) {
            for (std::size_t i = 0; i < end; ++i) {
                if (vertices[i] > vertices[i + 1]) {
                    std::swap(vertices[i], vertices[i + 1]);
                    turned = !turned;
                }
            }
        }
    }
    bool faces(const OrientedFacet& other) const {
        return vertices == other.vertices && turned != other.turned;
    }
    friend auto operator<=>(const OrientedFacet&, const OrientedFacet&) = default;

    Facet<D> vertices;
    bool turned = false;
};

template<int D>
using OrientedFacets = std::vector<OrientedFacet<D>>;

/// Result of a pass over some cells; numbers of cells and facets in ascending order.
template<int D>
struct CellFindings {
    std::vector<Index> unsound; ///< refer to points or cells out of range
    std::vector<Index> inverted;
    std::vector<Index> mismatched; ///< a neighbour does not lie across the shared facet
    OrientedFacets<D> boundary;

    void append(const CellFindings& more) {
        const auto join = [](auto& all, const auto& part) {
            all.insert(all.end(), part.begin(), part.end());
        };
        join(unsound, more.unsound);
        join(inverted, more.inverted);
        join(mismatched, more.mismatched);
        join(boundary, more.boundary);
    }
};

template<int D>
class CapInspection {
public:
    CapInspection(const CapMesh<D>& mesh, const Surface<D>& surface)
        : mesh_{mesh}, surface_{surface}, names_{surface, as_given_} {}

    void run() const {
        require_sizes();
        require_given_points();
        const CellFindings<D> found = inspect_cells();
        refuse_cells(found.unsound, "refer to points or cells that do not exist");
        refuse_cells(found.inverted, "are flat or turned inside out");
        refuse_cells(found.mismatched, "do not fit their neighbours");
        require_same_boundary(found.boundary);
        require_used_points();
    }

private:
    [[noreturn]] static void refuse(const std::string& message, std::vector<Entity> at_fault = {}) {
        throw GeometryError{"the mesher's result was refused: " + message, std::move(at_fault)};
    }
    void refuse_cells(const std::vector<Index>& cells, const char* fault) const;

    void require_sizes() const;
    void require_given_points() const;
    void require_used_points() const;
    void require_same_boundary(OrientedFacets<D> found) const;

    CellFindings<D> inspect_cells() const;
    void inspect_cell(Index cell, CellFindings<D>& findings) const;
    bool sound(Index cell) const;
    bool fits_neighbor(Index cell, int place) const;

    const CapMesh<D>& mesh_;
    const Surface<D>& surface_;
    FacetNaming as_given_;
    FacetNames<D> names_;
};

template<int D>
void CapInspection<D>::refuse_cells(const std::vector<Index>& cells, const char* fault) const {
    if (cells.empty()) {
        return;
    }
    const Point<D>& near =
        mesh_.points[std::min<std::size_t>(mesh_.cells[cells[0]][0], mesh_.points.size() - 1)];
    std::vector<Entity> at_fault;
    for (std::size_t k = 0; k < std::min(cells.size(), names_listed); ++k) {
        at_fault.push_back({"cell", cells[k], ""});
    }
    refuse(fmt::format("{} of {} cells {}, the first is cell {} near {}", cells.size(), mesh_.cells.size(),
                       fault, cells[0], place_in_words(near)),
           std::move(at_fault));
}

template<int D>
void CapInspection<D>::require_sizes() const {
    if (mesh_.cells.empty() || mesh_.points.empty()) {
        refuse("it is empty; the surface may be open");
    }
    if (mesh_.neighbors.size() != mesh_.cells.size()) {
        refuse(fmt::format("{} cells but neighbours of {}", mesh_.cells.size(), mesh_.neighbors.size()));
    }
}

template<int D>
void CapInspection<D>::require_given_points() const {
    const std::size_t given = surface_.points.size();
    if (mesh_.points.size() < given) {
        refuse(fmt::format("only {} of the surface's {} points came back", mesh_.points.size(), given));
    }
    if (std::memcmp(mesh_.points.data(), surface_.points.data(), given * sizeof(Point<D>)) == 0) {
        return;
    }
    for (std::size_t v = 0; v < given; ++v) {
        // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): bit for bit is what is meant
        if (std::memcmp(&mesh_.points[v], &surface_.points[v], sizeof(Point<D>)) != 0) {
            refuse(fmt::format("vertex {} of the surface at {} was moved or renumbered", v,
                               place_in_words(surface_.points[v])),
                   {{"vertex", static_cast<std::int64_t>(v), ""}});
        }
    }
}

template<int D>
void CapInspection<D>::require_used_points() const {
    std::vector<char> used(mesh_.points.size(), 0);
    for (const Simplex<D>& cell : mesh_.cells) {
        for (const Index v : cell) {
            used[v] = 1;
        }
    }
    const auto unused = std::find(used.begin(), used.end(), 0);
    if (unused != used.end()) {
        const auto v = static_cast<std::size_t>(unused - used.begin());
        refuse(fmt::format("no cell uses vertex {} at {}", v, place_in_words(mesh_.points[v])),
               {{"vertex", static_cast<std::int64_t>(v), ""}});
    }
}

template<int D>
bool CapInspection<D>::sound(Index cell) const {
    const auto points = mesh_.points.size();
    const auto cells = mesh_.cells.size();
    return std::all_of(mesh_.cells[cell].begin(), mesh_.cells[cell].end(),
                       [=](Index v) { return v < points; }) &&
           std::all_of(mesh_.neighbors[cell].begin(), mesh_.neighbors[cell].end(),
                       [=](Index c) { return c == no_index || c < cells; });
}

template<int D>
bool CapInspection<D>::fits_neighbor(Index cell, int place) const {
    const Index across = mesh_.neighbors[cell][static_cast<std::size_t>(place)];
    const OrientedFacet<D> facet{outward_facet<D>(mesh_.cells[cell], place)};
    for (int i = 0; i <= D; ++i) {
        if (mesh_.neighbors[across][static_cast<std::size_t>(i)] == cell &&
            facet.faces(OrientedFacet<D>{outward_facet<D>(mesh_.cells[across], i)})) {
            return true;
        }
    }
    return false;
}

template<int D>
void CapInspection<D>::inspect_cell(Index cell, CellFindings<D>& findings) const {
    if (!sound(cell)) {
        findings.unsound.push_back(cell);
        return;
    }
    if (exact::orientation(corners_of<D, D>(mesh_.cells[cell], mesh_.points)) <= 0) {
        findings.inverted.push_back(cell);
    }
    bool fits = true;
    for (int i = 0; i <= D; ++i) {
        if (mesh_.neighbors[cell][static_cast<std::size_t>(i)] == no_index) {
            findings.boundary.emplace_back(outward_facet<D>(mesh_.cells[cell], i));
        } else {
            fits = fits && fits_neighbor(cell, i);
        }
    }
    if (!fits) {
        findings.mismatched.push_back(cell);
    }
}

template<int D>
CellFindings<D> CapInspection<D>::inspect_cells() const {
    constexpr std::size_t grain = 1 << 14;
    const auto inspect = [this](std::size_t begin, std::size_t end, CellFindings<D>& piece) {
        for (std::size_t cell = begin; cell < end; ++cell) {
            inspect_cell(static_cast<Index>(cell), piece);
        }
    };
    CellFindings<D> all;
    for (const CellFindings<D>& piece :
         parallel_pieces<CellFindings<D>>(mesh_.cells.size(), grain, inspect)) {
        all.append(piece);
    }
    return all;
}

template<int D>
void CapInspection<D>::require_same_boundary(OrientedFacets<D> found) const {
    std::vector<std::pair<OrientedFacet<D>, Index>> wanted;
    for (Index f = 0; f < surface_.facets.size(); ++f) {
        wanted.emplace_back(OrientedFacet<D>{surface_.facets[f]}, f);
    }
    std::sort(wanted.begin(), wanted.end());
    std::sort(found.begin(), found.end());
    std::vector<Index> missing;
    OrientedFacets<D> added;
    auto has = found.begin();
    for (const auto& [facet, number] : wanted) {
        for (; has != found.end() && *has < facet; ++has) {
            added.push_back(*has);
        }
        if (has != found.end() && *has == facet) {
            ++has;
        } else {
            missing.push_back(number);
        }
    }
    added.insert(added.end(), has, found.end());
    if (missing.empty() && added.empty()) {
        return;
    }
    std::string message = fmt::format("its boundary lacks {} of the surface's {} facets and has {} others",
                                      missing.size(), surface_.facets.size(), added.size());
    if (!missing.empty()) {
        message += "; lacking: " + names_.list(missing);
    }
    if (!added.empty()) {
        message += fmt::format("; first other facet near {}: vertices {}",
                               place_in_words(mesh_.points[added[0].vertices[0]]),
                               fmt::join(added[0].vertices, ", "));
    }
    refuse(message, names_.entities(missing));
}

} // namespace

template<int D>
void verify_cap(const CapMesh<D>& mesh, const Surface<D>& surface) {
    CapInspection<D>{mesh, surface}.run();
}

template<int D>
CapMesh<D> with_shared_points(CapMesh<D> mesh, Communicator& ranks) {
    mesh.blocks = ranks.gather(mesh.blocks).front();
    Array<Point<D>> points = ranks.broadcast<Point<D>>(mesh.points, 0);
    if (ranks.first()) {
        return mesh; // with the points that it has
    }
    CapMesh<D> shared;
    shared.points = std::move(points);
    shared.blocks = mesh.blocks;
    return shared;
}

template CapMesh<2> with_shared_points<2>(CapMesh<2>, Communicator&);
template CapMesh<3> with_shared_points<3>(CapMesh<3>, Communicator&);
template void verify_cap<2>(const CapMesh<2>&, const Surface<2>&);
template void verify_cap<3>(const CapMesh<3>&, const Surface<3>&);

} // namespace slabhull
