// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/run.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/io/files.h"
#include "slabhull/slab/check.h"
#include "slabhull/slab/hull_files.h"
#include "slabhull/slab/initial.h"
#include "slabhull/slab/report.h"
#include "slabhull/slab/slab.h"

#include <fmt/format.h>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>

namespace slabhull {

namespace {

using Json = nlohmann::ordered_json;

Json seconds_as_json(const StageClock& clock) {
    Json seconds = Json::object();
    for (const auto& [stage, passed] : clock.stages()) {
        seconds[stage] = passed;
    }
    return seconds;
}

Json settings_as_json(const Case& the_case) {
    return {{"title", the_case.title},
            {"dimension", the_case.dimension},
            {"experiment", the_case.experiment},
            {"level", the_case.level},
            {"start", the_case.start},
            {"end", the_case.end},
            {"slabs", the_case.slabs},
            {"scheme", scheme_name(the_case.trajectory.scheme)},
            {"substeps", the_case.trajectory.substeps},
            {"split", split_name(the_case.split)},
            {"diagonals", the_case.diagonals == Diagonals::shape ? "shape" : "smallest-id"},
            {"cap_mesher", the_case.dimension == 3 ? "tetgen" : "cdt"},
            {"cap_size", std::isfinite(the_case.cap_size) ? Json(the_case.cap_size) : Json()},
            {"cap_growth", the_case.cap_growth},
            {"cap_quality", the_case.cap_quality},
            {"cap_order", the_case.cap_curve_order ? "curve" : "mesher"}};
}

void make_directory(const std::filesystem::path& directory) {
    std::error_code failure;
    std::filesystem::create_directories(directory, failure);
    if (failure) {
        throw OutputError(fmt::format("{}: {}", directory.string(), failure.message()));
    }
}

/// The files of a slab while they are being written. Without commit they vanish.
struct SlabFiles {
    std::vector<std::filesystem::path> paths;
    std::vector<std::unique_ptr<io::AtomicFile>> open;
    std::future<void> written; ///< last, to be waited for before the files go

    void add(const std::filesystem::path& path) {
        open.push_back(std::make_unique<io::AtomicFile>(path));
        paths.push_back(path);
    }
};

template<int D>
class Runner {
public:
    Runner(const Case& the_case, const Listener& listener) : case_{the_case}, listener_{listener} {}

    RunResult run() {
        listener_.progress("initial cap", 0);
        StageClock clock;
        SpatialMesh<D> cap = initial_cap<D>(case_, ids_, listener_, clock);
        settings_ = settings_of<D>(case_, cap.patches);
        report_initial(cap, clock);
        try {
            for (int slab = 0; slab < case_.slabs; ++slab) {
                cap = run_slab(cap, slab);
            }
        } catch (const Error&) {
            if (!result_.files.empty()) {
                write_report();
            }
            throw;
        }
        write_report();
        listener_.progress("done", 1);
        return std::move(result_);
    }

private:
    SpatialMesh<D> run_slab(const SpatialMesh<D>& initial, int number) {
        listener_.progress(fmt::format("slab {} of {}", number + 1, case_.slabs),
                           static_cast<double>(number) / case_.slabs);
        StageClock clock;
        Slab<D> slab = build_slab<D>(initial, number, case_.level_times(number), settings_, ids_, clock);
        SlabFiles files;
        begin_writing(slab, number, files); // the disk is slow: it works while the hull is checked
        const HullReport checked = check_hull<D>(columns_of(slab.hull));
        clock.book("checking");
        if (!checked.clean()) {
            throw GeometryError(fmt::format("the hull of slab {} has {} defects and was not written:\n{}",
                                            number, checked.total(), findings_as_text(checked)));
        }
        commit(files);
        result_.cells += slab.hull.cells.size();
        result_.points += slab.hull.points.size();
        clock.book("writing");
        report_slab(slab, checked, clock);
        return std::move(slab.terminating);
    }

    void begin_writing(const Slab<D>& slab, int number, SlabFiles& files) {
        make_directory(case_.directory);
        for (const std::string& format : case_.formats) {
            files.add(case_.directory / fmt::format("slab_{:04}.{}", number, format));
        }
        files.add(case_.directory / fmt::format("cap_{:04}.vtu", number + 1));
        files.written = std::async(thread_count() > 1 ? std::launch::async : std::launch::deferred,
                                   [this, &slab, &files] { write(slab, files); });
    }

    void write(const Slab<D>& slab, SlabFiles& files) const {
        for (std::size_t i = 0; i < case_.formats.size(); ++i) {
            write_hull(*files.open[i], slab.hull, case_.formats[i]);
            files.open[i]->finish();
        }
        write_cap(*files.open.back(), slab.terminating, slab.hull.time[1]);
        files.open.back()->finish();
    }

    void commit(SlabFiles& files) {
        files.written.get();
        for (std::size_t i = 0; i < files.open.size(); ++i) {
            files.open[i]->commit();
            result_.files.push_back(files.paths[i]);
        }
    }

    void report_initial(const SpatialMesh<D>& cap, const StageClock& clock) {
        report_["slabhull"] = version();
        report_["settings"] = settings_as_json(case_);
        report_["threads"] = thread_count();
        report_["patches"] = Json::object();
        for (const Patch& patch : cap.patches) {
            report_["patches"][std::to_string(patch.number)] = patch.name;
        }
        report_["initial_cap"] = {{"points", cap.points.size()},
                                  {"cells", cap.cells.size()},
                                  {"boundary_facets", cap.boundary_facets.size()},
                                  {"seconds", seconds_as_json(clock)}};
        report_["slabs"] = Json::array();
    }

    void report_slab(const Slab<D>& slab, const HullReport& checked, const StageClock& clock) {
        Json json = as_json(checked);
        json["slab"] = slab.hull.slab;
        json["projection"] = Json::object();
        for (const auto& [patch, moved] : slab.projected) {
            json["projection"][patch_name(slab.hull.patches, patch)] = {{"largest", moved.largest},
                                                                        {"mean", moved.mean}};
        }
        json["seconds"] = seconds_as_json(clock);
        report_["slabs"].push_back(std::move(json));
    }

    void write_report() {
        report_["peak_memory"] = {{"bytes", peak_memory()}, {"mesher_bytes", peak_memory_of_children()}};
        const auto path = case_.directory / "report.json";
        io::write_text(path, report_.dump(2) + "\n");
        result_.files.push_back(path);
    }

    const Case& case_;
    const Listener& listener_;
    IdCounter ids_;
    SlabSettings<D> settings_;
    RunResult result_;
    Json report_;
};

} // namespace

RunResult run_case(const Case& the_case, const Listener& listener) {
    return the_case.dimension == 2 ? Runner<2>{the_case, listener}.run()
                                   : Runner<3>{the_case, listener}.run();
}

const char* version() {
    return SLABHULL_VERSION;
}

} // namespace slabhull
