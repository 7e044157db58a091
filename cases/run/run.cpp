// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/cases/run.h"

#include "cases/run/case_checks.h"
#include "cases/run/cost.h"
#include "cases/run/earlier_run.h"
#include "cases/run/journal.h"
#include "cases/run/progress_meter.h"
#include "cases/run/report_objects.h"
#include "slabhull/cases/checkpoint.h"
#include "slabhull/cases/filling_files.h"
#include "slabhull/cases/hull_files.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/core/communicator.h"
#include "slabhull/core/error.h"
#include "slabhull/core/memory.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/progress.h"
#include "slabhull/core/version.h"
#include "slabhull/io/files.h"
#include "slabhull/io/folder_lock.h"
#include "slabhull/slab/caps_ahead.h"
#include "slabhull/slab/check.h"
#include "slabhull/slab/check_filling.h"
#include "slabhull/slab/fill.h"
#include "slabhull/slab/filling_quality.h"
#include "slabhull/slab/march.h"
#include "slabhull/slab/sound_hull.h"
#include "slabhull/slab/tangling.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <fmt/format.h>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>
#include <utility>

namespace slabhull {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* waiting_stage = "waiting for caps";

Json seconds_as_json(const StageClock& clock) {
    Json seconds = Json::object();
    for (const auto& [stage, passed] : clock.stages()) {
        seconds[stage] = passed;
    }
    return seconds;
}

/// The time of each stage, and of all but cap meshing, over that of cap meshing; empty without it.
Json shares_as_json(const StageClock& clock) {
    double meshing = 0;
    double all = 0;
    for (const auto& [stage, passed] : clock.stages()) {
        meshing += stage == cap_meshing_stage ? passed : 0;
        all += stage == waiting_stage ? 0 : passed;
    }
    Json shares = Json::object();
    if (meshing > 0) {
        for (const auto& [stage, passed] : clock.stages()) {
            if (stage != cap_meshing_stage && stage != waiting_stage) {
                shares[stage] = passed / meshing;
            }
        }
        shares["all"] = (all - meshing) / meshing;
    }
    return shares;
}

Json as_json(const LayerFit& fit, std::optional<std::size_t> enough) {
    Json json{{"number", fit.layers},
              {"largest_deviation", std::isfinite(fit.deviation) ? Json(fit.deviation) : Json()},
              {"largest_turn", fit.turn},
              {"sound", fit.sound()}};
    if (enough) {
        json["would_do"] = *enough;
    }
    return json;
}

Json peaks_as_json() {
    return {{"bytes", peak_memory()}, {"mesher_bytes", peak_memory_of_children()}};
}

const char* mesher_name(const Case& the_case) {
    if (the_case.dimension == 2) {
        return "cdt";
    }
    return the_case.cap_mesher == SolidMesher::hxt ? "hxt" : "tetgen";
}

const char* reuse_name(CapReuse reuse) {
    return reuse == CapReuse::none ? "none" : reuse == CapReuse::move ? "move" : "adapt";
}

Json as_json(const AdaptReport& report) {
    Json json{{"splits", report.splits},
              {"collapses", report.collapses},
              {"flips", report.flips},
              {"moved", report.moved},
              {"refused", report.refused},
              {"halvings", report.halvings},
              {"edge_length_ratio", {report.shortest_ratio, report.longest_ratio}},
              {"smallest_angle", report.smallest_angle}};
    if (report.boundary_ratios) {
        json["shifts"] = report.shifts;
        json["on_boundary"] = report.on_boundary;
        json["boundary_edge_length_ratio"] = *report.boundary_ratios;
    }
    return json;
}

Json settings_as_json(const Case& the_case) {
    return {{"title", the_case.title},
            {"dimension", the_case.dimension},
            {"experiment", the_case.experiment},
            {"level", the_case.level},
            {"start", the_case.start},
            {"end", the_case.end},
            {"slabs", the_case.slabs},
            {"layers", the_case.layers_follow_motion() ? "motion" : "given"},
            {"layer_tolerance", the_case.layer_tolerance},
            {"scheme", scheme_name(the_case.trajectory.scheme)},
            {"substeps", the_case.trajectory.substeps},
            {"split", split_name(the_case.split)},
            {"diagonals", the_case.diagonals == Diagonals::shape ? "shape" : "smallest-id"},
            {"cap_mesher", mesher_name(the_case)},
            {"cap_blocks", the_case.cap_blocks > 0 ? Json(the_case.cap_blocks) : Json()},
            {"cap_size", std::isfinite(the_case.cap_size) ? Json(the_case.cap_size) : Json()},
            {"cap_growth", the_case.cap_growth},
            {"cap_quality", the_case.cap_quality},
            {"cap_reuse", reuse_name(the_case.cap_reuse)},
            {"cap_reuse_angle", the_case.cap_reuse_angle},
            {"cap_order", the_case.cap_curve_order ? "curve" : "mesher"},
            {"check_embedding", the_case.check_embedding}};
}

/// A march's state without the cap's cells: what a checkpoint says of it.
template<int D>
MarchState<D> state_without_cells(const MarchState<D>& state) {
    MarchState<D> copy{{}, state.time, state.slab, state.ids, state.boundary};
    copy.cap.patches = state.cap.patches;
    copy.cap.boundary_facets = state.cap.boundary_facets;
    copy.cap.boundary_patch = state.cap.boundary_patch;
    return copy;
}

/// The files of a slab while they are being written. Without commit they vanish.
struct SlabFiles {
    io::AtomicFiles open;
    std::uint32_t cap_checksum = 0;
    std::optional<BackgroundStage> stage;
    std::future<void> written; ///< last, to be waited for before the files go
};

std::string slab_name(int slab, const std::string& format) {
    return fmt::format("slab_{:04}.{}", slab, format);
}

std::string cap_name(int cap) {
    return fmt::format("cap_{:04}.vtu", cap);
}

/// A radius-edge bound is TetGen's, which no cap in 2D asks for.
bool has_idle_quality(const Case& the_case) {
    return the_case.dimension == 2 && the_case.cap_quality != Case{}.cap_quality;
}

template<int D>
class Runner {
public:
    Runner(const Case& the_case, const RunOptions& options, const Listener& listener)
        : case_{the_case}, listener_{listener}, ranks_{options.ranks},
          meter_{listener, the_case.start, the_case.end, the_case.slabs}, watched_{meter_.watch()} {
        if (!case_.check_embedding) {
            listener_.warning("check.embedding is false: nothing proves that the hulls do not cross "
                              "themselves between levels");
        }
        if (has_idle_quality(case_)) {
            listener_.warning("cap.quality has no effect in 2D: leave it out");
        }
        if (first()) {
            io::make_folder(case_.directory);
            lock_.emplace(case_.directory);
            checksum_ = checksum_of_motions(case_);
            io::remove_stale_parts(case_.directory);
        }
        meet();
        if (!options.resume || !resume()) {
            begin();
        }
    }

