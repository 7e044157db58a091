// SPDX-License-Identifier: BSD-3-Clause
// What the operations of `slabhull convert` must leave as it was, whatever the mesh: relations between
// results, and adjacency found anew by sorting.
#include "slabhull/edit/soup_edit.h"

#include "io/scratch.h"
#include "slab/specimens.h"
#include "slabhull/cases/hull_files.h"
#include "slabhull/core/error.h"
#include "slabhull/edit/soup_numbers.h"
#include "slabhull/io/files.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <set>

using namespace slabhull;

namespace {

using Numbers = IntegerList;

template<int D>
io::Soup hull_soup(const std::string& format = "vtu") {
    const Hull<D> hull = specimens::HullMaker<D>{specimens::box_with_body<D>(), 2}.hull;
    const scratch::Folder folder;
    const auto path = folder / ("hull." + format);
    io::AtomicFiles files;
    write_hull(files, path, hull, format);
    files.commit();
    io::Soup soup = io::read_mesh(path);
    settle_numbers(soup);
    return soup;
}

std::size_t top(const io::Soup& soup) {
    return static_cast<std::size_t>(soup.top_dimension());
}
std::size_t cell_count(const io::Soup& soup) {
    return soup.simplices[top(soup)].size(soup.top_dimension());
}

template<class T>
using Values = std::conditional_t<std::is_integral_v<T>, Numbers, Array<T>>;

template<class T>
const Values<T>& values(const std::vector<io::DataArray>& arrays, const std::string& name) {
    const auto found =
        std::find_if(arrays.begin(), arrays.end(), [&](const auto& array) { return array.name == name; });
    REQUIRE(found != arrays.end());
    return std::get<Values<T>>(found->values);
}
template<class T>
Values<T>& values(std::vector<io::DataArray>& arrays, const std::string& name) {
    return const_cast<Values<T>&>(values<T>(std::as_const(arrays), name));
}

std::string bytes_of(const io::Soup& soup) {
    const scratch::Folder folder;
    io::write_vtu(folder / "a.vtu", io::columns_of(soup));
    return scratch::bytes_of(folder / "a.vtu");
}

// --- what a soup says, whatever the order of its points and cells

/// A place in space-time, bit for bit.
using Place = std::array<double, 4>;

Place place(const io::Soup& soup, Index v) {
    const Point<3>& x = soup.points[v];
    const bool timed = soup.find_point_data("t") != nullptr;
    return {x[0], x[1], x[2], timed ? values<double>(soup.point_data, "t")[v] : 0.0};
}

/// A simplex by the places of its vertices, its orientation and, where it is of the top dimension, its data.
struct Named {
    std::vector<Place> places;
    bool odd = false;
    std::vector<std::int64_t> data;
    auto operator<=>(const Named&) const = default;
};

Named named(const io::Soup& soup, std::size_t dimension, std::size_t cell) {
    Named result;
    const std::size_t corners = dimension + 1;
    for (std::size_t k = 0; k < corners; ++k) {
        result.places.push_back(place(soup, soup.simplices[dimension].vertices[cell * corners + k]));
    }
    for (std::size_t i = 0; i < corners; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            result.odd ^= result.places[i] < result.places[j];
        }
    }
    std::sort(result.places.begin(), result.places.end());
    for (const char* name : {"region", "patch", "layer"}) {
        if (soup.find_cell_data(name) != nullptr && dimension == top(soup)) {
            result.data.push_back(values<std::int64_t>(soup.cell_data, name)[cell]);
        }
    }
    return result;
}

std::multiset<Named> all_named(const io::Soup& soup) {
    std::multiset<Named> result;
    for (std::size_t cell = 0; cell < cell_count(soup); ++cell) {
        result.insert(named(soup, top(soup), cell));
    }
    return result;
}

// --- adjacency by sorting facets

