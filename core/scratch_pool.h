// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace slabhull {

/// Reusable scratch objects: as many are made as are in use at once, so one per thread at most.
template<class T>
class ScratchPool {
public:
    /// An idle object, else a new one from make().
    template<class Make>
    std::unique_ptr<T> take(const Make& make) {
        {
            const std::lock_guard guard{lock_};
            if (!idle_.empty()) {
                std::unique_ptr<T> taken = std::move(idle_.back());
                idle_.pop_back();
                return taken;
            }
        }
        return std::unique_ptr<T>{new T(make())};
    }

    void give_back(std::unique_ptr<T> object) {
        const std::lock_guard guard{lock_};
        idle_.push_back(std::move(object));
    }

private:
    std::mutex lock_;
    std::vector<std::unique_ptr<T>> idle_;
};

} // namespace slabhull
