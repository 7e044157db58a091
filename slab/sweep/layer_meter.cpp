// SPDX-License-Identifier: BSD-3-Clause
#include "slab/sweep/layer_meter.h"

#include "slabhull/core/parallel.h"
#include "slabhull/core/vector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace slabhull {

namespace {

constexpr std::size_t grain = 4096;
constexpr int samples_of_layer = 8;
constexpr int samples_of_slab = 32;
constexpr std::size_t most_rows = 1000;

/// Where defects are evaluated, as a fraction of the time between two samples: the golden section, which
/// stays clear of every period that the samples miss.
constexpr double probe_at = 0.381966;
/// Error of the path as a multiple of defect times sample interval: the integral of an error that vanishes at
/// both ends.
constexpr double defect_weight = 0.25;

/// A cubic's place and velocity at `s` in [0, 1].
template<int D>
struct Cubic {
    Point<D> place;
    Point<D> velocity;
};

template<int D>
Cubic<D> hermite(const Point<D>& x0, const Point<D>& v0, const Point<D>& x1, const Point<D>& v1, double h,
                 double s) {
    Cubic<D> at;
    const double w = 1 - s;
    for (std::size_t k = 0; k < D; ++k) {
        const double step = x1[k] - x0[k];
        at.place[k] = x0[k] + s * s * (3 - 2 * s) * step + h * s * w * (w * v0[k] - s * v1[k]);
        at.velocity[k] = 6 * s * w * step / h + w * (1 - 3 * s) * v0[k] + s * (3 * s - 2) * v1[k];
    }
    return at;
}

/// An orthonormal frame of a facet: its edges by Gram-Schmidt, and its normal.
template<int D>
std::array<Point<D>, D> frame_of(const Facet<D>& facet, const Array<Point<D>>& places) {
    std::array<Point<D>, D> frame{};
    for (std::size_t i = 0; i + 1 < D; ++i) {
        Point<D> edge = minus(places[facet[i + 1]], places[facet[0]]);
        for (std::size_t j = 0; j < i; ++j) {
            edge = minus(edge, times(dot(edge, frame[j]), frame[j]));
        }
        const double length = norm(edge);
        frame[i] = length > 0 ? times(1 / length, edge) : Point<D>{};
    }
    if constexpr (D == 2) {
        frame[1] = {-frame[0][1], frame[0][0]};
    } else {
        frame[2] = cross(frame[0], frame[1]);
    }
    return frame;
}

/// Cosine of the angle of the rotation from one frame to another, whose trace is D - 2 + 2 cos.
template<int D>
double cosine_between(const std::array<Point<D>, D>& a, const std::array<Point<D>, D>& b) {
    double trace = 0;
    for (std::size_t i = 0; i < D; ++i) {
        trace += dot(a[i], b[i]);
    }
    return (trace - (D - 2)) / 2;
}

double degrees_of(double cosine) {
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

bool is_field(const auto& group) {
    return group.moving != nullptr && group.moving->motion != nullptr && group.moving->motion->moves();
}

/// Vertices of a group per call of its motion.
std::size_t piece_of(const auto& group) {
    return group.moving->motion->in_one_call() ? std::max<std::size_t>(1, group.vertices.size()) : grain;
}

bool is_nodal(const auto& group) {
    return group.moving != nullptr && group.moving->motion == nullptr && group.moving->nodal != nullptr;
}

bool stretches(const auto& group) {
    return group.moving != nullptr && group.moving->stretch != nullptr;
}

/// The longest side of the box around the vertices.
template<int D>
double extent_of(std::span<const Index> vertices, std::span<const Point<D>> places) {
    double extent = 0;
    for (std::size_t k = 0; k < D && !vertices.empty(); ++k) {
        const auto by_coordinate = [&](Index a, Index b) { return places[a][k] < places[b][k]; };
        const auto [low, high] = std::minmax_element(vertices.begin(), vertices.end(), by_coordinate);
        extent = std::max(extent, places[*high][k] - places[*low][k]);
    }
    return extent;
}

} // namespace

template<int D>
Point<D> LayerMeter<D>::Layer::on_chord(Index vertex, double time) const {
    const double s = (time - from) / (to - from);
    return plus(times(1 - s, start[vertex]), times(s, end[vertex]));
}

template<int D>
LayerMeter<D>::LayerMeter(BoundaryMover<D>& mover, const Sweep<D>& sweep, const LayerOptions& options,
                          std::size_t layers, double begin, double end)
    : mover_{mover}, boundary_{sweep.boundary}, options_{options},
      samples_{std::max<int>(samples_of_layer, samples_of_slab / static_cast<int>(layers))},
      rows_{rows_within(mover.groups(), begin, end)}, edges_{boundary_.mean_edges(sweep.positions.front())} {
    fit_.layers = layers;
    local_ = edges_;
    allowed_ = allowed_deviations(options.tolerance, options.automatic ? options.edges_across : 0);
    std::vector<bool> moves(boundary_.vertex_count(), false);
    for (const Group& group : mover.groups()) {
        if (is_field(group) || is_nodal(group) || stretches(group)) {
            for (const Index v : group.vertices) {
                moves[v] = true;
            }
        }
    }
    for (Index f = 0; f < boundary_.facet_count(); ++f) {
        const Facet<D>& facet = boundary_.facets()[f];
        if (std::any_of(facet.begin(), facet.end(), [&](Index v) { return moves[v]; })) {
            moving_.push_back(f);
        }
    }
}

/// The allowed deviation of each vertex, in edges: the least of its patches.
template<int D>
std::vector<double> LayerMeter<D>::allowed_deviations(double tolerance, double edges_across) const {
    std::vector<double> allowed(boundary_.vertex_count(), tolerance);
    for (const Patch& patch : boundary_.patches()) {
        const std::vector<Index> vertices = boundary_.vertices_of({patch.number});
        const double extent = extent_of<D>(vertices, boundary_.start());
        double mean = 0;
        for (const Index v : vertices) {
            mean += edges_[v] / static_cast<double>(vertices.size());
        }
        const bool fine = edges_across > 0 && edges_across * mean < extent;
        for (const Index v : vertices) {
            allowed[v] = std::min(allowed[v], fine ? tolerance * edges_across * mean / extent : tolerance);
        }
    }
    return allowed;
}

template<int D>
std::vector<double> LayerMeter<D>::rows_within(const std::vector<Group>& groups, double begin, double end) {
    std::vector<double> rows;
    for (const Group& group : groups) {
        if (is_field(group) || is_nodal(group)) {
            const std::vector<double> times =
                is_field(group) ? group.moving->motion->row_times() : group.moving->nodal->row_times();
            std::copy_if(times.begin(), times.end(), std::back_inserter(rows),
                         [&](double t) { return begin < t && t < end; });
        }
    }
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    const std::size_t step = rows.size() / most_rows + 1;
    std::vector<double> looked_at;
    for (std::size_t k = 0; k < rows.size(); k += step) {
        looked_at.push_back(rows[k]);
    }
    return looked_at;
}

/// The sample times of a layer, without its start, with its end.
template<int D>
std::vector<double> LayerMeter<D>::sample_times(double from, double to) const {
    const double duration = to - from;
    std::vector<double> times(std::upper_bound(rows_.begin(), rows_.end(), from),
                              std::lower_bound(rows_.begin(), rows_.end(), to));
    for (int k = 1; k < samples_; ++k) {
        times.push_back(from + duration * k / samples_);
    }
    std::sort(times.begin(), times.end());
    times.push_back(to);
    constexpr double apart = 1e-6; // in layers
    std::vector<double> kept{from};
    for (const double t : times) {
        if (t - kept.back() > apart * duration && (t == to || to - t > apart * duration)) {
            kept.push_back(t);
        }
    }
    kept.erase(kept.begin());
    return kept;
}

template<int D>
typename LayerMeter<D>::Sample LayerMeter<D>::sample_at(double time, Array<Point<D>> places) const {
    const std::vector<Group>& groups = mover_.groups();
    Sample sample{time, std::move(places), {}};
    sample.velocities.resize(groups.size());
    for (std::size_t g = 0; g < groups.size(); ++g) {
        if (!is_field(groups[g])) {
            continue;
        }
        const std::vector<Index>& vertices = groups[g].vertices;
        std::vector<Point<D>>& velocities = sample.velocities[g];
        velocities.resize(vertices.size());
        parallel_for(vertices.size(), piece_of(groups[g]), [&](std::size_t begin, std::size_t end) {
            std::vector<Point<D>> x;
            for (std::size_t i = begin; i < end; ++i) {
                x.push_back(sample.places[vertices[i]]);
            }
            groups[g].moving->motion->velocity(x, time, std::span{velocities}.subspan(begin, end - begin));
        });
    }
    return sample;
}

template<int D>
void LayerMeter<D>::measure(const Array<Point<D>>& start, const Array<Point<D>>& end, double from,
                            double to) {
    if (moving_.empty()) {
        return;
    }
    std::vector<double> edges = boundary_.mean_edges(end);
    std::transform(edges_.begin(), edges_.end(), edges.begin(), local_.begin(),
                   [](double a, double b) { return std::min(a, b); });
    edges_ = std::move(edges);
    const Layer layer{start, end, from, to};
    const std::vector<Frame> frames = frames_at(start);
    Sample before = sample_at(from, start);
    for (const double time : sample_times(from, to)) {
        const double part = (time - before.time) / (to - from);
        Array<Point<D>> places =
            time == to ? end : mover_.drift(before.places, before.time, time, mover_.substeps_of(part));
        Sample after = sample_at(time, std::move(places));
        measure_deviations(layer, before, after);
        measure_turns(frames, after.places, time);
        before = std::move(after);
    }
}

template<int D>
void LayerMeter<D>::pass(const Array<Point<D>>& end) {
    edges_ = boundary_.mean_edges(end);
}

template<int D>
void LayerMeter<D>::measure_deviations(const Layer& layer, const Sample& before, const Sample& after) {
    const double probe = before.time + probe_at * (after.time - before.time);
    const std::vector<Group>& groups = mover_.groups();
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const Group& group = groups[g];
        if (is_field(group)) {
            measure_field(layer, group, g, before, after);
        } else if (is_nodal(group)) {
            std::vector<Point<D>> places(group.vertices.size());
            group.moving->nodal->positions(tracks_of<D>(boundary_, group.vertices), probe, places);
            measure_at(layer, group, places, probe);
        }
        if ((is_field(group) || is_nodal(group) || stretches(group)) && after.time != layer.to) {
            std::vector<Point<D>> places;
            for (const Index v : group.vertices) {
                places.push_back(after.places[v]);
            }
            measure_at(layer, group, places, after.time);
        }
    }
}