    RunResult run() {
        const std::size_t before = result_.files.size();
        try {
            while (march_->state().time < case_.end) {
                run_slab();
            }
            settle_all();
        } catch (const Error&) {
            if (first() && result_.files.size() > before) {
                const ProgressScope to_the_end{{}};
                try {
                    write_overview();
                } catch (const OutputError&) { // the error that stopped the run is the one to report
                }
            }
            throw;
        }
        if (first()) {
            write_overview();
        }
        meter_.end();
        return std::move(result_);
    }

private:
    std::filesystem::path path_of(const std::string& name) const { return case_.directory / name; }

    /// Whether this process speaks for all ranks.
    bool first() const { return ranks_ == nullptr || ranks_->first(); }
    /// Waits for the other ranks.
    void meet() const {
        if (ranks_ != nullptr) {
            ranks_->barrier();
        }
    }

    void begin() {
        enter_stage("initial cap");
        StageClock clock;
        const auto on_boundary = [this](const SpatialMesh<D>& mesh) {
            prepare(boundary_of(mesh), mesh, case_.start);
        };
        Domain<D> domain = initial_domain<D>(case_, {}, listener_, clock, on_boundary, ranks_);
        const std::size_t cells = domain.mesh.cells.size();
        initial_ = report_of_initial(domain.mesh, ranks_ != nullptr ? ranks_->sum(cells) : cells, clock);
        start(march_from<D>(std::move(domain), case_.start));
    }

    /// False when there is no checkpoint to go on from.
    bool resume() {
        const auto path = path_of(checkpoint_name);
        if (!std::filesystem::exists(path)) {
            listener_.warning(
                fmt::format("{}: no such checkpoint, the run starts from the beginning", path.string()));
            return false;
        }
        Checkpoint<D> checkpoint = read_checkpoint<D>(path);
        if (first() && checkpoint.files.case_checksum != checksum_) {
            listener_.warning(fmt::format(
                "the case file, or a table or surface that it names, is not what it was when {} was written: "
                "slabs that are there stay as they "
                "are, and what is left to do follows the new file; to build all of it anew, run without "
                "--resume",
                path.string()));
        }
        if (!first()) {
            leave_cells_on_first(checkpoint.state.cap, *ranks_);
            go_on_from(std::move(checkpoint.state));
            return true;
        }
        journal_.emplace(path_of(journal_name), checkpoint.files.journal_size,
                         checkpoint.files.journal_checksum);
        remove_unfinished_slab(case_.directory, checkpoint.state.slab);
        each_slab([this](const Json& slab) {
            const bool sound = slab["layers"]["sound"];
            told_of_layers_ = told_of_layers_ || !sound;
        });
        look_for_files();
        go_on_from(std::move(checkpoint.state));
        return true;
    }

    /// The journal's reports, without that of the initial cap.
    template<class Visit>
    void each_slab(const Visit& visit) const {
        bool initial = true;
        journal_->each_line([&](const std::string& line) {
            if (!std::exchange(initial, false)) {
                visit(report_in(line));
            }
        });
    }

    Json report_in(const std::string& line) const {
        try {
            return Json::parse(line);
        } catch (const Json::exception&) {
            throw InputError(
                fmt::format("{}: is damaged: a line is no JSON; start the run anew, without --resume",
                            path_of(journal_name).string()));
        }
    }

