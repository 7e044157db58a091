// SPDX-License-Identifier: BSD-3-Clause
#include "cases/run/bodies.h"

#include "cases/case/numbers.h"
#include "cases/case/patch_names.h"
#include "cases/run/mesh_soup.h"
#include "cases/run/orientation.h"
#include "core/listed.h"
#include "geometry/embedding/box_tree.h"
#include "slabhull/core/error.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/geometry/shapes.h"
#include "slabhull/io/files.h"
#include "slabhull/io/formats.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <set>

namespace slabhull {

namespace {

/// Gives every patch name a number, in the order in which they come.
class PatchNumbers {
public:
    Patch operator()(const std::string& name) {
        const PatchNumber known = patch_number(patches_, name);
        if (known != 0) {
            return {known, name};
        }
        patches_.push_back({static_cast<PatchNumber>(patches_.size() + 1), name});
        return patches_.back();
    }

private:
    PatchList patches_;
};

/// A surface file or, for patches of Gmsh and others, a mesh file of triangles.
template<int D>
io::Soup read_body_soup(const std::filesystem::path& file) {
    if (D == 2) {
        return io::read_curve(file);
    }
    const io::Format* format = io::format_of_extension(file);
    if (format == nullptr || format->features.max_dimension < 3) {
        return io::read_surface(file);
    }
    io::Soup soup = io::read_mesh(file);
    if (soup.top_dimension() == 3) {
        throw InputError(
            fmt::format("{}: a surface was expected, but it has tetrahedra; initial.mesh takes it, "
                        "or convert --extract-boundary",
                        soup.path));
    }
    return soup;
}

template<int D>
class BodyReader {
public:
    explicit BodyReader(const Listener& listener) : listener_{listener} {}

    Surface<D> boundary(const InitialBodies& bodies, FacetNaming& naming) {
        std::vector<Surface<D>> pieces;
        for (const BodyFile& body : bodies.files) {
            pieces.push_back(read(body, false));
        }
        files_before_outer_ = pieces.size();
        for (const EllipsoidBody& body : bodies.ellipsoids) {
            pieces.push_back(ellipsoid_body<D>(as_point<D>(body.centre), as_point<D>(body.semi_axes),
                                               body.frequency, number_(body.patch)));
        }
        if (const auto* box = std::get_if<BoxSpec>(&bodies.outer)) {
            pieces.push_back(box_of(*box));
        } else {
            pieces.push_back(read(std::get<BodyFile>(bodies.outer), true));
        }
        warn_of_shared_names(pieces);
        naming = naming_of_all(pieces);
        warn_of_sizes(pieces, naming.where);
        return join<D>(pieces);
    }

private:
    Surface<D> read(const BodyFile& body, bool encloses_domain) {
        const io::Soup soup = read_body_soup<D>(body.file);
        for (const std::string& remark : soup.remarks) {
            listener_.warning(remark);
        }
        Surface<D> surface = surface_of_soup<D>(soup, {1, body.patch});
        name_patches(surface, soup, body);
        FacetNaming naming{body.file.string(), {}};
        const io::SimplexBlock& block = soup.simplices[D - 1];
        for (std::size_t f = 0; f < surface.facets.size(); ++f) {
            naming.numbers.push_back(block.tag(f));
        }
        const std::size_t turned = turn_outward(surface, encloses_domain, naming);
        if (turned > 0) {
            listener_.warning(
                fmt::format("{}: {} of {} facets pointed inward, unlike the others, and were turned",
                            naming.where, turned, surface.facets.size()));
        }
        require_sound(surface, encloses_domain, naming);
        namings_.push_back(std::move(naming));
        return surface;
    }

    Surface<D> box_of(const BoxSpec& box) {
        try {
            return box_surface<D>(as_point<D>(box.min), as_point<D>(box.max), box.size, number_(box.patch));
        } catch (const LimitError& error) {
            throw LimitError(fmt::format("initial.box.size: {}", error.what()));
        }
    }

    /// Facets by their numbers in their own files; those of boxes and ellipsoids, which are meshed here, from
    /// 0.
    FacetNaming naming_of_all(const std::vector<Surface<D>>& pieces) const {
        constexpr std::size_t shown = 4;
        std::vector<std::string> files;
        FacetNaming all;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            // Files come first, in their order, and an outer file comes last.
            const bool outer_file = i + 1 == pieces.size() && namings_.size() > files_before_outer_;
            const FacetNaming* own = i < files_before_outer_ ? &namings_[i]
                                     : outer_file            ? &namings_.back()
                                                             : nullptr;
            for (std::size_t f = 0; f < pieces[i].facets.size(); ++f) {
                all.numbers.push_back(own != nullptr ? own->numbers[f] : static_cast<std::int64_t>(f));
            }
            if (own != nullptr && std::find(files.begin(), files.end(), own->where) == files.end()) {
                files.push_back(own->where);
            }
        }
        all.where = files.empty() ? "initial boundary" : "initial boundary of " + listed(files, shown);
        return all;
    }

    static void require_sound(const Surface<D>& surface, bool encloses_domain, const FacetNaming& naming) {
        if (encloses_domain) {
            require_domain_boundary(surface, naming, true);
            return;
        }
        Surface<D> alone = surface; // on its own, a body is the boundary of the domain inside it
        for (auto& facet : alone.facets) {
            std::swap(facet[0], facet[1]);
        }
        require_domain_boundary(alone, naming, true);
    }

