// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/cases/starting_case.h"

#include "cases/run/bodies.h"
#include "slabhull/cases/initial.h"
#include "slabhull/core/error.h"
#include "slabhull/core/vector.h"
#include "slabhull/io/files.h"
#include "slabhull/io/formats.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <limits>
#include <set>

namespace slabhull {

namespace {

struct Extent {
    Point<3> low;
    Point<3> high;
    std::size_t facets = 0;
    double edges = 0; ///< sum of their lengths
    std::size_t edge_count = 0;

    Extent() {
        low.fill(std::numeric_limits<double>::infinity());
        high.fill(-std::numeric_limits<double>::infinity());
    }
    void add(const Point<3>& point) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], point[k]);
            high[k] = std::max(high[k], point[k]);
        }
    }
    void add(const Extent& other) {
        add(other.low);
        add(other.high);
        edges += other.edges;
        edge_count += other.edge_count;
    }
    bool encloses(const Extent& other, int dimension) const {
        for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
            if (!(low[k] < other.low[k] && other.high[k] < high[k])) {
                return false;
            }
        }
        return true;
    }
    double largest_side() const { return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}); }
    double mean_edge() const { return edges / static_cast<double>(std::max<std::size_t>(edge_count, 1)); }
    Point<3> centre() const { return times(0.5, plus(low, high)); }
};

constexpr std::string_view box_patch = "walls";

/// A file to start from.
struct Source {
    std::filesystem::path path;
    io::Soup soup;
    int dimension = 0; ///< of space
    bool is_mesh = false;
    bool has_parts = false; ///< several groups of facets with names
    std::string patch;      ///< of a surface without parts
    Extent extent;
};

/// A text as a TOML string.
std::string quoted(const std::string& text) {
    std::string all = "\"";
    for (const char c : text) {
        all += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
    }
    return all + "\"";
}

std::string as_key(const std::string& name) {
    const bool bare = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-';
    });
    return bare ? name : quoted(name);
}

bool is_flat(const io::Soup& soup) {
    return std::all_of(soup.points.begin(), soup.points.end(), [](const Point<3>& p) { return p[2] == 0; });
}

/// Reads a file by what it is: a curve where its lines are pairs of numbers, else as any mesh or surface.
io::Soup read_any(const std::filesystem::path& path) {
    const io::Format* format = io::format_of_extension(path);
    const std::set<std::string> surfaces{".stl", ".off", ".obj", ".ply"};
    if (surfaces.contains(path.extension().string())) {
        return io::read_surface(path);
    }
    if (format == nullptr && io::format_of_content(path) == nullptr) {
        return io::read_curve(path);
    }
    return io::read_mesh(path);
}

Source open_source(const std::filesystem::path& path) {
    Source source{path, read_any(path), 0, false, false, path.stem().string(), {}};
    const io::Soup& soup = source.soup;
    if (soup.find_field_data("patch_number") != nullptr && soup.find_cell_data("region") != nullptr) {
        throw InputError(
            fmt::format("{}: is a hull that was built; a case starts from a mesh in space or from "
                        "surfaces, such as the cap files beside it",
                        path.string()));
    }
    const int top = soup.top_dimension();
    const bool flat = is_flat(soup);
    if (top < 1 || (top == 1 && !flat)) {
        throw InputError(fmt::format(
            "{}: has neither tetrahedra nor triangles nor a curve in the plane z = 0", path.string()));
    }
    source.is_mesh = top == 3 || (top == 2 && flat);
    source.dimension = top == 1 || (top == 2 && flat) ? 2 : 3;
    const auto& physical = soup.simplices[static_cast<std::size_t>(source.dimension - 1)].physical;
    source.has_parts = !source.is_mesh && std::set<PatchNumber>(physical.begin(), physical.end()).size() > 1;
    for (const Point<3>& point : soup.points) {
        source.extent.add(point);
    }
    return source;
}

/// Writes one case.
class CaseWriter {
public:
    CaseWriter(std::vector<Source> sources, const std::filesystem::path& directory, const Listener& listener)
        : sources_{std::move(sources)}, directory_{directory}, listener_{listener},
          dimension_{sources_.front().dimension} {
        require_alike();
        std::stable_sort(sources_.begin(), sources_.end(), [](const Source& a, const Source& b) {
            return a.extent.largest_side() > b.extent.largest_side();
        });
        const auto rest = sources_.begin() + 1;
        enclosed_ = !sources_.front().is_mesh && sources_.size() > 1 &&
                    std::all_of(rest, sources_.end(), [&](const Source& source) {
                        return sources_.front().extent.encloses(source.extent, dimension_);
                    });
        name_patches();
    }

