// SPDX-License-Identifier: BSD-3-Clause
#include "commands.h"

#include "fillings.h"
#include "mesh_formats.h"
#include "slabhull/cases/filling_files.h"
#include "slabhull/cases/hull_files.h"
#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/io/files.h"
#include "slabhull/io/files_read.h"
#include "slabhull/io/space_time_files.h"
#include "slabhull/view/view_page.h"

#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace slabhull::tools {

namespace {

struct ViewCommand {
    std::vector<std::string> files;
    std::string from;
    std::string out;
    std::size_t most_cells = ViewOptions{}.most_side_cells;
    int threads = 0;
};

/// The files, those of a series in its place.
std::vector<std::string> slabs_of(const std::vector<std::string>& files) {
    std::vector<std::string> slabs;
    for (const std::string& file : files) {
        if (std::filesystem::path{file}.extension() != ".pvd") {
            slabs.push_back(file);
            continue;
        }
        const std::vector<io::SeriesEntry> entries = io::read_pvd(file);
        if (entries.empty()) {
            throw InputError{fmt::format("{}: the series has no files", file)};
        }
        for (const io::SeriesEntry& entry : entries) {
            slabs.push_back(entry.file.string());
        }
    }
    return slabs;
}

void require_page_name(const std::string& out) {
    const std::filesystem::path extension = std::filesystem::path{out}.extension();
    if (extension != ".html" && extension != ".htm") {
        throw UsageError{fmt::format("--out: expected a .html file, not {}", out)};
    }
}

class ViewRun {
public:
    explicit ViewRun(const ViewCommand& command)
        : command_{command}, files_{slabs_of(command.files)}, page_{title(),
                                                                    {.slabs = files_.size(),
                                                                     .most_side_cells = command.most_cells}} {
    }

    void run() {
        for (const std::string& file : files_) {
            add(file);
        }
        read_.require_none(std::array{std::filesystem::path{command_.out}});
        if (std::filesystem::path{command_.out}.has_parent_path()) {
            io::make_folder(std::filesystem::path{command_.out}.parent_path());
        }
        io::AtomicFile out{command_.out};
        page_.write(out);
        out.commit();
        tell();
    }

private:
    std::string title() const {
        const std::filesystem::path first = command_.files.front();
        const std::string name = (first.parent_path().filename() / first.filename()).string();
        return command_.files.size() == 1 ? name
                                          : fmt::format("{} and {} more", name, command_.files.size() - 1);
    }

    /// What is wrong with a slab is the file's fault.
    void add(const std::string& file) {
        try {
            if (command_.from.empty() && io::is_space_time_file(file)) {
                add_filling(file, io::read_space_time(file));
            } else {
                add_mesh(file, read_named(file, command_.from));
            }
        } catch (const GeometryError& error) {
            throw InputError{fmt::format("{}: {}", file, error.what()), error.entities};
        }
    }

    void add_filling(const std::string& file, io::SpaceTimeSoup soup) {
        soup.dimension == 3 ? page_.add<2>(name_of(file), filling_to_write<2>(soup))
                            : page_.add<3>(name_of(file), filling_to_write<3>(soup));
    }

    void add_mesh(const std::string& file, io::Soup soup) {
        const MeshKind kind = kind_of(soup);
        if (kind.hull) {
            kind.dimension == 2 ? page_.add<2>(name_of(file), hull_of_soup<2>(soup).columns())
                                : page_.add<3>(name_of(file), hull_of_soup<3>(soup).columns());
        } else if (kind.dimension == 3 && soup.find_field_data("slab") != nullptr) { // of 2D + t, as VTU
            add_filling(file, filling_of_tetrahedra(soup));
        } else {
            throw InputError{fmt::format("{}: a mesh in space, neither the hull nor a filling of a slab; "
                                         "give a file that slabhull build or fill "
                                         "wrote (slab_0000.vtu)",
                                         file)};
        }
    }

    static std::string name_of(const std::string& file) {
        return std::filesystem::path{file}.filename().string();
    }

    void tell() const {
        for (const std::string& note : page_.notes()) {
            fmt::print(stderr, "slabhull: {}\n", note);
        }
        fmt::print("{}: {} slab{}, {} side cells, {:.1f} MB; open it in a browser\n", command_.out,
                   files_.size(), files_.size() > 1 ? "s" : "", page_.side_cells(),
                   1e-6 * static_cast<double>(std::filesystem::file_size(command_.out)));
    }

    const io::FilesRead read_{}; // before the files
    const ViewCommand& command_;
    std::vector<std::string> files_;
    ViewPage page_;
};

} // namespace

void add_view(CLI::App& program, int& exit_code) {
    auto command = std::make_shared<ViewCommand>();
    CLI::App* app = program.add_subcommand(
        "view", "One HTML file that shows hulls or fillings through time, offline: docs/view.md");
    app->add_option("FILE", command->files,
                    "Hulls of one or more slabs, or fillings (MFEM of dimension 4, GetFEM, HDF5), in the "
                    "order of their times; or a series of them, such as slabs.pvd")
        ->required();
    app->add_option("--from", command->from, "Format of all FILEs, whatever their extension and content");
    app->add_option("--out", command->out, "The page")->required();
    app->add_option("--most-cells", command->most_cells,
                    "Side cells that the page may have, by default 3000000: larger hulls are thinned")
        ->check(positive_number());
    app->add_option("--threads", command->threads, "Threads to use; 0 for all cores")
        ->check(CLI::Range(0, 1024));
    app->footer("Example: slabhull view out/ellipsoid/slabs.pvd --out ellipsoid.html");
    app->callback([command, &exit_code] {
        set_thread_count(command->threads);
        require_page_library();
        require_page_name(command->out);
        ViewRun{*command}.run();
        exit_code = 0;
    });
}

} // namespace slabhull::tools
