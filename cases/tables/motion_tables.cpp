// SPDX-License-Identifier: BSD-3-Clause
#include "cases/tables/motion_tables.h"

#include "slabhull/core/error.h"
#include "slabhull/core/text.h"
#include "slabhull/geometry/rigid_table.h"
#include "slabhull/io/files.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <numbers>
#include <set>

namespace slabhull {

namespace {

/// Picks columns from a table by name, and remembers which.
class MotionColumns {
public:
    explicit MotionColumns(const std::filesystem::path& path) : table_{io::read_motion_table(path)} {}

    bool has(const std::string& name) const { return table_.find(name).has_value(); }
    template<std::size_t N>
    bool has_any(const std::array<std::string, N>& names) const {
        return std::any_of(names.begin(), names.end(), [this](const auto& name) { return has(name); });
    }
    bool has_angle(const std::string& name) const { return has(name) || has(name + "_deg"); }

    std::vector<double> numbers(const std::string& name) {
        const auto column = table_.find(name);
        if (!column) {
            table_.fail_columns(
                fmt::format("there is no column \"{}\"{}", name, did_you_mean(name, table_.columns)));
        }
        known_.insert(name);
        std::vector<double> values(table_.rows());
        for (std::size_t row = 0; row < values.size(); ++row) {
            values[row] = table_.at(row, *column);
        }
        return values;
    }

    /// In radians.
    std::vector<double> angles(const std::string& name) {
        if (has(name)) {
            return numbers(name);
        }
        if (!has_angle(name)) {
            table_.fail_columns(fmt::format(
                "there is no column \"{0}\" (radians) or \"{0}_deg\" (degrees); name one so", name));
        }
        std::vector<double> values = numbers(name + "_deg");
        for (double& value : values) {
            value *= std::numbers::pi / 180;
        }
        return values;
    }

    /// One point per row, from as many columns.
    template<std::size_t N>
    std::vector<Point<N>> points(const std::array<std::string, N>& names, bool are_angles = false) {
        std::vector<Point<N>> rows(table_.rows());
        for (std::size_t k = 0; k < N; ++k) {
            const std::vector<double> column = are_angles ? angles(names[k]) : numbers(names[k]);
            for (std::size_t row = 0; row < rows.size(); ++row) {
                rows[row][k] = column[row];
            }
        }
        return rows;
    }

    /// Refuses values in a column that has no meaning in the plane.
    void require_zero(const std::string& name, const std::vector<double>& values) const {
        for (std::size_t row = 0; row < values.size(); ++row) {
            if (values[row] != 0) {
                table_.fail(row, fmt::format("column \"{}\": {} would leave the plane of a case with "
                                             "dimension = 2; 0 was expected",
                                             name, values[row]));
            }
        }
    }

    /// Refuses columns that nothing asked for, and a table of times alone.
    void require_all_known() const {
        for (const std::string& name : table_.columns) {
            if (!known_.contains(name)) {
                table_.fail_columns(fmt::format(
                    "the column \"{}\" has no meaning beside the others of this motion; leave it out", name));
            }
        }
        if (known_.size() < 2) {
            table_.fail_columns("there is neither a displacement nor a turn");
        }
    }

    void require_cover(const std::vector<double>& times, const TimeInterval& span) const {
        const double slack = 1e-9 * (times.back() - times.front());
        if (times.front() > span.start + slack || times.back() < span.end - slack) {
            throw InputError(fmt::format("{}: the rows go from t = {} to {}, but the case from {} to {}; "
                                         "extend the table or change [time]",
                                         table_.path, times.front(), times.back(), span.start, span.end));
        }
    }

    /// Adds file and line to what a factory of motions says about a row.
    template<class Make>
    auto made_by(const Make& make) const {
        try {
            return make();
        } catch (const UsageError& error) {
            if (!error.entities.empty() && error.entities[0].kind == "row") {
                table_.fail(static_cast<std::size_t>(error.entities[0].number), error.what());
            }
            throw InputError(fmt::format("{}: {}", table_.path, error.what()));
        }
    }

private:
    io::CsvTable table_;
    std::set<std::string> known_;
};

template<int D>
void read_shifts(MotionColumns& columns, RigidTable<D>& table) {
    static const std::array<std::string, 3> axes{"x", "y", "z"};
    std::array<std::string, D> names;
    std::copy_n(axes.begin(), D, names.begin());
    if (columns.has_any(names)) {
        table.shifts = columns.points(names);
    }
}

void read_turn(MotionColumns& columns, RigidTable<2>& table) {
    if (columns.has_angle("yaw")) {
        columns.require_zero("z", columns.numbers("z"));
        columns.require_zero("roll", columns.angles("roll"));
        columns.require_zero("pitch", columns.angles("pitch"));
        table.angles = columns.points<1>({"yaw"}, true);
    } else if (columns.has_angle("angle")) {
        table.angles = columns.points<1>({"angle"}, true);
    }
}

void read_turn(MotionColumns& columns, RigidTable<3>& table) {
    const std::array<std::string, 4> quaternion{"qw", "qx", "qy", "qz"};
    if (columns.has_any(quaternion)) {
        table.quaternions = columns.points(quaternion);
    } else if (columns.has_angle("roll") || columns.has_angle("pitch") || columns.has_angle("yaw")) {
        table.angles = columns.points<3>({"roll", "pitch", "yaw"}, true);
    }
}

} // namespace

template<int D>
MotionPointer<D> rotation_from_file(const std::filesystem::path& path, const Point<D>& axis,
                                    const Point<D>& centre, const TimeInterval& span) {
    MotionColumns columns{path};
    AngleTable table;
    table.times = columns.numbers("time");
    table.angles = columns.angles("angle");
    columns.require_all_known();
    auto motion = columns.made_by([&] { return rotation<D>(axis, centre, table); });
    columns.require_cover(table.times, span);
    return motion;
}

template<int D>
MotionPointer<D> rigid_table_from_file(const std::filesystem::path& path, const Point<D>& centre,
                                       const TimeInterval& span) {
    MotionColumns columns{path};
    RigidTable<D> table;
    table.times = columns.numbers("time");
    read_shifts(columns, table);
    read_turn(columns, table);
    columns.require_all_known();
    auto motion = columns.made_by([&] { return rigid_table<D>(table, centre); });
    columns.require_cover(table.times, span);
    return motion;
}

template MotionPointer<2> rotation_from_file<2>(const std::filesystem::path&, const Point<2>&,
                                                const Point<2>&, const TimeInterval&);
template MotionPointer<3> rotation_from_file<3>(const std::filesystem::path&, const Point<3>&,
                                                const Point<3>&, const TimeInterval&);
template MotionPointer<2> rigid_table_from_file<2>(const std::filesystem::path&, const Point<2>&,
                                                   const TimeInterval&);
template MotionPointer<3> rigid_table_from_file<3>(const std::filesystem::path&, const Point<3>&,
                                                   const TimeInterval&);

} // namespace slabhull