    std::string run() {
        for (const Source& source : sources_) {
            for (const std::string& remark : source.soup.remarks) {
                listener_.warning(remark);
            }
        }
        dimension_ == 2 ? find_patches<2>() : find_patches<3>();
        line("title = {}", quoted(sources_.front().path.stem().string()));
        line("dimension = {}", dimension_);
        initial();
        line("\n[time]\nstart = 0.0\nend = 1.0\nslabs = 4\n# layers = 8              # of each slab; without "
             "it, "
             "their number follows from the motion");
        motions();
        rest();
        return std::move(text_);
    }

private:
    template<class... Args>
    void line(fmt::format_string<Args...> format, Args&&... args) {
        text_ += fmt::format(format, std::forward<Args>(args)...) + "\n";
    }

    void require_alike() const {
        for (const Source& source : sources_) {
            if (source.is_mesh && sources_.size() > 1) {
                throw UsageError(fmt::format("{}: is a spatial mesh, which is a whole domain; give it alone, "
                                             "or surfaces only",
                                             source.path.string()));
            }
            if (source.dimension != dimension_) {
                throw UsageError(fmt::format("{} is of dimension {}, {} of dimension {}",
                                             sources_.front().path.string(), dimension_, source.path.string(),
                                             source.dimension));
            }
        }
    }

    /// Patches have names of their own, none of which hulls use for their caps.
    void name_patches() {
        std::set<std::string> taken{"initial", "terminating", std::string{box_patch}, ""};
        for (Source& source : sources_) {
            const std::string stem = source.patch;
            for (int k = 2; !taken.insert(source.patch).second; ++k) {
                source.patch = fmt::format("{}-{}", stem.empty() ? "body" : stem, k);
            }
        }
    }

    std::string path_of(const Source& source) const {
        const auto relative = std::filesystem::proximate(source.path, directory_);
        const bool far = relative.generic_string().starts_with("../..");
        return quoted((far ? std::filesystem::absolute(source.path) : relative).generic_string());
    }

    Extent all() const {
        Extent extent;
        for (const Source& source : sources_) {
            extent.add(source.extent);
        }
        return extent;
    }

    /// A point with six digits of the bodies' size, however far from the origin they are.
    std::string list(const Point<3>& point) const {
        constexpr double usual = 6;
        constexpr double most = 17; // of a double
        const Extent extent = all();
        double farthest = extent.largest_side();
        for (std::size_t k = 0; k < 3; ++k) {
            farthest = std::max({farthest, std::abs(extent.low[k]), std::abs(extent.high[k])});
        }
        const double more = std::ceil(std::log10(farthest / extent.largest_side()));
        return fmt::format("[{:.{}g}]", fmt::join(point.begin(), point.begin() + dimension_, ", "),
                           static_cast<int>(std::min(usual + more, most)));
    }

    /// As far around the bodies as they are large, in round numbers.
    Extent box() const {
        Extent box = all();
        const double margin = box.largest_side();
        const double step = std::pow(10, std::floor(std::log10(margin)) - 1);
        for (std::size_t k = 0; k < static_cast<std::size_t>(dimension_); ++k) {
            box.low[k] = step * std::floor((box.low[k] - margin) / step);
            box.high[k] = step * std::ceil((box.high[k] + margin) / step);
        }
        return box;
    }

    /// The case, as far as the domain is concerned.
    Case domain_case() const {
        Case the_case;
        the_case.dimension = dimension_;
        if (sources_.front().is_mesh) {
            the_case.initial = InitialMesh{sources_.front().path, {}, {}};
            return the_case;
        }
        InitialBodies bodies;
        for (const Source& source : sources_) {
            bodies.files.push_back({source.path, source.has_parts ? "" : source.patch, source.has_parts});
        }
        const auto count = static_cast<std::ptrdiff_t>(dimension_);
        const Extent around = box();
        if (enclosed_) {
            bodies.outer = bodies.files.front();
            bodies.files.erase(bodies.files.begin());
        } else {
            bodies.outer = BoxSpec{{around.low.begin(), around.low.begin() + count},
                                   {around.high.begin(), around.high.begin() + count},
                                   box_size(),
                                   std::string{box_patch}};
        }
        the_case.initial = bodies;
        return the_case;
    }

    /// Edges of the box.
    double box_size() const {
        constexpr double edges_along = 10;
        return box().largest_side() / edges_along;
    }

    template<int D>
    void find_patches() {
        const Case the_case = domain_case();
        if (sources_.front().is_mesh) {
            IdCounter ids;
            StageClock clock;
            const SpatialMesh<D> mesh = initial_domain<D>(the_case, ids, listener_, clock).mesh;
            measure<D>({mesh.points, mesh.boundary_facets, mesh.boundary_patch, mesh.patches});
        } else {
            FacetNaming naming;
            measure<D>(boundary_of_bodies<D>(std::get<InitialBodies>(the_case.initial), listener_, naming));
        }
    }

