// SPDX-License-Identifier: BSD-3-Clause
// A page that shows hulls and fillings through time, in one HTML file that needs no other and no network.
#pragma once

#include "slabhull/io/atomic_file.h"
#include "slabhull/slab/check.h"
#include "slabhull/topology/filling.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace slabhull {

struct ViewOptions {
    std::size_t slabs = 1; ///< that will be added: each has its share of the numbers below
    /// Side cells of the page. A slab with more than its share is thinned: fewer levels, prisms in D cells.
    std::size_t most_side_cells = 3'000'000;
    /// Cells of caps or of fillings. Those of a slab with more than its share are left out.
    std::size_t most_inside_cells = 2'000'000;
};

/// Throws UsageError in a build without three.js, which draws the page.
void require_page_library();

/// Collects slabs of one dimension in the order of their times, then writes the page. docs/view.md says what
/// it shows. Memory: some 40 bytes a cell that is shown.
class ViewPage {
public:
    ViewPage(std::string title, const ViewOptions& options);
    ~ViewPage();
    ViewPage(const ViewPage&) = delete;
    ViewPage& operator=(const ViewPage&) = delete;

    /// `name` is what the page calls the slab. Throws InputError for columns that do not fit, coordinates
    /// that are not finite, UsageError for slabs whose dimension or kind differs from that of the ones
    /// before, or that begin before the last one ends.
    template<int D>
    void add(const std::string& name, const HullColumns<D>& hull);
    template<int D>
    void add(const std::string& name, const Filling<D>& filling);

    std::size_t side_cells() const; ///< shown
    /// What the page does not show, or not as it is: sentences, which are in the page, too.
    const std::vector<std::string>& notes() const;

    /// Needs: a slab. The file is the caller's to commit.
    void write(io::AtomicFile& file) const;

private:
    struct Content;
    std::unique_ptr<Content> content_;
};

} // namespace slabhull