    /// Finished slabs may have been moved elsewhere; what is there must be whole.
    void look_for_files() const {
        std::vector<std::string> gone;
        each_slab([&](const Json& slab) {
            for (const Json& file : slab["files"]) {
                const std::string name = file["name"];
                if (!is_whole(path_of(name), file["bytes"])) {
                    gone.push_back(name);
                }
            }
        });
        if (!gone.empty()) {
            listener_.warning(fmt::format("{}: {} files of finished slabs are not there any more, the first "
                                          "{}; the run goes on without them",
                                          case_.directory.string(), gone.size(), gone.front()));
        }
    }

    /// False for a file that is not there.
    static bool is_whole(const std::filesystem::path& file, std::uintmax_t bytes) {
        std::error_code missing;
        const auto there = std::filesystem::file_size(file, missing);
        if (!missing && there != bytes) {
            throw InputError(
                fmt::format("{}: is damaged: it has {} bytes, and had {} when it was written; start "
                            "the run anew, without --resume, or remove the file",
                            file.string(), there, bytes));
        }
        return !missing;
    }

    void go_on_from(MarchState<D>&& state) {
        prepare(state.boundary, state.cap, state.time);
        require_on_course(state);
        start(std::move(state));
    }

    /// A patch with a surface, or with a motion of its vertices, is where these are at the time, whatever was
    /// before: with others than before it would jump there in one layer.
    void require_on_course(const MarchState<D>& state) const {
        const SlabSettings<D>& slab = settings_->slab;
        const std::optional<OffCourse> off =
            farthest_off_course<D>(state.boundary, state.cap, slab.motions, slab.motion_start, state.time);
        if (!off) {
            return;
        }
        const std::string patch = patch_name(state.cap.patches, off->patch);
        const std::string from =
            off->off_surface
                ? fmt::format("the surface of project.{}, which the motion moves from t = {:.9g} on", patch,
                              case_.start)
                : fmt::format("the place where the files of motion.{} have it", patch);
        const char* keep = off->off_surface ? "the patch's surface and its motion" : "what the files say";
        throw UsageError{
            fmt::format("--resume: the motion or the surface of patch {} is not what the run "
                        "began with: at t = {:.9g} its vertex {} is {:.4g} off {}. Run the "
                        "case anew, without --resume, or keep {} until t = {:.9g}{}",
                        patch, state.time, off->vertex, off->distance, from, keep, state.time,
                        off->off_surface ? ": a \"rigid-table\" may go on otherwise from there" : ""),
            {{"vertex", off->vertex, patch}}};
    }

    void start(MarchState<D>&& state) {
        prepare(state.boundary, state.cap, state.time);
        patches_ = state.cap.patches;
        if (ranks_ != nullptr) {
            divide_cells(state);
        }
        march_.emplace(std::move(state), std::move(settings_->slab));
    }

    /// Gives each rank a range of the cap's cells.
    void divide_cells(MarchState<D>& state) const {
        CapCells<D> cells = take_cells(state.cap, *ranks_);
        const HullRange here = range_of_rank(cells.all, *ranks_);
        state.cells = redistributed(std::move(cells), here, *ranks_);
    }

    /// Reads the settings, once there is a boundary, and begins with the caps that follow from that alone.
    void prepare(const Boundary<D>& boundary, const SpatialMesh<D>& cap, double time) {
        if (!settings_) {
            settings_ = case_settings<D>(case_, boundary);
            for (const std::string& remark : settings_->remarks) {
                listener_.warning(remark);
            }
            settings_->slab.layers.suggest = !told_of_layers_;
            settings_->slab.ranks = ranks_;
            settings_->slab.cap.ranks = ranks_;
            look_ahead(boundary, cap, time, settings_->slab);
        }
    }

    void look_ahead(const Boundary<D>& boundary, const SpatialMesh<D>& cap, double time,
                    const SlabSettings<D>& settings) {
        if (case_.cap_reuse != CapReuse::none || thread_count() < 2 || ranks_ != nullptr) {
            return;
        }
        ahead_.emplace(boundary, cap, time, settings, [this](double begin) {
            return begin < case_.end ? case_.level_times(begin, case_.slab_end(begin))
                                     : std::vector<double>{};
        });
    }

    struct Filled {
        Filling<D> mesh;
        Json report;
    };

    /// A slab on its way to the disk.
    struct Built {
        Slab<D> slab;
        std::optional<Filled> filled;
        StageClock clock;
        std::optional<SoundHull> sound;
        std::optional<MarchState<D>> after; ///< the march's state after it, if that has gone on already
        std::optional<PartToWrite<D>> part; ///< of a rank
        SlabFiles files;                    ///< last, so that they are waited for before the slab goes
    };

