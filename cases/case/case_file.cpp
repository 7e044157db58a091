// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/cases/case.h"

#include "slabhull/cases/experiments.h"
#include "slabhull/cases/filling_files.h"

#include "slabhull/core/error.h"
#include "slabhull/io/checksum.h"
#include "slabhull/slab/layers.h"

#include "cases/case/key_table.h"
#include "cases/case/motion_keys.h"
#include "cases/case/patch_names.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>

namespace slabhull {

namespace {

constexpr int most_layers = 1'000'000;
constexpr int most_pieces = 1'000'000;
constexpr std::array<const char*, 3> hull_formats{"vtu", "pvtu", "msh"};

/// Turns the tables of a case file into a Case. Each method reads one table.
class CaseReader {
public:
    CaseReader(KeyTable root, std::filesystem::path directory)
        : root_{std::move(root)}, directory_{std::move(directory)} {}

    Case run() {
        read_general();
        read_time();
        read_patches();
        read_trajectory();
        read_side();
        read_cap();
        read_fill();
        read_output();
        read_adapt();
        read_check();
        root_.require_all_known();
        return std::move(case_);
    }

private:
    void read_general() {
        KeyTable initial = root_.table("initial");
        if (const auto name = initial.optional_text("experiment")) {
            read_experiment(initial, *name);
        } else {
            case_.dimension = root_.integer("dimension", 2, 3);
            case_.split = case_.dimension == 3 ? Split::C : Split::centre;
            read_initial(initial);
        }
        case_.title = root_.optional_text("title").value_or(case_.title);
        initial.require_all_known();
    }

    void read_experiment(KeyTable& initial, const std::string& name) {
        for (const char* other : {"mesh", "surfaces", "curves", "box", "outer"}) {
            if (initial.has(other)) {
                initial.refuse(other, "the experiment has a domain of its own; remove one of the two");
            }
        }
        const int level = initial.has("level") ? initial.integer("level", 1, 99) : 1;
        const char* key = "experiment";
        try {
            experiment_levels(name);
            key = "level";
            case_ = experiment_case(name, level);
        } catch (const UsageError& error) {
            initial.refuse(key, error.what());
        }
        if (root_.has("dimension")) {
            root_.integer("dimension", case_.dimension, case_.dimension);
        }
    }

    void read_initial(KeyTable& initial) {
        const char* bodies = case_.dimension == 3 ? "surfaces" : "curves";
        const char* bodies_elsewhere = case_.dimension == 3 ? "curves" : "surfaces";
        if (initial.has(bodies_elsewhere)) {
            initial.refuse(bodies_elsewhere,
                           fmt::format("they are for dimension = {}; give {}, or change dimension",
                                       5 - case_.dimension, bodies));
        }
        if (initial.has("mesh")) {
            if (initial.has(bodies)) {
                initial.fail(bodies,
                             "exactly one of \"mesh\", \"surfaces\" or \"curves\", and \"experiment\"");
            }
            for (const char* outer : {"box", "outer"}) {
                if (initial.has(outer)) {
                    initial.refuse(outer,
                                   fmt::format("a mesh is the whole domain, its outer boundary included; "
                                               "remove this, or give {} instead of the mesh",
                                               bodies));
                }
            }
            case_.initial = read_mesh_keys(initial);
            return;
        }
        InitialBodies parts;
        for (KeyTable& body : initial.optional_tables(bodies)) {
            parts.files.push_back(read_body(body, nullptr));
        }
        if (initial.has("box") == initial.has("outer")) {
            initial.fail(
                "box",
                fmt::format("\"mesh\", \"experiment\", or {} with exactly one of \"box\" and \"outer\"",
                            bodies));
        }
        if (initial.has("box")) {
            parts.outer = read_box(initial.table("box"));
        } else {
            KeyTable outer = initial.table("outer");
            parts.outer = read_body(outer, "walls");
        }
        case_.initial = std::move(parts);
    }

    InitialMesh read_mesh_keys(KeyTable& initial) {
        InitialMesh mesh{directory_ / initial.text("mesh"), {}, {}};
        mesh.reading.linear = initial.has("linear") && initial.boolean("linear");
        mesh.reading.patch_array = initial.optional_text("patch_array").value_or("");
        if (initial.has("regions")) {
            mesh.regions = initial.texts("regions", -1);
            if (mesh.regions.empty()) {
                initial.fail("regions", "at least one group of the mesh");
            }
        }
        return mesh;
    }

