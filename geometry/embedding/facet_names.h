// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/place_in_words.h"
#include "slabhull/core/error.h"
#include "slabhull/geometry/embedding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace slabhull {

/// Largest number of entities of one kind named in a message.
inline constexpr std::size_t names_listed = 8;

/// Names of a surface's facets for messages: the user's number and the patch.
template<int D>
class FacetNames {
public:
    FacetNames(const Surface<D>& surface, const FacetNaming& naming) : surface_{surface}, naming_{naming} {}

    std::string placed(const std::string& message) const {
        return naming_.where.empty() ? message : naming_.where + ": " + message;
    }

    std::int64_t number(Index f) const {
        return f < naming_.numbers.size() ? naming_.numbers[f] : static_cast<std::int64_t>(f);
    }
    std::string patch(Index f) const {
        return f < surface_.patch.size() ? patch_name(surface_.patches, surface_.patch[f]) : std::string{};
    }

    /// "facet 812 (patch rotor)"
    std::string facet(Index f) const {
        const std::string in = patch(f);
        if (in.empty()) {
            return fmt::format("facet {}", number(f));
        }
        return fmt::format("facet {} ({}{})", number(f), in.starts_with("patch ") ? "" : "patch ", in);
    }

    /// Names of the first few facets.
    std::string list(std::span<const Index> facets) const {
        std::vector<std::string> words;
        for (const Index f : facets.first(std::min(facets.size(), names_listed))) {
            words.push_back(facet(f));
        }
        return fmt::format("{}{}", fmt::join(words, ", "), facets.size() > names_listed ? " ..." : "");
    }

    Entity entity(Index f) const { return {"facet", number(f), patch(f)}; }
    std::vector<Entity> entities(std::span<const Index> facets) const {
        std::vector<Entity> named;
        for (const Index f : facets.first(std::min(facets.size(), names_listed))) {
            named.push_back(entity(f));
        }
        return named;
    }

private:
    const Surface<D>& surface_;
    const FacetNaming& naming_;
};

} // namespace slabhull
