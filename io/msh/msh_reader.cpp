// SPDX-License-Identifier: BSD-3-Clause
// The formats are described in the Gmsh reference manual, sections "MSH file format" and "Legacy formats".
#include "slabhull/io/files.h"

#include "io/files/file_cursor.h"
#include "io/files/utf8.h"
#include "io/mesh/corners_only.h"
#include "io/mesh/readers.h"
#include "io/mesh/tag_index.h"
#include "io/msh/gmsh_types.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <memory>

namespace slabhull::io {

namespace {

constexpr std::size_t least_text = 2; // a digit and a blank

class MshReader {
public:
    MshReader(FileBytes& file, const ReadOptions& options) : file_{file}, in_{file}, options_{options} {
        soup_.path = file.path().string();
    }

    Soup read() {
        pass_byte_order_mark(in_);
        while (!in_.at_end()) {
            read_section();
        }
        require(version_ != Version::unknown, "this is no MSH file: $MeshFormat was expected");
        require(nodes_read_, "there is no section $Nodes");
        require(elements_read_, "there is no section $Elements");
        list_groups();
        remark_on_groups();
        remark_on_repeated();
        corners_only_.finish(soup_);
        return std::move(soup_);
    }

private:
    enum class Version { unknown, v2, v4 };

    void require(bool condition, const std::string& text) const {
        if (!condition) {
            in_.fail(text);
        }
    }

    // --- sections ---

    void read_section() {
        const std::size_t start = in_.offset();
        const std::string_view line = in_.line();
        const std::string name{line.substr(0, line.find_last_not_of(" \t") + 1)};
        if (version_ == Version::unknown && !name.starts_with('$')) {
            in_.fail_at(start, "this is no MSH file: $MeshFormat was expected");
        }
        require(name.size() > 1 && name[0] == '$', "a section's name, such as $Nodes, was expected");
        const bool heads = name == "$MeshFormat" || name == "$Comments";
        require(heads || version_ != Version::unknown, "this is no MSH file: $MeshFormat was expected");
        if (name == "$MeshFormat") {
            read_format();
        } else if (name == "$PhysicalNames") {
            read_physical_names();
        } else if (name == "$Entities") {
            read_entities();
        } else if (name == "$PartitionedEntities") {
            read_partitioned_entities();
        } else if (name == "$Nodes" || name == "$ParametricNodes") {
            read_nodes(name == "$ParametricNodes");
        } else if (name == "$Elements") {
            read_elements();
        } else if (name == "$NodeData" || name == "$ElementData") {
            read_data(name);
        } else {
            skip_section(name); // also $GhostElements, which repeats elements of other partitions
            if (name == "$ElementNodeData") {
                soup_.remarks.push_back(
                    fmt::format("{}: {} is left out: values at the corners of elements", soup_.path, name));
            }
        }
        const std::string closing = "$End" + name.substr(1);
        require(in_.word() == closing, closing + " was expected");
    }

    /// Skips to the closing line.
    void skip_section(const std::string& name) {
        if (!in_.seek_text("$End" + name.substr(1))) {
            in_.fail("section " + name + " does not end");
        }
    }

    void read_format() {
        require(version_ == Version::unknown, "$MeshFormat appears twice");
        const std::string version{in_.word()};
        const bool is_v2 = version == "2" || version == "2.0" || version == "2.1" || version == "2.2";
        require(is_v2 || version == "4.1",
                "MSH version " + version.substr(0, 20) + " is not read; save the mesh as version 4.1 or 2.2");
        version_ = is_v2 ? Version::v2 : Version::v4;
        const int binary = in_.parsed<int>("a file type, 0 or 1,");
        require(binary == 0 || binary == 1, "a file type, 0 or 1, was expected");
        size_width_ = in_.parsed<int>("a data size");
        require(size_width_ == 8 || (size_width_ == 4 && !is_v2), "a data size of 4 or 8 was expected");
        in_.line();
        in_.set_binary(binary == 1);
        if (in_.binary()) {
            constexpr std::int32_t swapped_one = 0x01000000;
            const auto mark = in_.raw<std::int32_t>("the byte order mark");
            require(mark == 1 || mark == swapped_one, "the byte order mark, a binary 1, was expected");
            in_.set_swapped(mark == swapped_one);
        }
    }

