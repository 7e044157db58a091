// SPDX-License-Identifier: BSD-3-Clause
#include "file_peers.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <stdexcept>

namespace slabhull::bench {

namespace {

template<class Values, class Value>
vtkSmartPointer<Values> array_of(const char* name, std::size_t rows, const Value& value) {
    const auto array = vtkSmartPointer<Values>::New();
    array->SetName(name);
    array->SetNumberOfValues(static_cast<vtkIdType>(rows));
    for (std::size_t row = 0; row < rows; ++row) {
        array->SetValue(static_cast<vtkIdType>(row), static_cast<typename Values::ValueType>(value(row)));
    }
    return array;
}

/// Rows of several components.
template<class Values, class Row>
vtkSmartPointer<Values> rows_of(const char* name, std::size_t rows, int width, const Row& values) {
    const auto array = vtkSmartPointer<Values>::New();
    array->SetName(name);
    array->SetNumberOfComponents(width);
    array->SetNumberOfTuples(static_cast<vtkIdType>(rows));
    auto* out = array->GetPointer(0);
    for (std::size_t row = 0; row < rows; ++row) {
        for (const auto value : values(row)) {
            *out++ = static_cast<typename Values::ValueType>(value);
        }
    }
    return array;
}

void add_fields(vtkFieldData& fields) {
    fields.AddArray(array_of<vtkTypeInt64Array>("slab", 1, [](std::size_t) { return 0; }));
    fields.AddArray(array_of<vtkDoubleArray>("time", 2, [](std::size_t i) { return i; }));
    fields.AddArray(array_of<vtkTypeInt64Array>("dimension", 1, [](std::size_t) { return 3; }));
    fields.AddArray(array_of<vtkTypeInt64Array>("patch_number", 1, [](std::size_t) { return 1; }));
    fields.AddArray(array_of<vtkUnsignedCharArray>("patch_name", 1, [](std::size_t) { return 0; }));
}

/// In 32 bits, as we write them.
vtkSmartPointer<vtkCellArray> cells_of(const HullSoup& soup) {
    const std::size_t count = soup.cell_count();
    const auto offsets =
        array_of<vtkTypeInt32Array>("offsets", count + 1, [](std::size_t c) { return 4 * c; });
    const auto vertices =
        rows_of<vtkTypeInt32Array>("connectivity", count, 4, [&](std::size_t c) { return soup.vertices(c); });
    vertices->SetNumberOfComponents(1);
    const auto cells = vtkSmartPointer<vtkCellArray>::New();
    cells->SetData(offsets, vertices);
    return cells;
}

vtkSmartPointer<vtkUnstructuredGrid> grid_of(const HullSoup& soup) {
    const std::size_t points = soup.point_count();
    const std::size_t cells = soup.cell_count();
    const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    vtkNew<vtkPoints> places;
    places->SetData(
        rows_of<vtkDoubleArray>("Points", points, 3, [&](std::size_t v) { return soup.point(v); }));
    grid->SetPoints(places);
    grid->SetCells(VTK_TETRA, cells_of(soup));
    auto& at_points = *grid->GetPointData();
    at_points.AddArray(array_of<vtkDoubleArray>("t", points, [&](std::size_t v) { return soup.time(v); }));
    at_points.AddArray(
        array_of<vtkTypeInt64Array>("vertex_id", points, [&](std::size_t v) { return soup.id(v); }));
    at_points.AddArray(
        array_of<vtkTypeInt64Array>("track_id", points, [&](std::size_t v) { return soup.track(v); }));
    at_points.AddArray(
        array_of<vtkTypeInt64Array>("cell", points, [&](std::size_t v) { return soup.cell(v); }));
    auto& in_cells = *grid->GetCellData();
    in_cells.AddArray(
        array_of<vtkTypeInt32Array>("region", cells, [&](std::size_t c) { return soup.region(c); }));
    in_cells.AddArray(
        array_of<vtkTypeInt32Array>("patch", cells, [&](std::size_t c) { return soup.patch(c); }));
    in_cells.AddArray(
        array_of<vtkTypeInt32Array>("layer", cells, [&](std::size_t c) { return soup.layer(c); }));
    in_cells.AddArray(
        rows_of<vtkTypeInt64Array>("neighbors", cells, 4, [&](std::size_t c) { return soup.across(c); }));
    add_fields(*grid->GetFieldData());
    return grid;
}

Run writing(const HullSoup& soup) {
    return [grid = grid_of(soup)](const std::string& file) {
        vtkNew<vtkXMLUnstructuredGridWriter> writer;
        writer->SetFileName(file.c_str());
        writer->SetInputData(grid);
        writer->SetDataModeToAppended();
        writer->EncodeAppendedDataOff();
        writer->SetCompressorTypeToNone();
        writer->SetHeaderTypeToUInt64();
        if (writer->Write() == 0) {
            throw std::runtime_error{"VTK has not written"};
        }
        return Outcome{};
    };
}

/// All values of all arrays; ids of any width.
bool is(vtkUnstructuredGrid& grid, const HullSoup& soup) {
    const auto same = [](vtkDataArray* array, std::size_t rows, int width, const auto& values) {
        if (array == nullptr || array->GetNumberOfTuples() != static_cast<vtkIdType>(rows) ||
            array->GetNumberOfComponents() != width) {
            return false;
        }
        std::array<double, 4> found{};
        for (std::size_t row = 0; row < rows; ++row) {
            array->GetTuple(static_cast<vtkIdType>(row), found.data());
            const auto wanted = values(row);
            if (!std::equal(wanted.begin(), wanted.end(), found.begin(),
                            [](auto a, double b) { return static_cast<double>(a) == b; })) {
                return false;
            }
        }
        return true;
    };
    const auto one = [](auto value) { return std::array<decltype(value), 1>{value}; };
    const std::size_t points = soup.point_count();
    const std::size_t cells = soup.cell_count();
    vtkPointData& at_points = *grid.GetPointData();
    vtkCellData& in_cells = *grid.GetCellData();
    bool right =
        grid.GetNumberOfPoints() == static_cast<vtkIdType>(points) &&
        grid.GetNumberOfCells() == static_cast<vtkIdType>(cells) &&
        same(grid.GetPoints()->GetData(), points, 3, [&](std::size_t v) { return soup.point(v); }) &&
        same(at_points.GetArray("t"), points, 1, [&](std::size_t v) { return one(soup.time(v)); }) &&
        same(at_points.GetArray("vertex_id"), points, 1, [&](std::size_t v) { return one(soup.id(v)); }) &&
        same(at_points.GetArray("track_id"), points, 1, [&](std::size_t v) { return one(soup.track(v)); }) &&
        same(at_points.GetArray("cell"), points, 1, [&](std::size_t v) { return one(soup.cell(v)); }) &&
        same(in_cells.GetArray("region"), cells, 1, [&](std::size_t c) { return one(soup.region(c)); }) &&
        same(in_cells.GetArray("patch"), cells, 1, [&](std::size_t c) { return one(soup.patch(c)); }) &&
        same(in_cells.GetArray("layer"), cells, 1, [&](std::size_t c) { return one(soup.layer(c)); }) &&
        same(in_cells.GetArray("neighbors"), cells, 4, [&](std::size_t c) { return soup.across(c); });
    vtkIdType size = 0;
    const vtkIdType* corners = nullptr;
    for (std::size_t c = 0; right && c < cells; ++c) {
        grid.GetCells()->GetCellAtId(static_cast<vtkIdType>(c), size, corners);
        const auto wanted = soup.vertices(c);
        right = size == 4 && grid.GetCellType(static_cast<vtkIdType>(c)) == VTK_TETRA &&
                std::equal(wanted.begin(), wanted.end(), corners);
    }
    return right;
}

Run reading(const HullSoup& soup) {
    return [soup](const std::string& file) {
        const auto reader = vtkSmartPointer<vtkXMLUnstructuredGridReader>::New();
        reader->SetFileName(file.c_str());
        reader->Update();
        return Outcome{[soup, reader] { return is(*reader->GetOutput(), soup); }};
    };
}

const bool added =
    add_contestant({"write_vtu", "vtk", writing}) && add_contestant({"read_vtu", "vtk", reading});

} // namespace

} // namespace slabhull::bench
