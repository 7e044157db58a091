// SPDX-License-Identifier: BSD-3-Clause
#include "cases/tables/displacement_files.h"

#include "cases/tables/displacement_table.h"
#include "geometry/basics/point_finder.h"

#include "slabhull/core/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <system_error>

namespace slabhull {

namespace {

/// The vertices of patches of one name at the start, by ascending track.
template<int D>
struct PatchVertices {
    std::string patch;
    std::vector<TrackId> tracks;
    Array<Point<D>> points;
};

template<int D>
PatchVertices<D> vertices_of(const Surface<D>& start, std::span<const TrackId> tracks,
                             std::span<const PatchNumber> patches) {
    std::set<std::pair<TrackId, Index>> used;
    for (std::size_t f = 0; f < start.facets.size(); ++f) {
        if (std::find(patches.begin(), patches.end(), start.patch[f]) != patches.end()) {
            for (const Index v : start.facets[f]) {
                used.emplace(tracks[v], v);
            }
        }
    }
    PatchVertices<D> vertices{patch_name(start.patches, patches.front()), {}, {}};
    for (const auto& [track, v] : used) {
        vertices.tracks.push_back(track);
        vertices.points.push_back(start.points[v]);
    }
    return vertices;
}

/// The longest side of the box around some points.
template<int D>
double extent_of(std::span<const Point<D>> points) {
    double extent = 0;
    for (std::size_t k = 0; k < D; ++k) {
        const auto [low, high] = std::minmax_element(
            points.begin(), points.end(), [k](const Point<D>& a, const Point<D>& b) { return a[k] < b[k]; });
        extent = std::max(extent, points.empty() ? 0 : (*high)[k] - (*low)[k]);
    }
    return extent;
}

/// Finds the row of each vertex of a patch in a file.
template<int D>
class RowFinder {
public:
    RowFinder(const DisplacementTable<D>& table, const PatchVertices<D>& vertices, double tolerance)
        : table_{table}, vertices_{vertices}, tolerance_{tolerance} {}

    std::vector<std::size_t> run() {
        std::vector<std::size_t> rows = table_.tracks.empty() ? by_position() : by_track();
        if (!missing_.empty()) {
            refuse_missing();
        }
        require_own_rows(rows);
        return rows;
    }

    /// Between a vertex and its row, over all vertices.
    double largest_distance() const { return largest_; }

private:
    std::vector<std::size_t> by_position() {
        const PointFinder<D> finder{table_.points};
        std::vector<std::size_t> rows;
        for (std::size_t i = 0; i < vertices_.points.size(); ++i) {
            const auto near = finder.within(vertices_.points[i], tolerance_);
            if (near.empty()) {
                missing_.push_back(i);
                continue;
            }
            for (const std::size_t other : near) { // points of a seam may be there twice
                if (table_.displacements[other] != table_.displacements[near.front()]) {
                    refuse_two_rows(i, near.front(), other);
                }
            }
            rows.push_back(near.front());
            note(distance(table_.points[near.front()], vertices_.points[i]));
        }
        return rows;
    }

    std::vector<std::size_t> by_track() {
        std::vector<std::size_t> order(table_.tracks.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
            return table_.tracks[a] < table_.tracks[b];
        });
        std::vector<std::size_t> rows;
        for (std::size_t i = 0; i < vertices_.tracks.size(); ++i) {
            const TrackId track = vertices_.tracks[i];
            const auto found =
                std::lower_bound(order.begin(), order.end(), track, [this](std::size_t row, TrackId wanted) {
                    return table_.tracks[row] < wanted;
                });
            if (found == order.end() || table_.tracks[*found] != track) {
                missing_.push_back(i);
                continue;
            }
            if (const auto after = std::next(found); after != order.end() && table_.tracks[*after] == track) {
                refuse_two_rows(i, *found, *after);
            }
            rows.push_back(*found);
            require_in_place(i, *found);
        }
        return rows;
    }

    /// Else tracks of another run would go unnoticed.
    void require_in_place(std::size_t vertex, std::size_t row) {
        if (table_.points.empty()) {
            return;
        }
        const Point<D>& start = vertices_.points[vertex];
        Point<D> displaced = start;
        for (std::size_t k = 0; k < D; ++k) {
            displaced[k] += table_.displacements[row][k];
        }
        const Point<D>& said = table_.points[row];
        const double off = std::min(distance(said, start), distance(said, displaced));
        if (!(off <= tolerance_)) {
            refuse(vertex,
                   fmt::format("{} has its track, but is {:.6g} from there and from where it would "
                               "be displaced to (tolerance {:.6g}): are the tracks those of this case?",
                               table_.row_name(row), off, tolerance_));
        }
        note(off);
    }