    template<int D>
    void measure(const Surface<D>& surface) {
        for (const Patch& patch : surface.patches) {
            patches_.emplace_back(patch.name, Extent{});
            Extent& extent = patches_.back().second;
            for (std::size_t f = 0; f < surface.facets.size(); ++f) {
                if (surface.patch[f] == patch.number) {
                    add_facet<D>(surface, surface.facets[f], extent);
                }
            }
        }
    }

    template<int D>
    static void add_facet(const Surface<D>& surface, const Facet<D>& facet, Extent& extent) {
        ++extent.facets;
        for (std::size_t i = 0; i < D; ++i) {
            Point<3> place{};
            std::copy_n(surface.points[facet[i]].begin(), D, place.begin());
            extent.add(place);
            for (std::size_t j = 0; j < i; ++j) {
                extent.edges += distance(surface.points[facet[i]], surface.points[facet[j]]);
                ++extent.edge_count;
            }
        }
    }

    void initial() {
        line("\n[initial]");
        const Source& first = sources_.front();
        if (first.is_mesh) {
            line("mesh = {}", path_of(first));
        } else {
            line("{} = [", dimension_ == 2 ? "curves" : "surfaces");
            for (const Source& source : sources_) {
                if (!enclosed_ || &source != &first) {
                    line("    {},", entry(source));
                }
            }
            line("]");
            if (enclosed_) {
                line("outer = {}", entry(first));
            } else {
                const Extent around = box();
                line("box = {{ min = {}, max = {}, size = {:.2g}, patch = {} }}", list(around.low),
                     list(around.high), box_size(), quoted(std::string{box_patch}));
            }
        }
        line("# Patches:");
        for (const auto& [name, extent] : patches_) {
            line("#   {}: {} {}, from {} to {}, edges of {:.3g}", name, extent.facets,
                 dimension_ == 2 ? "edges" : "triangles", list(extent.low), list(extent.high),
                 extent.mean_edge());
        }
    }

    std::string entry(const Source& source) const {
        return source.has_parts
                   ? fmt::format("{{ file = {}, patches = \"file\" }}", path_of(source))
                   : fmt::format("{{ file = {}, patch = {} }}", path_of(source), quoted(source.patch));
    }

    /// One motion a patch, of different kinds, to be chosen from.
    void motions() {
        line("\n# A patch without a motion stands still. Other kinds: translation, expansion, velocity, "
             "rigid-table, sequence,\n# displacement-series, stretch (docs/case-file.md).");
        for (const auto& [name, extent] : patches_) {
            if (name == box_patch) {
                continue;
            }
            line("# [motion.{}]", as_key(name));
            line("# kind = \"rotation\"");
            if (dimension_ == 3) {
                line("# axis = [0, 0, 1]");
            }
            line("# centre = {}", list(extent.centre()));
            line("# rate = 0.5               # radians per unit of time");
        }
        line("\n# [project.{}]           # the surface that the patch's vertices are put back on",
             as_key(patches_.front().first));
        line("# surface = \"file\"\n# file = \"{}\"", dimension_ == 3 ? "surface.stl" : "curve.dat");
    }

    void rest() {
        const bool space = dimension_ == 3;
        line("\n# [trajectory]\n# scheme = \"rk4\"           # euler, heun, dopri5, exact\n# substeps = 8    "
             "         # of each layer");
        line("\n# [side]\n# split = {}              # {}", space ? "\"C\"" : "\"centre\"",
             space ? "A (3 tetrahedra a prism) to E (14): docs/splits.md" : "or diagonal");
        line("\n# [cap]\n# size = {:.2g}              # largest spacing inside; none by default\n# growth = "
             "0.3             # of "
             "the spacing, per distance from the boundary",
             all().largest_side() / 5);
        line("# reuse = \"none\"           # \"move\" or \"adapt\": caps are one mesh, moved; [fill] needs "
             "it");
        line("\n# [adapt]                  # of reuse = \"adapt\"\n# angle = 10               # smallest "
             "angle, degrees\n# boundary = false         # "
             "true: edges of the boundary keep their length, too");
        line("\n# [fill]                   # every slab as a space-time mesh\n# formats = [\"mfem\"]");
        line("\n# [check]\n# embedding = true");
        line("\n[output]\n# directory = \"out\"\nformats = [\"vtu\"]        # hulls for ParaView; also "
             "\"msh\"");
    }

    std::vector<Source> sources_;
    std::filesystem::path directory_;
    const Listener& listener_;
    int dimension_;
    bool enclosed_ = false; ///< the first source has all others inside
    std::vector<std::pair<std::string, Extent>> patches_;
    std::string text_;
};

} // namespace

std::string starting_case(const std::vector<std::filesystem::path>& files,
                          const std::filesystem::path& directory, const Listener& listener) {
    std::vector<Source> sources;
    for (const std::filesystem::path& file : files) {
        sources.push_back(open_source(file));
    }
    return CaseWriter{std::move(sources), directory, listener}.run();
}

} // namespace slabhull
