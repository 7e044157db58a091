// SPDX-License-Identifier: BSD-3-Clause
#include "commands.h"

#include "mesh_formats.h"
#include "slabhull/cases/filling_files.h"
#include "slabhull/cases/hull_files.h"
#include "slabhull/cases/report.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/io/files_read.h"
#include "slabhull/io/space_time_files.h"
#include "slabhull/slab/slice.h"
#include "slabhull/slab/slice_filling.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

namespace slabhull::tools {

namespace {

struct SliceCommand {
    std::vector<std::string> files;
    std::string from;
    std::optional<std::string> time;
    std::string times;
    std::string out;
    bool json = false;
    int threads = 0;
};

// --- times

double parse_time(std::string_view text, const char* option) {
    double time = 0;
    const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), time);
    if (problem != std::errc{} || stop != text.data() + text.size() || !std::isfinite(time)) {
        throw UsageError{fmt::format("{}: expected a finite number, not \"{}\"; write times as 0.5, 0:1:11 "
                                     "(first:last:number) or 0,0.5,1",
                                     option, text)};
    }
    return time;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t end = 0; end != std::string_view::npos;
         text.remove_prefix(std::min(text.size(), end + 1))) {
        end = text.find(separator);
        parts.push_back(text.substr(0, end));
    }
    return parts;
}

/// "a:b:n": n times from a to b, both included.
std::vector<double> parse_range(const std::vector<std::string_view>& parts) {
    constexpr int most = 1'000'000;
    int count = 0;
    const std::string_view text = parts.size() == 3 ? parts[2] : "";
    const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (problem != std::errc{} || stop != text.data() + text.size() || count < 2 || count > most) {
        throw UsageError{fmt::format("--times: expected first:last:number with a number from 2 to {}", most)};
    }
    const double first = parse_time(parts[0], "--times");
    const double last = parse_time(parts[1], "--times");
    std::vector<double> times;
    for (int k = 0; k < count; ++k) {
        times.push_back(std::lerp(first, last, static_cast<double>(k) / (count - 1)));
    }
    return times;
}