    /// The groups that facets are in, by number; 0 for none.
    static std::map<PatchNumber, std::string> groups_in_use(const io::Soup& soup) {
        const auto& physical = soup.simplices[D - 1].physical;
        std::map<PatchNumber, std::string> names;
        for (const PatchNumber number : std::set<PatchNumber>(physical.begin(), physical.end())) {
            const std::string name = number == 0 ? "" : patch_name(soup.groups[D - 1], number);
            names.emplace(number, name.empty() && number != 0 ? fmt::format("{}", number) : name);
        }
        return names;
    }

    void name_patches(Surface<D>& surface, const io::Soup& soup, const BodyFile& body) {
        const auto groups = groups_in_use(soup);
        if (!body.patches_of_file) {
            set_patches(surface, {}, {{0, body.patch}});
            tell_of_groups(soup, groups, body.patch);
            return;
        }
        std::map<PatchNumber, std::string> names = groups;
        const auto without = names.find(0);
        if (groups.empty() || without != names.end()) {
            names[0] = body.patch;
            require_patch_for_the_rest(soup, groups, body);
        }
        for (const auto& [number, name] : names) {
            require_patch_name(name, soup.path);
        }
        set_patches(surface, soup.simplices[D - 1].physical, names);
    }

    void set_patches(Surface<D>& surface, const std::vector<PatchNumber>& group,
                     const std::map<PatchNumber, std::string>& names) {
        std::map<PatchNumber, Patch> patches;
        surface.patches.clear();
        for (const auto& [number, name] : names) {
            patches[number] = number_(name);
            if (patch_number(surface.patches, name) == 0) {
                surface.patches.push_back(patches[number]);
            }
        }
        for (std::size_t f = 0; f < surface.patch.size(); ++f) {
            surface.patch[f] = patches[group.empty() ? 0 : group[f]].number;
        }
    }

    static void require_patch_for_the_rest(const io::Soup& soup,
                                           const std::map<PatchNumber, std::string>& groups,
                                           const BodyFile& body) {
        if (!body.patch.empty()) {
            return;
        }
        const auto& physical = soup.simplices[D - 1].physical;
        const auto rest = groups.empty() ? static_cast<std::ptrdiff_t>(soup.simplices[D - 1].size(D - 1))
                                         : std::count(physical.begin(), physical.end(), 0);
        throw InputError(fmt::format("{}: {} facets are in no part that has a name (solid, group, object, "
                                     "material), which patches = \"file\" asks for; give these facets a name "
                                     "with patch = \"..\" beside it",
                                     soup.path, rest));
    }

    /// Several parts that become one patch.
    void tell_of_groups(const io::Soup& soup, const std::map<PatchNumber, std::string>& groups,
                        const std::string& patch) const {
        if (groups.size() < 2) {
            return;
        }
        std::vector<std::string> names;
        for (const auto& [number, name] : groups) {
            if (number != 0) {
                names.push_back(name);
            }
        }
        const std::size_t shown = std::min<std::size_t>(names.size(), 8);
        listener_.warning(fmt::format(
            "{}: its parts \"{}\"{} are one patch, \"{}\"; with patches = \"file\" each is a patch",
            soup.path, fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), "\", \""),
            shown < names.size() ? " ..." : "", patch));
    }

    /// Bodies that are dots in their box: one of the two may be in other units.
    void warn_of_sizes(const std::vector<Surface<D>>& pieces, const std::string& where) const {
        constexpr double usual = 500;
        const auto longest_side = [](const Surface<D>& piece) {
            Box<D> box;
            for (const Point<D>& point : piece.points) {
                box.include(point);
            }
            return box.extent();
        };
        double largest = 0;
        for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
            largest = std::max(largest, longest_side(pieces[i]));
        }
        const double outer = longest_side(pieces.back());
        if (pieces.size() > 1 && outer > usual * largest) {
            listener_.warning(
                fmt::format("{}: the largest body is {:.3g} long, the outer boundary {:.3g}: if they are in "
                            "different units, slabhull convert --scale changes those of a surface",
                            where, largest, outer));
        }
    }

    /// Motions are given by patch, so bodies of one name move together.
    void warn_of_shared_names(const std::vector<Surface<D>>& pieces) const {
        for (std::size_t i = 1; i + 1 < pieces.size(); ++i) {
            for (const Patch& patch : pieces[i].patches) {
                const bool earlier = std::any_of(
                    pieces.begin(), pieces.begin() + static_cast<std::ptrdiff_t>(i),
                    [&](const auto& piece) { return patch_number(piece.patches, patch.name) != 0; });
                if (earlier) {
                    listener_.warning(
                        fmt::format("the patch \"{}\" is part of several bodies: they move, or stand "
                                    "still, together; give each a name of its own to move it alone",
                                    patch.name));
                }
            }
        }
        for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
            for (const Patch& patch : pieces[i].patches) {
                if (patch_number(pieces.back().patches, patch.name) != 0) {
                    listener_.warning(
                        fmt::format("the patch \"{}\" is part of a body and of the outer boundary: "
                                    "both move, or stand still, together",
                                    patch.name));
                }
            }
        }
    }

    const Listener& listener_;
    PatchNumbers number_;
    std::vector<FacetNaming> namings_; ///< of the files
    std::size_t files_before_outer_ = 0;
};

} // namespace

template<int D>
Surface<D> boundary_of_bodies(const InitialBodies& bodies, const Listener& listener, FacetNaming& naming) {
    return BodyReader<D>{listener}.boundary(bodies, naming);
}

template Surface<2> boundary_of_bodies<2>(const InitialBodies&, const Listener&, FacetNaming&);
template Surface<3> boundary_of_bodies<3>(const InitialBodies&, const Listener&, FacetNaming&);

} // namespace slabhull
