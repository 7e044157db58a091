// SPDX-License-Identifier: BSD-3-Clause
#include "core/page_pool.h"

#include "slabhull/core/array.h"
#include "slabhull/core/child_process.h"
#include "slabhull/core/memory.h"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cstring>
#include <new>
#include <sys/mman.h>
#include <thread>
#include <vector>

using namespace slabhull;
using slabhull::detail::PagePool;

namespace {

constexpr std::size_t mib = std::size_t{1} << 20;

void* mapped(std::size_t bytes) {
    void* const memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) {
        throw std::bad_alloc{};
    }
    return memory;
}

/// Takes a block from the pool, or from the system.
void* taken(PagePool& pool, std::size_t bytes) {
    void* const kept = pool.take(bytes);
    return kept != nullptr ? kept : mapped(bytes);
}

} // namespace

TEST_CASE("a block that was put back serves the next of its size, and no other", "[pages]") {
    PagePool pool{true};
    void* const block = mapped(4 * mib);
    pool.put(block, 4 * mib);
    CHECK(pool.kept_bytes() == 4 * mib);
    CHECK(pool.take(4 * mib) == block);
    CHECK(pool.kept_bytes() == 0);
    CHECK(pool.take(4 * mib) == nullptr);
    pool.put(block, 4 * mib);
    CHECK(pool.take(2 * mib) == nullptr); // the other one went to make room for it
    CHECK(pool.kept_bytes() == 0);
}

TEST_CASE("blocks in use and those kept are never more than were in use at once", "[pages]") {
    PagePool pool{true};
    std::size_t in_use = 0;
    std::size_t most = 0;
    std::vector<std::pair<void*, std::size_t>> blocks;
    for (std::size_t k = 0; k < 300; ++k) {
        if (k % 7 < 4) {
            const std::size_t bytes = (1 + k * k % 5) * mib;
            blocks.emplace_back(taken(pool, bytes), bytes);
            in_use += bytes;
        } else if (!blocks.empty()) {
            const auto [memory, bytes] = blocks[k % blocks.size()];
            blocks.erase(blocks.begin() + static_cast<std::ptrdiff_t>(k % blocks.size()));
            pool.put(memory, bytes);
            in_use -= bytes;
        }
        most = std::max(most, in_use);
        REQUIRE(in_use + pool.kept_bytes() <= most);
    }
    for (const auto& [memory, bytes] : blocks) {
        ::munmap(memory, bytes);
    }
    pool.give_back();
    CHECK(pool.kept_bytes() == 0);
}

TEST_CASE("more blocks than there is room for push the oldest out", "[pages]") {
    PagePool pool{true};
    std::vector<void*> blocks(100);
    for (void*& block : blocks) {
        block = mapped(4096);
    }
    for (void* const block : blocks) {
        pool.put(block, 4096);
    }
    CHECK(pool.kept_bytes() < blocks.size() * 4096);
    CHECK(pool.take(4096) == blocks.back());
    ::munmap(blocks.back(), 4096);
}

TEST_CASE("a pool that does not keep gives all back", "[pages]") {
    PagePool pool;
    pool.put(mapped(mib), mib);
    CHECK(pool.kept_bytes() == 0);
    CHECK(pool.take(mib) == nullptr);
}

TEST_CASE("threads never get the same block at once", "[pages]") {
    PagePool pool{true};
    std::atomic<int> wrong{0};
    std::vector<std::jthread> threads;
    for (char mark = 1; mark <= 4; ++mark) {
        threads.emplace_back([&pool, &wrong, mark] {
            for (std::size_t k = 0; k < 2000; ++k) {
                const std::size_t bytes = (1 + k % 3) * 4096;
                void* const block = taken(pool, bytes);
                std::memset(block, mark, bytes);
                const auto* const bytes_of = static_cast<const char*>(block);
                wrong += std::count(bytes_of, bytes_of + bytes, mark) != static_cast<std::ptrdiff_t>(bytes);
                pool.put(block, bytes);
            }
        });
    }
    threads.clear();
    CHECK(wrong == 0);
}

TEST_CASE("arrays reuse kept memory, in forked children too, which are made while threads allocate",
          "[pages]") {
    keep_freed_memory();
    const auto fill = [] {
        for (int k = 0; k < 50; ++k) {
            const Array<char> array(4 * mib + static_cast<std::size_t>(k % 3) * mib, static_cast<char>(k));
            if (array.back() != static_cast<char>(k) || array.front() != array.back()) {
                return false;
            }
        }
        return true;
    };
    std::atomic<bool> done{false};
    std::atomic<bool> good{true};
    std::jthread other{[&] {
        while (!done) {
            good = good && fill();
        }
    }};
    for (int round = 0; round < 10; ++round) {
        char answer = 0;
        const ChildEnd end = run_in_child(
            [&](const Send& send) {
                const char yes = fill() ? 1 : 2;
                send(&yes, 1);
            },
            [&](const Receive& receive) { return receive(&answer, 1); });
        REQUIRE(end.received);
        REQUIRE(answer == 1);
    }
    done = true;
    other.join();
    CHECK(good);
    detail::page_pool().give_back();
}
