// SPDX-License-Identifier: BSD-3-Clause
// Neighbours of a soup of tetrahedra: ours, and other libraries' where they are installed. Each result is
// compared before its time counts: ours with TetGen's own neighbours, the others' with ours.
//     bench_topology_adjacency [--soups=DIR] [Google Benchmark's options]
#include "slabhull/topology/adjacency.h"

#include "../growth.h"
#include "../memory.h"
#include "../soups.h"
#include "adjacency_peers.h"
#include "slabhull/core/parallel.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <malloc.h>
#include <map>
#include <string_view>
#include <unistd.h>

using namespace slabhull;
using namespace slabhull::bench;

namespace {

using Result = Array<Neighbors<3>>;

/// What is compared in one table: runs on one thread on one soup.
using Table = std::pair<CellOrder, std::size_t>; ///< with the number of cells

/// Million cells per second of CPU, by who made them.
std::map<Table, std::map<std::string, double>> one_thread_rates;

std::map<std::string, Growth> growths;

double cpu_seconds() {
    std::timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Run {
    std::string who;
    int divisions;
    CellOrder order;
    int threads;
};

std::string series(const Run& run) {
    const char* order = run.order == CellOrder::mesher ? "tetgen_order" : "curve_order";
    return run.who + '/' + order + "/threads:" + std::to_string(run.threads);
}

/// Large blocks fresh from the system and back to it. Libraries that PETSc brings along (SuperLU_DIST is one)
/// forbid this to the whole process when they are loaded, and then freed memory is not used again for our
/// arrays.
void let_malloc_map_large_blocks() {
    ::mallopt(M_MMAP_MAX, 1 << 16);
    ::mallopt(M_MMAP_THRESHOLD, 4 << 20);
}

/// Times find() in its own fresh memory, and has the last result checked.
template<class Find, class Right>
void measure(benchmark::State& state, const Run& run, const Find& find, const Right& right) {
    const Soup& tets = soup(run.divisions, run.order);
    const auto cells = static_cast<double>(tets.mesh.cells.size());
    set_thread_count(run.threads);
    let_malloc_map_large_blocks();
    Result result;
    double shortest = 1e300;
    const PeakMemory memory;
    for (auto iteration : state) {
        state.PauseTiming();
        result = Result{};
        state.ResumeTiming();
        const double start = cpu_seconds();
        result = find();
        shortest = std::min(shortest, cpu_seconds() - start);
    }
    state.counters["extra_bytes_per_tet"] = memory.more() / cells - sizeof(Neighbors<3>);
    state.counters["huge_page_share"] = huge_page_share();
    if (!right(result)) {
        state.SkipWithError("wrong neighbours");
        return;
    }
    state.counters["tets"] = cells;
    state.counters["Mtets_per_cpu_second"] = 1e-6 * cells / shortest;
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(cells));
    Growth& growth = growths[series(run)];
    growth.add(cells, shortest);
    if (growth.known()) {
        state.counters["growth"] = growth.exponent();
    }
    if (run.threads == 1) {
        double& rate = one_thread_rates[{run.order, tets.mesh.cells.size()}][run.who];
        rate = std::max(rate, 1e-6 * cells / shortest);
    }
}

void ours(benchmark::State& state, const Run& run) {
    const CapMesh<3>& mesh = soup(run.divisions, run.order).mesh;
    measure(
        state, run, [&] { return build_adjacency<3>(mesh.cells, mesh.points.size()).neighbors; },
        [&](const Result& found) { return found == mesh.neighbors; });
}

void theirs(benchmark::State& state, const Run& run, const Peer& peer) {
    const CapMesh<3>& mesh = soup(run.divisions, run.order).mesh;
    const auto find =
        peer.prepare({mesh.points.data(), mesh.points.size(), mesh.cells.data(), mesh.cells.size()});
    measure(
        state, run,
        [&] {
            Result result(mesh.cells.size());
            find(result.data());
            return result;
        },
        [&](const Result& found) {
            return found == build_adjacency<3>(mesh.cells, mesh.points.size()).neighbors;
        });
}

template<class Body>
benchmark::internal::Benchmark* add(const Run& run, const Body& body) {
    const std::string name = series(run) + "/divisions:" + std::to_string(run.divisions);
    return benchmark::RegisterBenchmark(name.c_str(), body)
        ->Unit(benchmark::kMillisecond)
        ->MinTime(3) // one run of the slow, several of the quick
        ->UseRealTime()
        ->MeasureProcessCPUTime();
}

/// Ours first: the others leave a heap full of holes, where our few small things would be spread over huge
/// pages.
void add_all() {
    for (const CellOrder order : {CellOrder::mesher, CellOrder::curve}) {
        for (const int threads : {1, 2}) {
            for (const int divisions : {3, 6, 9, 13}) {
                const Run run{"ours", divisions, order, threads};
                add(run, [=](benchmark::State& state) { ours(state, run); });
            }
        }
    }
    for (const Peer& peer : peers()) {
        for (const CellOrder order : {CellOrder::mesher, CellOrder::curve}) {
            for (const int divisions : {6, 9, 13}) {
                const Run run{peer.name, divisions, order, 1};
                if (divisions <= peer.divisions) {
                    add(run, [=](benchmark::State& state) { theirs(state, run, peer); });
                }
            }
        }
    }
}

/// How many times faster we are than the best of the others, soup by soup.
void print_ratios() {
    for (const auto& [table, rates] : one_thread_rates) {
        const auto& [order, cells] = table;
        std::string best;
        for (const auto& [who, rate] : rates) {
            if (who != "ours" && (best.empty() || rate > rates.at(best))) {
                best = who;
            }
        }
        if (!best.empty() && rates.count("ours") != 0) {
            std::fprintf(stderr, "%zu tets in %s order, one thread: ours %.2f Mtets/s, %s %.2f, ratio %.1f\n",
                         cells, order == CellOrder::mesher ? "TetGen's" : "curve", rates.at("ours"),
                         best.c_str(), rates.at(best), rates.at("ours") / rates.at(best));
        }
    }
}

/// The others take their memory from malloc: it gets huge pages, as ours has. And one thread. Both are read
/// when a program starts, so we start once more.
void start_on_equal_terms(char** arguments) {
    if (std::getenv("GLIBC_TUNABLES") == nullptr) {
        ::setenv("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1", 1);
        ::setenv("VTK_SMP_BACKEND_IN_USE", "Sequential", 1);
        ::execv("/proc/self/exe", arguments);
    }
}

/// Takes --soups=DIR out of the arguments.
void read_own_options(int& count, char** arguments) {
    constexpr std::string_view option = "--soups=";
    char** const end = std::remove_if(arguments + 1, arguments + count, [&](const char* argument) {
        const bool own = std::string_view{argument}.substr(0, option.size()) == option;
        if (own) {
            keep_soups_in(argument + option.size());
        }
        return own;
    });
    count = static_cast<int>(end - arguments);
}

} // namespace

int main(int count, char** arguments) {
    start_on_equal_terms(arguments);
    read_own_options(count, arguments);
    add_all();
    benchmark::Initialize(&count, arguments);
    if (benchmark::ReportUnrecognizedArguments(count, arguments)) {
        return 2;
    }
    benchmark::RunSpecifiedBenchmarks();
    print_ratios();
}
