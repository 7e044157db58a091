// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace slabhull {

/// Threads that parallel loops use: by default as many as the machine has cores.
int thread_count();
/// Sets them, for the whole process; 0 means the machine's cores.
void set_thread_count(int count);

/// Calls body(begin, end) over [0, count) in consecutive pieces of `grain`, on thread_count() threads.
/// The pieces do not depend on the number of threads, so a result kept by piece is the same for any.
/// The first exception (by piece) is thrown again when all threads are done. Throws Interrupted before a
/// piece when the work is to stop, see ProgressScope.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

} // namespace slabhull
