// SPDX-License-Identifier: BSD-3-Clause
#include "commands.h"

#include "fillings.h"
#include "mesh_formats.h"
#include "slabhull/core/error.h"
#include "slabhull/edit/soup_edit.h"
#include "slabhull/edit/soup_numbers.h"
#include "slabhull/edit/soup_output.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
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
    bool boundary = false;
    bool reverse = false;
    bool split = false;
    io::ReadOptions reading;
    io::WriteOptions writing;
};

const std::vector<std::string> region_names{"initial", "side", "terminating"}; // by their numbers

void require_sense(const ConvertCommand& command) {
    if (command.weld && !(*command.weld >= 0 && std::isfinite(*command.weld))) {
        throw UsageError{fmt::format("--weld: expected a distance of at least 0, not {}", *command.weld)};
    }
    if (command.scale && !(*command.scale > 0 && std::isfinite(*command.scale))) {
        throw UsageError{fmt::format("--scale: expected a positive factor, not {}", *command.scale)};
    }
}

void tell(const std::string& file, const std::string& text) {
    fmt::print(stderr, "slabhull: {}: {}\n", file, text);
}

/// Whether what is written is not the whole hull as it was built.
bool ends_adaptation(const ConvertCommand& command, const Welded& welded) {
    return !command.region.empty() || command.patch || command.boundary || command.split ||
           command.scale.value_or(1) != 1 || !command.renumber.empty() || welded.points + welded.cells > 0;
}