    void read_physical_names() {
        const std::size_t count =
            in_.plausible(in_.parsed<std::uint64_t>("a count of names"), 3 * least_text, "names");
        for (std::size_t i = 0; i < count; ++i) {
            const int dimension = in_.parsed<int>("a dimension");
            require(dimension >= 0 && dimension <= 3, fmt::format("{} is no dimension", dimension));
            const int number = in_.parsed<int>("a physical group's number");
            require(number > 0, fmt::format("{} is no number of a physical group", number));
            names_[static_cast<std::size_t>(dimension)][number] = as_utf8(in_.quoted());
        }
    }

    // --- values of 4.1 ---

    std::uint64_t size_value(const char* what) {
        return in_.binary() && size_width_ == 4 ? in_.raw<std::uint32_t>(what)
                                                : in_.number<std::uint64_t>(what);
    }

    template<class T>
    void size_values(T* out, std::size_t count, const char* what) {
        if (in_.binary() && size_width_ == 4) {
            for (std::size_t i = 0; i < count; ++i) {
                out[i] = in_.raw<std::uint32_t>(what);
            }
        } else {
            in_.numbers(out, count, what);
        }
    }

    /// A checked count of items that each take `binary_bytes` or, as text, `words` words.
    std::size_t counted(std::uint64_t count, std::size_t binary_bytes, std::size_t words,
                        const char* what) const {
        return in_.plausible(count, in_.binary() ? binary_bytes : words * least_text - 1, what);
    }

    // --- entities ---

    void read_entities() {
        require(version_ == Version::v4, "$Entities was not expected in MSH 2");
        read_entity_lists(false);
    }

    /// Reads the parts of the model's entities in partitions, and the interfaces between these.
    void read_partitioned_entities() {
        require(version_ == Version::v4, "$PartitionedEntities was not expected in MSH 2");
        size_value("a count of partitions");
        const std::size_t ghosts = counted(size_value("a count of ghost entities"), 8, 2, "ghost entities");
        for (std::size_t i = 0; i < ghosts; ++i) {
            in_.number<std::int32_t>("a ghost entity's number");
            in_.number<std::int32_t>("a partition");
        }
        read_entity_lists(true);
    }

    void read_entity_lists(bool partitioned) {
        std::array<std::uint64_t, 4> counts{};
        size_values(counts.data(), 4, "a count of entities");
        for (std::size_t dimension = 0; dimension < 4; ++dimension) {
            const std::size_t count = counted(counts[dimension], 32, 5, "entities");
            for (std::size_t i = 0; i < count; ++i) {
                read_entity(dimension, partitioned);
            }
        }
    }

    void read_entity(std::size_t dimension, bool partitioned) {
        const auto tag = in_.number<std::int32_t>("an entity's number");
        if (partitioned) {
            const auto parent_dimension = in_.number<std::int32_t>("the dimension of an entity's parent");
            const auto parent = in_.number<std::int32_t>("the number of an entity's parent");
            parent_of_[dimension][tag] = {parent_dimension, parent};
            read_tags("partitions");
        }
        std::array<double, 6> box{};
        in_.numbers(box.data(), dimension == 0 ? 3 : 6, "an entity's box");
        const std::vector<std::int32_t> groups = read_tags("physical groups");
        physical_of_[dimension][tag] = first_positive(groups);
        if (groups.size() > 1) {
            groups_of_[dimension][tag] = groups;
        }
        if (dimension > 0) {
            read_tags("bounding entities");
        }
    }

    std::vector<std::int32_t> read_tags(const char* what) {
        std::vector<std::int32_t> tags(counted(size_value(what), sizeof(std::int32_t), 1, what));
        in_.numbers(tags.data(), tags.size(), what);
        return tags;
    }

    /// Gmsh writes the negative number of a group that holds the entity reversed.
    static PatchNumber first_positive(const std::vector<std::int32_t>& tags) {
        const auto found = std::find_if(tags.begin(), tags.end(), [](std::int32_t tag) { return tag > 0; });
        return found != tags.end() ? *found : tags.empty() ? 0 : positive(tags.front());
    }
    static PatchNumber positive(std::int32_t tag) {
        return tag == std::numeric_limits<std::int32_t>::min() ? 0 : std::abs(tag);
    }