/// `places` are those of the group's vertices.
template<int D>
void LayerMeter<D>::measure_at(const Layer& layer, const Group& group, std::span<const Point<D>> places,
                               double time) {
    std::vector<Worst> found(group.vertices.size() / grain + 1);
    parallel_for(group.vertices.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Index v = group.vertices[i];
            note(found[begin / grain], v, distance(places[i], layer.on_chord(v, time)));
        }
    });
    keep_vertices(found, group, time);
}

template<int D>
void LayerMeter<D>::measure_field(const Layer& layer, const Group& group, std::size_t g, const Sample& before,
                                  const Sample& after) {
    const double h = after.time - before.time;
    const double probe = before.time + probe_at * h;
    std::vector<Worst> found(group.vertices.size() / grain + 1);
    parallel_for(group.vertices.size(), piece_of(group), [&](std::size_t begin, std::size_t end) {
        std::vector<Point<D>> x;
        std::vector<Point<D>> cubic_velocity;
        for (std::size_t i = begin; i < end; ++i) {
            const Index v = group.vertices[i];
            const Cubic<D> at = hermite<D>(before.places[v], before.velocities[g][i], after.places[v],
                                           after.velocities[g][i], h, probe_at);
            x.push_back(at.place);
            cubic_velocity.push_back(at.velocity);
        }
        std::vector<Point<D>> velocity(x.size());
        try {
            group.moving->motion->velocity(x, probe, velocity);
        } catch (const GeometryError&) { // a cubic that is far off the path may leave the field
            velocity.front()[0] = std::numeric_limits<double>::infinity();
        }
        for (std::size_t i = begin; i < end; ++i) {
            const Index v = group.vertices[i];
            const double defect = distance(cubic_velocity[i - begin], velocity[i - begin]);
            note(found[begin / grain], v,
                 distance(x[i - begin], layer.on_chord(v, probe)) + defect_weight * h * defect);
        }
    });
    keep_vertices(found, group, probe);
}