    /// Builds a slab. It is checked and written while the next ones are built, where threads and memory
    /// allow.
    void run_slab() {
        const double time = march_->state().time;
        meter_.begin_slab(march_->state().slab, time, case_.slab_end(time));
        auto built = std::make_shared<Built>();
        try {
            std::tie(built->slab, built->filled) = build_and_fill(built->clock);
        } catch (const Error&) {
            settle_all(); // the slabs before come first, and so do their faults
            throw;
        }
        meter_.hull_built(built->slab.hull_cells());
        warn_of_layers(built->slab);
        warn_of_halvings(built->slab);
        warn_of_edges(built->slab);
        built->files.stage.emplace(
            "writing",
            static_cast<std::uint64_t>(file_bytes_per_cell_ * static_cast<double>(built->slab.hull_cells())));
        if (can_go_on_meanwhile(*built)) {
            march_->accept(built->slab);
            built->after = state_without_cells(march_->state());
            const BackgroundStage stage{"checking and writing"};
            finishing_.push_back({stage, built, std::async(std::launch::async, stage.counted([this, built] {
                                      examine(*built);
                                  }))});
        } else {
            settle_all();
            examine(*built);
            record(*built);
        }
    }

    /// Whether there are threads and memory for checking this hull while the next one is built. Waits for the
    /// first of several that are being checked.
    bool can_go_on_meanwhile(const Built& built) {
        constexpr std::size_t most_at_once = 2;
        while (finishing_.size() >= most_at_once) {
            settle_first();
        }
        const double bytes = 2 * bytes_per_simplex(case_) * static_cast<double>(built.slab.hull.cells.size());
        return thread_count() > 1 && ranks_ == nullptr && bytes < static_cast<double>(available_memory());
    }

    /// Waits until the first slab that is not yet on the disk is there. Throws what went wrong with it.
    void settle_first() {
        Finishing first = std::move(finishing_.front());
        finishing_.pop_front();
        first.stage.show();
        wait_for(first.done);
        record(*first.built);
    }

    void settle_all() {
        while (!finishing_.empty()) {
            settle_first();
        }
    }

    /// Checks a slab and writes its files, which are still to be put in place.
    void examine(Built& built) {
        StageClock clock;
        const Slab<D>& slab = built.slab;
        if (slab.part) {
            built.part.emplace(part_to_write(*slab.part, slab.hull, *ranks_));
        }
        on_all_ranks([&] {
            begin_writing(slab, built.part, built.filled, built.files); // beside the check: the disk is slow
            built.sound = require_sound(slab, clock);
            built.files.stage->show();
            wait_for(built.files.written);
            if (slab.part) {
                write_cap_of_ranks(built.slab, built.files);
            }
        });
        clock.book("writing");
        built.clock.add(clock);
    }

    /// Puts the files of a slab in place, and takes it into journal and checkpoint.
    void record(Built& built) {
        Slab<D>& slab = built.slab;
        const std::size_t files_before = result_.files.size();
        on_all_ranks([&] { commit(built.files); });
        result_.cells += slab.hull_cells();
        result_.points += slab.hull_points();
        ++result_.slabs;
        // The next slab's files will be about as large.
        file_bytes_per_cell_ =
            static_cast<double>(built.files.stage->done()) / static_cast<double>(slab.hull_cells());
        Json report = report_of(slab, *built.sound, built.clock);
        if (ranks_ != nullptr) {
            report["ranks"] = report_of_ranks(slab, built.clock);
        }
        if (built.filled) {
            report["fill"] = built.filled->report;
        }
        report["files"] = sizes_of_files(files_before);
        const std::string cap = cap_name(slab.hull.slab + 1);
        if (!built.after) {
            march_->accept(std::move(slab));
        }
        on_all_ranks([&] {
            if (first()) {
                journal_->append(report.dump());
                write_checkpoint(
                    path_of(checkpoint_name), built.after ? *built.after : march_->state(),
                    {cap, built.files.cap_checksum, journal_->size(), journal_->checksum(), checksum_});
            }
        });
        meter_.end_slab(built.clock);
    }

    /// Names and sizes of the files written after the first `before`.
    Json sizes_of_files(std::size_t before) const {
        Json sizes = Json::array();
        for (std::size_t k = before; k < result_.files.size(); ++k) {
            std::error_code unseen; // of another rank, in a shared file system
            const auto bytes = std::filesystem::file_size(result_.files[k], unseen);
            if (!unseen) {
                sizes.push_back({{"name", result_.files[k].filename().string()}, {"bytes", bytes}});
            }
        }
        return sizes;
    }

    SoundHull require_sound(const Slab<D>& slab, StageClock& clock) const {
        const std::string name = fmt::format("the hull of slab {}", slab.hull.slab);
        return slab.part ? require_sound_parts<D>(*slab.part, slab.hull, *ranks_, name, case_.check_embedding,
                                                  clock)
                         : require_sound_hull<D>(slab.hull, name, case_.check_embedding, clock);
    }

    /// Does work in which any rank may fail: if one does, all do.
    template<class Work>
    void on_all_ranks(const Work& work) const {
        if (ranks_ != nullptr) {
            together(*ranks_, work);
        } else {
            work();
        }
    }

    /// Gives the files of a slab their names: those of the other ranks before those of the first, which name
    /// them. All are on the disk of each rank by now.
    void commit(SlabFiles& files) {
        if (first() && !journal_) {
            replace_earlier_run();
        }
        meet();
        if (!first()) {
            files.open.commit();
        }
        list_files_of_others(files.open.paths());
        if (first()) {
            files.open.commit();
            result_.files.insert(result_.files.end(), files.open.paths().begin(), files.open.paths().end());
        }
    }