    // --- nodes ---

    /// `parametric` (MSH 2 only): nodes have parameters on the model's entities, which are skipped.
    void read_nodes(bool parametric) {
        require(!nodes_read_, "$Nodes appears twice");
        require(!parametric || version_ == Version::v2, "$ParametricNodes was not expected in MSH 4");
        const std::size_t start = in_.offset();
        const std::uint64_t claimed =
            version_ == Version::v4 ? read_node_blocks() : read_node_list(parametric);
        require(claimed == soup_.points.size(),
                fmt::format("{} nodes are claimed, {} are there", claimed, soup_.points.size()));
        nodes_ = TagIndex{soup_.point_tags};
        if (const auto tag = nodes_.repeated()) {
            in_.fail_at(start, fmt::format("node {} appears twice", *tag));
        }
        nodes_read_ = true;
    }

    std::uint64_t read_node_blocks() {
        std::array<std::uint64_t, 4> head{}; // blocks, nodes, smallest and largest tag
        size_values(head.data(), 4, "the counts of nodes");
        const std::size_t blocks = counted(head[0], 16, 4, "blocks of nodes");
        reserve_nodes(counted(head[1], 28, 4, "nodes"));
        for (std::size_t i = 0; i < blocks; ++i) {
            read_node_block();
        }
        return head[1];
    }

    void read_node_block() {
        const auto dimension = in_.number<std::int32_t>("an entity's dimension");
        require(dimension >= 0 && dimension <= 3, fmt::format("{} is no dimension", dimension));
        in_.number<std::int32_t>("an entity's number");
        const bool parametric = in_.number<std::int32_t>("0 or 1") != 0;
        const std::size_t count = counted(size_value("a count of nodes"), 28, 4, "nodes");
        const std::size_t first = soup_.points.size();
        soup_.points.resize(first + count);
        soup_.point_tags.resize(first + count);
        size_values(soup_.point_tags.data() + first, count, "node numbers");
        if (!parametric && count > 0) {
            in_.numbers(soup_.points[first].data(), 3 * count, "node coordinates");
        }
        for (std::size_t i = first; parametric && i < first + count; ++i) {
            in_.numbers(soup_.points[i].data(), 3, "node coordinates");
            std::array<double, 3> parameters{};
            in_.numbers(parameters.data(), static_cast<std::size_t>(dimension), "node parameters");
        }
        require_finite(first);
    }

    std::uint64_t read_node_list(bool parametric) {
        const auto claimed = in_.parsed<std::uint64_t>("the count of nodes");
        in_.line();
        const std::size_t count = counted(claimed, 28, 4, "nodes");
        reserve_nodes(count);
        for (std::size_t i = 0; i < count; ++i) {
            soup_.point_tags.push_back(in_.number<std::int32_t>("a node's number"));
            Point<3> x{};
            in_.numbers(x.data(), 3, "node coordinates");
            soup_.points.push_back(x);
            if (parametric) {
                pass_parameters();
            }
            require_finite(i);
        }
        return claimed;
    }

    /// Skips parameters: one on a curve, two on a surface, none elsewhere.
    void pass_parameters() {
        const auto dimension = in_.number<std::int32_t>("an entity's dimension");
        require(dimension >= 0 && dimension <= 3, fmt::format("{} is no dimension", dimension));
        in_.number<std::int32_t>("an entity's number");
        std::array<double, 2> parameters{};
        in_.numbers(parameters.data(), dimension < 3 ? static_cast<std::size_t>(dimension) : 0,
                    "node parameters");
    }

    void reserve_nodes(std::size_t count) {
        checked_index(count, "nodes");
        soup_.points.reserve(count);
        soup_.point_tags.reserve(count);
    }

    void require_finite(std::size_t first) const {
        for (std::size_t i = first; i < soup_.points.size(); ++i) {
            for (const double x : soup_.points[i]) {
                if (!std::isfinite(x)) {
                    in_.fail(fmt::format("node {} has a coordinate that is not a finite number",
                                         soup_.point_tags[i]));
                }
            }
        }
    }