    BodyFile read_body(KeyTable& table, const char* default_patch) {
        BodyFile body{directory_ / table.text("file"), {}};
        body.patches_of_file = table.has("patches") && table.choice<bool>("patches", {{"file", true}});
        if (table.has("patch") || (default_patch == nullptr && !body.patches_of_file)) {
            body.patch = patch_name(table, table.text("patch"));
        } else if (default_patch != nullptr) {
            body.patch = default_patch;
        }
        table.require_all_known();
        return body;
    }

    static std::string patch_name(const KeyTable& table, const std::string& name) {
        if (!is_patch_name(name)) {
            table.fail("patch", patch_name_rule);
        }
        return name;
    }

    BoxSpec read_box(KeyTable table) {
        BoxSpec box;
        box.min = table.numbers("min", case_.dimension);
        box.max = table.numbers("max", case_.dimension);
        box.size = table.positive("size");
        box.patch = patch_name(table, table.optional_text("patch").value_or(box.patch));
        for (std::size_t k = 0; k < box.min.size(); ++k) {
            if (!(box.min[k] < box.max[k])) {
                table.fail("max", "each entry above that of \"min\"");
            }
        }
        table.require_all_known();
        return box;
    }

    void read_time() {
        KeyTable time = root_.optional_table("time");
        case_.start = time.number_or("start", case_.start);
        case_.end = time.number_or("end", case_.end);
        if (!(case_.start < case_.end)) {
            time.fail("end", fmt::format("a time after \"start\", {}, not {}", case_.start, case_.end));
        }
        if (time.has("slabs")) {
            case_.slabs = time.integer("slabs", 1, 100'000'000);
        }
        if (time.has("layers") && time.has("spacing")) {
            time.fail("spacing", "one of \"layers\" and \"spacing\"");
        }
        if (time.has("layers")) {
            case_.layers = time.integer("layers", 1, most_layers);
            case_.spacing.reset();
        } else if (time.has("spacing")) {
            case_.spacing = time.positive("spacing");
            case_.layers.reset();
            if ((case_.end - case_.start) / case_.slabs > most_layers * *case_.spacing) {
                time.fail("spacing",
                          fmt::format("a spacing that makes at most {} layers in a slab", most_layers));
            }
        }
        if (time.has("layer_tolerance")) {
            case_.layer_tolerance = time.positive("layer_tolerance");
        }
        require_distinct_levels(time);
        read_adapt(time);
        time.require_all_known();
    }

    void require_distinct_levels(KeyTable& time) const {
        const double duration = case_.end - case_.start;
        if (!std::isfinite(duration)) {
            time.fail("end", "a finite duration since \"start\"");
        }
        const double slab = duration / case_.slabs;
        const double layers =
            case_.spacing ? std::max(1.0, std::ceil(slab / *case_.spacing)) : case_.layers.value_or(1);
        const double rounding =
            std::numeric_limits<double>::epsilon() * std::max(std::abs(case_.start), std::abs(case_.end));
        if (!(slab / layers > 4 * rounding)) {
            time.fail("end", "a time so long after \"start\" that rounding leaves no two levels at one time");
        }
    }

    void read_adapt(KeyTable& time) {
        if (time.has("adapt")) {
            case_.adapt = time.boolean("adapt");
        }
        if (time.has("adapt_floor")) {
            case_.adapt_floor = time.positive("adapt_floor");
            if (case_.adapt_floor > 1) {
                time.fail("adapt_floor", "a part of a slab's duration, at most 1");
            }
        }
    }

    void read_patches() {
        const PatchKeysContext context{case_.dimension, case_.end - case_.start, directory_};
        KeyTable motions = root_.optional_table("motion");
        for (const std::string& patch : motions.keys()) {
            case_.motions[patch] = read_motion(motions.table(patch), context);
        }
        KeyTable projections = root_.optional_table("project");
        for (const std::string& patch : projections.keys()) {
            case_.projections[patch] = read_projection(projections.table(patch), context);
            const auto motion = case_.motions.find(patch);
            if (motion != case_.motions.end() &&
                motion->second.kind == MotionSpec::Kind::displacement_series) {
                projections.fail(patch, "no projection of a patch whose motion is a displacement-series, for "
                                        "nothing says how the surface would move");
            }
        }
    }