template<class Use>
void for_each_facet(const io::Soup& soup, const Use& use) {
    const std::size_t corners = top(soup) + 1;
    for (std::size_t c = 0; c < cell_count(soup); ++c) {
        const auto begin =
            soup.simplices[top(soup)].vertices.begin() + static_cast<std::ptrdiff_t>(c * corners);
        for (std::size_t i = 0; i < corners; ++i) {
            std::vector<Index> facet(begin, begin + static_cast<std::ptrdiff_t>(corners));
            facet.erase(facet.begin() + static_cast<std::ptrdiff_t>(i));
            std::sort(facet.begin(), facet.end());
            use(facet, c, i);
        }
    }
}

std::map<std::vector<Index>, std::vector<std::size_t>> cells_of_facets(const io::Soup& soup) {
    std::map<std::vector<Index>, std::vector<std::size_t>> cells;
    for_each_facet(soup, [&](const auto& facet, std::size_t c, std::size_t) { cells[facet].push_back(c); });
    return cells;
}

Numbers neighbors_by_sorting(const io::Soup& soup) {
    const auto cells = cells_of_facets(soup);
    Numbers neighbors;
    for_each_facet(soup, [&](const auto& facet, std::size_t c, std::size_t) {
        const auto& both = cells.at(facet);
        neighbors.push_back(both.size() == 2 ? static_cast<std::int64_t>(both[0] == c ? both[1] : both[0])
                                             : -1);
    });
    return neighbors;
}

std::size_t single_facets(const io::Soup& soup) {
    const auto cells = cells_of_facets(soup);
    return static_cast<std::size_t>(std::count_if(
        cells.begin(), cells.end(), [](const auto& entry) { return entry.second.size() == 1; }));
}

/// "neighbors" are as sorting has them, and "cell" names a cell of each point.
bool adjacency_is_right(const io::Soup& soup) {
    const Numbers& cell = values<std::int64_t>(soup.point_data, "cell");
    const std::size_t corners = top(soup) + 1;
    bool right = true;
    for (std::size_t v = 0; v < cell.size(); ++v) {
        if (cell[v] < 0 || cell[v] >= static_cast<std::int64_t>(cell_count(soup))) {
            return false;
        }
        const Index* vertices =
            &soup.simplices[top(soup)].vertices[static_cast<std::size_t>(cell[v]) * corners];
        right = right && std::find(vertices, vertices + corners, v) != vertices + corners;
    }
    return right && values<std::int64_t>(soup.cell_data, "neighbors") == neighbors_by_sorting(soup);
}

// --- measures, by determinants of Gram matrices and by Stokes

