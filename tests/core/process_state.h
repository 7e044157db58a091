// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/child_process.h"

#include <fstream>
#include <string>

#include <sys/types.h>
#include <unistd.h>

namespace slabhull {

/// Waits for a byte of a child that sends none: whether one came.
inline bool receive_nothing(const Receive& receive) {
    char byte = 0;
    return receive(&byte, 1);
}

/// Whether a process works: not when it is gone, or waits to be buried.
inline bool works(pid_t process) {
    std::ifstream stat{"/proc/" + std::to_string(process) + "/stat"};
    std::string id, name, state;
    stat >> id >> name >> state;
    return !state.empty() && state != "Z";
}

/// Whether it stops working within a second: whoever adopts it may take a moment to bury it.
inline bool ends_soon(pid_t process) {
    for (int tries = 0; tries < 100 && works(process); ++tries) {
        usleep(10'000);
    }
    return !works(process);
}

} // namespace slabhull