/// Ascending, each once.
std::vector<double> times_of(const SliceCommand& command) {
    if (command.time) {
        return {parse_time(*command.time, "--time")};
    }
    std::vector<double> times;
    if (const auto parts = split(command.times, ':'); parts.size() > 1) {
        times = parse_range(parts);
    } else {
        for (const std::string_view part : split(command.times, ',')) {
            times.push_back(parse_time(part, "--times"));
        }
    }
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

// --- files

/// Where the sections go: one file, or numbered files with a series that lists them.
class Target {
public:
    Target(const std::filesystem::path& out, std::size_t times) {
        if (out.extension() == ".vtu") {
            if (times > 1) {
                throw UsageError{fmt::format("--out: {} holds one section, but there are {} times; give a "
                                             "directory or a .pvd file",
                                             out.string(), times)};
            }
            stem_ = out;
        } else if (out.extension() == ".pvd") {
            series_ = out;
            stem_ = out.parent_path() / out.stem();
        } else if (!out.has_extension() || std::filesystem::is_directory(out)) {
            series_ = out / "sections.pvd";
            stem_ = out / "section";
        } else {
            throw UsageError{
                fmt::format("--out: expected a .vtu or .pvd file or a directory, not {}", out.string())};
        }
    }

    std::filesystem::path file(std::size_t k) const {
        return series_ ? std::filesystem::path{fmt::format("{}_{:04}.vtu", stem_.string(), k)} : stem_;
    }
    const std::optional<std::filesystem::path>& series() const { return series_; }

    void make_directory() const {
        if (stem_.has_parent_path()) {
            io::make_folder(stem_.parent_path());
        }
    }

private:
    std::filesystem::path stem_;
    std::optional<std::filesystem::path> series_;
};

// --- cutting

/// A section that was cut, its file complete but not yet in place.
struct Written {
    double time = 0;
    std::filesystem::path path;
    std::unique_ptr<io::AtomicFile> file;
    std::string text; ///< what is told of it
    nlohmann::ordered_json json;
};

std::string told(const SectionReport& report, const PatchList& patches) {
    const bool plane = report.dimension == 2;
    std::string parts;
    for (const PatchMeasure& patch : report.patches) {
        parts += fmt::format("{}{} {:.10g}", parts.empty() ? "" : ", ", patch_name(patches, patch.number),
                             patch.measure);
    }
    return fmt::format("  {} {}, {} vertices, {} closed {}{}, |sum of normals| {:.3g}\n"
                       "  {} {:.10g} ({}), encloses {:.10g}\n",
                       report.facets, plane ? "edges" : "triangles", report.vertices, report.components,
                       plane ? "curve" : "surface", report.components > 1 ? "s" : "", report.closure,
                       plane ? "length" : "area", report.measure, parts, report.enclosed);
}

std::string told(const FillingSectionReport& report) {
    const bool plane = report.dimension == 2;
    return fmt::format("  {} {}, {} vertices\n  {} {:.10g}, the smallest cell {:.3g}\n", report.cells,
                       plane ? "triangles" : "tetrahedra", report.vertices, plane ? "area" : "volume",
                       report.measure, report.smallest_cell);
}

nlohmann::ordered_json as_json(const FillingSectionReport& report) {
    nlohmann::ordered_json facets = nlohmann::ordered_json::object();
    for (const auto& [attribute, count] : report.facets_by_attribute) {
        facets[std::to_string(attribute)] = count;
    }
    return {{"time", report.time},
            {"counts", {{"vertices", report.vertices}, {"cells", report.cells}}},
            {"facets_by_attribute", facets},
            {"measure", {{"domain", report.measure}, {"smallest_cell", report.smallest_cell}}}};
}

/// One pass over the files. No file gets its final name before all times are cut.
class SliceRun {
public:
    explicit SliceRun(const SliceCommand& command)
        : command_{command}, times_{times_of(command)}, target_{command.out, times_.size()},
          sections_(times_.size()) {}

    void run() {
        target_.make_directory();
        for (const std::string& file : command_.files) {
            cut_file(file);
        }
        read_.require_none(outputs());
        require_all_cut();
        commit();
        command_.json ? print_json() : print_text();
    }

private:
    std::vector<std::filesystem::path> outputs() const {
        std::vector<std::filesystem::path> paths;
        for (std::size_t k = 0; k < times_.size(); ++k) {
            paths.push_back(target_.file(k));
        }
        if (target_.series()) {
            paths.push_back(*target_.series());
        }
        return paths;
    }

    void cut_file(const std::string& file) {
        if (io::is_space_time_file(file)) {
            return cut_filling_file(file);
        }
        io::Soup soup = read_named(file, command_.from);
        const MeshKind kind = kind_of(soup);
        if (!kind.hull) {
            throw InputError{
                fmt::format("{}: neither the hull of a slab nor a filling that can be cut; give a "
                            "hull that slabhull build wrote (slab_0000.vtu), or a filling as .h5 "
                            "or .getfem",
                            file)};
        }
        require_dimension(file, kind.dimension);
        cut_as_input(file, [&] { kind.dimension == 2 ? cut_hull<2>(file, soup) : cut_hull<3>(file, soup); });
    }

    void cut_filling_file(const std::string& file) {
        io::SpaceTimeSoup soup = io::read_space_time(file);
        require_dimension(file, soup.dimension - 1);
        cut_as_input(file,
                     [&] { soup.dimension == 3 ? cut_filling<2>(file, soup) : cut_filling<3>(file, soup); });
    }

    void require_dimension(const std::string& file, int dimension) {
        if (dimension_ != 0 && dimension != dimension_) {
            throw UsageError{
                fmt::format("{} is of {}D+t, the files before it are of {}D+t", file, dimension, dimension_)};
        }
        dimension_ = dimension;
    }

    /// What cannot be cut is the file's fault.
    template<class Cut>
    static void cut_as_input(const std::string& file, const Cut& cut) {
        try {
            cut();
        } catch (const GeometryError& error) {
            throw InputError{fmt::format("{}: {}", file, error.what()), error.entities};
        }
    }

    template<int D>
    void cut_hull(const std::string& file, io::Soup& soup) {
        const HullArrays<D> arrays = hull_of_soup<D>(soup);
        const HullColumns<D> hull = arrays.columns();
        const std::vector<std::size_t> numbers = times_within(file, time_span(hull));
        std::vector<double> times;
        for (const std::size_t k : numbers) {
            times.push_back(times_[k]);
        }
        SliceOptions options;
        options.cell_number = [&](Index cell) { return soup.simplices[D].tag(cell); };
        auto next = numbers.begin();
        slice_hull<D>(
            hull, times, [&](Section<D>&& section) { write(file, *next++, section); }, options);
    }

    template<int D>
    void cut_filling(const std::string& file, io::SpaceTimeSoup& soup) {
        const FillingArrays<D> arrays = filling_of_soup<D>(soup);
        const FillingColumns<D> filling = arrays.columns();
        for (const std::size_t k : times_within(file, time_span(filling))) {
            write(file, k, slice_filling<D>(filling, times_[k]));
        }
    }

    /// The numbers of the times in the span that are not cut yet.
    std::vector<std::size_t> times_within(const std::string& file, const TimeSpan& span) {
        spans_ +=
            fmt::format("{}{} lasts from {} to {}", spans_.empty() ? "" : ", ", file, span.first, span.last);
        std::vector<std::size_t> numbers;
        for (std::size_t k = 0; k < times_.size(); ++k) {
            if (sections_[k].file == nullptr && span.contains(times_[k])) {
                numbers.push_back(k);
            }
        }
        return numbers;
    }

    template<int D>
    void write(const std::string& hull, std::size_t k, const Section<D>& section) {
        const SectionReport report = measure_section(section);
        auto json = nlohmann::ordered_json::parse(report_as_json(report, section.surface.patches));
        json["hull"] = hull;
        finish(hull, k, section, told(report, section.surface.patches), std::move(json));
    }
    template<int D>
    void write(const std::string& filling, std::size_t k, const FillingSection<D>& section) {
        const FillingSectionReport report = measure_section(section);
        auto json = as_json(report);
        json["filling"] = filling;
        finish(filling, k, section, told(report), std::move(json));
    }
    template<class Cut>
    void finish(const std::string& from, std::size_t k, const Cut& section, const std::string& text,
                nlohmann::ordered_json json) {
        const auto path = target_.file(k);
        auto file = std::make_unique<io::AtomicFile>(path);
        write_section(*file, section);
        file->finish();
        json["file"] = path.string();
        sections_[k] = {section.time, path, std::move(file),
                        fmt::format("{}: t = {}, cut from {}\n{}", path.string(), section.time, from, text),
                        std::move(json)};
    }

    void require_all_cut() const {
        for (std::size_t k = 0; k < times_.size(); ++k) {
            if (sections_[k].file == nullptr) {
                throw UsageError{
                    fmt::format("{}: t = {} is in none of the files: {}; give a time in one of them",
                                command_.time ? "--time" : "--times", times_[k], spans_)};
            }
        }
    }

    void commit() {
        std::vector<io::SeriesEntry> series;
        for (const Written& section : sections_) {
            section.file->commit();
            series.push_back({section.time, section.path.filename()});
        }
        if (target_.series()) {
            io::write_pvd(*target_.series(), series);
        }
    }

    void print_json() const {
        nlohmann::ordered_json sections = nlohmann::ordered_json::array();
        for (const Written& section : sections_) {
            sections.push_back(section.json);
        }
        nlohmann::ordered_json document{{"sections", std::move(sections)}};
        if (target_.series()) {
            document["series"] = target_.series()->string();
        }
        fmt::print("{}\n", document.dump(2));
    }

    void print_text() const {
        for (const Written& section : sections_) {
            fmt::print("{}", section.text);
        }
        if (target_.series()) {
            fmt::print("{}: {} section{}\n", target_.series()->string(), sections_.size(),
                       sections_.size() > 1 ? "s" : "");
        }
    }

    const io::FilesRead read_{};
    const SliceCommand& command_;
    std::vector<double> times_;
    Target target_;
    std::vector<Written> sections_; ///< by time; without a file until it is cut
    int dimension_ = 0;
    std::string spans_; ///< of the hulls, for messages
};

} // namespace

