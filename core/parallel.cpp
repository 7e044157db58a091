// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/core/parallel.h"

#include "slabhull/core/progress.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace slabhull {

namespace {

/// Asked once: the answer is read from files each time.
int machine_cores() {
    static const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return cores;
}

std::atomic<int> configured_threads{0};

} // namespace

int thread_count() {
    const int configured = configured_threads.load();
    return configured > 0 ? configured : machine_cores();
}

void set_thread_count(int count) {
    configured_threads.store(std::max(0, count));
}

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
    const std::size_t piece = std::max<std::size_t>(1, grain);
    const std::size_t pieces = (count + piece - 1) / piece;
    const auto run_piece = [&](std::size_t k) {
        go_on();
        body(k * piece, std::min(count, (k + 1) * piece));
    };

    const std::size_t threads = std::min(pieces, static_cast<std::size_t>(thread_count()));
    if (threads <= 1) {
        for (std::size_t k = 0; k < pieces; ++k) {
            run_piece(k);
        }
        return;
    }

    std::atomic<std::size_t> next{0};
    std::mutex failure_lock;
    std::exception_ptr failure;
    std::atomic<std::size_t> failed_piece{pieces}; // pieces after it need not run: they could not fail first
    const auto work = [&] {
        for (std::size_t k = next++; k < failed_piece; k = next++) {
            try {
                run_piece(k);
            } catch (...) {
                const std::lock_guard guard{failure_lock};
                if (k < failed_piece) {
                    failed_piece = k;
                    failure = std::current_exception();
                }
            }
        }
    };
    std::vector<std::jthread> team;
    for (std::size_t i = 1; i < threads; ++i) {
        team.emplace_back(watched_as_here([&work] { work(); }));
    }
    work();
    team.clear(); // joins
    if (failure) {
        std::rethrow_exception(failure);
    }
}

} // namespace slabhull
