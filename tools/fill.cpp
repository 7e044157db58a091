// SPDX-License-Identifier: BSD-3-Clause
#include "commands.h"

#include "mesh_formats.h"
#include "progress_display.h"
#include "slabhull/cases/filling_files.h"
#include "slabhull/cases/hull_files.h"
#include "slabhull/cases/report.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/io/files_read.h"
#include "slabhull/slab/fill.h"
#include "slabhull/slab/filling_quality.h"

#include <array>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace slabhull::tools {

namespace {

struct FillCommand {
    std::string hull;
    std::string from;
    std::string out;
    std::string to;
    std::string method = "march";
    double time_scale = 0;
    FillingFileOptions file;
    bool json = false;
    int threads = 0;
    std::string progress = "auto";
};

/// The hull in a soup, whose arrays it takes. Throws InputError when it is not sound.
template<int D>
Hull<D> sound_hull(const FillCommand& command, io::Soup& soup) {
    const HullArrays<D> arrays = hull_of_soup<D>(soup);
    const HullColumns<D> columns = arrays.columns();
    const HullReport report = check_hull<D>(columns);
    if (!report.clean()) {
        throw InputError{fmt::format("{}: `slabhull check` finds {} defects, so it cannot be filled; the "
                                     "first: {}",
                                     command.hull, report.total(), report.findings.front().text),
                         report.findings.front().entities};
    }
    Hull<D> hull = hull_of_columns<D>(columns);
    read_slab_fields(soup, hull);
    return hull;
}

template<int D>
void tell(const FillCommand& command, const Filling<D>& filling, std::size_t layers,
          const FillingReport& report, const StageClock& clock) {
    if (command.json) {
        nlohmann::ordered_json json{{"file", command.out}};
        json.update(nlohmann::ordered_json::parse(report_as_json(report)));
        const FillingQuality quality = filling_quality(filling, layers);
        json["steiner_points"] = filling.steiner_points;
        json["mean_ratio"] = {quality.smallest, quality.one_per_cent, quality.median};
        json["angle"] = {{"smallest", quality.angles.smallest}, {"largest", quality.angles.largest}};
        json["time_scale"] = quality.time_scale;
        for (const auto& [stage, seconds] : clock.stages()) {
            json["seconds"][stage] = seconds;
        }
        fmt::print("{}\n", json.dump(2));
        return;
    }
    fmt::print("{}: {} {} on {} points, {} of them centres; volume {:.15g}\n", command.out,
               filling.cells.size(), D == 2 ? "tetrahedra" : "pentatopes", filling.points.size(),
               filling.steiner_points, report.volume);
}

template<int D>
Filling<D> fill_hull(const FillCommand& command, const Hull<D>& hull, StageClock& clock) {
    if (command.method == "march") {
        try {
            return fill_slab(hull, clock);
        } catch (const GeometryError& error) {
            throw GeometryError{fmt::format("{}: {}", command.hull, error.what()), error.entities};
        }
    }
    if constexpr (D == 2) {
        return fill_unstructured(hull, clock, {command.time_scale});
    } else {
        throw UsageError{fmt::format("{}: TetGen fills hulls in 2D+t only; those in 3D+t whose caps are one "
                                     "mesh moved are filled by --method march",
                                     command.hull)};
    }
}

template<int D>
int fill_file(const FillCommand& command, io::Soup& soup) {
    const std::string format = filling_format(command.out, command.to, D);
    StageClock clock;
    const Hull<D> hull = sound_hull<D>(command, soup);
    clock.book("reading and checking the hull");
    enter_stage("filling");
    const Filling<D> filling = fill_hull(command, hull, clock);
    const FillingReport report = check_filling<D>(columns_of(filling), &hull);
    clock.book("check");
    if (!report.clean()) {
        throw GeometryError{fmt::format("the filling of {} is not sound, so it is not written:\n{}",
                                        command.hull, findings_as_text(report))};
    }
    enter_stage("writing");
    io::AtomicFiles files;
    write_filling<D>(files, command.out, filling, format, command.file);
    files.commit();
    clock.book("writing");
    enter_stage({}); // nothing is shown beside the report
    tell<D>(command, filling, hull.layers, report, clock);
    return 0;
}

int fill(const FillCommand& command) {
    set_thread_count(command.threads);
    ProgressDisplay display{progress_form(command.progress, false)};
    const ProgressScope shown{display.for_work()};
    enter_stage("reading");
    const io::FilesRead read;
    if (command.method == "march" && command.time_scale > 0) {
        throw UsageError{"--time-scale is for --method tetgen: an extrusion has its levels"};
    }
    io::Soup soup = read_named(command.hull, command.from);
    read.require_none(std::array{std::filesystem::path{command.out}});
    const MeshKind kind = kind_of(soup);
    if (!kind.hull) {
        throw UsageError{fmt::format(
            "{}: a mesh in space; only the hulls of slabs are filled: give a file that slabhull build wrote "
            "(slab_0000.vtu)",
            command.hull)};
    }
    return kind.dimension == 2 ? fill_file<2>(command, soup) : fill_file<3>(command, soup);
}

} // namespace

void add_fill(CLI::App& program, int& exit_code) {
    auto command = std::make_shared<FillCommand>();
    CLI::App* app = program.add_subcommand("fill", "Fill a hull with space-time simplices");
    app->add_option(
           "HULL", command->hull,
           "The hull of a slab; for march built with cap.reuse = \"move\" or \"adapt\" (then its VTU file)")
        ->required();
    app->add_option("OUT", command->out, "The filling: .mfem, .getfem, .h5; in 2D+t also .vtu and .msh")
        ->required();
    app->add_option("--from", command->from, "Format of HULL, whatever its extension and content");
    app->add_option("--to", command->to, "Format of OUT, whatever its extension");
    app->add_option("--method", command->method,
                    "march: by extrusion of the caps' cells; tetgen (2D+t): whatever the caps, unstructured")
        ->check(CLI::IsMember({"march", "tetgen"}));
    app->add_option(
           "--time-scale", command->time_scale,
           "With tetgen: the length that a unit of time counts for; by default a layer lasts an edge")
        ->check(positive_number());
    app->add_option("--pentatope-code", command->file.pentatope_code,
                    "Of MFEM files in four dimensions: 6 (CFOSLS, older), 7 (2021) or 8 (later)")
        ->check(CLI::Range(6, 8));
    app->add_flag("--json", command->json, "One JSON document on stdout");
    add_progress_option(*app, command->progress);
    app->add_option("--threads", command->threads, "Threads to use; 0 for all cores")
        ->check(CLI::Range(0, 1024));
    app->footer("Exit code 4: the caps are not one mesh moved, or a simplex would be inside out.\n"
                "Example: slabhull fill out/ellipsoid/slab_0000.vtu fill_0000.mfem");
    app->callback([command, &exit_code] { exit_code = fill(*command); });
}

} // namespace slabhull::tools