template<int D>
void LayerMeter<D>::note(Worst& worst, Index vertex, double distance) const {
    const double known = std::isnan(distance) ? std::numeric_limits<double>::infinity() : distance;
    const double in_edges = known > 0 ? known / local_[vertex] : 0;
    const double growth = std::sqrt(in_edges / allowed_[vertex]); // chord error is of order two
    worst.deviation = std::max(worst.deviation, in_edges);
    if (growth > worst.growth) {
        worst.growth = growth;
        worst.at = vertex;
    }
}

template<int D>
void LayerMeter<D>::keep_vertices(std::span<const Worst> found, const Group& group, double time) {
    for (const Worst& worst : found) {
        PatchNumber patch = group.patches.front();
        if (worst.growth > fit_.growth && group.patches.size() > 1) {
            for (const Index f : moving_) {
                const Facet<D>& facet = boundary_.facets()[f];
                if (std::find(facet.begin(), facet.end(), worst.at) != facet.end()) {
                    patch = boundary_.patch()[f];
                    break;
                }
            }
        }
        keep(worst, patch, time);
    }
}

template<int D>
void LayerMeter<D>::keep(const Worst& worst, PatchNumber patch, double time) {
    fit_.deviation = std::max(fit_.deviation, worst.deviation);
    fit_.turn = std::max(fit_.turn, worst.turn);
    if (worst.growth > fit_.growth) {
        fit_.growth = worst.growth;
        fit_.patch = patch;
        fit_.time = time;
    }
}

