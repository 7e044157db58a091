// SPDX-License-Identifier: BSD-3-Clause
// Mesh files written and read: ours, and other libraries' where they are installed, by turns in one process.
// Every result is compared with the mesh before its time counts. A line of JSON per run on stdout; medians
// and ratios on stderr.
//     bench_io_files [--benches=write_vtu,read_msh ..] [--who=ours,vtk ..] [--cells=9000000] [--rounds=5]
//                    [--dir=/tmp] [--soups=DIR] [--threads=N] [--huge-pages=1]
#include "slabhull/io/files.h"
#include "../memory.h"
#include "../soups.h"
#include "file_peers.h"
#include "hull_columns.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/stopwatch.h"
#include "slabhull/io/checksum.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <map>
#include <string_view>
#include <unistd.h>

using namespace slabhull;
using namespace slabhull::bench;

namespace {

struct Options {
    std::string benches; ///< with commas; empty: all
    std::string who;     ///< likewise
    double cells = 9e6;
    int rounds = 5;
    std::string folder = "/tmp";
    bool huge_pages = false; ///< for the others, too
};

bool chosen(const std::string& list, const std::string& name) {
    return list.empty() || (',' + list + ',').find(',' + name + ',') != std::string::npos;
}

/// TetGen's mesh along a curve, up to 9 million cells; above, several of these.
class Mesh {
public:
    explicit Mesh(double cells) : tets_{soup(divisions(cells), CellOrder::curve).mesh} {
        cell_of_.resize(tets_.points.size());
        for (std::size_t c = tets_.cells.size(); c-- > 0;) {
            for (const Index v : tets_.cells[c]) {
                cell_of_[v] = static_cast<Index>(c);
            }
        }
        const double copies = std::round(cells / static_cast<double>(tets_.cells.size()));
        hull = {tets_.points.data(),
                tets_.cells.data(),
                tets_.neighbors.data(),
                cell_of_.data(),
                tets_.points.size(),
                tets_.cells.size(),
                std::max<std::size_t>(1, static_cast<std::size_t>(copies))};
    }

    HullSoup hull;

private:
    static int divisions(double cells) {
        constexpr double cells_of_one = 4070;
        constexpr int largest = 13;
        return std::clamp(static_cast<int>(std::cbrt(cells / cells_of_one) + 0.5), 1, largest);
    }

