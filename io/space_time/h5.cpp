// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/column_stream.h"
#include "io/space_time/h5_reader.h"
#include "io/xdmf/hdf5_file.h"
#include "slabhull/core/error.h"

#include <fmt/format.h>

namespace slabhull::io {

namespace {

template<class Stored, class Given>
void write_column(Hdf5Writer& out, const char* dataset, Hdf5Type type, const Column<Given>& column) {
    if (column.given()) {
        out.write(dataset, type, column.rows(), column.components(), stored_as<Stored>(column));
    }
}

/// A dataset of `width` columns (0: any number); `rows` receives its number of rows.
template<class T>
Array<T> read_table(Hdf5Reader& in, const char* dataset, std::size_t& width, std::size_t& rows) {
    const Hdf5Dataset data = in.open(dataset);
    const auto& extents = data.extents();
    const std::size_t columns = extents.size() < 2 ? 1 : static_cast<std::size_t>(extents[1]);
    if (extents.empty() || extents.size() > 2 || (width != 0 && columns != width)) {
        throw InputError{fmt::format("dataset {} has not the shape of a space-time mesh", dataset)};
    }
    width = columns;
    rows = static_cast<std::size_t>(extents[0]);
    Array<T> values(rows * width);
    data.read(values.data(), rows, width, width);
    return values;
}

template<class T>
Array<T> read_rows(Hdf5Reader& in, const char* dataset, std::size_t width, std::size_t rows) {
    std::size_t found = 0;
    Array<T> values = read_table<T>(in, dataset, width, found);
    if (rows != 0 && found != rows) {
        throw InputError{fmt::format("dataset {} has {} rows, expected {}", dataset, found, rows)};
    }
    return values;
}

} // namespace

void write_h5(AtomicFile& file, const SpaceTimeColumns& mesh) {
    Hdf5Writer out{file.temporary(), file.target().string()};
    write_column<double>(out, "/points", Hdf5Type::float64, mesh.points);
    write_column<std::int32_t>(out, "/cells", Hdf5Type::int32, mesh.cells);
    write_column<std::int32_t>(out, "/neighbors", Hdf5Type::int32, mesh.neighbors);
    write_column<std::int32_t>(out, "/facets", Hdf5Type::int32, mesh.facets);
    write_column<std::int32_t>(out, "/facet_attribute", Hdf5Type::int32, mesh.facet_attribute);
    write_column<std::int64_t>(out, "/vertex_id", Hdf5Type::int64, mesh.vertex_id);
    write_column<std::int64_t>(out, "/track_id", Hdf5Type::int64, mesh.track_id);
    write_column<double>(out, "/time", Hdf5Type::float64,
                         Column<double>::over(std::span<const double>{mesh.time}));
    write_column<std::int64_t>(out, "/slab", Hdf5Type::int64, Column<std::int64_t>::constant(1, mesh.slab));
    out.close();
}

SpaceTimeSoup read_h5(const std::filesystem::path& path) {
    Hdf5Reader in{path};
    SpaceTimeSoup soup;
    soup.path = path.string();
    std::size_t width = 0;
    std::size_t points = 0;
    soup.points = read_table<double>(in, "/points", width, points);
    if (width != 3 && width != 4) {
        throw InputError{fmt::format("{}: points of {} coordinates; 3 or 4 of space-time were expected",
                                     path.string(), width)};
    }
    soup.dimension = static_cast<int>(width);
    std::size_t corners = width + 1;
    std::size_t cells = 0;
    soup.cells = read_table<Index>(in, "/cells", corners, cells);
    soup.neighbors = read_rows<std::int64_t>(in, "/neighbors", corners, cells);
    std::size_t facets = 0;
    soup.facets = read_table<Index>(in, "/facets", width, facets);
    soup.facet_attribute = read_rows<std::int64_t>(in, "/facet_attribute", 1, facets);
    soup.vertex_id = read_rows<std::int64_t>(in, "/vertex_id", 1, points);
    soup.track_id = read_rows<std::int64_t>(in, "/track_id", 1, points);
    soup.time = read_rows<double>(in, "/time", 1, 2);
    return soup;
}

} // namespace slabhull::io