template<int D>
std::vector<typename LayerMeter<D>::Frame> LayerMeter<D>::frames_at(const Array<Point<D>>& places) const {
    std::vector<Frame> frames(moving_.size());
    parallel_for(frames.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            frames[i] = frame_of<D>(boundary_.facets()[moving_[i]], places);
        }
    });
    return frames;
}

template<int D>
void LayerMeter<D>::measure_turns(const std::vector<Frame>& start, const Array<Point<D>>& places,
                                  double time) {
    std::vector<Worst> found(moving_.size() / grain + 1);
    parallel_for(moving_.size(), grain, [&](std::size_t begin, std::size_t end) {
        double least = 1; // cosine
        Index farthest = no_index;
        for (std::size_t i = begin; i < end; ++i) {
            const double cosine =
                cosine_between<D>(start[i], frame_of<D>(boundary_.facets()[moving_[i]], places));
            if (cosine < least) {
                least = cosine;
                farthest = moving_[i];
            }
        }
        const double turn = degrees_of(least);
        found[begin / grain] = {0, turn, turn / options_.turn, farthest};
    });
    for (const Worst& worst : found) {
        if (worst.at != no_index) {
            keep(worst, boundary_.patch()[worst.at], time);
        }
    }
}

template class LayerMeter<2>;
template class LayerMeter<3>;

} // namespace slabhull
