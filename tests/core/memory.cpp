// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/memory.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <string>
#include <unistd.h>

using namespace slabhull;

namespace {

/// A machine's proc and sys, as far as memory is concerned: 1 GB free.
class FakeMachine {
public:
    FakeMachine()
        : root_{std::filesystem::temp_directory_path() / ("slabhull-memory-" + std::to_string(::getpid()))} {
        write("proc/meminfo", "MemTotal: 4000000 kB\nMemFree: 10 kB\nMemAvailable: 1000000 kB\n");
    }
    ~FakeMachine() { std::filesystem::remove_all(root_); }
    FakeMachine(const FakeMachine&) = delete;
    FakeMachine& operator=(const FakeMachine&) = delete;

    void write(const std::filesystem::path& file, const std::string& text) const {
        std::filesystem::create_directories((root_ / file).parent_path());
        std::ofstream{root_ / file} << text;
    }
    std::size_t available() const { return available_memory(root_); }

private:
    std::filesystem::path root_;
};

constexpr std::size_t machine = 1'024'000'000;

} // namespace

TEST_CASE("without a limit, what the machine has free is available") {
    const FakeMachine fake;
    CHECK(fake.available() == machine);
    fake.write("proc/self/cgroup", "9:name=systemd:/\n4:memory:/jobs/7\n0::/\nno line\n");
    CHECK(fake.available() == machine);
    fake.write("sys/fs/cgroup/memory/jobs/7/memory.limit_in_bytes", "9223372036854771712\n");
    fake.write("sys/fs/cgroup/memory/jobs/7/memory.usage_in_bytes", "4234792960\n");
    CHECK(fake.available() == machine);
    CHECK(available_memory() > 1 << 20); // here
}

TEST_CASE("a control group leaves its limit less what it keeps") {
    const FakeMachine fake;
    fake.write("proc/self/cgroup", "0::/jobs/7\n");
    fake.write("sys/fs/cgroup/jobs/7/memory.max", "500000\n");
    fake.write("sys/fs/cgroup/jobs/7/memory.current", "300000\n");
    CHECK(fake.available() == 200'000);
    fake.write("sys/fs/cgroup/jobs/7/memory.stat", "anon 5\ninactive_file 100000\n");
    CHECK(fake.available() == 300'000);
    fake.write("sys/fs/cgroup/jobs/7/memory.current", "700000\n"); // above its limit, as can be for a moment
    CHECK(fake.available() == 0);
    fake.write("sys/fs/cgroup/jobs/7/memory.max", "max\n");
    CHECK(fake.available() == machine);
}

TEST_CASE("a group that ours is part of limits us, too, in both versions of control groups") {
    const FakeMachine fake;
    fake.write("proc/self/cgroup", "0::/jobs/7\n");
    fake.write("sys/fs/cgroup/jobs/7/memory.max", "max\n");
    fake.write("sys/fs/cgroup/jobs/7/memory.current", "10\n");
    fake.write("sys/fs/cgroup/jobs/memory.max", "9000\n");
    fake.write("sys/fs/cgroup/jobs/memory.current", "2000\n");
    CHECK(fake.available() == 7'000);

    fake.write("proc/self/cgroup", "3:cpu,memory2:/\n4:memory:/a/b\n");
    fake.write("sys/fs/cgroup/memory/a/b/memory.limit_in_bytes", "5000\n");
    fake.write("sys/fs/cgroup/memory/a/b/memory.usage_in_bytes", "1000\n");
    fake.write("sys/fs/cgroup/memory/a/b/memory.stat", "inactive_file 1\ntotal_inactive_file 400\n");
    CHECK(fake.available() == 4'400);
    fake.write("sys/fs/cgroup/memory/memory.limit_in_bytes", "100\n");
    fake.write("sys/fs/cgroup/memory/memory.usage_in_bytes", "30\n");
    CHECK(fake.available() == 70);
}