    void note(double off) { largest_ = std::max(largest_, off); }

    /// Two vertices on one row: the tolerance is too large for the spacing.
    void require_own_rows(const std::vector<std::size_t>& rows) const {
        std::vector<std::size_t> vertex_of_row(table_.displacements.size(), rows.size());
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const std::size_t other = std::exchange(vertex_of_row[rows[i]], i);
            if (other != rows.size()) {
                refuse(i,
                       fmt::format("{} is the nearest row, but that of the vertex at ({:.9g}), too; is the "
                                   "tolerance {:.6g} too large?",
                                   table_.row_name(rows[i]), fmt::join(vertices_.points[other], ", "),
                                   tolerance_));
            }
        }
    }

    [[noreturn]] void refuse_two_rows(std::size_t vertex, std::size_t first, std::size_t second) const {
        refuse(vertex, fmt::format("{} and {} both say how it is displaced{}", table_.row_name(first),
                                   table_.row_name(second),
                                   table_.tracks.empty()
                                       ? fmt::format(" (both are within the tolerance {:.6g})", tolerance_)
                                       : ""));
    }

    [[noreturn]] void refuse_missing() const {
        const std::size_t first = missing_.front();
        std::string nearest;
        if (!table_.points.empty()) {
            const std::size_t row = PointFinder<D>{table_.points}.nearest(vertices_.points[first]);
            nearest = fmt::format("; the nearest, {}, is {:.6g} away", table_.row_name(row),
                                  distance(table_.points[row], vertices_.points[first]));
        }
        refuse(first,
               fmt::format("no row {}{}. So it is for {} of {} vertices; give every vertex of the patch a "
                           "row, with its place "
                           "at the start",
                           table_.tracks.empty() ? fmt::format("is within the tolerance {:.6g}", tolerance_)
                                                 : "has its track",
                           nearest, missing_.size(), vertices_.points.size()));
    }

    [[noreturn]] void refuse(std::size_t vertex, const std::string& what) const {
        const TrackId track = vertices_.tracks[vertex];
        throw InputError(fmt::format("{}: vertex of track {} of patch {} at ({:.9g}): {}", table_.path, track,
                                     vertices_.patch, fmt::join(vertices_.points[vertex], ", "), what),
                         {{"track", track, vertices_.patch}});
    }

    const DisplacementTable<D>& table_;
    const PatchVertices<D>& vertices_;
    double tolerance_;
    double largest_ = 0;
    std::vector<std::size_t> missing_; ///< vertices without a row
};

/// Reads the files of one patch, one after the other.
template<int D>
class SeriesReader {
public:
    SeriesReader(const DisplacementSpec& spec, PatchVertices<D> vertices)
        : spec_{spec}, vertices_{std::move(vertices)}, files_{spec.files.empty()
                                                                  ? files_of_pattern(spec.pattern)
                                                                  : spec.files} {
        match_.files = files_.size();
        match_.vertices = vertices_.points.size();
        match_.tolerance = spec.tolerance.value_or(1e-6 * extent_of<D>(vertices_.points));
    }

    DisplacementFiles<D> run(const TimeInterval& span) {
        if (!spec_.times.empty() && spec_.times.size() != files_.size()) {
            throw UsageError(fmt::format("{} times for {} files of displacements, from {} to {}",
                                         spec_.times.size(), files_.size(), files_.front().string(),
                                         files_.back().string()));
        }
        rows_.tracks = vertices_.tracks;
        rows_.start = vertices_.points;
        for (std::size_t i = 0; i < files_.size(); ++i) {
            read(i);
        }
        require_cover(span);
        const auto motion = displacement_series<D>(std::move(rows_), spec_.interpolation);
        require_start(*motion, span.start);
        return {motion, std::move(match_)};
    }

private:
    void read(std::size_t number) {
        const auto table = read_displacement_table<D>(files_[number], spec_.array);
        if (spec_.times.empty() && !table.time) {
            throw UsageError(fmt::format("{} does not say its time (field data \"time\" of a VTU): the key "
                                         "\"times\" is needed, with a time for each file",
                                         table.path));
        }
        const double time = spec_.times.empty() ? *table.time : spec_.times[number];
        if (number > 0 && !(time > rows_.times.back())) {
            throw UsageError(
                fmt::format("the times of displacements must ascend, but {} at t = {} comes after "
                            "{} at t = {}",
                            table.path, time, files_[number - 1].string(), rows_.times.back()));
        }
        rows_.times.push_back(time);
        add_row(table);
    }

    void add_row(const DisplacementTable<D>& table) {
        RowFinder<D> finder{table, vertices_, match_.tolerance};
        Array<Point<D>>& row = rows_.displacements.emplace_back();
        for (const std::size_t found : finder.run()) {
            row.push_back(table.displacements[found]);
        }
        if (finder.largest_distance() > match_.largest) {
            match_.largest = finder.largest_distance();
            match_.where = table.path;
        }
    }

