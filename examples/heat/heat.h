// SPDX-License-Identifier: BSD-3-Clause
// The heat equation on one slab's filling, by linear elements in space-time: find u with
//
//     integral of (du/dt v + grad u . grad v) = integral of f v     for all v,
//
// u given at the slab's start and on its side (O. Steinbach, Space-time finite element methods for parabolic
// problems, Computational Methods in Applied Mathematics 15, 2015). The motion of the domain needs no term of
// its own: the mesh follows it in space-time.
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/topology/filling.h"

#include <Eigen/LU>
#include <Eigen/Sparse>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace heat {

using namespace slabhull;

template<int D>
using Function = std::function<double(const Point<D + 1>&)>;

template<int D>
struct Problem {
    Function<D> solution;                                               ///< at the start and on the side
    std::function<std::array<double, D>(const Point<D + 1>&)> gradient; ///< in space, where u is known inside
    Function<D> source;
    FacetAttribute warm = 0; ///< u = 1 on facets of this attribute, whatever `solution` says
};

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// A simplex of dimension N = D + 1 with its linear functions.
template<int D>
struct Element {
    static constexpr int N = D + 1;
    std::array<Point<N>, N + 1> corners;
    double volume;
    Eigen::Matrix<double, N, N + 1> gradients; ///< of each corner's function; the last row is d/dt

    Element(const Filling<D>& mesh, std::size_t cell)
        : corners{corners_of<N, N>(mesh.cells[cell], mesh.points)}, volume{signed_measure<N>(corners)} {
        Eigen::Matrix<double, N, N> edges;
        for (int i = 0; i < N; ++i) {
            for (int k = 0; k < N; ++k) {
                edges(i, k) = corners[static_cast<std::size_t>(i + 1)][static_cast<std::size_t>(k)] -
                              corners[0][static_cast<std::size_t>(k)];
            }
        }
        gradients.template rightCols<N>() = edges.inverse();
        gradients.col(0) = -gradients.template rightCols<N>().rowwise().sum();
    }

    /// Calls use(weight, values of the corners' functions, place) at the points of a rule of degree two.
    template<class Use>
    void integrate(const Use& use) const {
        const double others = (1 - 1 / std::sqrt(N + 2.0)) / (N + 1);
        for (std::size_t q = 0; q <= N; ++q) {
            std::array<double, N + 1> value;
            value.fill(others);
            value[q] = 1 - N * others;
            Point<N> place{};
            for (std::size_t i = 0; i <= N; ++i) {
                place = plus(place, times(value[i], corners[i]));
            }
            use(volume / (N + 1), value, place);
        }
    }
};

/// Values at all vertices from those that are known, the others being `unknown`.
template<int D>
std::vector<double> solve(const Filling<D>& mesh, std::vector<double> u, const Function<D>& source) {
    std::vector<int> row(u.size(), -1);
    int rows = 0;
    for (std::size_t v = 0; v < u.size(); ++v) {
        row[v] = std::isnan(u[v]) ? rows++ : -1;
    }
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(rows);
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        const Element<D> element{mesh, c};
        Eigen::Matrix<double, D + 2, 1> load = Eigen::Matrix<double, D + 2, 1>::Zero();
        element.integrate([&](double weight, const auto& value, const Point<D + 1>& place) {
            for (std::size_t i = 0; i < value.size(); ++i) {
                load[static_cast<int>(i)] += weight * source(place) * value[i];
            }
        });
        const auto space = element.gradients.template topRows<D>();
        for (int i = 0; i < D + 2; ++i) {
            const int at = row[mesh.cells[c][static_cast<std::size_t>(i)]];
            if (at < 0) {
                continue;
            }
            right[at] += load[i];
            for (int j = 0; j < D + 2; ++j) {
                const Index v = mesh.cells[c][static_cast<std::size_t>(j)];
                const double entry =
                    element.volume * (element.gradients(D, j) / (D + 2) + space.col(i).dot(space.col(j)));
                if (row[v] >= 0) {
                    entries.emplace_back(at, row[v], entry);
                } else {
                    right[at] -= entry * u[v];
                }
            }
        }
    }
    Eigen::SparseMatrix<double> matrix(rows, rows);
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::BiCGSTAB<Eigen::SparseMatrix<double>, Eigen::IncompleteLUT<double>> solver;
    solver.preconditioner().setDroptol(1e-4);
    solver.preconditioner().setFillfactor(20);
    solver.setTolerance(1e-13);
    const Eigen::VectorXd found = solver.compute(matrix).solve(right);
    if (solver.info() != Eigen::Success) {
        throw std::runtime_error{"the linear system was not solved"};
    }
    for (std::size_t v = 0; v < u.size(); ++v) {
        u[v] = row[v] < 0 ? u[v] : found[row[v]];
    }
    return u;
}