    /// Takes the files of the other ranks into the result, when they have their names.
    void list_files_of_others(const std::vector<std::filesystem::path>& paths) {
        if (ranks_ == nullptr) {
            return;
        }
        std::string lines;
        for (const std::filesystem::path& path : paths) {
            lines += path.string() + '\0';
        }
        const std::vector<Array<char>> all = ranks_->all_gather<char>(lines);
        for (std::size_t r = 1; r < all.size() && first(); ++r) {
            for (std::string& path : texts_of(all[r])) {
                result_.files.emplace_back(std::move(path));
            }
        }
    }

    /// Texts that end with a zero each.
    static std::vector<std::string> texts_of(const Array<char>& joined) {
        std::vector<std::string> texts;
        for (auto begin = joined.begin(); begin != joined.end();) {
            const auto end = std::find(begin, joined.end(), '\0');
            texts.emplace_back(begin, end);
            begin = end + 1;
        }
        return texts;
    }

    /// CPU time of each rank in the stages that the first has been through: it may have more than others.
    Json stages_of_ranks(const StageClock& clock) const {
        std::string names;
        for (const auto& [stage, cpu] : clock.cpu_stages()) {
            names += stage + '\0';
        }
        Json stages = Json::object();
        for (const std::string& name : texts_of(ranks_->broadcast<char>(names, 0))) {
            const auto of_name = [&](const auto& stage) { return stage.first == name; };
            const auto found = std::ranges::find_if(clock.cpu_stages(), of_name);
            stages[name] = ranks_->gather(found != clock.cpu_stages().end() ? found->second : 0.0);
        }
        return stages;
    }

    /// What each rank has and takes.
    Json report_of_ranks(const Slab<D>& slab, const StageClock& clock) const {
        return {{"number", ranks_->size()},
                {"cells", ranks_->gather(slab.part->cells.size())},
                {"peak_memory", ranks_->gather(peak_memory())},
                {"mesher_peak_memory", ranks_->gather(peak_memory_of_children())},
                {"cpu_seconds", ranks_->gather(cpu_seconds())},
                {"stage_cpu_seconds", stages_of_ranks(clock)},
                {"sent_bytes", ranks_->gather(ranks_->sent_bytes())},
                {"meetings", ranks_->meetings()}};
    }

    /// Throws what went wrong with it.
    static void wait_for(std::future<void>& work) {
        while (work.wait_for(std::chrono::milliseconds{20}) == std::future_status::timeout) {
            go_on();
        }
        work.get();
    }

    /// The first slab is complete and takes the place of what an earlier run may have left.
    void replace_earlier_run() {
        remove_earlier_run(case_.directory);
        journal_.emplace(path_of(journal_name));
        journal_->append(initial_.dump());
    }

    /// Given layers may make more simplices than was meant: warn before minutes go by, with what they take.
    void expect_size(std::size_t layers) {
        constexpr double many = 5e7;
        const auto facets = march_->state().boundary.facets().size();
        const double simplices = side_simplex_count(facets, layers, case_.split);
        const MarchState<D>& state = march_->state();
        const std::size_t cap_cells = state.cells ? state.cells->all : state.cap.cells.size();
        meter_.expect_seconds((simplices + 2 * static_cast<double>(cap_cells)) / simplices_per_second);
        if (!case_.layers_follow_motion() && simplices > many) {
            listener_.warning(fmt::format("slab {}: {} facets in {} layers make a side of {:.2g} simplices; "
                                          "that takes some {:.2g} GB and {:.0f} minutes",
                                          march_->state().slab, facets, layers, simplices,
                                          1e-9 * bytes_per_simplex(case_) * simplices,
                                          simplices / simplices_per_second / 60));
        }
    }

    /// The slab and its filling, if that is wanted. Layers of an adapted slab that cannot be filled are
    /// halved.
    std::pair<Slab<D>, std::optional<Filled>> build_and_fill(StageClock& clock) {
        constexpr int most_halvings = 4;
        const LayerOptions layers = march_->settings().layers;
        for (int halvings = 0;; ++halvings) {
            Slab<D> slab = build(clock, halvings);
            try {
                std::optional<Filled> filled = fill(slab, clock);
                march_->settings().layers.at_least = layers.at_least;
                if (slab.adapted) {
                    slab.adapted->report.halvings += halvings;
                }
                return {std::move(slab), std::move(filled)};
            } catch (const GeometryError&) {
                const std::size_t doubled = 2 * slab.hull.layers;
                if (!slab.adapted || halvings == most_halvings ||
                    doubled > static_cast<std::size_t>(layers.most)) {
                    throw;
                }
                march_->settings().layers.at_least = static_cast<int>(doubled);
            }
        }
    }

    /// The slab at these levels. What may have to be built again keeps the initial cap.
    Slab<D> build_at(std::vector<double> times, StageClock& clock) {
        if (std::optional<PreparedSlab<D>> prepared = take_ahead(times, clock)) {
            return march_->build(*std::move(prepared), clock);
        }
        return case_.fill && case_.cap_reuse == CapReuse::adapt ? march_->propose(std::move(times), clock)
                                                                : march_->build(std::move(times), clock);
    }