    // --- elements ---

    void read_elements() {
        require(nodes_read_, "$Nodes was expected before $Elements");
        require(!elements_read_, "$Elements appears twice");
        const std::uint64_t claimed = version_ == Version::v4 ? read_element_blocks()
                                      : in_.binary()          ? read_binary_elements()
                                                              : read_text_elements();
        require(claimed == element_count_,
                fmt::format("{} elements are claimed, {} are there", claimed, element_count_));
        elements_read_ = true;
    }

    GmshSimplex simplex(int type, std::int64_t tag) const {
        const GmshSimplex simplex = gmsh_simplex(type);
        if (simplex.dimension < 0) {
            in_.fail(fmt::format(
                "element {} is a {}; only points and straight lines, triangles and tetrahedra are read; mesh "
                "without recombination into quadrangles or hexahedra",
                tag, gmsh_type_name(type)));
        }
        if (simplex.is_curved() && !options_.linear) {
            in_.fail(fmt::format("element {} is a {}; {}", tag, gmsh_type_name(type), how_to_take_corners));
        }
        return simplex;
    }

    std::uint64_t read_element_blocks() {
        std::array<std::uint64_t, 4> head{}; // blocks, elements, smallest and largest tag
        size_values(head.data(), 4, "the counts of elements");
        const std::size_t blocks = counted(head[0], 16, 4, "blocks of elements");
        elements_claimed_ = head[1];
        for (std::size_t i = 0; i < blocks; ++i) {
            read_element_block();
        }
        return head[1];
    }

    void read_element_block() {
        const auto entity_dimension = in_.number<std::int32_t>("an entity's dimension");
        const auto entity = in_.number<std::int32_t>("an entity's number");
        const auto type = in_.number<std::int32_t>("an element type");
        const std::uint64_t claimed = size_value("a count of elements");
        if (claimed == 0) {
            return;
        }
        if (is_refused(type)) { // only the tag is needed, for the message
            simplex(type, static_cast<std::int64_t>(size_value("an element's number")));
        }
        const GmshSimplex kind = simplex(type, 0);
        const auto dimension = static_cast<std::size_t>(kind.dimension);
        require(entity_dimension == static_cast<std::int32_t>(dimension),
                fmt::format("elements of dimension {} on an entity of dimension {}", dimension,
                            entity_dimension));
        const std::size_t row = static_cast<std::size_t>(kind.nodes) + 1;
        const std::size_t count =
            counted(claimed, row * static_cast<std::size_t>(size_width_), row, "elements");
        const auto parent = parent_of_[dimension].find(entity);
        const bool is_part = parent != parent_of_[dimension].end();
        if (is_part && parent->second.dimension != entity_dimension) {
            SimplexBlock interface; // between partitions, not part of the model
            read_rows(interface, kind, count);
            return;
        }
        const PatchNumber physical = physical_of(dimension, entity);
        SimplexBlock& block = soup_.simplices[dimension];
        reserve_elements(block, dimension);
        block.physical.resize(block.physical.size() + count, physical);
        block.entity.resize(block.entity.size() + count, is_part ? parent->second.number : entity);
        read_rows(block, kind, count);
    }

    bool is_refused(int type) const {
        const GmshSimplex simplex = gmsh_simplex(type);
        return simplex.dimension < 0 || (simplex.is_curved() && !options_.linear);
    }

    /// Reserves addresses for all elements that may follow, so that arrays never move; memory is taken only
    /// as they are filled.
    void reserve_elements(SimplexBlock& block, std::size_t dimension) const {
        if (!block.tags.empty()) {
            return;
        }
        const std::size_t corners = dimension + 1;
        const std::size_t least_row = in_.binary() ? (corners + 1) * 4 : (corners + 1) * least_text - 1;
        const std::size_t most = std::min(elements_claimed_ - std::min(elements_claimed_, element_count_),
                                          std::uint64_t{in_.remaining() / least_row});
        block.vertices.reserve(most * corners);
        block.tags.reserve(most);
        block.physical.reserve(most);
        block.entity.reserve(most);
    }

