// SPDX-License-Identifier: BSD-3-Clause
#include "commands.h"

#include "mesh_formats.h"
#include "progress_display.h"
#include "slabhull/cases/filling_files.h"
#include "slabhull/cases/hull_files.h"
#include "slabhull/cases/report.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/slab/check_embedding.h"
#include "slabhull/slab/fill.h"
#include "slabhull/topology/homology.h"

#include <fmt/format.h>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

namespace slabhull::tools {

namespace {

struct CheckCommand {
    std::string file;
    std::string from;
    bool json = false;
    bool betti = false; ///< without this and the next: for hulls up to practical_betti_cells
    bool no_betti = false;
    bool embedding = false; ///< also where facets are at fault
    bool no_embedding = false;
    std::string hull; ///< that the filling is compared with
    int threads = 0;
    std::string progress = "auto";
};

constexpr int clean = 0;
constexpr int defects_found = 1;

std::string counted(std::size_t findings) {
    return findings == 0 ? "nothing found" : fmt::format("{} finding{}", findings, findings > 1 ? "s" : "");
}

void print_report(const std::string& file, const HullReport& report) {
    const auto& counts = report.counts;
    const auto& cells = report.cells_by_region;
    const auto& measures = report.measure_by_region;
    fmt::print("{}: hull of a slab in {}D+t, t = {} to {}\n", file, report.dimension, report.time[0],
               report.time[1]);
    fmt::print("  {} vertices, {} edges, {} facets, {} cells (initial {}, side {}, terminating {})\n",
               counts.vertices, counts.edges, counts.facets, counts.cells, cells[0], cells[1], cells[2]);
    fmt::print("  Euler characteristic {}, {} component{}", counts.euler, counts.components,
               counts.components == 1 ? "" : "s");
    if (!report.betti.empty()) {
        fmt::print(", Betti numbers ({})", fmt::join(report.betti, ", "));
    }
    fmt::print("\n  measure {:.10g} (initial {:.10g}, side {:.10g}, terminating {:.10g})\n", report.measure,
               measures[0], measures[1], measures[2]);
    fmt::print("  encloses {:.10g}, |sum of normals| {:.3g}, dihedral angles {:.1f} to {:.1f} degrees\n",
               report.enclosed, report.closure, report.angles.smallest, report.angles.largest);
}

void print_report(const std::string& file, const MeshReport& report) {
    fmt::print("{}: mesh of dimension {}\n", file, report.dimension);
    fmt::print("  {} vertices, {} cells, {} boundary facets, {} component{}\n", report.vertices, report.cells,
               report.boundary_facets, report.components, report.components == 1 ? "" : "s");
    fmt::print("  measure {:.10g}, dihedral angles {:.1f} to {:.1f} degrees\n", report.measure,
               report.angles.smallest, report.angles.largest);
}

void print_report(const std::string& file, const FillingReport& report) {
    fmt::print("{}: filling of a slab in {}D+t, t = {} to {}\n", file, report.dimension, report.time[0],
               report.time[1]);
    fmt::print("  {} vertices, {} cells, {} boundary facets", report.vertices, report.cells,
               report.boundary_facets);
    for (const auto& [attribute, facets] : report.facets_by_attribute) {
        fmt::print("{}{} of attribute {}",
                   attribute == report.facets_by_attribute.begin()->first ? " (" : ", ", facets, attribute);
    }
    fmt::print("{}\n  volume {:.15g}, the boundary encloses {:.15g}; smallest cell {:.3g}\n",
               report.facets_by_attribute.empty() ? "" : ")", report.volume, report.enclosed,
               report.smallest_volume);
}

void print_summary(const EmbeddingSummary& embedding) {
    fmt::print("  embedding: {} cells{}; {} of {} stars proven as a whole, {} pairs of groups apart from "
               "each other; "
               "{} pairs of cells, {} of them decided in rational numbers{}\n",
               embedding.tested_cells, embedding.caps_proven ? ", the caps proven as a whole" : "",
               embedding.proven_stars, embedding.stars, embedding.group_pairs, embedding.tested_pairs,
               embedding.exact_pairs, embedding.all_listed ? "" : "; stopped, as there are many crossings");
}

template<class Report>
int tell(const CheckCommand& command, const Report& report,
         const std::optional<EmbeddingSummary>& embedding = std::nullopt) {
    enter_stage({}); // nothing is shown beside the report
    if (command.json) {
        nlohmann::ordered_json json{{"file", command.file}};
        json.update(nlohmann::ordered_json::parse(report_as_json(report)));
        if (embedding) {
            json["embedding"] = nlohmann::ordered_json::parse(report_as_json(*embedding));
        }
        fmt::print("{}\n", json.dump(2));
    } else {
        print_report(command.file, report);
        if (embedding) {
            print_summary(*embedding);
        }
        fmt::print("{}{}\n", findings_as_text(report), counted(report.total()));
    }
    return report.clean() ? clean : defects_found;
}

std::size_t betti_limit(const CheckCommand& command) {
    if (command.no_betti) {
        return 0;
    }
    return command.betti ? std::numeric_limits<std::size_t>::max() : practical_betti_cells;
}

template<int D>
int check_soup(const CheckCommand& command, io::Soup& soup, bool hull) {
    CheckOptions options;
    options.betti_cells = betti_limit(command);
    const io::SimplexBlock& block = soup.simplices[D];
    if (!soup.point_tags.empty()) {
        options.vertex_number = [&soup](Index v) { return soup.point_tag(v); };
    }
    if (!block.tags.empty()) {
        options.cell_number = [&block](Index c) { return block.tag(c); };
    }
    if (hull) {
        const HullArrays<D> arrays = hull_of_soup<D>(soup);
        const HullColumns<D> columns = arrays.columns();
        HullReport report = check_hull<D>(columns, options);
        std::optional<EmbeddingSummary> embedding;
        if (!command.no_embedding) {
            embedding = check_embedding<D>(columns, options, report, command.embedding);
        } else {
            report.skipped.push_back("embedding: left out, as asked (--no-embedding)");
        }
        return tell(command, report, embedding);
    }
    if (command.embedding) {
        throw UsageError{
            fmt::format("{}: a mesh in space; --embedding is for the hulls of slabs", command.file)};
    }
    const MeshArrays<D> mesh = mesh_of_soup<D>(soup);
    return tell(command, check_mesh<D>(mesh.points, mesh.cells, options));
}

/// The hull of a file, in the order that fillings need.
template<int D>
Hull<D> read_hull(const CheckCommand& command) {
    io::Soup soup = read_named(command.hull, "");
    const MeshKind kind = kind_of(soup);
    if (kind.dimension != D || !kind.hull) {
        throw UsageError{
            fmt::format("--hull: {} is not a hull in {}D+t; give the one that was filled (slab_0000.vtu)",
                        command.hull, D)};
    }
    const HullArrays<D> arrays = hull_of_soup<D>(soup);
    return hull_of_columns<D>(arrays.columns());
}

template<int D>
int check_filling_file(const CheckCommand& command, const FillingArrays<D>& filling) {
    std::optional<Hull<D>> hull;
    if (!command.hull.empty()) {
        hull = read_hull<D>(command);
    }
    return tell(command, check_filling<D>(filling.columns(), hull ? &*hull : nullptr));
}

/// Tetrahedra of points (x, y, t) as a filling; triangles that a file lists are claims of its boundary, their
/// groups attributes.
FillingArrays<2> filling_in_space(const io::Soup& soup) {
    const MeshArrays<3> mesh = mesh_of_soup<3>(soup);
    FillingArrays<2> filling;
    filling.points = mesh.points;
    filling.cells = mesh.cells;
    const io::SimplexBlock& listed = soup.simplices[2];
    filling.facets.resize(listed.size(2));
    for (std::size_t f = 0; f < filling.facets.size(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            filling.facets[f][k] = listed.vertices[3 * f + k];
        }
    }
    filling.facet_attribute.assign(listed.physical.begin(), listed.physical.end());
    return filling;
}

/// Checks a filling: a space-time file, or any file when --hull is given; nothing for other files.
std::optional<int> check_as_filling(const CheckCommand& command) {
    if (io::is_space_time_file(command.file)) {
        io::SpaceTimeSoup soup = io::read_space_time(command.file);
        return soup.dimension == 3 ? check_filling_file<2>(command, filling_of_soup<2>(soup))
                                   : check_filling_file<3>(command, filling_of_soup<3>(soup));
    }
    if (command.hull.empty()) {
        return std::nullopt;
    }
    const io::Soup soup = read_named(command.file, command.from); // tetrahedra of points (x, y, t)
    if (kind_of(soup).hull) {
        throw UsageError{
            fmt::format("{}: the hull of a slab, no filling, which --hull compares with the hull "
                        "that it fills; leave --hull out to check it by itself",
                        command.file)};
    }
    return check_filling_file<2>(command, filling_in_space(soup));
}

int check(const CheckCommand& command) {
    set_thread_count(command.threads);
    ProgressDisplay display{progress_form(command.progress, false)};
    const ProgressScope shown{display.for_work()};
    enter_stage("reading");
    if (const std::optional<int> exit_code = check_as_filling(command)) {
        return *exit_code;
    }
    io::Soup soup = read_named(command.file, command.from);
    const MeshKind kind = kind_of(soup);
    return kind.dimension == 2 ? check_soup<2>(command, soup, kind.hull)
                               : check_soup<3>(command, soup, kind.hull);
}

} // namespace

void add_check(CLI::App& program, int& exit_code) {
    auto command = std::make_shared<CheckCommand>();
    CLI::App* app = program.add_subcommand("check", "Validate a mesh or hull, list what is wrong");
    app->add_option("FILE", command->file, "A hull or mesh")->required();
    app->add_option("--from", command->from, "Format of FILE, whatever its extension and content");
    app->add_flag("--json", command->json, "One JSON document on stdout");
    CLI::Option* betti = app->add_flag(
        "--betti", command->betti,
        fmt::format("Betti numbers, the slowest part, of any hull; else of those up to {} cells",
                    practical_betti_cells));
    app->add_flag("--no-betti", command->no_betti, "No Betti numbers")->excludes(betti);
    CLI::Option* embedding = app->add_flag("--embedding", command->embedding,
                                           "For a hull with facets at fault, too: whether it crosses itself, "
                                           "pair of cells by pair; all others are "
                                           "proven not to without this");
    app->add_flag("--no-embedding", command->no_embedding,
                  "No proof that a hull does not cross itself, in space or in time between its levels")
        ->excludes(embedding);
    app->add_option("--hull", command->hull, "FILE fills the hull of this file: compare them");
    add_progress_option(*app, command->progress);
    app->add_option("--threads", command->threads, "Threads to use; 0 for all cores")
        ->check(CLI::Range(0, 1024));
    app->footer(
        formats_help() +
        "Exit code 0: nothing found, 1: defects found.\nExample: slabhull check out/ellipsoid/slab_0000.vtu");
    app->callback([command, &exit_code] { exit_code = check(*command); });
}

} // namespace slabhull::tools