    /// The slab at these levels, if it was prepared ahead.
    std::optional<PreparedSlab<D>> take_ahead(const std::vector<double>& times, StageClock& clock) {
        constexpr int most_failures = 3;
        if (!ahead_ && failures_ahead_ < most_failures) {
            const MarchState<D>& state = march_->state();
            look_ahead(state.boundary, state.cap, state.time, march_->settings());
        }
        if (!ahead_) {
            return std::nullopt;
        }
        std::optional<PreparedSlab<D>> prepared = ahead_->take(march_->state().boundary, times);
        clock.book(waiting_stage);
        if (!prepared) {
            ahead_.reset();
            ++failures_ahead_;
        }
        return prepared;
    }

    /// The slab as planned, with given layers halved so often; with time.adapt, cut short before its boundary
    /// tangles.
    Slab<D> build(StageClock& clock, int halvings) {
        const double begin = march_->state().time;
        const double floor = case_.adapt_floor * (case_.end - case_.start) / case_.slabs;
        expect_size(case_.level_times(begin, case_.slab_end(begin)).size() - 1);
        for (double end = case_.slab_end(begin);;) {
            try {
                std::vector<double> times = case_.level_times(begin, end);
                for (int k = 0; k < halvings && !case_.layers_follow_motion(); ++k) {
                    times = halved_levels(times);
                }
                return build_at(std::move(times), clock);
            } catch (const TangledBoundary& tangled) {
                if (!case_.adapt) {
                    throw;
                }
                if (tangled.good_until - begin < floor) {
                    throw GeometryError(
                        fmt::format(
                            "slab {} would have to be shorter than {:.3g}, the least that "
                            "[time] adapt_floor allows:\n{}.\nChange the motion, or allow shorter slabs.",
                            march_->state().slab, floor, tangled.without_advice),
                        tangled.entities);
                }
                end = tangled.good_until;
                listener_.warning(fmt::format("slab {} ends at t = {:.9g}, before its boundary tangles",
                                              march_->state().slab, end));
            }
        }
    }

    /// Warns once only: the reports have the figures of every slab.
    void warn_of_layers(const Slab<D>& slab) {
        if (slab.layers.sound() || !march_->settings().layers.suggest) {
            return;
        }
        march_->settings().layers.suggest = false;
        const std::string enough =
            slab.layers_enough ? fmt::format("{} would do", *slab.layers_enough)
                               : fmt::format("none up to {} would do", march_->settings().layers.most);
        listener_.warning(fmt::format(
            "slab {}: {} {} too few for the motion of patch {}: it is up to {:.3g} local edge lengths off "
            "its "
            "chords (time.layer_tolerance is {:g}) and facets turn by up to {:.3g} degrees in a layer, worst "
            "near t = {:.9g}; {}. Without time.layers and time.spacing, the number follows from the motion",
            slab.hull.slab, slab.layers.layers, slab.layers.layers == 1 ? "layer is" : "layers are",
            patch_name(patches_, slab.layers.patch), slab.layers.deviation, case_.layer_tolerance,
            slab.layers.turn, slab.layers.time, enough));
    }

    void warn_of_halvings(const Slab<D>& slab) const {
        if (slab.adapted && slab.adapted->report.halvings > 0) {
            listener_.warning(fmt::format("slab {} has {} layers: with fewer, cells of its cap or filling "
                                          "would be inside out or too flat",
                                          slab.hull.slab, slab.layers.layers));
        }
    }

    /// Sizes may be out of reach of the operations that the layers have room for. Told at the end, as slabs
    /// come nearer one after the other.
    void warn_of_edges(const Slab<D>& slab) const {
        constexpr double shortest = 0.3; // half of what is aimed at, and twice
        constexpr double longest = 3.2;
        if (!slab.adapted || !slab.adapted->report.boundary_ratios || slab.hull.time[1] < case_.end) {
            return;
        }
        const auto& ratios = *slab.adapted->report.boundary_ratios;
        if (ratios[0] < shortest || ratios[1] > longest) {
            listener_.warning(
                fmt::format("edges of the boundary end between {:.3g} and {:.3g} of the lengths that "
                            "[adapt] asks for, where 0.6 to 1.6 is aimed at: more slabs or layers "
                            "come nearer, or sizes nearer to the edges at the start",
                            ratios[0], ratios[1]));
        }
    }

    /// The filling; none when the case wants none, or when the cap was meshed anew. In ranks the first has
    /// it, which is given the whole hull for that time.
    std::optional<Filled> fill(const Slab<D>& slab, StageClock& clock) const {
        if (!case_.fill) {
            return std::nullopt;
        }
        if (case_.fill->method == FillMethod::march && !slab.cap_moved) {
            listener_.warning(fmt::format("slab {} is not filled: its terminating cap was meshed anew, since "
                                          "moving it left angles below cap.reuse_angle",
                                          slab.hull.slab));
            return std::nullopt;
        }
        enter_stage("filling");
        if (!slab.part) {
            return fill_and_check(slab, slab.hull, clock);
        }
        const Hull<D> whole = gather_hull(*slab.part, slab.hull, *ranks_);
        clock.book("gathering the hull");
        return together(*ranks_, [&] {
            return first() ? std::optional{fill_and_check(slab, whole, clock)} : std::nullopt;
        });
    }