    /// Reads rows of an element's number and its nodes' numbers.
    void read_rows(SimplexBlock& block, const GmshSimplex& kind, std::size_t count) {
        const auto corners = static_cast<std::size_t>(kind.dimension) + 1;
        const auto nodes = static_cast<std::size_t>(kind.nodes);
        const std::size_t next = block.tags.size();
        checked_index(next + count, "elements");
        block.tags.resize(next + count);
        block.vertices.resize((next + count) * corners);
        const Rows rows{in_.offset(), corners, nodes, block.tags.data() + next,
                        block.vertices.data() + next * corners};
        if (in_.binary() && size_width_ == 8 && !kind.is_curved()) {
            parallel_for(count, 16 * rows_at_once,
                         [&](std::size_t begin, std::size_t end) { copy_rows(rows, begin, end); });
            in_.seek(in_.offset() + count * (corners + 1) * sizeof(std::int64_t));
        } else {
            parse_rows(rows, count);
        }
        corners_only_.add_cells(kind.is_curved() ? count : 0);
        element_count_ += count;
    }

    static constexpr std::size_t rows_at_once = 512;              // rows of straight simplices
    using RowValues = std::array<std::int64_t, rows_at_once * 5>; // up to 1 + 4 in a row

    /// A block of elements in the file, and its destination.
    struct Rows {
        std::size_t byte;
        std::size_t corners;
        std::size_t nodes; ///< corners and more
        std::int64_t* tags;
        Index* vertices;
    };

    void parse_rows(const Rows& all, std::size_t count) {
        RowValues values;
        const std::size_t at_once = values.size() / (all.nodes + 1);
        for (std::size_t done = 0; done < count; done += at_once) {
            const std::size_t rows = std::min(at_once, count - done);
            size_values(values.data(), rows * (all.nodes + 1), "elements");
            take_rows(all, done, rows, values, in_.offset());
            take_nodes_between(all, rows, values);
        }
    }

    /// Reads rows [begin, end) directly from the file, without moving the cursor.
    void copy_rows(const Rows& all, std::size_t begin, std::size_t end) const {
        const std::size_t row_bytes = (all.corners + 1) * sizeof(std::int64_t);
        RowValues values;
        for (std::size_t done = begin; done < end; done += rows_at_once) {
            const std::size_t rows = std::min(rows_at_once, end - done);
            const std::size_t byte = all.byte + done * row_bytes;
            file_.copy(byte, byte + rows * row_bytes, reinterpret_cast<char*>(values.data()));
            if (in_.swapped()) {
                std::transform(values.begin(), values.end(), values.begin(), [](const std::int64_t& value) {
                    return load<std::int64_t>(reinterpret_cast<const char*>(&value), true);
                });
            }
            take_rows(all, done, rows, values, byte);
        }
    }

    /// Stores rows from `first` on, which were read from a byte of the file.
    void take_rows(const Rows& all, std::size_t first, std::size_t count, const RowValues& values,
                   std::size_t byte) const {
        const std::int64_t* value = values.data();
        Index* vertex = all.vertices + first * all.corners;
        for (std::size_t i = first; i < first + count; ++i) {
            const std::int64_t tag = *value++;
            all.tags[i] = tag;
            for (std::size_t k = 0; k < all.corners; ++k) {
                *vertex++ = node(*value++, tag, byte);
            }
            value += all.nodes - all.corners;
        }
    }

    void take_nodes_between(const Rows& all, std::size_t count, const RowValues& values) {
        for (std::size_t i = 0; i < count; ++i) {
            const std::int64_t* row = values.data() + i * (all.nodes + 1);
            for (std::size_t k = all.corners; k < all.nodes; ++k) {
                corners_only_.add_between(node(row[1 + k], row[0]), soup_.points.size());
            }
        }
    }

    Index node(std::int64_t node_tag, std::int64_t element_tag) const {
        return node(node_tag, element_tag, in_.offset());
    }

    Index node(std::int64_t node_tag, std::int64_t element_tag, std::size_t byte) const {
        const Index index = nodes_.find(node_tag);
        if (index == no_index) {
            in_.fail_at(byte,
                        fmt::format("element {} names node {}, which does not exist; write the mesh again",
                                    element_tag, node_tag));
        }
        return index;
    }