void edit(const ConvertCommand& command, io::Soup& soup) {
    if (!command.region.empty()) {
        const auto region =
            std::find(region_names.begin(), region_names.end(), command.region) - region_names.begin();
        select_region(soup, static_cast<int>(region));
    }
    if (command.patch) {
        select_patch(soup, *command.patch);
    }
    if (command.boundary) {
        extract_boundary(soup);
    }
    Welded welded;
    if (command.weld) {
        welded = weld(soup, *command.weld);
        tell(command.in, fmt::format("{} points welded to others, {} cells that collapsed left out",
                                     welded.points, welded.cells));
    }
    if (ends_adaptation(command, welded) && drop_adaptation(soup)) {
        tell(command.in,
             "adapt_settings and adapt_spacing left out: slabhull fill needs an adapted hull as it was "
             "built; fill it first");
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
    if (dimension < format.features.min_dimension || dimension > format.features.max_dimension) {
        const bool surface_would_do = dimension == 3 && format.features.max_dimension == 2;
        throw FormatLimit{fmt::format(
            "{}: {} has no place for {}; give {}", command.out, format.title, simplices_called(dimension),
            surface_would_do ? "--extract-boundary for their surface" : "a format that has, such as .vtu")};
    }
}

/// OUT's name with the part's before its extension; what is awkward in a file's name becomes '_'.
std::filesystem::path path_of_part(const std::filesystem::path& out, std::string name) {
    std::replace_if(
        name.begin(), name.end(),
        [](unsigned char c) { return c <= ' ' || c == 127 || std::strchr("/\\:*?\"<>|", c) != nullptr; },
        '_');
    std::filesystem::path path{out};
    return path.replace_filename(out.stem().string() + "_" + name + out.extension().string());
}

/// Writes one or several soups; their files appear together, when all are complete.
class Output {
public:
    Output(const ConvertCommand& command, const io::Format& format, const io::FilesRead& read)
        : command_{command}, format_{format}, read_{read} {}

    /// Brings arrays and groups of the soup to the form that the format stores.
    void write(const std::filesystem::path& path, io::Soup soup) {
        require_dimension(command_, format_, soup);
        settle_groups(format_, soup);
        add_losses(io::losses(format_, soup, command_.writing));
        if (format_.features.one_based_tags) {
            number_by_tags(soup);
        }
        const io::MeshColumns mesh = columns_to_write(soup);
        const std::size_t first = files_.paths().size();
        format_.write(files_, path, mesh, command_.writing);
        std::vector<std::string> names;
        std::transform(files_.paths().begin() + static_cast<std::ptrdiff_t>(first), files_.paths().end(),
                       std::back_inserter(names), [](const auto& each) { return each.string(); });
        told_ += fmt::format("{}: {} points, {} {}\n", fmt::join(names, ", "), soup.points.size(),
                             mesh.cells.rows(), simplices_called(mesh.dimension));
    }

    /// Each loss once, however many parts have it.
    void add_losses(const std::vector<std::string>& lost) {
        for (const std::string& each : lost) {
            if (std::find(lost_.begin(), lost_.end(), each) == lost_.end()) {
                lost_.push_back(each);
            }
        }
    }

    void commit() {
        read_.require_none(files_.paths());
        if (!lost_.empty()) {
            tell(command_.out, fmt::format("{} does not hold: {}", format_.title, fmt::join(lost_, "; ")));
        }
        files_.commit();
        fmt::print("{}", told_);
    }

private:
    const ConvertCommand& command_;
    const io::Format& format_;
    const io::FilesRead& read_;
    io::AtomicFiles files_;
    std::vector<std::string> lost_;
    std::string told_; ///< for stdout
};

void write_parts(const ConvertCommand& command, const io::Soup& soup, Output& output) {
    const std::vector<SoupPart> parts = parts_of(soup);
    if (parts.size() == 1 && parts.front().name == "rest") {
        throw UsageError{fmt::format("--split-output: {} has neither regions nor patches", command.in)};
    }
    for (const SoupPart& part : parts) {
        io::Soup alone = soup;
        keep_part(alone, part);
        output.write(path_of_part(command.out, part.name), std::move(alone));
    }
}

bool has_choices(const ConvertCommand& command) {
    const io::WriteOptions& writing = command.writing;
    return !writing.encoding.empty() || !writing.version.empty() || writing.four_dimensional ||
           writing.pieces > 0 || command.reading.linear;
}

bool edits(const ConvertCommand& command) {
    return command.patch || command.weld || command.scale || !command.region.empty() ||
           !command.renumber.empty() || command.boundary || command.reverse || command.split;
}

int convert(const ConvertCommand& command) {
    const io::FilesRead read;
    if (converts_filling(command.in, command.out, command.to)) {
        if (edits(command) || has_choices(command)) {
            throw UsageError{
                fmt::format("{}: a filling in space-time is converted as it is, without a choice of parts, "
                            "edits, --linear, --encoding, --version, --pieces or --four-dimensional",
                            command.in)};
        }
        convert_filling({command.in, command.from, command.out, command.to, read});
        return 0;
    }
    const io::Format& from = format_to_read(command.in, command.from);
    const io::Format& to = format_to_write(command.out, command.to);
    io::require_supported(to, command.writing, "--");
    require_sense(command);
    io::Soup soup = io::read_as(from, command.in, command.reading);
    print_remarks(soup);
    const std::vector<std::string> lost_numbers = io::lost_numbers(soup);
    settle_numbers(soup);
    edit(command, soup);
    Output output{command, to, read};
    if (command.split) {
        write_parts(command, soup, output);
    } else {
        output.write(command.out, std::move(soup));
    }
    output.add_losses(lost_numbers);
    output.commit();
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
    app->add_flag("--linear", command->reading.linear,
                  "Of curved (second-order) simplices, take the corners");
    app->add_flag("--split-output", command->split,
                  "A file for each region and patch: OUT with _initial, _terminating, _PATCH in its name");
    app->add_option("--encoding", command->writing.encoding,
                    "How OUT stores values: binary or ascii (MSH); raw, zlib, lz4 or ascii (VTU)");
    app->add_option("--version", command->writing.version, "Version of OUT's format: 4.1 or 2.2 (MSH)");
    app->add_flag("--four-dimensional", command->writing.four_dimensional,
                  "OUT in Medit's dialect with vertices x y z t, from the point data t");
    app->add_option("--pieces", command->writing.pieces,
                    "So many files, ranges of cells, for parallel readers: .pvtu, .msh")
        ->check([](const std::string& count) {
            return count == "0" || count.starts_with('-') ? "expected at least 1, not " + count
                                                          : std::string{};
        });
    app->add_option("--region", command->region, "Of a hull, only that part: initial, side or terminating")
        ->check(CLI::IsMember(region_names));
    app->add_option("--patch", command->patch,
                    "Only the simplices of the patch or physical group of that name");
    app->add_flag("--extract-boundary", command->boundary, "The facets that only one cell has, outward");
    app->add_option("--weld", command->weld, "Join points that are no farther apart than that");
    app->add_option("--scale", command->scale, "Multiply space by that; time stays");
    app->add_flag("--reverse", command->reverse, "Turn all simplices round");
    app->add_option("--renumber", command->renumber,
                    "Number points and cells along a space-filling curve: curve")
        ->check(CLI::IsMember({"curve"}));
    app->footer("Operations from --region on are done in the order in which they are listed. What OUT's "
                "format cannot hold is told on stderr.\n" +
                formats_help() +
                "Example: slabhull convert out/room/slab_0000.vtu side.msh --region side --renumber curve");
    app->callback([command, &exit_code] { exit_code = convert(*command); });
}

} // namespace slabhull::tools