    /// `hull` is the slab's, whole.
    Filled fill_and_check(const Slab<D>& slab, const Hull<D>& hull, StageClock& clock) const {
        const double before = clock.total();
        Filled filled{make_filling(slab, hull, clock), {}};
        const FillingReport checked = check_filling<D>(columns_of(filled.mesh), &hull);
        clock.book("checking the filling");
        if (!checked.clean()) {
            throw GeometryError{fmt::format("the filling of slab {} has {} defects and was not written:\n{}",
                                            hull.slab, checked.total(), findings_as_text(checked))};
        }
        filled.report =
            as_json(checked, filled.mesh, filling_quality(filled.mesh, hull.layers), clock.total() - before);
        return filled;
    }

    Filling<D> make_filling(const Slab<D>& slab, const Hull<D>& hull, StageClock& clock) const {
        if (case_.fill->method != FillMethod::march) {
            return fill_by_tetgen(hull, clock);
        }
        return slab.part ? fill_slab(hull, clock) : fill_slab(slab, clock);
    }

    Filling<D> fill_by_tetgen(const Hull<D>& hull, StageClock& clock) const {
        if constexpr (D == 2) {
            return fill_unstructured(hull, clock, case_.fill->unstructured);
        } else {
            throw UsageError{"only hulls in 2D+t are filled by TetGen"};
        }
    }

    void begin_writing(const Slab<D>& slab, const std::optional<PartToWrite<D>>& part,
                       const std::optional<Filled>& filled, SlabFiles& files) {
        files.written = std::async(thread_count() > 1 ? std::launch::async : std::launch::deferred,
                                   files.stage->counted([this, &slab, &part, &filled, &files] {
                                       part ? write(slab, *part, files) : write(slab, files);
                                       if (filled) {
                                           write(filled->mesh, files);
                                       }
                                   }));
    }

    void write(const Filling<D>& filling, SlabFiles& files) const {
        for (const std::string& format : case_.fill->formats) {
            write_filling(files.open, path_of(fmt::format("fill_{:04}.{}", filling.slab, format)), filling,
                          format, {case_.fill->pentatope_code});
        }
        files.open.finish();
    }

    void write(const Slab<D>& slab, SlabFiles& files) const {
        for (const std::string& format : case_.formats) {
            write_hull(files.open, path_of(slab_name(slab.hull.slab, format)), slab.hull, format,
                       case_.writing_of(format));
            files.open.finish();
        }
        io::AtomicFile& cap = files.open.open(path_of(cap_name(slab.hull.slab + 1)));
        cap.keep_checksum();
        write_terminating_cap(cap, slab.hull);
        cap.finish();
        files.cap_checksum = cap.checksum();
    }

    /// This rank's part.
    void write(const Slab<D>& slab, const PartToWrite<D>& part, SlabFiles& files) const {
        for (const std::string& format : case_.formats) {
            write_part(files.open, path_of(slab_name(slab.hull.slab, format)), part, format,
                       case_.writing_of(format));
            files.open.finish();
        }
    }

    /// The first rank writes the cap, whose cells it collects for that.
    void write_cap_of_ranks(Slab<D>& slab, SlabFiles& files) const {
        Array<Simplex<D>> cells = all_cells_on_first(terminating_cells_of(*slab.part, slab.hull), *ranks_);
        if (!first()) {
            return;
        }
        slab.cap->cells.swap(cells);
        io::AtomicFile& cap = files.open.open(path_of(cap_name(slab.hull.slab + 1)));
        cap.keep_checksum();
        write_cap(cap, *slab.cap, slab.hull.time[1]);
        cap.finish();
        files.cap_checksum = cap.checksum();
        slab.cap->cells.swap(cells);
    }

    static Json report_of_initial(const SpatialMesh<D>& cap, std::size_t cells, const StageClock& clock) {
        return {{"points", cap.points.size()},
                {"cells", cells},
                {"boundary_facets", cap.boundary_facets.size()},
                {"seconds", seconds_as_json(clock)}};
    }

    static Json report_of(const Slab<D>& slab, const SoundHull& sound, const StageClock& clock) {
        Json json = as_json(sound.report);
        json["embedding"] = sound.embedding ? as_json(*sound.embedding) : Json();
        json["slab"] = slab.hull.slab;
        json["layers"] = as_json(slab.layers, slab.layers_enough);
        json["projection"] = Json::object();
        for (const auto& [patch, moved] : slab.projected) {
            json["projection"][patch_name(slab.hull.patches, patch)] = {{"largest", moved.largest},
                                                                        {"mean", moved.mean}};
        }
        json["cap"] = {{"made", slab.adapted ? "adapted" : slab.cap_moved ? "moved" : "meshed"}};
        if (slab.adapted) {
            json["adapt"] = as_json(slab.adapted->report);
        }
        if (!slab.cap_moved) {
            json["cap"]["blocks"] = slab.cap_blocks;
        }
        if (slab.moved_angle) {
            json["cap"]["angle_when_moved"] = *slab.moved_angle;
        }
        json["seconds"] = seconds_as_json(clock);
        json["beside_cap_meshing"] = shares_as_json(clock);
        json["peak_memory"] = peaks_as_json();
        json["peak_memory"]["bytes_per_cell"] =
            static_cast<double>(peak_memory()) / static_cast<double>(slab.hull_cells());
        return json;
    }