    void read_trajectory() {
        KeyTable table = root_.optional_table("trajectory");
        if (const auto name = table.optional_text("scheme")) {
            try {
                case_.trajectory.scheme = scheme_from_name(*name);
            } catch (const UsageError& error) {
                table.fail("scheme", error.what());
            }
        }
        if (table.has("substeps")) {
            case_.trajectory.substeps = table.integer("substeps", 1, 1'000'000);
        }
        if (table.has("tolerance")) {
            if (case_.trajectory.scheme != Scheme::dopri5) {
                table.fail("tolerance", "scheme = \"dopri5\" with it, the one that chooses its steps");
            }
            case_.trajectory.tolerance = table.positive("tolerance");
        }
        table.require_all_known();
    }

    void read_side() {
        KeyTable table = root_.optional_table("side");
        if (const auto name = table.optional_text("split")) {
            try {
                case_.split = split_from_name(*name, case_.dimension);
            } catch (const UsageError& error) {
                table.refuse("split", error.what());
            }
        }
        if (table.has("diagonals")) {
            case_.diagonals = table.choice<Diagonals>(
                "diagonals", {{"shape", Diagonals::shape}, {"smallest-id", Diagonals::smallest_id}});
        }
        table.require_all_known();
    }

    void read_cap() {
        KeyTable table = root_.optional_table("cap");
        read_cap_mesher(table);
        if (table.has("size")) {
            case_.cap_size = table.positive("size");
        }
        if (table.has("growth")) {
            case_.cap_growth = table.positive("growth");
        }
        if (table.has("quality")) {
            if (case_.dimension == 3 && case_.cap_mesher == SolidMesher::hxt) {
                table.fail("quality", "nothing for mesher = \"hxt\", which knows no such bound");
            }
            case_.cap_quality = table.number("quality");
            if (!(case_.cap_quality >= 1 && case_.cap_quality <= 100)) {
                table.fail("quality", "a radius-edge bound from 1 to 100");
            }
        }
        if (table.has("order")) {
            case_.cap_curve_order = table.choice<bool>("order", {{"mesher", false}, {"curve", true}});
        }
        read_cap_reuse(table);
        table.require_all_known();
    }

    void read_cap_mesher(KeyTable& table) {
        if (table.has("mesher") && case_.dimension == 2) {
            table.choice<int>("mesher", {{"cdt", 0}});
        } else if (table.has("mesher")) {
            case_.cap_mesher = table.choice<SolidMesher>(
                "mesher", {{"tetgen", SolidMesher::tetgen}, {"hxt", SolidMesher::hxt}});
            if (!has_mesher(case_.cap_mesher)) {
                table.fail("mesher", "a mesher that this build has; configure it with -DSLABHULL_GMSH=ON for "
                                     "\"hxt\" and -DSLABHULL_TETGEN=ON for \"tetgen\"");
            }
        }
        if (table.has("blocks")) {
            if (case_.dimension == 2) {
                table.fail("blocks", "nothing for dimension = 2, where a cap is meshed in one piece");
            }
            case_.cap_blocks = table.integer("blocks", 1, 4096);
        }
    }

    void read_cap_reuse(KeyTable& table) {
        if (table.has("reuse")) {
            case_.cap_reuse = table.choice<CapReuse>(
                "reuse", {{"none", CapReuse::none}, {"move", CapReuse::move}, {"adapt", CapReuse::adapt}});
        }
        // Below the smallest angles that the meshers give: 7 degrees for D = 3, 20 for D = 2.
        case_.cap_reuse_angle = table.number_or("reuse_angle", case_.dimension == 3 ? 5 : 10);
        if (!(case_.cap_reuse_angle >= 0 && case_.cap_reuse_angle <= 60)) {
            table.fail("reuse_angle", "an angle from 0 to 60 degrees");
        }
    }

