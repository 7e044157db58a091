// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/stretch.h"

#include "geometry/basics/vector_algebra.h"
#include "geometry/motion/intrinsic_delaunay.h"

#include "slabhull/core/error.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace slabhull {

namespace {

using namespace detail;

/// The facets of some patches, and their vertices, divided into followers and leaders.
struct StretchedPart {
    std::vector<Index> facets;  ///< of the boundary, ascending
    std::vector<Index> inner;   ///< vertices that follow, ascending
    std::vector<Index> leading; ///< vertices shared with other patches, ascending
};

template<int D>
StretchedPart part_of(const Boundary<D>& boundary, const std::set<PatchNumber>& patches) {
    StretchedPart part;
    std::vector<bool> inside(boundary.vertex_count(), false);
    std::vector<bool> outside(boundary.vertex_count(), false);
    for (Index f = 0; f < boundary.facet_count(); ++f) {
        const bool stretched = patches.contains(boundary.patch()[f]);
        if (stretched) {
            part.facets.push_back(f);
        }
        for (const Index v : boundary.facets()[f]) {
            (stretched ? inside : outside)[v] = true;
        }
    }
    for (Index v = 0; v < inside.size(); ++v) {
        if (inside[v]) {
            (outside[v] ? part.leading : part.inner).push_back(v);
        }
    }
    return part;
}

/// Connected sets of vertices, by union-find with the smallest vertex as representative.
class JoinedVertices {
public:
    explicit JoinedVertices(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), Index{0});
    }
    Index representative(Index v) {
        while (parent_[v] != v) {
            parent_[v] = parent_[parent_[v]];
            v = parent_[v];
        }
        return v;
    }
    void join(Index a, Index b) {
        a = representative(a);
        b = representative(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<Index> parent_;
};

template<int D>
[[noreturn]] void refuse_unled(const Boundary<D>& boundary, PatchNumber patch, Index vertex) {
    const std::string name = patch_name(boundary.patches(), patch);
    throw UsageError{fmt::format("patch {} is to stretch, but nothing leads its part around vertex {} at {}: "
                                 "it shares no vertex with a patch that does not stretch. Give it, or a "
                                 "neighbour, another motion",
                                 name, vertex, to_text(boundary.start()[vertex])),
                     {{"vertex", vertex, name}}};
}

template<int D>
void require_led(const Boundary<D>& boundary, const StretchedPart& part) {
    JoinedVertices joined{boundary.vertex_count()};
    for (const Index f : part.facets) {
        for (const Index v : boundary.facets()[f]) {
            joined.join(boundary.facets()[f][0], v);
        }
    }
    std::vector<bool> led(boundary.vertex_count(), false);
    for (const Index v : part.leading) {
        led[joined.representative(v)] = true;
    }
    for (const Index f : part.facets) {
        const Index v = boundary.facets()[f][0];
        if (!led[joined.representative(v)]) {
            refuse_unled(boundary, boundary.patch()[f], v);
        }
    }
}

std::vector<WeightedEdge> weighted_edges(const Boundary<2>& boundary, std::span<const Index> facets) {
    std::vector<WeightedEdge> edges;
    for (const Index f : facets) {
        const auto& [a, b] = boundary.facets()[f];
        edges.push_back({a, b, 1 / distance(boundary.start()[a], boundary.start()[b])});
    }
    return edges;
}

std::vector<WeightedEdge> weighted_edges(const Boundary<3>& boundary, std::span<const Index> facets) {
    return cotangent_edges(boundary, facets);
}

/// Solves Laplace's equation for the displacements of the inner vertices, given those of the leading ones.
template<int D>
class HarmonicStretch final : public Stretch<D> {
public:
    HarmonicStretch(const Boundary<D>& boundary, const std::set<PatchNumber>& patches)
        : part_{part_of(boundary, patches)}, start_{boundary.start().begin(), boundary.start().end()} {
        require_led(boundary, part_);
        if (!part_.inner.empty()) {
            assemble(weighted_edges(boundary, part_.facets));
        }
    }

    void follow(std::span<Point<D>> x) const override {
        if (part_.inner.empty()) {
            return;
        }
        Eigen::Matrix<double, Eigen::Dynamic, D> led_by(part_.leading.size(), D);
        for (std::size_t i = 0; i < part_.leading.size(); ++i) {
            const Index v = part_.leading[i];
            led_by.row(static_cast<Eigen::Index>(i)) = as_row(minus(x[v], start_[v]));
        }
        const Eigen::Matrix<double, Eigen::Dynamic, D> moved = factors_.solve(coupling_ * led_by);
        for (std::size_t i = 0; i < part_.inner.size(); ++i) {
            const Index v = part_.inner[i];
            for (std::size_t k = 0; k < D; ++k) {
                x[v][k] = start_[v][k] + moved(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
            }
        }
    }

private:
    using Matrix = Eigen::SparseMatrix<double>;
    using Entry = Eigen::Triplet<double>;

    static Eigen::Matrix<double, 1, D> as_row(const Point<D>& point) {
        return Eigen::Map<const Eigen::Matrix<double, 1, D>>(point.data());
    }

    /// inner * (displacements of the inner vertices) = coupling_ * (those of the leading ones)
    void assemble(const std::vector<WeightedEdge>& edges) {
        const auto place = places();
        const std::vector<bool> follows = followers();
        std::vector<Entry> inner;
        std::vector<Entry> coupling;
        const auto add_half = [&](Index v, Index neighbour, double weight) {
            if (follows[v]) {
                inner.emplace_back(place[v], place[v], weight);
                follows[neighbour] ? inner.emplace_back(place[v], place[neighbour], -weight)
                                   : coupling.emplace_back(place[v], place[neighbour], weight);
            }
        };
        for (const auto& [from, to, weight] : edges) {
            add_half(from, to, weight);
            add_half(to, from, weight);
        }
        coupling_ = matrix(part_.leading.size(), coupling);
        factors_.compute(matrix(part_.inner.size(), inner));
        if (factors_.info() != Eigen::Success) {
            throw GeometryError{fmt::format("the {} vertices that are to stretch give no solvable system: "
                                            "some triangles of their patches have no area to speak of",
                                            part_.inner.size())};
        }
    }

    /// A row per inner vertex; entries at the same position are summed.
    Matrix matrix(std::size_t columns, const std::vector<Entry>& entries) const {
        Matrix result(static_cast<Eigen::Index>(part_.inner.size()), static_cast<Eigen::Index>(columns));
        result.setFromTriplets(entries.begin(), entries.end());
        return result;
    }

    /// Number of each vertex of the part among the inner or the leading ones.
    std::vector<int> places() const {
        std::vector<int> place(start_.size(), -1);
        for (const auto* vertices : {&part_.inner, &part_.leading}) {
            for (std::size_t i = 0; i < vertices->size(); ++i) {
                place[(*vertices)[i]] = static_cast<int>(i);
            }
        }
        return place;
    }

    std::vector<bool> followers() const {
        std::vector<bool> follows(start_.size(), false);
        for (const Index v : part_.inner) {
            follows[v] = true;
        }
        return follows;
    }

    StretchedPart part_;
    Array<Point<D>> start_;
    Matrix coupling_;
    Eigen::SimplicialLDLT<Matrix> factors_;
};

} // namespace

template<int D>
StretchPointer<D> harmonic_stretch(const Boundary<D>& boundary, const std::set<PatchNumber>& patches) {
    return std::make_shared<HarmonicStretch<D>>(boundary, patches);
}

template StretchPointer<2> harmonic_stretch<2>(const Boundary<2>&, const std::set<PatchNumber>&);
template StretchPointer<3> harmonic_stretch<3>(const Boundary<3>&, const std::set<PatchNumber>&);

} // namespace slabhull