    /// report.json and the series for ParaView, of all slabs there are.
    void write_overview() {
        Json head;
        head["slabhull"] = version();
        head["settings"] = settings_as_json(case_);
        head["threads"] = thread_count();
        head["patches"] = Json::object();
        for (const Patch& patch : patches_) {
            head["patches"][std::to_string(patch.number)] = patch.name;
        }
        for (const auto& [patch, match] : settings_->matches) {
            head["displacements"][patch_name(patches_, patch)] = {{"files", match.files},
                                                                  {"vertices", match.vertices},
                                                                  {"tolerance", match.tolerance},
                                                                  {"largest_distance", match.largest}};
        }
        head["peak_memory"] = peaks_as_json();
        io::AtomicFile file{path_of(report_name)};
        write_report(head, file);
        file.commit();
        result_.files.push_back(path_of(report_name));
        write_series();
    }

    /// Collections for ParaView: the slabs at the times they begin, the caps at theirs.
    void write_series() {
        std::vector<io::SeriesEntry> slabs, caps;
        each_slab([&](const Json& slab) {
            const int number = slab["slab"];
            add_to_series(slabs, slab["time"][0], shown_file(slab));
            add_to_series(caps, slab["time"][1], cap_name(number + 1));
        });
        if (!slabs.empty()) {
            add_series(slabs_series_name, slabs);
        }
        add_series(caps_series_name, caps);
    }

    /// The file of a slab that ParaView opens; empty without.
    static std::string shown_file(const Json& slab) {
        const int number = slab["slab"];
        for (const Json& file : slab["files"]) {
            std::string name = file["name"];
            if (name == slab_name(number, "vtu") || name == slab_name(number, "pvtu")) {
                return name;
            }
        }
        return {};
    }

    void add_to_series(std::vector<io::SeriesEntry>& series, double time, const std::string& name) const {
        if (!name.empty() && std::filesystem::exists(path_of(name))) {
            series.push_back({time, name});
        }
    }

    void add_series(const char* name, const std::vector<io::SeriesEntry>& entries) {
        io::write_pvd(path_of(name), entries);
        result_.files.push_back(path_of(name));
    }

    void write_report(const Json& head, io::AtomicFile& file) const {
        const std::string text = head.dump(2);
        file.write(std::string_view{text}.substr(0, text.size() - 2)); // without the closing brace
        bool initial = true;
        const char* before = "";
        journal_->each_line([&](const std::string& line) {
            file.write(initial ? ",\n  \"initial_cap\": " + line + ",\n  \"slabs\": ["
                               : before + ("\n    " + line));
            before = initial ? "" : ",";
            initial = false;
        });
        file.write("\n  ]\n}\n");
    }

    const Case& case_;
    const Listener& listener_;
    Communicator* ranks_; ///< nullptr: this process alone
    std::optional<io::FolderLock> lock_;
    std::uint32_t checksum_ = 0; ///< of the inputs that a resumed run goes on with; on the first rank
    ProgressMeter meter_;
    ProgressScope watched_;
    double file_bytes_per_cell_ = 0;          ///< in the last slab
    std::optional<CaseSettings<D>> settings_; ///< the march has those of its slabs
    std::optional<March<D>> march_;
    std::optional<Journal> journal_; ///< there from the first slab on
    Json initial_;
    PatchList patches_;
    RunResult result_;
    bool told_of_layers_ = false; ///< that they are too few
    std::optional<CapsAhead<D>> ahead_;
    int failures_ahead_ = 0; ///< slabs that were not as prepared

    /// A slab that is being checked and written.
    struct Finishing {
        BackgroundStage stage;
        std::shared_ptr<Built> built;
        std::future<void> done;
    };
    std::deque<Finishing> finishing_; ///< last, so that they are waited for before all else goes
};

} // namespace

namespace {

RunResult run_alone(const Case& the_case, const Listener& listener, const RunOptions& options) {
    require_files(the_case);
    warn_of_turns(the_case, listener);
    return the_case.dimension == 2 ? Runner<2>{the_case, options, listener}.run()
                                   : Runner<3>{the_case, options, listener}.run();
}

} // namespace

RunResult run_case(const Case& the_case, const Listener& listener, const RunOptions& options) {
    if (options.ranks == nullptr) {
        return run_alone(the_case, listener, options);
    }
    return together(*options.ranks, [&] {
        const Case divided = case_in_ranks(the_case, options.ranks->size());
        return run_alone(divided, options.ranks->first() ? listener : Listener{}, options);
    });
}

const char* version() {
    return SLABHULL_VERSION;
}

} // namespace slabhull
