// SPDX-License-Identifier: BSD-3-Clause
// Velocities given as formulas, evaluated by muParser point by point: its bulk mode, which distributes the
// points by OpenMP, took two to three times as long where we measured (9 against 31 ns for
// "w*(x-0.5)*(y+t)+z^2").
#include "slabhull/geometry/motion.h"

#include "core/scratch_pool.h"
#include "geometry/basics/vector_algebra.h"

#include "slabhull/core/error.h"

#include <fmt/core.h>

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

using namespace detail;
using Constants = std::map<std::string, double>;

[[noreturn]] void refuse(const std::string& formula, const std::string& complaint) {
    throw UsageError{fmt::format("velocity formula \"{}\": {}", formula, complaint)};
}

std::string words_of(const mu::ParserError& error) {
    // Many of muParser's messages name the position, counted from 0; add it to the others.
    std::string words = error.GetMsg();
    if (error.GetPos() >= 0 && words.find("position") == std::string::npos) {
        words += fmt::format(" at position {}", error.GetPos());
    }
    if (!words.empty() && words.back() == '.') {
        words.pop_back();
    }
    return words;
}

/// What is wrong with a formula and how it is written; `variables`: "x, y, t".
std::string fault_of(const mu::ParserError& error, const std::string& variables) {
    if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN) {
        return fmt::format("the name \"{}\" means nothing here; the variables are {}, further ones stand in "
                           "constants = {{ name = 1.0 }}",
                           error.GetToken(), variables);
    }
    return words_of(error) + "; write it as in -2 * y + sin(pi * t), powers with ^";
}

bool assigns(const mu::Parser& parser) {
    for (const mu::SToken* token = parser.GetByteCode().GetBase(); token->Cmd != mu::cmEND; ++token) {
        if (token->Cmd == mu::cmASSIGN) {
            return true;
        }
    }
    return false;
}

/// An evaluator of one motion's formulas. muParser's evaluation has state, so each thread needs its own.
template<int D>
class Evaluator {
public:
    Evaluator(const std::array<std::string, D>& formulas, const Constants& constants) {
        for (std::size_t i = 0; i < D; ++i) {
            define_constants(parsers_[i], constants);
            define_variables(parsers_[i]);
            compile(parsers_[i], formulas[i]);
        }
    }
    Evaluator(const Evaluator&) = delete;
    Evaluator& operator=(const Evaluator&) = delete;

    Point<D> operator()(const Point<D>& x, double t) {
        std::copy(x.begin(), x.end(), variables_.begin());
        variables_[D] = t;
        Point<D> value;
        for (std::size_t i = 0; i < D; ++i) {
            value[i] = parsers_[i].Eval();
        }
        return value;
    }

private:
    static const char* variable_name(std::size_t i) {
        static constexpr std::array names{"x", "y", "z"};
        return i == D ? "t" : names[i];
    }

    static void define_constants(mu::Parser& parser, const Constants& constants) {
        parser.DefineConst("pi", std::numbers::pi);
        for (const auto& [name, value] : constants) {
            require_finite(value, fmt::format("the constant \"{}\" of a velocity formula", name).c_str());
            bool taken = name == "pi" || parser.GetFunDef().contains(name);
            for (std::size_t i = 0; i <= D; ++i) {
                taken = taken || name == variable_name(i);
            }
            if (taken) {
                throw UsageError{
                    fmt::format("a velocity formula cannot have a constant \"{}\": the name already "
                                "has a meaning in formulas; choose another",
                                name)};
            }
            try {
                parser.DefineConst(name, value);
            } catch (const mu::ParserError&) {
                throw UsageError{
                    fmt::format("a velocity formula cannot have a constant \"{}\": names are made of "
                                "letters, digits and _, and do not start with a digit",
                                name)};
            }
        }
    }

    void define_variables(mu::Parser& parser) {
        for (std::size_t i = 0; i <= D; ++i) {
            parser.DefineVar(variable_name(i), &variables_[i]);
        }
    }

    static std::string advice_on(const mu::ParserError& error) {
        std::string variables = variable_name(0);
        for (std::size_t i = 1; i <= D; ++i) {
            variables += std::string{", "} + variable_name(i);
        }
        return fault_of(error, variables);
    }

    /// Compiles by evaluating once: muParser parses at the first evaluation.
    static void compile(mu::Parser& parser, const std::string& formula) {
        try {
            parser.SetExpr(formula);
            parser.Eval();
        } catch (const mu::ParserError& error) {
            refuse(formula, advice_on(error));
        }
        if (parser.GetNumResults() != 1) {
            refuse(formula, "one value expected, but commas separate several; the decimal sign is a point");
        }
        if (assigns(parser)) {
            refuse(formula, "a single = would change a variable; compare with ==");
        }
    }

    std::array<double, D + 1> variables_{};
    std::array<mu::Parser, D> parsers_;
};

template<int D>
class FormulaVelocity final : public Motion<D> {
public:
    FormulaVelocity(const std::array<std::string, D>& formulas, const Constants& constants)
        : formulas_{formulas}, constants_{constants} {
        evaluators_.give_back(borrow()); // to find errors in the formulas now
    }

    void velocity(std::span<const Point<D>> x, double t, std::span<Point<D>> v) const override {
        EvaluatorPointer evaluator = borrow();
        std::size_t i = 0;
        for (; i < x.size(); ++i) {
            v[i] = (*evaluator)(x[i], t);
            if (!all_finite(v[i])) {
                break;
            }
        }
        evaluators_.give_back(std::move(evaluator));
        if (i < x.size()) {
            report_infinite(x[i], t, v[i]);
        }
    }
    std::optional<AffineMap<D>> map(double, double) const override { return std::nullopt; }

private:
    using EvaluatorPointer = std::unique_ptr<Evaluator<D>>;

    /// An evaluator that no other thread is using; compiling one takes some 40 microseconds.
    EvaluatorPointer borrow() const {
        return evaluators_.take([this] { return Evaluator<D>{formulas_, constants_}; });
    }

    [[noreturn]] void report_infinite(const Point<D>& x, double t, const Point<D>& v) const {
        std::size_t i = 0;
        while (std::isfinite(v[i])) {
            ++i;
        }
        throw GeometryError{fmt::format(
            "velocity formula \"{}\" is {} at the point {} at t = {}; change it so that it "
            "is finite wherever the patch goes",
            formulas_[i], std::isnan(v[i]) ? "no number" : "infinite (a division by zero?)", to_text(x), t)};
    }

    std::array<std::string, D> formulas_;
    Constants constants_;
    mutable ScratchPool<Evaluator<D>> evaluators_;
};

} // namespace

template<int D>
MotionPointer<D> formula_velocity(const std::array<std::string, D>& formulas, const Constants& constants) {
    return std::make_shared<FormulaVelocity<D>>(formulas, constants);
}

template MotionPointer<2> formula_velocity<2>(const std::array<std::string, 2>&, const Constants&);
template MotionPointer<3> formula_velocity<3>(const std::array<std::string, 3>&, const Constants&);

} // namespace slabhull
