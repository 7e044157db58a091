// SPDX-License-Identifier: BSD-3-Clause
#include "commands.h"

#include "mesh_formats.h"
#include "slabhull/core/error.h"
#include "slabhull/slab/soup_edit.h"
#include "slabhull/slab/soup_numbers.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <optional>

namespace slabhull::tools {

namespace {

struct ConvertCommand {
    std::string in;
    std::string out;
    std::string from;
    std::string to;
    std::string region;
    std::optional<std::string> patch;
    std::optional<double> weld;
    std::optional<double> scale;
    std::string renumber;
    std::optional<std::size_t> pieces;
    bool boundary = false;
    bool reverse = false;
};

const std::vector<std::string> regions{"initial", "side", "terminating"}; // by their numbers

void require_sense(const ConvertCommand& command) {
    if (command.weld && !(*command.weld >= 0 && std::isfinite(*command.weld))) {
        throw UsageError{fmt::format("--weld: expected a distance of at least 0, not {}", *command.weld)};
    }
    if (command.scale && !(*command.scale > 0 && std::isfinite(*command.scale))) {
        throw UsageError{fmt::format("--scale: expected a positive factor, not {}", *command.scale)};
    }
    if (command.pieces == std::size_t{0}) {
        throw UsageError{"--pieces: expected a number of at least 1, not 0"};
    }
}

void tell(const std::string& file, const std::string& text) {
    fmt::print(stderr, "slabhull: {}: {}\n", file, text);
}

void edit(const ConvertCommand& command, io::Soup& soup) {
    if (!command.region.empty()) {
        const auto region = std::find(regions.begin(), regions.end(), command.region) - regions.begin();
        select_region(soup, static_cast<int>(region));
    }
    if (command.patch) {
        select_patch(soup, *command.patch);
    }
    if (command.boundary) {
        extract_boundary(soup);
    }
    if (command.weld) {
        const Welded welded = weld(soup, *command.weld);
        tell(command.in, fmt::format("{} points welded to others, {} cells that collapsed left out",
                                     welded.points, welded.cells));
    }
    if (command.scale) {
        scale(soup, *command.scale);
    }
    if (command.reverse) {
        reverse(soup);
    }
    if (!command.renumber.empty()) {
        renumber_along_curve(soup);
    }
}

void require_dimension(const ConvertCommand& command, const io::Format& format, const io::Soup& soup) {
    const int dimension = soup.top_dimension();
    if (dimension == 0) {
        throw InputError{fmt::format("{}: there are no cells to write", command.in)};
    }
    if (dimension < format.holds.least_dimension || dimension > format.holds.most_dimension) {
        const bool surface_would_do = dimension == 3 && format.holds.most_dimension == 2;
        throw UsageError{fmt::format("{}: {} has no place for {}{}", command.out, format.title,
                                     simplices_called(dimension),
                                     surface_would_do ? "; --extract-boundary gives their surface" : "")};
    }
}

/// Brings what the soup says into the format's own terms, and tells what is lost.
void adapt(const ConvertCommand& command, const io::Format& format, io::Soup& soup,
           const std::vector<std::string>& lost_numbers) {
    format.holds.groups ? arrays_to_groups(soup) : groups_to_arrays(soup);
    std::vector<std::string> lost = io::losses(format, soup);
    lost.insert(lost.end(), lost_numbers.begin(), lost_numbers.end());
    if (!lost.empty()) {
        tell(command.out, fmt::format("{} does not hold: {}", format.title, fmt::join(lost, "; ")));
    }
    if (format.holds.tags) {
        number_by_tags(soup);
    }
}

/// Hulls keep the types that docs/formats.md gives their arrays.
io::MeshColumns columns_to_write(const io::Soup& soup) {
    io::MeshColumns mesh = io::columns_of(soup);
    for (io::DataColumn& column : mesh.cell_data) {
        if (column.type == io::Scalar::int64 &&
            (column.name == "region" || column.name == "patch" || column.name == "layer")) {
            column.type = io::Scalar::int32;
        }
    }
    return mesh;
}

void write(const ConvertCommand& command, const io::Format& to, const io::MeshColumns& mesh) {
    if (command.pieces) {
        to.write_pieces(command.out, mesh, *command.pieces);
        return;
    }
    io::AtomicFile file{command.out};
    to.write(file, mesh);
    file.commit();
}

int convert(const ConvertCommand& command) {
    const io::Format& from = format_to_read(command.in, command.from);
    const io::Format& to = command.pieces ? format_to_write_in_pieces(command.out, command.to)
                                          : format_to_write(command.out, command.to);
    require_sense(command);
    io::Soup soup = from.read(command.in);
    const std::vector<std::string> lost_numbers = io::lost_numbers(soup);
    settle_numbers(soup);
    edit(command, soup);
    require_dimension(command, to, soup);
    adapt(command, to, soup, lost_numbers);
    const io::MeshColumns mesh = columns_to_write(soup);
    write(command, to, mesh);
    fmt::print("{}: {} points, {} {}\n", command.out, soup.points.size(), mesh.cells.rows(),
               simplices_called(mesh.dimension));
    return 0;
}

} // namespace

void add_convert(CLI::App& program, int& exit_code) {
    auto command = std::make_shared<ConvertCommand>();
    CLI::App* app = program.add_subcommand("convert", "Translate a mesh or hull to another format");
    app->add_option("IN", command->in, "The mesh to read")->required();
    app->add_option("OUT", command->out, "The file to write; whole, or not at all")->required();
    app->add_option("--from", command->from, "Format of IN, whatever its extension");
    app->add_option("--to", command->to, "Format of OUT, whatever its extension");
    app->add_option("--region", command->region, "Of a hull, only that part: initial, side or terminating")
        ->check(CLI::IsMember(regions));
    app->add_option("--patch", command->patch,
                    "Only the simplices of the patch or physical group of that name");
    app->add_flag("--extract-boundary", command->boundary, "The facets that only one cell has, outward");
    app->add_option("--weld", command->weld, "Join points that are no farther apart than that");
    app->add_option("--scale", command->scale, "Multiply space by that; time stays");
    app->add_flag("--reverse", command->reverse, "Turn all simplices round");
    app->add_option("--renumber", command->renumber,
                    "Number points and cells along a space-filling curve: curve")
        ->check(CLI::IsMember({"curve"}));
    app->add_option("--pieces", command->pieces,
                    "Write so many files, ranges of cells, for parallel readers: .pvtu, .msh");
    app->footer(
        "These are done in the order in which they are listed. What OUT's format cannot hold is told on "
        "stderr.\n" +
        formats_help() +
        "Example: slabhull convert out/room/slab_0000.vtu side.msh --region side --renumber curve");
    app->callback([command, &exit_code] { exit_code = convert(*command); });
}

} // namespace slabhull::tools