    void read_adapt() {
        if (!root_.has("adapt")) {
            return;
        }
        if (case_.cap_reuse != CapReuse::adapt) {
            root_.fail("adapt", "[cap] reuse = \"adapt\" with it");
        }
        KeyTable table = root_.table("adapt");
        require_no_patch_named_as_key(table);
        if (table.has("size")) {
            case_.adapt_size = table.positive("size");
        }
        case_.adapt_angle = table.number_or("angle", case_.adapt_angle);
        // Beyond these, cells become ever more and no better; with less, they become too flat to be moved.
        const double least = 5;
        const double most = case_.dimension == 3 ? 15 : 30;
        if (!(case_.adapt_angle >= least && case_.adapt_angle <= most)) {
            table.fail("angle", fmt::format("an angle from {} to {} degrees", least, most));
        }
        read_boundary_adaptation(table);
        table.require_all_known();
    }

    static void require_no_patch_named_as_key(const KeyTable& table) {
        const std::vector<std::string> patches = table.table_names();
        for (const char* key : {"size", "angle", "boundary", "feature_angle", "distance"}) {
            if (std::find(patches.begin(), patches.end(), key) != patches.end()) {
                table.fail(key,
                           "a value, not the table of a patch, for [adapt] has a key of this name: give the "
                           "patch another one. Facets in no group of a mesh are \"boundary\": put them in "
                           "a group with a name");
            }
        }
    }

    void read_boundary_adaptation(KeyTable& table) {
        const std::vector<std::string> patches = table.table_names();
        case_.adapt_boundary = !patches.empty();
        if (table.has("boundary")) {
            case_.adapt_boundary = table.boolean("boundary");
        }
        if (!case_.adapt_boundary && !patches.empty()) {
            table.fail("boundary",
                       fmt::format("true, or nothing, beside [adapt.{}], which adapts the boundary",
                                   patches.front()));
        }
        case_.adapt_feature_angle = table.number_or("feature_angle", case_.adapt_feature_angle);
        if (!(case_.adapt_feature_angle > 0 && case_.adapt_feature_angle <= 90)) {
            table.fail("feature_angle", "an angle above 0, up to 90 degrees");
        }
        case_.adapt_distance = table.number_or("distance", case_.adapt_distance);
        if (!(case_.adapt_distance >= 0 && case_.adapt_distance <= 1)) {
            table.fail("distance", "a part of the target length, from 0 to 1");
        }
        for (const std::string& name : patches) {
            KeyTable patch = table.table(name);
            PatchAdaptation& wanted = case_.adapt_patches[name];
            if (patch.has("size")) {
                wanted.size = patch.positive("size");
            }
            if (patch.has("fixed")) {
                wanted.fixed = patch.boolean("fixed");
            }
            patch.require_all_known();
        }
    }

    void read_check() {
        KeyTable table = root_.optional_table("check");
        if (table.has("embedding")) {
            case_.check_embedding = table.boolean("embedding");
        }
        table.require_all_known();
    }

    void read_unstructured(KeyTable& table, UnstructuredFill& fill) {
        if (case_.dimension != 2 || !has_mesher(SolidMesher::tetgen)) {
            table.fail("method", "\"march\": \"tetgen\" fills hulls in 2D+t, in builds that have TetGen");
        }
        if (table.has("time_scale")) {
            fill.time_scale = table.positive("time_scale");
        }
    }

    void read_fill() {
        if (!root_.has("fill")) {
            return;
        }
        KeyTable table = root_.table("fill");
        FillSpec fill;
        if (table.has("method")) {
            fill.method = table.choice<FillMethod>(
                "method", {{"march", FillMethod::march}, {"tetgen", FillMethod::tetgen}});
        }
        if (fill.method == FillMethod::tetgen) {
            read_unstructured(table, fill.unstructured);
        } else if (case_.cap_reuse == CapReuse::none) {
            root_.fail(
                "fill",
                "[cap] reuse = \"move\" or \"adapt\" with it: caps that are meshed anew are not filled");
        }
        if (table.has("formats")) {
            fill.formats.clear();
            for (const std::string& format : table.texts("formats", -1)) {
                try {
                    fill.formats.push_back(filling_format("formats", format, case_.dimension));
                } catch (const UsageError& error) {
                    table.fail("formats", error.what());
                }
            }
        }
        if (table.has("pentatope_code")) {
            fill.pentatope_code = table.integer("pentatope_code", 6, 8);
        }
        table.require_all_known();
        case_.fill = std::move(fill);
    }