double determinant(std::vector<std::vector<double>> a) {
    double product = 1;
    for (std::size_t k = 0; k < a.size(); ++k) {
        const auto pivot =
            std::max_element(a.begin() + static_cast<std::ptrdiff_t>(k), a.end(),
                             [k](const auto& p, const auto& q) { return std::abs(p[k]) < std::abs(q[k]); });
        if ((*pivot)[k] == 0) {
            return 0;
        }
        if (pivot != a.begin() + static_cast<std::ptrdiff_t>(k)) {
            std::swap(*pivot, a[k]);
            product = -product;
        }
        product *= a[k][k];
        for (std::size_t i = k + 1; i < a.size(); ++i) {
            const double factor = a[i][k] / a[k][k];
            for (std::size_t j = k; j < a.size(); ++j) {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    return product;
}

double factorial(std::size_t n) {
    return n < 2 ? 1 : static_cast<double>(n) * factorial(n - 1);
}

/// In space-time; a hull of D = 2 has its time as third coordinate, not once more.
Place coordinates(const io::Soup& soup, Index v) {
    Place x = place(soup, v);
    x[3] = has_time_as_coordinate(soup) ? 0.0 : x[3];
    return x;
}

double measure(const io::Soup& soup) {
    const std::size_t d = top(soup);
    double sum = 0;
    for (std::size_t c = 0; c < cell_count(soup); ++c) {
        const Index* v = &soup.simplices[d].vertices[c * (d + 1)];
        std::vector<std::vector<double>> gram(d, std::vector<double>(d));
        for (std::size_t i = 0; i < d; ++i) {
            for (std::size_t j = 0; j < d; ++j) {
                for (std::size_t k = 0; k < 4; ++k) {
                    const double a = coordinates(soup, v[i + 1])[k] - coordinates(soup, v[0])[k];
                    gram[i][j] += a * (coordinates(soup, v[j + 1])[k] - coordinates(soup, v[0])[k]);
                }
            }
        }
        sum += std::sqrt(std::max(0.0, determinant(gram))) / factorial(d);
    }
    return sum;
}

/// Sum of det[v_0 .. v_D] / (D + 1)!, what closed simplices of dimension D in the first D + 1 axes (for
/// tetrahedra x, y, z, t) enclose; positive when they are oriented like the facets of a positive simplex.
double enclosed(const io::Soup& soup) {
    const std::size_t d = top(soup);
    double sum = 0;
    for (std::size_t c = 0; c < cell_count(soup); ++c) {
        std::vector<std::vector<double>> rows;
        for (std::size_t k = 0; k <= d; ++k) {
            const Place x = place(soup, soup.simplices[d].vertices[c * (d + 1) + k]);
            rows.emplace_back(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(d) + 1);
        }
        sum += determinant(rows) / factorial(d + 1);
    }
    return sum;
}

std::size_t number_of_points_in_use(const io::Soup& soup) {
    std::set<Index> used;
    for (const auto& block : soup.simplices) {
        used.insert(block.vertices.begin(), block.vertices.end());
    }
    return used.size();
}

/// The same cells, each with points of its own.
io::Soup torn(const io::Soup& soup) {
    io::Soup result = soup;
    const Array<Index>& vertices = soup.simplices[top(soup)].vertices;
    result.points.resize(vertices.size());
    for (io::DataArray& array : result.point_data) {
        array.keep_rows(vertices);
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        result.points[i] = soup.points[vertices[i]];
        result.simplices[top(soup)].vertices[i] = static_cast<Index>(i);
    }
    Numbers& neighbors = values<std::int64_t>(result.cell_data, "neighbors");
    neighbors = Numbers::generated(neighbors.size(), [](std::size_t) { return -1; });
    Numbers& cell = values<std::int64_t>(result.point_data, "cell");
    cell = Numbers::generated(cell.size(),
                              [&](std::size_t i) { return static_cast<std::int64_t>(i / (top(soup) + 1)); });
    return result;
}

void replace(Numbers& numbers, std::size_t place, std::int64_t value) {
    numbers =
        Numbers::generated(numbers.size(), [&](std::size_t k) { return k == place ? value : numbers[k]; });
}

const char* const formats[] = {"vtu", "msh"};

} // namespace

TEMPLATE_TEST_CASE_SIG("The checkers of these tests find planted faults", "[slab]", ((int D), D), 2, 3) {
    io::Soup soup = hull_soup<D>();
    CHECK(adjacency_is_right(soup));
    Numbers& neighbors = values<std::int64_t>(soup.cell_data, "neighbors");
    const std::int64_t right = neighbors[5];
    replace(neighbors, 5, right + 1);
    CHECK_FALSE(adjacency_is_right(soup));
    replace(neighbors, 5, right);
    replace(values<std::int64_t>(soup.point_data, "cell"), 3, -1);
    CHECK_FALSE(adjacency_is_right(soup));
    io::Soup turned = hull_soup<D>();
    std::swap(turned.simplices[D].vertices[0], turned.simplices[D].vertices[1]);
    CHECK(all_named(turned) != all_named(hull_soup<D>()));
    CHECK(single_facets(turned) == 0);
}

TEMPLATE_TEST_CASE_SIG("Reversing twice changes no byte, once the sign of what is enclosed", "[slab]",
                       ((int D), D), 2, 3) {
    const io::Soup soup = hull_soup<D>();
    io::Soup turned = soup;
    reverse(turned);
    CHECK(bytes_of(turned) != bytes_of(soup));
    CHECK(adjacency_is_right(turned));
    CHECK(enclosed(turned) == Approx(-enclosed(soup)));
    CHECK(measure(turned) == Approx(measure(soup)).epsilon(1e-14));
    reverse(turned);
    CHECK(bytes_of(turned) == bytes_of(soup));
}

TEMPLATE_TEST_CASE_SIG("Scaling multiplies caps and what is enclosed by the power D, and leaves time alone",
                       "[slab]", ((int D), D), 2, 3) {
    const double power = std::pow(2.5, D);
    io::Soup soup = hull_soup<D>();
    io::Soup scaled = soup;
    scale(scaled, 2.5);
    CHECK(values<double>(scaled.point_data, "t") == values<double>(soup.point_data, "t"));
    CHECK(enclosed(scaled) == Approx(power * enclosed(soup)));
    for (const int cap : {0, 2}) {
        io::Soup part = soup;
        io::Soup scaled_part = scaled;
        select_region(part, cap);
        select_region(scaled_part, cap);
        CHECK(measure(scaled_part) == Approx(power * measure(part)));
    }
    if constexpr (D == 2) {
        CHECK(has_time_as_coordinate(scaled));
    }
    scale(soup, 4); // powers of two lose nothing
    scale(soup, 0.25);
    CHECK(bytes_of(soup) == bytes_of(hull_soup<D>()));
}

TEST_CASE("A patch's name takes all patches that have it", "[slab]") {
    io::Soup soup = hull_soup<2>();
    io::Soup side = soup;
    select_region(side, 1);
    for (io::DataArray& array : soup.field_data) {
        if (auto* names = std::get_if<std::vector<std::string>>(&array.values); array.name == "patch_name") {
            REQUIRE(names->size() > 1);
            std::fill(names->begin(), names->end(), "one");
        }
    }
    select_patch(soup, "one");
    CHECK(cell_count(soup) == cell_count(side));
}

TEMPLATE_TEST_CASE_SIG("Renumbering keeps the set of simplices with their data, and adjacency", "[slab]",
                       ((int D), D), 2, 3) {
    const io::Soup soup = hull_soup<D>();
    io::Soup curve = soup;
    renumber_along_curve(curve);
    CHECK(bytes_of(curve) != bytes_of(soup));
    CHECK(all_named(curve) == all_named(soup));
    CHECK(adjacency_is_right(curve));
    const Numbers& before = values<std::int64_t>(soup.point_data, "vertex_id");
    const Numbers& after = values<std::int64_t>(curve.point_data, "vertex_id");
    std::map<std::int64_t, Place> place_of;
    for (std::size_t v = 0; v < before.size(); ++v) {
        place_of[before[v]] = place(soup, static_cast<Index>(v));
    }
    REQUIRE(after.size() == before.size());
    std::size_t moved = 0;
    for (std::size_t v = 0; v < after.size(); ++v) {
        moved += place_of.at(after[v]) == place(curve, static_cast<Index>(v)) ? 0 : 1;
    }
    CHECK(moved == 0);
}

TEMPLATE_TEST_CASE_SIG("The regions make the hull together, each with right adjacency and its points only",
                       "[slab]", ((int D), D), 2, 3) {
    for (const char* format : formats) {
        const io::Soup soup = hull_soup<D>(format);
        std::multiset<Named> together;
        double sum = 0;
        for (int region = 0; region < 3; ++region) {
            io::Soup part = soup;
            select_region(part, region);
            CHECK(part.points.size() == number_of_points_in_use(part));
            together.merge(all_named(part));
            sum += measure(part);
            if (part.find_cell_data("neighbors") != nullptr && part.find_point_data("cell") != nullptr) {
                CHECK(adjacency_is_right(part));
            }
            CHECK(single_facets(part) > 0);
            const std::string once = bytes_of(part);
            select_region(part, region); // what is left has no other region
            CHECK(bytes_of(part) == once);
        }
        CHECK(together == all_named(soup));
        CHECK(sum == Approx(measure(soup)));
    }
    io::Soup cap = hull_soup<D>();
    select_region(cap, 0);
    CHECK_THROWS_AS(select_region(cap, 1), InputError);
    io::Soup mesh = hull_soup<D>();
    std::erase_if(mesh.cell_data, [](const auto& array) { return array.name == "region"; });
    CHECK_THROWS_AS(select_region(mesh, 1), UsageError);
}

TEMPLATE_TEST_CASE_SIG("The patches make the side together, from arrays and from groups", "[slab]",
                       ((int D), D), 2, 3) {
    for (const char* format : formats) {
        const io::Soup soup = hull_soup<D>(format);
        io::Soup side = soup;
        select_region(side, 1);
        std::multiset<Named> together;
        PatchList patches = listed_patches(soup);
        for (const Patch& group : soup.groups[D]) {
            if (group.name != "initial" && group.name != "terminating") {
                patches.push_back(group);
            }
        }
        REQUIRE(patches.size() == 2);
        for (const Patch& patch : patches) {
            io::Soup part = soup;
            select_patch(part, patch.name);
            CHECK(part.points.size() == number_of_points_in_use(part));
            together.merge(all_named(part));
        }
        CHECK(together == all_named(side));
        io::Soup whole = soup;
        CHECK_THROWS_AS(select_patch(whole, "no such patch"), UsageError);
        CHECK(bytes_of(whole) == bytes_of(soup));
    }
}

TEMPLATE_TEST_CASE_SIG("A closed hull has no boundary; that of a part is closed and faces outward", "[slab]",
                       ((int D), D), 2, 3) {
    io::Soup hull = hull_soup<D>();
    CHECK_THROWS_AS(extract_boundary(hull), InputError);
    for (int region = 0; region < 3; ++region) {
        io::Soup part = hull;
        select_region(part, region);
        const std::size_t facets = single_facets(part);
        io::Soup boundary = part;
        extract_boundary(boundary);
        CHECK(cell_count(boundary) == facets);
        CHECK(boundary.points.size() == number_of_points_in_use(boundary));
        CHECK(boundary.find_cell_data("neighbors") == nullptr);
        std::map<Index, int> sum; // lines: each point as often an end as a start
        if constexpr (D == 2) {
            for (std::size_t i = 0; i < 2 * facets; ++i) {
                sum[boundary.simplices[1].vertices[i]] += i % 2 == 0 ? 1 : -1;
            }
            CHECK(std::all_of(sum.begin(), sum.end(), [](const auto& entry) { return entry.second == 0; }));
        } else {
            CHECK_THROWS_AS(extract_boundary(io::Soup{boundary}.points.empty() ? hull : boundary),
                            InputError);
        }
    }
    // of the terminating cap, which is positive: by Stokes its boundary encloses its measure
    io::Soup cap = hull;
    select_region(cap, 2);
    const double inside = measure(cap);
    extract_boundary(cap);
    // the project's outward facets of the plane have the domain to their right
    CHECK(enclosed(cap) == Approx(D == 2 ? -inside : inside));
    io::Soup back = hull;
    select_region(back, 0);
    extract_boundary(back);
    CHECK(enclosed(back) * enclosed(cap) < 0);
}

TEMPLATE_TEST_CASE_SIG("Welding a hull whose cells were torn apart gives its counts and adjacency back",
                       "[slab]", ((int D), D), 2, 3) {
    const io::Soup soup = hull_soup<D>();
    for (const double tolerance : {0.0, 1e-9}) {
        io::Soup welded = torn(soup);
        const std::size_t pieces = welded.points.size();
        const Welded result = weld(welded, tolerance);
        CHECK(result.points == pieces - soup.points.size());
        CHECK(result.cells == 0);
        CHECK(welded.points.size() == soup.points.size());
        CHECK(all_named(welded) == all_named(soup));
        CHECK(adjacency_is_right(welded));
        const std::string once = bytes_of(welded);
        CHECK(weld(welded, tolerance).points == 0);
        CHECK(bytes_of(welded) == once);
    }
    io::Soup untouched = soup;
    weld(untouched, 0);
    CHECK(bytes_of(untouched) == bytes_of(soup));
}

TEMPLATE_TEST_CASE_SIG("Welding asks for nearness in space-time, and collapsed cells go", "[slab]",
                       ((int D), D), 2, 3) {
    io::Soup shaken = torn(hull_soup<D>());
    std::mt19937 random{7};
    for (Point<3>& x : shaken.points) {
        for (std::size_t k = 0; k < 2; ++k) {
            x[k] += 1e-7 * static_cast<double>(static_cast<int>(random() % 3) - 1);
        }
    }
    const io::Soup soup = hull_soup<D>();
    io::Soup exact = shaken;
    weld(exact, 0);
    CHECK(exact.points.size() > soup.points.size());
    weld(shaken, 1e-5);
    CHECK(shaken.points.size() == soup.points.size());
    CHECK(adjacency_is_right(shaken));
    // levels are half a unit of time apart, points of a level at least 0.6 units of space
    io::Soup apart = soup;
    CHECK(weld(apart, 0.4).points == 0);
    io::Soup flat = soup;
    const Welded through_time = weld(flat, 0.51);
    CHECK(through_time.points > 0);
    CHECK(through_time.cells > 0);
    bool distinct = true;
    for (std::size_t c = 0; c < cell_count(flat); ++c) {
        const Index* v = &flat.simplices[D].vertices[c * (D + 1)];
        distinct = distinct && std::set<Index>(v, v + D + 1).size() == D + 1;
    }
    CHECK(distinct);
}

TEMPLATE_TEST_CASE_SIG("Arrays become groups and groups arrays, and the hull is the same", "[slab]",
                       ((int D), D), 2, 3) {
    const io::Soup soup = hull_soup<D>();
    io::Soup grouped = soup;
    arrays_to_groups(grouped);
    CHECK(grouped.find_cell_data("region") == nullptr);
    REQUIRE(grouped.simplices[D].physical.size() == cell_count(soup));
    const auto number = [&](const char* name) { return patch_number(grouped.groups[D], name); };
    std::size_t right = 0;
    for (std::size_t c = 0; c < cell_count(soup); ++c) {
        const std::int64_t region = values<std::int64_t>(soup.cell_data, "region")[c];
        const PatchNumber group = grouped.simplices[D].physical[c];
        right += group == (region == 0   ? number("initial")
                           : region == 2 ? number("terminating")
                                         : values<std::int64_t>(soup.cell_data, "patch")[c])
                     ? 1
                     : 0;
    }
    CHECK(right == cell_count(soup));
    for (int region = 0; region < 3; ++region) { // selecting goes by either
        io::Soup by_group = grouped;
        io::Soup by_array = soup;
        select_region(by_group, region);
        select_region(by_array, region);
        CHECK(by_group.points == by_array.points);
        CHECK(by_group.simplices[D].vertices == by_array.simplices[D].vertices);
    }
    groups_to_arrays(grouped);
    CHECK(all_named(grouped) == all_named(soup));
    CHECK(listed_patches(grouped) == listed_patches(soup));
}

TEMPLATE_TEST_CASE_SIG("Neighbors as element tags come back as numbers from 0", "[slab]", ((int D), D), 2,
                       3) {
    const io::Soup soup = hull_soup<D>();
    io::Soup tagged = soup;
    number_by_tags(tagged);
    const Numbers& before = values<std::int64_t>(soup.cell_data, "neighbors");
    const Numbers& tags = values<std::int64_t>(tagged.cell_data, "neighbor");
    CHECK(std::equal(tags.begin(), tags.end(), before.begin(), before.end(),
                     [](std::int64_t tag, std::int64_t cell) { return tag == cell + 1; }));
    CHECK(adjacency_is_right(soup));
    io::Soup through_msh = hull_soup<D>("msh"); // settle_numbers() read it
    CHECK(values<std::int64_t>(through_msh.cell_data, "neighbors") == before);
    Numbers& wrong = values<std::int64_t>(through_msh.cell_data, "neighbors");
    io::Soup bad = through_msh;
    bad.cell_data.clear();
    for (std::size_t i = 0; i <= D; ++i) {
        Numbers row;
        for (std::size_t c = 0; c < cell_count(bad); ++c) {
            row.push_back(wrong[c * (D + 1) + i] + 1);
        }
        bad.cell_data.push_back({"neighbor_" + std::to_string(i), 1, row});
    }
    io::Soup good = bad;
    settle_numbers(good);
    CHECK(values<std::int64_t>(good.cell_data, "neighbors") == before);
    replace(values<std::int64_t>(bad.cell_data, "neighbor_1"), 0, 999999999);
    CHECK_THROWS_AS(settle_numbers(bad), InputError);
}
