// SPDX-License-Identifier: BSD-3-Clause
// Python has one class for both dimensions: what it holds is either the one or the other.
#pragma once

#include "slabhull/core/error.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <variant>

namespace slabhull::python {

template<int D>
using Dimension = std::integral_constant<int, D>;

/// A T<2> or a T<3>, shared with the arrays that look into it.
template<template<int> class T>
using Any = std::variant<std::shared_ptr<const T<2>>, std::shared_ptr<const T<3>>>;

template<class... Each>
int dimension_of(const std::variant<Each...>& any) {
    return any.index() == 0 ? 2 : 3;
}

/// Calls work(Dimension<D>{}) for a dimension that is known when the program runs.
template<class Work>
auto with_dimension(int dimension, const Work& work) {
    if (dimension != 2 && dimension != 3) {
        throw UsageError{fmt::format("the dimension of space is 2 or 3, not {}", dimension)};
    }
    return dimension == 2 ? work(Dimension<2>{}) : work(Dimension<3>{});
}

/// The T<D> of an Any; `what` is what the message calls it if it has the other dimension.
template<int D, class Variant>
const auto& of_dimension(const Variant& any, const std::string& what) {
    if (dimension_of(any) != D) {
        throw UsageError{fmt::format("{} is for a domain in {}D, not in {}D", what, dimension_of(any), D)};
    }
    return std::get<D - 2>(any);
}

} // namespace slabhull::python