void add_slice(CLI::App& program, int& exit_code) {
    auto command = std::make_shared<SliceCommand>();
    CLI::App* app = program.add_subcommand(
        "slice",
        "Cut hulls at instants: the domain's closed boundary with its patches, and what it encloses; or "
        "fillings: the domain's mesh");
    app->add_option("FILE", command->files,
                    "Hulls of one or more slabs, or fillings (MFEM of dimension 4, GetFEM, HDF5)")
        ->required();
    app->add_option("--from", command->from, "Format of all FILEs, whatever their extension and content");
    CLI::Option_group* when = app->add_option_group("When", "One of");
    when->add_option("--time", command->time, "One time");
    when->add_option("--times", command->times, "first:last:number, both ends included, or a list t1,t2,...");
    when->require_option(1);
    app->add_option("--out", command->out,
                    "FILE.vtu for one time; FILE.pvd or a directory for a series that ParaView opens")
        ->required();
    app->add_flag("--json", command->json, "One JSON document on stdout");
    app->add_option("--threads", command->threads, "Threads to use; 0 for all cores")
        ->check(CLI::Range(0, 1024));
    app->footer(
        "Each time is cut from the first of the files that contains it. At a cap's own time the section is "
        "the cap's\nboundary; the mesh inside is in build's cap files (cap_0001.vtu ...).\n"
        "Example: slabhull slice out/ellipsoid/slab_0000.vtu --times 0:1:50 --out "
        "out/ellipsoid/surface.pvd");
    app->callback([command, &exit_code] {
        set_thread_count(command->threads);
        SliceRun{*command}.run();
        exit_code = 0;
    });
}

} // namespace slabhull::tools