    const CapMesh<3>& tets_;
    Array<Index> cell_of_;
};

double sync_seconds(const std::string& file) {
    const Stopwatch watch;
    const int descriptor = ::open(file.c_str(), O_RDONLY);
    if (descriptor >= 0) {
        ::fdatasync(descriptor);
        ::close(descriptor);
    }
    return watch.seconds();
}

bool is_written(const std::string& bench, const std::string& file, const HullSoup& soup) {
    return bench == "write_vtu" ? is_hull(io::read_vtu(file), soup)
                                : is_mesh(io::read_msh(file), soup, tolerance_of(bench));
}

/// What one bench has shown so far.
struct Series {
    std::vector<double> seconds;
    std::vector<double> rates; ///< MB/s
};
using Table = std::map<std::string, Series>;

/// Runs once, and prints it.
void measure(const Contestant& contestant, const Run& run, const HullSoup& soup, const std::string& file,
             Series& series) {
    const bool writes = contestant.bench.rfind("write", 0) == 0;
    if (writes) {
        std::filesystem::remove(file); // or a writer would have to free its blocks
    }
    const PeakMemory memory;
    const Stopwatch watch;
    const Outcome outcome = run(file);
    const double seconds = outcome.seconds > 0 ? outcome.seconds : watch.seconds();
    const double more = memory.more();
    const double synced = writes ? sync_seconds(file) : 0;
    const auto bytes = static_cast<double>(std::filesystem::file_size(file));
    const bool right = outcome.right ? outcome.right() : is_written(contestant.bench, file, soup);
    if (!right) {
        throw std::runtime_error{contestant.bench + ": " + contestant.who + " has not the mesh"};
    }
    series.seconds.push_back(seconds);
    series.rates.push_back(1e-6 * bytes / seconds);
    fmt::print("{{\"bench\": \"{}\", \"who\": \"{}\", \"tets\": {}, \"threads\": {}, \"bytes\": {:.0f}, "
               "\"seconds\": {:.4f}, \"sync_seconds\": {:.4f}, \"MB_per_second\": {:.1f}, "
               "\"extra_MiB\": {:.1f}, \"extra_bytes_per_tet\": {:.1f}}}\n",
               contestant.bench, contestant.who, soup.cell_count(), thread_count(), bytes, seconds, synced,
               series.rates.back(), more / (1 << 20), more / static_cast<double>(soup.cell_count()));
    std::fflush(stdout);
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

void print_ratios(const std::string& bench, const Table& table) {
    for (const auto& [who, series] : table) {
        fmt::print(stderr, "{:16} {:14} {:8.3f} s {:8.1f} MB/s", bench, who, median(series.seconds),
                   median(series.rates));
        if (who != "ours" && table.count("ours") != 0) {
            const Series& ours = table.at("ours");
            fmt::print(stderr, "   ours: {:.2f} times by time, {:.2f} by rate",
                       median(series.seconds) / median(ours.seconds),
                       median(ours.rates) / median(series.rates));
        }
        fmt::print(stderr, "\n");
    }
}

/// The file that a bench reads: ours where we write such, and in the page cache.
void provide(const std::string& bench, const HullSoup& soup, const std::string& file) {
    const std::string writing = "write" + bench.substr(bench.find('_'));
    const Contestant* writer = nullptr;
    for (const Contestant& each : contestants()) {
        if (each.bench == writing && (writer == nullptr || each.who == "ours")) {
            writer = &each;
        }
    }
    if (writer == nullptr) {
        throw std::runtime_error{bench + ": nobody is there to write the file"};
    }
    writer->prepare(soup)(file);
    io::checksum_of(file);
}

/// All who take part, round by round.
void compete(const std::string& bench, const Options& options, const HullSoup& soup) {
    const std::string file = fmt::format("{}/bench-io-{}.{}", options.folder, ::getpid(),
                                         bench.find("vtu") != std::string::npos ? "vtu" : "msh");
    if (bench.rfind("read", 0) == 0) {
        provide(bench, soup, file);
    }
    std::vector<std::pair<Contestant, Run>> runs;
    for (const Contestant& contestant : contestants()) {
        if (contestant.bench == bench && chosen(options.who, contestant.who)) {
            runs.emplace_back(contestant, contestant.prepare(soup));
        }
    }
    Table table;
    for (int round = 0; round < options.rounds; ++round) {
        for (const auto& [contestant, run] : runs) {
            measure(contestant, run, soup, file, table[contestant.who]);
        }
    }
    std::filesystem::remove(file);
    print_ratios(bench, table);
}

Options read_options(int count, char** arguments) {
    Options options;
    for (int i = 1; i < count; ++i) {
        const std::string argument = arguments[i];
        const std::size_t equals = std::min(argument.find('='), argument.size() - 1);
        const std::string name = argument.substr(0, equals);
        const std::string value = argument.substr(equals + 1);
        if (name == "--benches") {
            options.benches = value;
        } else if (name == "--who") {
            options.who = value;
        } else if (name == "--cells") {
            options.cells = std::atof(value.c_str());
        } else if (name == "--rounds") {
            options.rounds = std::atoi(value.c_str());
        } else if (name == "--dir") {
            options.folder = value;
        } else if (name == "--huge-pages") {
            options.huge_pages = value != "0";
        } else if (name == "--soups") {
            keep_soups_in(value);
        } else if (name == "--threads") {
            set_thread_count(std::atoi(value.c_str()));
        } else {
            throw std::invalid_argument{argument + " is no option"};
        }
    }
    return options;
}

/// The others take their memory from malloc, which is to ask for huge pages, as our Array does. This is read
/// when a program starts, so we start once more.
void start_with_huge_pages(char** arguments) {
    if (std::getenv("GLIBC_TUNABLES") == nullptr) {
        ::setenv("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1", 1);
        ::execv("/proc/self/exe", arguments);
    }
}

} // namespace

int main(int count, char** arguments) try {
    const Options options = read_options(count, arguments);
    if (options.huge_pages) {
        start_with_huge_pages(arguments);
    }
    const Mesh mesh{options.cells};
    for (const char* bench :
         {"write_vtu", "read_vtu", "write_msh", "read_msh", "write_msh_ascii", "read_msh_ascii"}) {
        if (chosen(options.benches, bench)) {
            compete(bench, options, mesh.hull);
        }
    }
} catch (const std::exception& problem) {
    std::fprintf(stderr, "%s\n", problem.what());
    return 1;
}
