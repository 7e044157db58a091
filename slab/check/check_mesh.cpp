// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/check_shape.h"
#include "slab/check/findings.h"
#include "slabhull/topology/adjacency.h"

#include <fmt/format.h>

namespace slabhull {

namespace {

template<int D>
class MeshCheck {
public:
    MeshCheck(std::span<const Point<D>> points, std::span<const Simplex<D>> cells,
              const CheckOptions& options)
        : points_{points}, cells_{cells}, options_{options}, findings_{report_, options_} {}

    MeshReport run() {
        report_.dimension = D;
        report_.cells = cells_.size();
        if (!check_indices<D>(cells_, points_.size(), findings_)) {
            findings_.skip("all but the indices",
                           "there are no cells, or cells name vertices that do not exist");
            return std::move(report_);
        }
        examine_connectivity();
        examine_boundary();
        if (check_finite<D>(points_, findings_)) {
            examine_shape();
        } else {
            findings_.skip("shape", "there are coordinates that are not finite");
        }
        return std::move(report_);
    }

private:
    /// Unlike a hull, a mesh has a boundary, and its orientation is judged by measures.
    void examine_connectivity() {
        adjacency_ = build_adjacency<D>(cells_, points_.size());
        const ManifoldReport manifold =
            examine_manifold<D>(cells_, points_.size(), adjacency_, {options_.most_findings});
        translate(manifold, {ManifoldDefect::open_facet, ManifoldDefect::disoriented_facet}, findings_);
        report_.vertices = manifold.counts.vertices;
        report_.components = manifold.counts.components;
    }

    void examine_boundary() {
        Array<Simplex<D - 1>> boundary;
        for (const FacetDefect<D>& defect : adjacency_.defects) {
            if (defect.kind == FacetDefect<D>::Kind::open) {
                boundary.push_back(defect.facet);
            }
        }
        report_.boundary_facets = boundary.size();
        const auto ridges = build_adjacency<D - 1>(boundary, points_.size());
        for (const FacetDefect<D - 1>& ridge : ridges.defects) {
            if (ridge.kind == FacetDefect<D - 1>::Kind::overfull) {
                findings_.vertices(Defect::singular_boundary_ridge, ridge.facet, {},
                                   fmt::format("{} facets of the boundary meet there", ridge.cells.size()));
            }
        }
        if constexpr (D == 3) {
            examine_boundary_fans(boundary, ridges);
        }
    }

    void examine_boundary_fans(const Array<Simplex<2>>& boundary, const Adjacency<2>& ridges) {
        const ManifoldReport surface =
            examine_manifold<2>(boundary, points_.size(), ridges, {options_.most_findings});
        for (const ManifoldFinding& found : surface.findings) {
            if (found.what == ManifoldDefect::singular_vertex) {
                findings_.vertices(Defect::singular_boundary_vertex, found.vertices, {},
                                   "the boundary's facets around it are not one fan");
            }
        }
        findings_.set_count(Defect::singular_boundary_vertex, surface.count(ManifoldDefect::singular_vertex));
    }

    void examine_shape() {
        check_coincident<D>(points_, findings_);
        check_degenerate<D, D>(points_, cells_, findings_);
        find_signs();
        report_.orientation =
            std::count(sign_.begin(), sign_.end(), 1) >= std::count(sign_.begin(), sign_.end(), -1) ? 1 : -1;
        const SolidMeasures measures = measure_solid<D>(points_, cells_);
        report_.measure = report_.orientation * measures.measure;
        report_.angles = measures.angles;
        report_inverted();
        report_folded();
    }

    /// Finds the sign of each cell's measure, 0 for a degenerate cell.
    void find_signs() {
        sign_.resize(cells_.size());
        parallel_for(cells_.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                const auto corners = corners_of<D, D>(cells_[c], points_);
                const int sign = signed_measure<D>(corners) > 0 ? 1 : -1;
                sign_[c] = static_cast<std::int8_t>(is_degenerate<D, D>(corners) ? 0 : sign);
            }
        });
    }

    void report_inverted() {
        for (const Index c :
             select(cells_.size(), [&](std::size_t k) { return sign_[k] == -report_.orientation; })) {
            findings_.cell(Defect::inverted_cell, c, "its orientation is not that of most cells");
        }
    }

    /// Cells that agree in sign but give their facet the same orientation lie on the same side of it.
    void report_folded() {
        for (const FacetDefect<D>& defect : adjacency_.defects) {
            if (defect.kind == FacetDefect<D>::Kind::disoriented &&
                lie_folded(defect.cells[0], defect.cells[1])) {
                findings_.vertices(Defect::folded_facet, defect.facet, defect.cells,
                                   "its cells lie on the same side of it");
            }
        }
    }

    /// False for inverted, degenerate or duplicate cells, which other checks report.
    bool lie_folded(Index a, Index b) const {
        const Simplex<D>& cell = cells_[a];
        return sign_[a] == report_.orientation && sign_[b] == report_.orientation &&
               !std::is_permutation(cell.begin(), cell.end(), cells_[b].begin());
    }

    std::span<const Point<D>> points_;
    std::span<const Simplex<D>> cells_;
    CheckOptions options_;
    MeshReport report_;
    Findings findings_;
    Adjacency<D> adjacency_;
    Array<std::int8_t> sign_;
};

} // namespace

template<int D>
MeshReport check_mesh(std::span<const Point<D>> points, std::span<const Simplex<D>> cells,
                      const CheckOptions& options) {
    return MeshCheck<D>{points, cells, options}.run();
}

template MeshReport check_mesh<2>(std::span<const Point<2>>, std::span<const Simplex<2>>,
                                  const CheckOptions&);
template MeshReport check_mesh<3>(std::span<const Point<3>>, std::span<const Simplex<3>>,
                                  const CheckOptions&);

} // namespace slabhull
