// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/cases/checkpoint.h"
#include "slabhull/cases/settings.h"

#include "slabhull/cases/hull_files.h"
#include "slabhull/cases/initial.h"
#include "slabhull/core/error.h"
#include "slabhull/io/atomic_file.h"

#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <unistd.h>

using namespace slabhull;

namespace {

struct Folder {
    Folder()
        : path{std::filesystem::temp_directory_path() /
               ("slabhull-checkpoint-" + std::to_string(::getpid()))} {
        std::filesystem::create_directories(path);
    }
    ~Folder() { std::filesystem::remove_all(path); }
    std::filesystem::path path;
};

template<int D>
March<D> march_after_a_slab() {
    const Case the_case = D == 2 ? experiment_at("expanding-circle", 0.5) : experiment_at("ellipsoid", 0.25);
    StageClock clock;
    IdCounter ids;
    MarchState<D> state = march_from<D>(initial_cap<D>(the_case, ids, {}, clock), 0, ids);
    SlabSettings<D> settings = settings_of<D>(the_case, state.boundary);
    March<D> march{std::move(state), std::move(settings)};
    march.accept(march.propose({0, 0.1}));
    return march;
}

/// Writes cap and checkpoint; returns the checkpoint's path.
template<int D>
std::filesystem::path save(const MarchState<D>& state, const std::filesystem::path& folder) {
    io::AtomicFile cap{folder / "cap.vtu"};
    cap.keep_checksum();
    write_cap(cap, state.cap, state.time);
    cap.finish();
    cap.commit();
    write_checkpoint(folder / "march.state", state, {"cap.vtu", cap.checksum(), 17, 42, 4711});
    return folder / "march.state";
}

std::string bytes_of(const std::filesystem::path& path) {
    std::ostringstream all;
    all << std::ifstream{path, std::ios::binary}.rdbuf();
    return all.str();
}

void put(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream{path, std::ios::binary} << bytes;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("a march goes on from its checkpoint as if it had not stopped", "[checkpoint]",
                       ((int D), D), 2, 3) {
    const Folder folder;
    March<D> march = march_after_a_slab<D>();
    const Checkpoint<D> read = read_checkpoint<D>(save(march.state(), folder.path));
    CHECK(read.files.journal_size == 17);
    CHECK(read.files.journal_checksum == 42);
    CHECK(read.files.case_checksum == 4711);
    CHECK(read.state.time == march.state().time);
    CHECK(read.state.slab == march.state().slab);
    CHECK(read.state.ids.next == march.state().ids.next);
    CHECK(std::ranges::equal(read.state.boundary.start(), march.state().boundary.start()));
    CHECK(std::ranges::equal(read.state.boundary.persistent_ids(), march.state().boundary.persistent_ids()));
    CHECK(read.state.cap.patches == march.state().cap.patches);
    const March<D> other{read.state, march.settings()};
    const Hull<D> here = march.propose({0.1, 0.2}).hull;
    const Hull<D> there = other.propose({0.1, 0.2}).hull;
    CHECK(here.points == there.points);
    CHECK(here.cells == there.cells);
    CHECK(here.neighbors == there.neighbors);
    CHECK(here.vertex_ids == there.vertex_ids);
    CHECK(here.track_ids == there.track_ids);
}

TEST_CASE("no damaged checkpoint or cap is read as good", "[checkpoint]") {
    const Folder folder;
    const March<2> march = march_after_a_slab<2>();
    const auto path = save(march.state(), folder.path);
    const auto damaged = folder.path / GENERATE("march.state", "cap.vtu");
    const std::string sound = bytes_of(damaged);
    std::mt19937 random{7};
    for (int k = 0; k < 300; ++k) {
        std::string bytes = sound;
        const std::size_t at = random() % bytes.size();
        if (k % 3 == 0) {
            bytes.resize(at);
        } else if (k % 3 == 1) {
            bytes[at] = static_cast<char>(bytes[at] ^ (1 << (random() % 8)));
        } else {
            bytes.insert(at, 1, 'x');
        }
        put(damaged, bytes);
        REQUIRE_THROWS_AS(read_checkpoint<2>(path), InputError);
    }
    std::filesystem::remove(damaged);
    CHECK_THROWS_AS(read_checkpoint<2>(path), InputError);
}

TEST_CASE("a checkpoint of another dimension is refused", "[checkpoint]") {
    const Folder folder;
    const auto path = save(march_after_a_slab<2>().state(), folder.path);
    CHECK_THROWS_WITH(read_checkpoint<3>(path), Catch::Contains("dimension"));
}