    void require_cover(const TimeInterval& span) const {
        const double slack = 1e-9 * (span.end - span.start);
        if (rows_.times.front() > span.start + slack || rows_.times.back() < span.end - slack) {
            throw UsageError(
                fmt::format("the displacements go from t = {} to {}, but the case from {} to {}; "
                            "add files or change [time]",
                            rows_.times.front(), rows_.times.back(), span.start, span.end));
        }
    }

    /// The mesh is that of the start, so nothing is displaced there.
    void require_start(const NodalMotion<D>& motion, double start) const {
        std::vector<Point<D>> places(vertices_.tracks.size());
        motion.positions(vertices_.tracks, start, places);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const double off = distance(places[i], vertices_.points[i]);
            if (off > match_.tolerance) {
                throw InputError(
                    fmt::format(
                        "{}: the vertex of track {} of patch {} at ({:.9g}) is displaced by {:.6g} at "
                        "the start of the case, t = {}, already; displacements count from the mesh "
                        "at the start",
                        files_.front().string(), vertices_.tracks[i], vertices_.patch,
                        fmt::join(vertices_.points[i], ", "), off, start),
                    {{"track", vertices_.tracks[i], vertices_.patch}});
            }
        }
    }

    const DisplacementSpec& spec_;
    PatchVertices<D> vertices_;
    std::vector<std::filesystem::path> files_;
    DisplacementRows<D> rows_;
    DisplacementMatch match_;
};

/// The number that stands in `name` for the '*' between `before` and `after`, if it is one.
std::optional<std::string> number_in(const std::string& name, const std::string& before,
                                     const std::string& after) {
    const bool long_enough = name.size() > before.size() + after.size();
    if (!long_enough || !name.starts_with(before) || !name.ends_with(after)) {
        return std::nullopt;
    }
    std::string digits = name.substr(before.size(), name.size() - before.size() - after.size());
    if (digits.find_first_not_of("0123456789") != std::string::npos) {
        return std::nullopt;
    }
    digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size() - 1));
    return digits;
}

} // namespace

std::vector<std::filesystem::path> files_of_pattern(const std::filesystem::path& pattern) {
    const std::string name = pattern.filename().string();
    const std::size_t star = name.find('*');
    if (star == std::string::npos || name.find('*', star + 1) != std::string::npos) {
        throw UsageError(
            fmt::format("the pattern {} needs one '*' in its file name, for a number", pattern.string()));
    }
    // Numbers without leading zeros ascend by length, then as texts.
    std::map<std::pair<std::size_t, std::string>, std::filesystem::path> by_number;
    const std::filesystem::path directory = pattern.has_parent_path() ? pattern.parent_path() : ".";
    std::error_code failure;
    for (const auto& entry : std::filesystem::directory_iterator{directory, failure}) {
        const std::string file = entry.path().filename().string();
        const auto number = number_in(file, name.substr(0, star), name.substr(star + 1));
        if (!number) {
            continue;
        }
        const auto [same, fresh] =
            by_number.try_emplace({number->size(), *number}, pattern.parent_path() / file);
        if (!fresh) {
            const auto [first, second] =
                std::minmax({same->second.string(), (pattern.parent_path() / file).string()});
            throw UsageError(
                fmt::format("the pattern {} finds both {} and {}", pattern.string(), first, second));
        }
    }
    if (by_number.empty()) {
        throw UsageError(fmt::format("pattern: there is no file with a number in place of the '*' of {}; "
                                     "check the path, which starts from the "
                                     "folder of the case file",
                                     pattern.string()));
    }
    std::vector<std::filesystem::path> files;
    for (const auto& [number, file] : by_number) {
        files.push_back(file);
    }
    return files;
}

template<int D>
DisplacementFiles<D> read_displacement_files(const DisplacementSpec& spec, const Surface<D>& start,
                                             std::span<const TrackId> tracks,
                                             std::span<const PatchNumber> patches, const TimeInterval& span) {
    return SeriesReader<D>{spec, vertices_of<D>(start, tracks, patches)}.run(span);
}

template DisplacementFiles<2> read_displacement_files<2>(const DisplacementSpec&, const Surface<2>&,
                                                         std::span<const TrackId>,
                                                         std::span<const PatchNumber>, const TimeInterval&);
template DisplacementFiles<3> read_displacement_files<3>(const DisplacementSpec&, const Surface<3>&,
                                                         std::span<const TrackId>,
                                                         std::span<const PatchNumber>, const TimeInterval&);

} // namespace slabhull
