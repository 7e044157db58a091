// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/conjugate_gradients.h"

#include "core/pieces.h"

#include "slabhull/core/parallel.h"

#include <algorithm>
#include <vector>

namespace slabhull::detail {

namespace {

constexpr std::size_t rows_per_piece = 1 << 12;

class ConjugateGradients {
public:
    ConjugateGradients(const Stiffness& matrix, Array<Lanes>& x)
        : matrix_{matrix}, x_{x}, coarse_{matrix}, residual_(x.size()), direction_(x.size()),
          image_(x.size()) {}

    int run(double tolerance, int most) {
        start();
        const Sums goal = squares_ * (tolerance * tolerance);
        int iterations = 0;
        for (; iterations < most && (squares_ > goal).any(); ++iterations) {
            const Sums before = product_;
            step(ratio(before, apply()));
            product_ = squares_ + coarse_.solve(residual_);
            turn(ratio(product_, before));
        }
        return iterations;
    }

private:
    /// Zero for a lane that has converged exactly, so that it stays unchanged.
    static Lanes ratio(const Sums& a, const Sums& b) {
        return (b > 0).select(a / b, Sums::Zero()).cast<float>();
    }

    /// Sum of body(v) over the free vertices.
    template<class Body>
    Sums over_free(const Body& body) {
        const auto sum_of = [&](std::size_t begin, std::size_t end, Sums& piece) {
            Sums sum = Sums::Zero();
            for (std::size_t v = begin; v < end; ++v) {
                if (matrix_.is_free(v)) {
                    sum += body(v).template cast<double>();
                }
            }
            piece = sum;
        };
        Sums total = Sums::Zero();
        for (const Sums& piece : parallel_pieces<Sums>(x_.size(), rows_per_piece, sum_of, Sums::Zero())) {
            total += piece;
        }
        return total;
    }

    Lanes row_times(std::size_t v, const Array<Lanes>& x) const {
        Lanes sum = x[v];
        for (const Stiffness::Entry& entry : matrix_.row(v)) {
            sum += entry.value * x[entry.column];
        }
        return sum;
    }

    void start() {
        std::fill(residual_.begin(), residual_.end(), Lanes::Zero());
        std::fill(direction_.begin(), direction_.end(), Lanes::Zero());
        squares_ = over_free([this](std::size_t v) -> Lanes {
            residual_[v] = -row_times(v, x_);
            return residual_[v].square();
        });
        product_ = squares_ + coarse_.solve(residual_);
        turn(Lanes::Zero());
    }
    Sums apply() {
        return over_free([this](std::size_t v) -> Lanes {
            image_[v] = row_times(v, direction_);
            return direction_[v] * image_[v];
        });
    }
    void step(const Lanes& length) {
        squares_ = over_free([&](std::size_t v) -> Lanes {
            x_[v] += length * direction_[v];
            residual_[v] -= length * image_[v];
            return residual_[v].square();
        });
    }
    void turn(const Lanes& share) {
        parallel_for(x_.size(), rows_per_piece, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                if (matrix_.is_free(v)) {
                    direction_[v] = residual_[v] + coarse_.correction(v) + share * direction_[v];
                }
            }
        });
    }

    const Stiffness& matrix_;
    Array<Lanes>& x_;
    CoarseSpace coarse_;
    Array<Lanes> residual_, direction_, image_;
    Sums squares_; ///< of the residual
    Sums product_; ///< of the residual and the preconditioned residual
};

} // namespace

int solve_for_free(const Stiffness& matrix, Array<Lanes>& x, double tolerance, int most) {
    return ConjugateGradients{matrix, x}.run(tolerance, most);
}

} // namespace slabhull::detail
