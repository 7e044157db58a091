// SPDX-License-Identifier: BSD-3-Clause
#include "commands.h"

#include "mesh_formats.h"
#include "slabhull/cases/hull_files.h"
#include "slabhull/cases/report.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/slab/check_embedding.h"
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
    bool betti = false; ///< neither this nor the next: as far as it is practical
    bool no_betti = false;
    bool embedding = false; ///< even of torn hulls
    bool no_embedding = false;
    int threads = 0;
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

int check(const CheckCommand& command) {
    set_thread_count(command.threads);
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
    app->add_option("--threads", command->threads, "Threads to use; 0 for all cores")
        ->check(CLI::Range(0, 1024));
    app->footer(
        formats_help() +
        "Exit code 0: nothing found, 1: defects found.\nExample: slabhull check out/ellipsoid/slab_0000.vtu");
    app->callback([command, &exit_code] { exit_code = check(*command); });
}

} // namespace slabhull::tools