    PatchNumber physical_of(std::size_t dimension, std::int32_t entity) {
        const auto found = physical_of_[dimension].find(entity);
        const PatchNumber physical = found == physical_of_[dimension].end() ? 0 : found->second;
        if (physical > 0) {
            names_[dimension].try_emplace(physical);
        }
        return physical;
    }

    std::uint64_t read_text_elements() {
        const auto claimed = in_.parsed<std::uint64_t>("the count of elements");
        const std::size_t count = counted(claimed, 1, 4, "elements");
        elements_claimed_ = claimed;
        for (std::size_t i = 0; i < count; ++i) {
            const auto tag = in_.parsed<std::int32_t>("an element's number");
            const GmshSimplex kind = simplex(in_.parsed<int>("an element type"), tag);
            read_legacy_element(tag, kind, in_.parsed<std::uint32_t>("a count of tags"));
        }
        return claimed;
    }

    std::uint64_t read_binary_elements() {
        const auto claimed = in_.parsed<std::uint64_t>("the count of elements");
        in_.line();
        counted(claimed, 8, 1, "elements");
        elements_claimed_ = claimed;
        while (element_count_ < claimed) {
            std::array<std::int32_t, 3> head{}; // type, elements, tags of each
            in_.numbers(head.data(), head.size(), "a head of elements");
            require(head[1] > 0 && head[2] >= 0, "a count of elements was expected");
            if (is_refused(head[0])) {
                simplex(head[0], in_.raw<std::int32_t>("an element's number"));
            }
            const GmshSimplex kind = simplex(head[0], 0);
            for (std::int32_t i = 0; i < head[1]; ++i) {
                const auto tag = in_.raw<std::int32_t>("an element's number");
                read_legacy_element(tag, kind, static_cast<std::uint32_t>(head[2]));
            }
        }
        return claimed;
    }

    /// Reads an element of MSH 2 after its number and type. The first tags are physical group and entity.
    void read_legacy_element(std::int64_t tag, const GmshSimplex& kind, std::uint32_t tag_count) {
        const auto dimension = static_cast<std::size_t>(kind.dimension);
        std::array<std::int32_t, 2> tags{};
        for (std::uint32_t i = 0; i < tag_count; ++i) {
            const auto value = in_.number<std::int32_t>("an element's tag");
            if (i < tags.size()) {
                tags[i] = value;
            }
        }
        SimplexBlock& block = soup_.simplices[dimension];
        reserve_elements(block, dimension);
        for (std::size_t k = 0; k <= dimension; ++k) {
            block.vertices.push_back(node(in_.number<std::int32_t>("a node's number"), tag));
        }
        for (int k = kind.dimension + 1; k < kind.nodes; ++k) {
            corners_only_.add_between(node(in_.number<std::int32_t>("a node's number"), tag),
                                      soup_.points.size());
        }
        corners_only_.add_cells(kind.is_curved() ? 1 : 0);
        const PatchNumber physical = positive(tags[0]);
        block.tags.push_back(tag);
        block.physical.push_back(physical);
        block.entity.push_back(tags[1]);
        if (physical > 0) {
            names_[dimension].try_emplace(physical);
        }
        ++element_count_;
    }

    // --- data ---

    struct DataHead {
        std::string name;
        std::size_t components;
        std::uint64_t rows;
    };

    DataHead read_data_head() {
        const auto heads = [&](const char* what) {
            const auto count = in_.plausible(in_.parsed<std::uint64_t>(what), 1, what);
            in_.line();
            return count;
        };
        DataHead head;
        const std::size_t strings = heads("a count of string tags");
        for (std::size_t i = 0; i < strings; ++i) {
            const std::string text = in_.quoted();
            head.name = i == 0 ? text : head.name;
        }
        const std::size_t reals = heads("a count of real tags");
        for (std::size_t i = 0; i < reals; ++i) {
            in_.parsed<double>("a real tag");
        }
        std::array<std::uint64_t, 3> integers{}; // time step, components, rows
        const auto count = in_.parsed<std::uint64_t>("a count of integer tags");
        require(count >= 3 && count <= 4, "three or four integer tags were expected");
        for (std::size_t i = 0; i < count; ++i) {
            const auto value = in_.parsed<std::uint64_t>("an integer tag");
            if (i < integers.size()) {
                integers[i] = value;
            }
        }
        in_.line();
        constexpr std::uint64_t most_components = 1000;
        require(integers[1] >= 1 && integers[1] <= most_components, "a number of components was expected");
        head.components = static_cast<std::size_t>(integers[1]);
        head.rows = integers[2];
        return head;
    }