/// What is known at the start: the solution on the side, and on the initial cap the values that the slab
/// before ended with, by persistent id; where there is none, the solution.
template<int D, class Ids>
std::vector<double> known_values(const Filling<D>& mesh, const Problem<D>& problem, const Ids& before) {
    std::vector<double> u(mesh.points.size(), unknown);
    for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
        for (const Index v : mesh.facets[f]) {
            if (mesh.facet_attribute[f] > 2) { // on the side
                u[v] = mesh.facet_attribute[f] == problem.warm ? 1 : problem.solution(mesh.points[v]);
            } else if (mesh.facet_attribute[f] == 1 && std::isnan(u[v])) {
                const auto found = before.find(mesh.vertex_ids[v]);
                u[v] = found != before.end() ? found->second : problem.solution(mesh.points[v]);
            }
        }
    }
    return u;
}

/// Squares of the errors, integrated over a slab.
struct Errors {
    double value = 0;
    double gradient = 0;
};

template<int D>
Errors errors(const Filling<D>& mesh, const std::vector<double>& u, const Problem<D>& problem) {
    Errors sum;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        const Element<D> element{mesh, c};
        Eigen::Matrix<double, D + 2, 1> nodal;
        for (int i = 0; i < D + 2; ++i) {
            nodal[i] = u[mesh.cells[c][static_cast<std::size_t>(i)]];
        }
        const Eigen::Matrix<double, D + 1, 1> slope = element.gradients * nodal;
        element.integrate([&](double weight, const auto& value, const Point<D + 1>& place) {
            double here = -problem.solution(place);
            for (std::size_t i = 0; i < value.size(); ++i) {
                here += value[i] * nodal[static_cast<int>(i)];
            }
            sum.value += weight * here * here;
            const auto exact = problem.gradient(place);
            for (std::size_t k = 0; k < D; ++k) {
                sum.gradient += weight * std::pow(slope[static_cast<int>(k)] - exact[k], 2);
            }
        });
    }
    return sum;
}

/// u linear in space and time: linear elements find it to rounding.
template<int D>
Problem<D> patch_test() {
    return {[](const Point<D + 1>& p) { return 1 + 2 * p[0] - p[1] + 3 * p[D] + (D == 3 ? 0.5 * p[2] : 0); },
            [](const Point<D + 1>&) {
                std::array<double, D> slope{2, -1};
                slope[D - 1] = D == 3 ? 0.5 : slope[D - 1];
                return slope;
            },
            [](const Point<D + 1>&) { return 3.0; }};
}

/// u = exp(-t) cos x cos y (cos z): du/dt = -u and the Laplacian is -D u.
template<int D>
Problem<D> decaying_wave() {
    const auto u = [](const Point<D + 1>& p) {
        double product = std::exp(-p[D]);
        for (std::size_t k = 0; k < D; ++k) {
            product *= std::cos(p[k]);
        }
        return product;
    };
    const auto slope = [u](const Point<D + 1>& p) {
        std::array<double, D> gradient;
        for (std::size_t k = 0; k < D; ++k) {
            Point<D + 1> shifted = p; // d cos x = cos (x + pi/2)
            shifted[k] += 1.5707963267948966;
            gradient[k] = u(shifted);
        }
        return gradient;
    };
    return {u, slope, [u](const Point<D + 1>& p) { return (D - 1) * u(p); }};
}

/// The first patch is kept at 1, all others at 0, which everything is at first.
template<int D>
Problem<D> warm_body() {
    const auto zero = [](const Point<D + 1>&) { return 0.0; };
    return {zero, {}, zero, 3};
}

template<int D>
std::optional<Problem<D>> known_problem(const std::string& name) {
    return name == "wave"    ? std::optional{decaying_wave<D>()}
           : name == "patch" ? std::optional{patch_test<D>()}
           : name == "warm"  ? std::optional{warm_body<D>()}
                             : std::nullopt;
}

} // namespace heat
