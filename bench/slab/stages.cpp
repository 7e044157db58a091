// SPDX-License-Identifier: BSD-3-Clause
// A slab from end to end, as `slabhull build` makes it: how long each stage takes, beside the meshing of its
// two caps. Hulls of the turning ellipsoid that are mostly caps, by turns; a line of JSON per run, medians at
// the end. A run counts only when the hull's check found nothing and its file was written.
//     bench_slab_stages [MILLIONS_OF_TETRAHEDRA [ROUNDS [FOLDER]]]
#include "slabhull/cases/run.h"
#include "slabhull/core/stopwatch.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

using namespace slabhull;

namespace {

using Json = nlohmann::ordered_json;

/// The experiment's hull with about so many tetrahedra; refinement 1.187 gives 367,000.
Case case_of(double tets, const std::filesystem::path& folder) {
    Case the_case = experiment_at("ellipsoid", 1.187 * std::cbrt(tets / 367'000), Bulk::caps);
    the_case.directory = folder;
    the_case.formats = {"vtu"};
    return the_case;
}

using Seconds = std::map<std::string, double>;

struct Run {
    std::size_t tets = 0;
    int cap_blocks = 0; ///< of the terminating cap, as chosen for the memory there is
    Seconds stages;
    double cpu_beside = 0;  ///< of this process
    double cpu_meshers = 0; ///< of the meshers' processes

    double meshing() const { return stages.at("cap meshing"); }
    double beside() const {
        double sum = 0;
        for (const auto& [stage, seconds] : stages) {
            sum += stage == "cap meshing" ? 0 : seconds;
        }
        return sum;
    }
};

Run run(double tets, const std::filesystem::path& folder) {
    const double self = cpu_seconds();
    const double children = cpu_seconds_of_children();
    Run result;
    result.tets = run_case(case_of(tets, folder), {}, {}).cells;
    result.cpu_beside = cpu_seconds() - self;
    result.cpu_meshers = cpu_seconds_of_children() - children;
    const Json report = Json::parse(std::ifstream{folder / "report.json"});
    result.cap_blocks = report["slabs"][0]["cap"]["blocks"];
    for (const Json& part : {report["initial_cap"], report["slabs"][0]}) {
        for (const auto& [stage, seconds] : part["seconds"].items()) {
            result.stages[stage] += seconds.get<double>();
        }
    }
    if (!report["slabs"][0]["clean"].get<bool>() || !std::filesystem::exists(folder / "slab_0000.vtu")) {
        std::fprintf(stderr, "the hull is not clean, or not written\n");
        std::exit(1);
    }
    return result;
}

Json as_json(const Run& run) {
    Json json{{"tets", run.tets},
              {"cap_blocks", run.cap_blocks},
              {"beside_cap_meshing", run.beside() / run.meshing()},
              {"cpu_beside_meshers", run.cpu_beside / run.cpu_meshers}};
    for (const auto& [stage, seconds] : run.stages) {
        json["seconds"][stage] = seconds;
        if (stage != "cap meshing") {
            json["parts_of_cap_meshing"][stage] = seconds / run.meshing();
        }
    }
    return json;
}

} // namespace

int main(int count, char** arguments) {
    const double millions = count > 1 ? std::atof(arguments[1]) : 7;
    const int rounds = count > 2 ? std::atoi(arguments[2]) : 3;
    const std::filesystem::path folder =
        count > 3 ? arguments[3] : std::filesystem::temp_directory_path() / "slabhull-stages";
    std::vector<Run> runs;
    for (int round = 0; round < rounds; ++round) {
        runs.push_back(run(millions * 1e6, folder));
        std::printf("%s\n", as_json(runs.back()).dump().c_str());
        std::fflush(stdout);
    }
    std::sort(runs.begin(), runs.end(),
              [](const Run& a, const Run& b) { return a.beside() / a.meshing() < b.beside() / b.meshing(); });
    std::printf("median: %s\n", as_json(runs[runs.size() / 2]).dump().c_str());
    std::filesystem::remove_all(folder);
    return 0;
}