    /// Data of all nodes, or of all elements of the top dimension, become arrays; other data are left out
    /// with a remark.
    void read_data(const std::string& section) {
        const bool on_nodes = section == "$NodeData";
        require(on_nodes ? nodes_read_ : elements_read_, section + " was expected after what it describes");
        const DataHead head = read_data_head();
        const std::size_t row_bytes = sizeof(std::int32_t) + sizeof(double) * head.components;
        const std::size_t rows = counted(head.rows, row_bytes, 1 + head.components, "rows of data");
        if (!on_nodes && element_of_ == nullptr) {
            element_of_ = std::make_unique<TagIndex>(top_block().tags);
        }
        const TagIndex& index = on_nodes ? nodes_ : *element_of_;
        const std::size_t wanted = on_nodes ? soup_.points.size() : top_block().tags.size();
        if (rows < wanted) {
            in_.binary() ? in_.seek(in_.offset() + rows * row_bytes) : skip_section(section);
            remark_partial(head.name, on_nodes);
            return;
        }
        Array<double> values(wanted * head.components);
        if (read_data_rows(rows, head.components, index, wanted, values)) {
            auto& arrays = on_nodes ? soup_.point_data : soup_.cell_data;
            arrays.push_back({head.name, static_cast<int>(head.components), std::move(values)});
        } else {
            remark_partial(head.name, on_nodes);
        }
    }

    void remark_partial(const std::string& array, bool on_nodes) {
        soup_.remarks.push_back(fmt::format("{}: the array \"{}\" is left out: it has no value for some {}",
                                            soup_.path, readable(array), on_nodes ? "nodes" : "elements"));
    }

    /// Reads rows of data; returns whether each of the `wanted` got its row.
    bool read_data_rows(std::size_t rows, std::size_t components, const TagIndex& index, std::size_t wanted,
                        Array<double>& values) {
        std::size_t in_order = 0;
        std::vector<bool> given; // only used if rows are not in order, as it is as long as the mesh
        std::vector<double> row(components);
        for (std::size_t i = 0; i < rows; ++i) {
            const Index place = index.find(in_.number<std::int32_t>("a number of a node or element"));
            in_.numbers(row.data(), components, "a value");
            if (place == no_index) { // data may also be on elements of a lower dimension
                continue;
            }
            std::copy(row.begin(), row.end(),
                      values.begin() + static_cast<std::ptrdiff_t>(place * components));
            if (given.empty() && place == in_order) {
                ++in_order;
                continue;
            }
            if (given.empty()) {
                given.assign(wanted, false);
                std::fill_n(given.begin(), in_order, true);
            }
            given[place] = true;
        }
        return given.empty() ? in_order == wanted
                             : std::all_of(given.begin(), given.end(), [](bool one) { return one; });
    }

    const SimplexBlock& top_block() const {
        return soup_.simplices[static_cast<std::size_t>(soup_.top_dimension())];
    }

    void list_groups() {
        for (std::size_t dimension = 0; dimension < 4; ++dimension) {
            for (const auto& [number, name] : names_[dimension]) {
                soup_.groups[dimension].push_back({number, name});
            }
        }
    }

