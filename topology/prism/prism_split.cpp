// SPDX-License-Identifier: BSD-3-Clause
// The prism splits of Anderson, Williams and Corrigan, section on hypersurface meshing, as cones. The paper's
// printed list for E covers each quadrilateral with both diagonals; this one does not (docs/architecture.md).
#include "slabhull/topology/prism_split.h"

#include "slabhull/core/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <string>

namespace slabhull {

namespace {

using Apex = SplitRecipe::Apex;
using Carries = SplitRecipe::Carries;

constexpr std::array<SplitRecipe, 7> recipes{{
    {Split::diagonal, "diagonal", 2, Apex::corner, Carries::diagonal, Carries::diagonal},
    {Split::centre, "centre", 2, Apex::prism_centre, Carries::centre, Carries::centre},
    {Split::A, "A", 3, Apex::corner, Carries::diagonal, Carries::diagonal},
    {Split::B, "B", 3, Apex::face_centre, Carries::centre, Carries::diagonal},
    {Split::C, "C", 3, Apex::face_centre, Carries::centre, Carries::centre},
    {Split::D, "D", 3, Apex::prism_centre, Carries::diagonal, Carries::centre},
    {Split::E, "E", 3, Apex::prism_centre, Carries::centre, Carries::centre},
}};

template<int D>
using P = PrismPoint<D>;

/// Whether the recipe can leave a prism with these quadrilaterals.
template<int D>
bool fits(const SplitRecipe& recipe, const Quads<D>& quads) {
    const auto as_shared =
        static_cast<std::size_t>(std::count_if(quads.begin(), quads.end(), [&recipe](Quad quad) {
            return (quad == Quad::centred) == (recipe.shared == Carries::centre);
        }));
    return as_shared == (recipe.pairs() ? 1 : quads.size());
}

/// The bottom corner at which all diagonals beside it start.
template<int D>
std::optional<int> corner_of_diagonals(const Quads<D>& quads) {
    for (std::size_t corner = 0; corner < D; ++corner) {
        bool all = true;
        for (std::size_t q = 0; q < quads.size(); ++q) {
            const auto [j, k] = quad_corners<D>(q);
            all = all && (j != corner || quads[q] == Quad::rising) &&
                  (k != corner || quads[q] == Quad::falling);
        }
        if (all) {
            return P<D>::bottom(static_cast<int>(corner));
        }
    }
    return {};
}

template<int D>
std::optional<int> apex_of(const SplitRecipe& recipe, const Quads<D>& quads) {
    switch (recipe.apex) {
    case Apex::corner:
        return corner_of_diagonals<D>(quads);
    case Apex::face_centre:
        return P<D>::face_centre(
            static_cast<int>(std::find(quads.begin(), quads.end(), Quad::centred) - quads.begin()));
    case Apex::prism_centre:
        break;
    }
    return P<D>::centre;
}

template<int D>
constexpr std::size_t combinations = D == 2 ? 3 : 27;

template<int D>
Quads<D> combination(std::size_t number) {
    Quads<D> quads;
    for (std::size_t q = quads.size(); q-- > 0; number /= 3) {
        quads[q] = static_cast<Quad>(number % 3);
    }
    return quads;
}

template<int D>
using TemplateTable = std::array<PrismTemplate<D>, combinations<D>>;

template<int D>
TemplateTable<D> make_templates(const SplitRecipe& recipe) {
    TemplateTable<D> table{};
    for (std::size_t number = 0; number < table.size(); ++number) {
        const Quads<D> quads = combination<D>(number);
        if (recipe.dimension != D || !fits<D>(recipe, quads)) {
            continue;
        }
        if (const auto apex = apex_of<D>(recipe, quads)) {
            table[number] = cone_template<D>(*apex, quads);
        }
    }
    return table;
}

template<int D>
int cells_of_any(Split split) {
    const auto templates = templates_of<D>(split);
    const auto filled =
        std::find_if(templates.begin(), templates.end(), [](const auto& t) { return !t.cells.empty(); });
    return static_cast<int>(filled->cells.size());
}

} // namespace

Split split_from_name(std::string_view name, int dimension) {
    std::string known;
    for (const SplitRecipe& recipe : recipes) {
        if (recipe.dimension != dimension) {
            continue;
        }
        if (recipe.name == name) {
            return recipe.split;
        }
        known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", recipe.name);
    }
    throw UsageError(fmt::format("no split \"{}\" for dimension {}; there are {}", name, dimension, known));
}

std::string_view split_name(Split split) {
    return recipe_of(split).name;
}

const SplitRecipe& recipe_of(Split split) {
    return *std::find_if(recipes.begin(), recipes.end(),
                         [split](const SplitRecipe& recipe) { return recipe.split == split; });
}

int simplices_per_prism(Split split) {
    return recipe_of(split).dimension == 2 ? cells_of_any<2>(split) : cells_of_any<3>(split);
}

template<int D>
std::span<const PrismTemplate<D>> templates_of(Split split) {
    static const auto tables = [] {
        std::array<TemplateTable<D>, recipes.size()> all;
        std::transform(recipes.begin(), recipes.end(), all.begin(), make_templates<D>);
        return all;
    }();
    return tables[static_cast<std::size_t>(&recipe_of(split) - recipes.data())];
}

template std::span<const PrismTemplate<2>> templates_of<2>(Split);
template std::span<const PrismTemplate<3>> templates_of<3>(Split);

} // namespace slabhull