    void read_output() {
        KeyTable table = root_.optional_table("output");
        const auto directory = table.optional_text("directory");
        case_.directory = (directory_ / directory.value_or(case_.directory.string())).lexically_normal();
        if (table.has("formats")) {
            case_.formats = read_formats(table);
        }
        for (const char* format : hull_formats) {
            read_writing(table.optional_table(format), format);
        }
        if (table.has("pieces")) {
            read_pieces(table);
        }
        table.require_all_known();
    }

    static std::vector<std::string> read_formats(KeyTable& table) {
        std::vector<std::string> formats;
        for (const std::string& format : table.texts("formats", -1)) {
            if (std::find(hull_formats.begin(), hull_formats.end(), format) == hull_formats.end()) {
                table.fail("formats",
                           fmt::format("\"{}\", not \"{}\"", fmt::join(hull_formats, "\", \""), format));
            }
            if (std::find(formats.begin(), formats.end(), format) == formats.end()) {
                formats.push_back(format);
            }
        }
        return formats;
    }

    /// Refuses output.pieces where a format cannot be written in pieces.
    void read_pieces(KeyTable& table) {
        const auto pieces = static_cast<std::size_t>(table.integer("pieces", 1, most_pieces));
        for (const std::string& format : case_.formats) {
            case_.writing[format].pieces = pieces;
            try {
                io::require_supported(*io::format_named(format), case_.writing[format], "");
            } catch (const UsageError& error) {
                table.fail("pieces", fmt::format("formats that have them ({})", error.what()));
            }
        }
    }

    /// How files of a format are written: [output.msh] version = "2.2".
    void read_writing(KeyTable table, const char* format) {
        const io::WriteVariants& variants = io::format_named(format)->variants;
        const auto one_of = [&](const char* key, const std::vector<std::string_view>& offered) {
            std::string chosen = table.optional_text(key).value_or("");
            if (!chosen.empty() && std::find(offered.begin(), offered.end(), chosen) == offered.end()) {
                table.fail(key,
                           fmt::format("one of \"{}\", not \"{}\"", fmt::join(offered, "\", \""), chosen));
            }
            return chosen;
        };
        io::WriteOptions& writing = case_.writing[format];
        writing.encoding = one_of("encoding", variants.encodings);
        if (variants.versions.size() > 1) {
            writing.version = one_of("version", variants.versions);
        }
        table.require_all_known();
    }

    KeyTable root_;
    std::filesystem::path directory_;
    Case case_;
};

} // namespace

namespace {

/// A mesh where a case file is wanted is told so.
void require_case_file(const std::filesystem::path& path) {
    const io::Format* format = io::format_of_extension(path);
    if (format != nullptr && std::filesystem::is_regular_file(path)) {
        throw UsageError(
            fmt::format("{}: this is a mesh or surface ({}), not a case file; slabhull new {} writes a "
                        "case file to start with",
                        path.string(), format->title, path.string()));
    }
}

} // namespace

Case read_case(const std::filesystem::path& path) {
    require_case_file(path);
    Case the_case = CaseReader{KeyTable::parse_file(path), path.parent_path()}.run();
    the_case.file = path;
    the_case.checksum = io::checksum_of(path);
    return the_case;
}

Case parse_case(const std::string& text, const std::filesystem::path& path) {
    Case the_case = CaseReader{KeyTable::parse(text, path.string()), path.parent_path()}.run();
    the_case.file = path;
    io::Checksum checksum;
    checksum.add(text.data(), text.size());
    the_case.checksum = checksum.value();
    return the_case;
}

double Case::slab_begin(int slab) const {
    return slab == slabs ? end : start + (end - start) * slab / static_cast<double>(slabs);
}

double Case::slab_end(double time) const {
    const double passed = std::floor((time - start) / (end - start) * slabs);
    int slab = std::max(0, static_cast<int>(std::min(passed, slabs - 1.0)) - 1);
    while (slab + 1 < slabs && !(slab_begin(slab + 1) > time)) {
        ++slab; // rounding may have put us a slab off
    }
    return slab_begin(slab + 1);
}

std::vector<double> Case::level_times(double begin, double end_of_slab) const {
    const double duration = end_of_slab - begin;
    // A spacing that divides the duration up to rounding does so exactly.
    const double wanted = spacing ? std::max(1.0, std::ceil(duration / *spacing - 1e-9)) : layers.value_or(1);
    return even_levels(begin, end_of_slab, static_cast<std::size_t>(wanted));
}

} // namespace slabhull