    /// Elements of an entity in several groups are in the first one only; remarks on groups that stay empty.
    void remark_on_groups() {
        constexpr std::array<const char*, 4> kinds{"points", "lines", "triangles", "tetrahedra"};
        std::map<std::pair<std::size_t, std::vector<std::int32_t>>, std::size_t> counts;
        for (std::size_t d = 0; d < 4; ++d) {
            for (std::size_t i = 0; !groups_of_[d].empty() && i < soup_.simplices[d].entity.size(); ++i) {
                const std::int32_t entity = soup_.simplices[d].entity[i];
                const auto groups = groups_of_[d].find(entity);
                if (groups != groups_of_[d].end()) {
                    ++counts[{d, groups->second}];
                }
            }
        }
        for (const auto& [where, count] : counts) {
            const auto& [d, groups] = where;
            std::vector<std::string> names;
            for (const std::int32_t group : groups) {
                const std::string& name = names_[d][positive(group)];
                names.push_back(name.empty() ? fmt::format("{}", positive(group)) : name);
            }
            const PatchNumber first = first_positive(groups);
            soup_.remarks.push_back(
                fmt::format("{}: {} {} are in several physical groups, \"{}\"; they count in \"{}\" only",
                            soup_.path, count, kinds[d], fmt::join(names, "\", \""),
                            names_[d][first].empty() ? fmt::format("{}", first) : names_[d][first]));
        }
    }

    /// MSH 2.2 lists a cell once for each of its groups.
    void remark_on_repeated() {
        constexpr std::array<const char*, 4> kinds{"points", "lines", "triangles", "tetrahedra"};
        for (std::size_t d = 0; version_ == Version::v2 && d < soup_.simplices.size(); ++d) {
            const SimplexBlock& block = soup_.simplices[d];
            const std::size_t repeated = has_overlapping_groups(block) ? repeated_cells(block, d + 1) : 0;
            if (repeated > 0) {
                soup_.remarks.push_back(fmt::format(
                    "{}: {} {} are listed again for another physical group, as MSH 2.2 does with groups that "
                    "overlap; leave such groups out, or write version 4.1",
                    soup_.path, repeated, kinds[d]));
            }
        }
    }

    /// Whether cells of one entity are in several groups, which does not yet mean that cells are repeated.
    static bool has_overlapping_groups(const SimplexBlock& block) {
        std::map<std::int32_t, PatchNumber> group_of;
        for (std::size_t i = 0; i < std::min(block.entity.size(), block.physical.size()); ++i) {
            if (group_of.try_emplace(block.entity[i], block.physical[i]).first->second != block.physical[i]) {
                return true;
            }
        }
        return false;
    }

    static std::size_t repeated_cells(const SimplexBlock& block, std::size_t corners) {
        std::vector<std::array<Index, 4>> cells(block.vertices.size() / corners);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            cells[i].fill(no_index);
            std::copy_n(block.vertices.begin() + static_cast<std::ptrdiff_t>(i * corners), corners,
                        cells[i].begin());
            std::sort(cells[i].begin(), cells[i].end());
        }
        std::sort(cells.begin(), cells.end());
        return static_cast<std::size_t>(cells.end() - std::unique(cells.begin(), cells.end()));
    }

    struct Parent {
        std::int32_t dimension;
        std::int32_t number;
    };

    const FileBytes& file_;
    FileCursor in_;
    const ReadOptions& options_;
    CornersOnly corners_only_;
    Soup soup_;
    Version version_ = Version::unknown;
    int size_width_ = 8; ///< bytes of a size_t of MSH 4.1
    bool nodes_read_ = false;
    bool elements_read_ = false;
    std::uint64_t elements_claimed_ = 0;
    std::uint64_t element_count_ = 0;
    TagIndex nodes_;
    std::unique_ptr<TagIndex> element_of_; ///< elements of the top dimension; made when data need it
    std::array<std::map<PatchNumber, std::string>, 4> names_;
    std::array<std::map<std::int32_t, PatchNumber>, 4> physical_of_;             ///< an entity's group
    std::array<std::map<std::int32_t, std::vector<std::int32_t>>, 4> groups_of_; ///< its groups, if several
    std::array<std::map<std::int32_t, Parent>, 4> parent_of_; ///< the model's entity of a part
};

} // namespace

Soup read_msh(const std::filesystem::path& path) {
    return read_msh(path, ReadOptions{});
}

Soup read_msh(const std::filesystem::path& path, const ReadOptions& options) {
    FileBytes file{path};
    return MshReader{file, options}.read();
}

} // namespace slabhull::io
