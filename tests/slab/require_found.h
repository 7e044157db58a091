// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/slab/check.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace slabhull {

/// A defect that a check must find and, where they are given, the entities that its findings must name: each
/// of these in some finding, and no finding without one of them.
struct ExpectedFinding {
    Defect what;
    std::string kind;
    std::set<std::int64_t> numbers;

    ExpectedFinding(Defect defect) : what{defect} {} // NOLINT: a defect alone reads best
    ExpectedFinding(Defect defect, std::string entity_kind, std::set<std::int64_t> named)
        : what{defect}, kind{std::move(entity_kind)}, numbers{std::move(named)} {}
};

inline void require_named(const CheckResult& result, const ExpectedFinding& expected) {
    std::set<std::int64_t> missing = expected.numbers;
    for (const Finding& finding : result.findings) {
        if (finding.what != expected.what) {
            continue;
        }
        const auto is_expected = [&](const Entity& entity) {
            return entity.kind == expected.kind && expected.numbers.contains(entity.number);
        };
        if (std::none_of(finding.entities.begin(), finding.entities.end(), is_expected)) {
            FAIL(defect_name(finding.what) << " names none of what is at fault: " << finding.text);
        }
        for (const Entity& entity : finding.entities) {
            if (entity.kind == expected.kind) {
                missing.erase(entity.number);
            }
        }
    }
    if (!missing.empty()) {
        FAIL(defect_name(expected.what) << " does not name " << expected.kind << ' ' << *missing.begin());
    }
}

/// These defects are found and no others.
inline void require_found(const CheckResult& result, const std::vector<ExpectedFinding>& expected) {
    for (const Finding& finding : result.findings) {
        UNSCOPED_INFO(finding.text);
        CHECK_FALSE(finding.text.empty());
    }
    for (std::size_t kind = 0; kind < defect_kinds; ++kind) {
        UNSCOPED_INFO(defect_name(static_cast<Defect>(kind)) << ": " << result.found[kind]);
    }
    for (std::size_t kind = 0; kind < defect_kinds; ++kind) {
        const bool is_expected =
            std::any_of(expected.begin(), expected.end(),
                        [kind](const ExpectedFinding& one) { return one.what == static_cast<Defect>(kind); });
        if ((result.found[kind] > 0) != is_expected) {
            FAIL("unexpected or missing: " << defect_name(static_cast<Defect>(kind)));
        }
    }
    for (const ExpectedFinding& one : expected) {
        if (!one.kind.empty()) {
            require_named(result, one);
        }
    }
}

} // namespace slabhull
