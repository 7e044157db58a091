// SPDX-License-Identifier: BSD-3-Clause
#include "adjacency_peers.h"

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkStaticCellLinksTemplate.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>

namespace slabhull::bench {

namespace {

/// The soup in VTK's `IdArray` storage, 32 or 64 bits.
template<class IdArray>
vtkSmartPointer<vtkUnstructuredGrid> grid_of(const TetSoup& soup) {
    using Id = typename IdArray::ValueType;
    vtkNew<IdArray> offsets;
    vtkNew<IdArray> vertices;
    offsets->SetNumberOfValues(static_cast<vtkIdType>(soup.cell_count + 1));
    vertices->SetNumberOfValues(static_cast<vtkIdType>(4 * soup.cell_count));
    for (std::size_t c = 0; c <= soup.cell_count; ++c) {
        offsets->SetValue(static_cast<vtkIdType>(c), static_cast<Id>(4 * c));
    }
    std::copy_n(soup.cells->data(), 4 * soup.cell_count, vertices->GetPointer(0));
    vtkNew<vtkCellArray> cells;
    cells->SetData(offsets, vertices);
    vtkNew<vtkPoints> points;
    points->SetNumberOfPoints(static_cast<vtkIdType>(soup.point_count)); // where they are is no matter
    const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    grid->SetPoints(points);
    grid->SetCells(VTK_TETRA, cells);
    return grid;
}

/// The cells of one vertex, descending, as VTK lists them.
struct Star {
    const int* begin;
    const int* end;
};

/// The cell other than `self` that is in all three stars.
std::uint32_t common_cell(const std::array<Star, 3>& stars, int self) {
    const int* p = stars[0].begin;
    const int* q = stars[1].begin;
    while (p != stars[0].end && q != stars[1].end) {
        if (*p > *q) {
            ++p;
        } else if (*q > *p) {
            ++q;
        } else if (*p != self && std::find(stars[2].begin, stars[2].end, *p) != stars[2].end) {
            return static_cast<std::uint32_t>(*p);
        } else {
            ++p;
            ++q;
        }
    }
    return no_cell;
}

/// Intersects the stars of a facet's vertices, the two shortest first; each facet once.
void intersect_stars(const TetSoup& soup, vtkStaticCellLinksTemplate<int>& links, Quad* result) {
    std::fill_n(result, soup.cell_count, Quad{no_cell, no_cell, no_cell, no_cell});
    for (std::uint32_t c = 0; c < soup.cell_count; ++c) {
        std::array<Star, 4> stars{};
        std::transform(soup.cells[c].begin(), soup.cells[c].end(), stars.begin(), [&](std::uint32_t v) {
            return Star{links.GetCells(v), links.GetCells(v) + links.GetNumberOfCells(v)};
        });
        for (std::size_t i = 0; i < 4; ++i) {
            if (result[c][i] != no_cell) {
                continue;
            }
            std::array<Star, 3> facet{stars[(i + 1) % 4], stars[(i + 2) % 4], stars[(i + 3) % 4]};
            std::sort(facet.begin(), facet.end(),
                      [](const Star& a, const Star& b) { return a.end - a.begin < b.end - b.begin; });
            const std::uint32_t other = common_cell(facet, static_cast<int>(c));
            if (other != no_cell) {
                result[c][i] = other;
                result[other][place_across(soup.cells[other], soup.cells[c], i)] = c;
            }
        }
    }
}

/// The template that vtkStaticCellLinks wraps, with 32-bit ids: 15 % faster than with vtkIdType.
Peer::Find static_links(const TetSoup& soup) {
    return [soup, grid = grid_of<vtkTypeInt32Array>(soup)](Quad* result) {
        vtkStaticCellLinksTemplate<int> links;
        links.SerialBuildLinks(grid->GetNumberOfPoints(), grid->GetNumberOfCells(), grid->GetCells());
        intersect_stars(soup, links, result);
    };
}

/// What VTK itself offers: the cells that share some points of a cell.
Peer::Find get_cell_neighbors(const TetSoup& soup) {
    return [soup, grid = grid_of<vtkTypeInt64Array>(soup)](Quad* result) {
        grid->BuildLinks();
        vtkNew<vtkIdList> found;
        for (std::size_t c = 0; c < soup.cell_count; ++c) {
            const Quad& cell = soup.cells[c];
            for (std::size_t i = 0; i < 4; ++i) {
                const std::array<vtkIdType, 3> facet{cell[(i + 1) % 4], cell[(i + 2) % 4], cell[(i + 3) % 4]};
                grid->GetCellNeighbors(static_cast<vtkIdType>(c), 3, facet.data(), found);
                result[c][i] =
                    found->GetNumberOfIds() == 1 ? static_cast<std::uint32_t>(found->GetId(0)) : no_cell;
            }
        }
    };
}

const bool added = add_peer({"vtk_static_links", 13, static_links}) &&
                   add_peer({"vtk_get_cell_neighbors", 9, get_cell_neighbors});

} // namespace

} // namespace slabhull::bench
