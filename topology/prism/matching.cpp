// SPDX-License-Identifier: BSD-3-Clause
// Boost's maximum matching initialises the whole graph for each augmenting path, which is quadratic from its
// own start. So it comes last: a greedy matching leaves next to nothing free, a forest of alternating paths
// most of the rest, and Boost's, which contracts odd cycles, matches what is left inside small balls that
// grow until they hold a path.
#include "slabhull/topology/matching.h"

#include "core/listed.h"
#include "slabhull/core/error.h"
#include "slabhull/core/progress.h"
#include "topology/prism/alternating_forest.h"
#include "topology/prism/greedy_matching.h"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/max_cardinality_matching.hpp>
#include <exception>
#include <fmt/format.h>
#include <pthread.h>
#include <vector>

namespace slabhull {

namespace {

using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS>;
using Vertex = boost::graph_traits<Graph>::vertex_descriptor;
using Mates = boost::iterator_property_map<std::vector<Vertex>::iterator,
                                           boost::property_map<Graph, boost::vertex_index_t>::const_type>;

/// For boost::matching: start from what the mate map already holds.
template<class, class>
struct GivenStart {
    template<class G, class M>
    static void find_matching(const G&, M) {}
};

void augment(const Graph& graph, std::vector<Vertex>& mates) {
    const auto index = get(boost::vertex_index, graph);
    boost::matching<Graph, Mates, decltype(index), boost::edmonds_augmenting_path_finder, GivenStart,
                    boost::no_matching_verifier>(graph, Mates{mates.begin(), index}, index);
}

/// Runs `work` on a stack of its own. Boost unrolls an augmenting path by recursion, one call per vertex.
template<class Work>
void run_on_stack(std::size_t bytes, const Work& work) {
    struct Task {
        const Work& work;
        std::exception_ptr failure;
    } task{work, nullptr};
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, bytes);
    pthread_t thread;
    const int refused = pthread_create(
        &thread, &attributes,
        [](void* argument) -> void* {
            Task& mine = *static_cast<Task*>(argument);
            try {
                mine.work();
            } catch (...) {
                mine.failure = std::current_exception();
            }
            return nullptr;
        },
        &task);
    pthread_attr_destroy(&attributes);
    if (refused != 0) {
        throw std::bad_alloc{};
    }
    pthread_join(thread, nullptr);
    if (task.failure) {
        std::rethrow_exception(task.failure);
    }
}

/// Matches the triangles that a matching leaves free, each inside a ball of triangles around it.
class Repair {
public:
    Repair(std::span<const Neighbors<2>> neighbors, Array<Index>& mate) : neighbors_{neighbors}, mate_{mate} {
        place_.assign(neighbors.size(), no_index);
    }

    /// Small balls everywhere before larger ones: what a large one is left to do is little then.
    void run() {
        std::vector<Index> left;
        for (Index f = 0; f < mate_.size(); ++f) {
            if (mate_[f] == no_index) {
                left.push_back(f);
            }
        }
        for (std::size_t size = first_size; !left.empty(); size *= growth) {
            go_on();
            std::erase_if(left, [&](Index f) { return mate_[f] != no_index || augment_ball(f, size); });
            if (size > mate_.size() && !left.empty()) {
                refuse(left);
            }
        }
    }

private:
    static constexpr std::size_t first_size = 256;
    static constexpr std::size_t growth = 4;
    static constexpr std::size_t small_enough_for_any_stack = 1 << 14;
    static constexpr std::size_t bytes_per_call = 512; // ample: a call takes about 100, with sanitizers 300

    /// Augments inside a ball of `size` triangles around `centre`. Returns whether that matches the centre.
    bool augment_ball(Index centre, std::size_t size) {
        gather(centre, size);
        if (free_in_ball() > 1) {
            match_ball();
        }
        forget_ball();
        return mate_[centre] != no_index;
    }

    /// The triangles nearest to `centre`.
    void gather(Index centre, std::size_t size) {
        add(centre);
        for (std::size_t k = 0; k < ball_.size() && ball_.size() < size; ++k) {
            for (const Index across : neighbors_[ball_[k]]) {
                if (across != no_index && place_[across] == no_index) {
                    add(across);
                }
            }
        }
    }

    void add(Index f) {
        place_[f] = static_cast<Index>(ball_.size());
        ball_.push_back(f);
    }

    void forget_ball() {
        for (const Index f : ball_) {
            place_[f] = no_index;
        }
        ball_.clear();
    }

    std::ptrdiff_t free_in_ball() const {
        return std::count_if(ball_.begin(), ball_.end(), [this](Index f) { return mate_[f] == no_index; });
    }

    /// Whether f is in the ball together with its partner, if it has one: the others must stay as they are.
    bool takes_part(Index f) const {
        return place_[f] != no_index && (mate_[f] == no_index || place_[mate_[f]] != no_index);
    }

    void match_ball() {
        Graph graph(ball_.size());
        std::vector<Vertex> mates(ball_.size(), boost::graph_traits<Graph>::null_vertex());
        for (const Index f : ball_) {
            if (!takes_part(f)) {
                continue;
            }
            if (mate_[f] != no_index) {
                mates[place_[f]] = place_[mate_[f]];
            }
            for (const Index across : neighbors_[f]) {
                if (across != no_index && f < across && takes_part(across)) {
                    add_edge(place_[f], place_[across], graph);
                }
            }
        }
        if (ball_.size() <= small_enough_for_any_stack) {
            augment(graph, mates);
        } else {
            run_on_stack(bytes_per_call * ball_.size(), [&] { augment(graph, mates); });
        }
        keep(mates);
    }

    void keep(const std::vector<Vertex>& mates) {
        for (std::size_t k = 0; k < ball_.size(); ++k) {
            if (mates[k] != boost::graph_traits<Graph>::null_vertex()) {
                mate_[ball_[k]] = ball_[mates[k]];
            }
        }
    }

    [[noreturn]] static void refuse(const std::vector<Index>& left) {
        std::vector<Entity> entities;
        for (const Index f : left) {
            entities.push_back({"facet", f, {}});
        }
        throw GeometryError(
            fmt::format("{} facets of the boundary cannot be paired with a neighbour: {}. The "
                        "boundary must be closed: each edge in exactly two facets",
                        left.size(), listed(left)),
            std::move(entities));
    }

    std::span<const Neighbors<2>> neighbors_;
    Array<Index>& mate_;
    std::vector<Index> ball_;
    Array<Index> place_; ///< of each triangle in the ball
};

} // namespace

Array<Index> perfect_matching(std::span<const Neighbors<2>> neighbors) {
    Array<Index> mate = greedy_matching(neighbors);
    AlternatingForest forest{neighbors, mate};
    while (forest.augment() > 0) {
        go_on();
    }
    Repair{neighbors, mate}.run();
    return mate;
}

} // namespace slabhull
