// SPDX-License-Identifier: BSD-3-Clause
#include "cases/tables/displacement_table.h"

#include "slabhull/core/error.h"
#include "slabhull/io/files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace slabhull {

namespace {

constexpr std::array<const char*, 3> position_columns{"x", "y", "z"};
constexpr std::array<const char*, 3> displacement_columns{"dx", "dy", "dz"};

template<int D>
[[noreturn]] void refuse_out_of_plane(const DisplacementTable<D>& table, std::size_t row, double along_z) {
    throw InputError(fmt::format("{}: {} is displaced by {} along z, but a plane mesh (dimension = 2) has "
                                 "no such direction",
                                 table.path, table.row_name(row), along_z));
}

/// A CSV file as a table.
template<int D>
class CsvDisplacements {
public:
    explicit CsvDisplacements(const std::filesystem::path& path) : csv_{io::read_csv(path)} {}

    DisplacementTable<D> run() {
        require_known_columns();
        table_.path = csv_.path;
        table_.row_name = [lines = csv_.lines](std::size_t row) {
            return fmt::format("line {}", lines[row]);
        };
        const auto id = csv_.find("track_id") ? csv_.find("track_id") : csv_.find("id");
        if (id) {
            read_tracks(*id);
        }
        if (csv_.find("x") || !id) {
            table_.points = columns(position_columns);
        }
        table_.displacements = columns(displacement_columns);
        if (const auto dz = csv_.find("dz"); D == 2 && dz) {
            for (std::size_t row = 0; row < csv_.rows(); ++row) {
                if (csv_.at(row, *dz) != 0) {
                    refuse_out_of_plane(table_, row, csv_.at(row, *dz));
                }
            }
        }
        return std::move(table_);
    }

private:
    void require_known_columns() const {
        for (const std::string& name : csv_.columns) {
            const auto is_name = [&name](const char* known) { return name == known; };
            if (name != "id" && name != "track_id" &&
                std::none_of(position_columns.begin(), position_columns.end(), is_name) &&
                std::none_of(displacement_columns.begin(), displacement_columns.end(), is_name)) {
                csv_.fail_columns(fmt::format("the column \"{}\" has no meaning among displacements, which "
                                              "have x, y, z or track_id, and dx, dy, dz",
                                              name));
            }
        }
    }

    void read_tracks(std::size_t column) {
        constexpr double largest = 9007199254740992; // doubles tell whole numbers apart up to here
        for (std::size_t row = 0; row < csv_.rows(); ++row) {
            const double value = csv_.at(row, column);
            if (std::floor(value) != value || std::abs(value) > largest) {
                csv_.fail(row, fmt::format("{} {} is not a whole number", csv_.columns[column], value));
            }
            table_.tracks.push_back(static_cast<TrackId>(value));
        }
    }

    Array<Point<D>> columns(const std::array<const char*, 3>& names) const {
        Array<Point<D>> points(csv_.rows());
        for (std::size_t k = 0; k < D; ++k) {
            const auto column = csv_.find(names[k]);
            if (!column) {
                csv_.fail_columns(fmt::format("there is no column \"{}\"", names[k]));
            }
            for (std::size_t row = 0; row < points.size(); ++row) {
                points[row][k] = csv_.at(row, *column);
            }
        }
        return points;
    }

    io::CsvTable csv_;
    DisplacementTable<D> table_;
};

/// A VTU file as a table.
template<int D>
class VtuDisplacements {
public:
    VtuDisplacements(const std::filesystem::path& path, const std::string& array)
        : soup_{io::read_vtu(path)}, array_{array} {}

    DisplacementTable<D> run() {
        table_.path = soup_.path;
        table_.row_name = [](std::size_t row) { return fmt::format("point {}", row); };
        for (const Point<3>& point : soup_.points) {
            std::copy_n(point.begin(), D, table_.points.emplace_back().begin());
        }
        read_displacements();
        if (const auto* array = soup_.find_point_data("track_id")) {
            if (const auto* tracks = std::get_if<Array<std::int64_t>>(&array->values)) {
                table_.tracks = *tracks;
            }
        }
        table_.time = time();
        return std::move(table_);
    }

private:
    static bool may_displace(const io::DataArray& array) {
        const bool fits = array.components == 3 || array.components == D;
        return fits && std::holds_alternative<Array<double>>(array.values);
    }

    void read_displacements() {
        const io::DataArray* array = soup_.find_point_data(array_);
        if (array == nullptr || !may_displace(*array)) {
            refuse_array();
        }
        const auto& values = std::get<Array<double>>(array->values);
        const auto components = static_cast<std::size_t>(array->components);
        for (std::size_t row = 0; row < soup_.points.size(); ++row) {
            const double* of_row = &values[row * components];
            for (std::size_t k = 0; k < components; ++k) {
                if (!std::isfinite(of_row[k])) {
                    throw InputError(
                        fmt::format("{}: point {}: {} is not a finite number", soup_.path, row, array_));
                }
            }
            std::copy_n(of_row, D, table_.displacements.emplace_back().begin());
            if (D < components && of_row[components - 1] != 0) {
                refuse_out_of_plane(table_, row, of_row[components - 1]);
            }
        }
    }

    [[noreturn]] void refuse_array() const {
        std::vector<std::string> fitting;
        for (const io::DataArray& array : soup_.point_data) {
            if (may_displace(array)) {
                fitting.push_back(fmt::format("\"{}\"", array.name));
            }
        }
        throw InputError(fmt::format("{}: has no point data \"{}\" of {} floating-point components; {}",
                                     soup_.path, array_, D == 3 ? "3" : "2 or 3",
                                     fitting.empty() ? "there are none that fit"
                                                     : fmt::format("name one of {} with the key \"array\"",
                                                                   fmt::join(fitting, ", "))));
    }

    std::optional<double> time() const {
        for (const char* name : {"time", "TimeValue"}) {
            const io::DataArray* array = soup_.find_field_data(name);
            const auto* values = array == nullptr ? nullptr : std::get_if<Array<double>>(&array->values);
            if (values != nullptr && values->size() == 1 && std::isfinite(values->front())) {
                return values->front();
            }
        }
        return std::nullopt;
    }

    io::Soup soup_;
    const std::string& array_;
    DisplacementTable<D> table_;
};

} // namespace

template<int D>
DisplacementTable<D> read_displacement_table(const std::filesystem::path& path, const std::string& array) {
    return path.extension() == ".vtu" ? VtuDisplacements<D>{path, array}.run()
                                      : CsvDisplacements<D>{path}.run();
}

template DisplacementTable<2> read_displacement_table<2>(const std::filesystem::path&, const std::string&);
template DisplacementTable<3> read_displacement_table<3>(const std::filesystem::path&, const std::string&);

} // namespace slabhull
