// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/io/files.h"

#include "io/vtk/xml_text.h"
#include "io/xdmf/hdf5_file.h"
#include "io/xdmf/xdmf_names.h"
#include "slabhull/core/error.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <limits>
#include <set>

namespace slabhull::io {

static_assert(std::endian::native == std::endian::little,
              "files are written in the machine's own byte order");

namespace {

/// A dataset to be written.
struct Dataset {
    Hdf5Type type = Hdf5Type::float64;
    std::size_t rows = 0;
    int components = 1;
    RowFill fill;
};

template<class Stored, class Given>
Dataset dataset(Hdf5Type type, const Column<Given>& column) {
    return {type, column.rows(), column.components(), stored_as<Stored>(column)};
}

Dataset dataset(const DataColumn& data) {
    return std::visit(
        [&](const auto& column) {
            switch (data.type) {
            case Scalar::int64:
                return dataset<std::int64_t>(Hdf5Type::int64, column);
            case Scalar::int32:
                return dataset<std::int32_t>(Hdf5Type::int32, column);
            case Scalar::float64:
                break;
            }
            return dataset<double>(Hdf5Type::float64, column);
        },
        data.values);
}

/// Texts are bytes, each text ended by a zero.
Dataset dataset(const DataArray& data) {
    if (const auto* texts = std::get_if<std::vector<std::string>>(&data.values)) {
        std::string bytes;
        for (const std::string& text : *texts) {
            bytes += text.substr(0, text.find('\0')) + '\0';
        }
        return {Hdf5Type::uint8, bytes.size(), 1, [bytes](std::size_t begin, std::size_t end, char* out) {
                    bytes.copy(out, end - begin, begin);
                }};
    }
    if (const auto* integers = std::get_if<IntegerList>(&data.values)) {
        return dataset<std::int64_t>(Hdf5Type::int64, integer_column(*integers, data.components));
    }
    const auto& reals = std::get<Array<double>>(data.values);
    return dataset<double>(Hdf5Type::float64, Column<double>::over(std::span{reals}, data.components));
}

/// Int32 if the largest number fits, which halves the file.
Dataset cells_dataset(const MeshColumns& mesh) {
    return mesh.points.rows() <= std::numeric_limits<std::int32_t>::max()
               ? dataset<std::int32_t>(Hdf5Type::int32, mesh.cells)
               : dataset<std::int64_t>(Hdf5Type::int64, mesh.cells);
}

/// Points and times side by side.
Column<double> with_times(const Column<double>& points, const Column<double>& times) {
    return {points.rows(), 4, [points, times](std::size_t begin, std::size_t end, double* out) {
                std::vector<double> t(end - begin);
                times.fill(begin, end, t.data());
                for_each_row(points, begin, end, [&](std::size_t row, const double* x) {
                    out = std::copy_n(x, 3, out);
                    *out++ = t[row - begin];
                });
            }};
}

const Column<double>* times_of(const MeshColumns& mesh) {
    const auto found =
        std::find_if(mesh.point_data.begin(), mesh.point_data.end(), [](const DataColumn& data) {
            return data.name == "t" && std::holds_alternative<Column<double>>(data.values) &&
                   components_of(data) == 1;
        });
    return mesh.dimension < 3 || found == mesh.point_data.end() ? nullptr
                                                                : &std::get<Column<double>>(found->values);
}

const char* attribute_type(int components) {
    return components == 1 ? "Scalar" : components == 3 ? "Vector" : components == 9 ? "Tensor" : "Matrix";
}

const char* number_type(Hdf5Type type) {
    return type == Hdf5Type::float64 ? "Float" : type == Hdf5Type::uint8 ? "UChar" : "Int";
}

int precision(Hdf5Type type) {
    return type == Hdf5Type::uint8 ? 1 : type == Hdf5Type::int32 ? 4 : 8;
}

/// The XML, which is short, and the datasets, which it names.
class XdmfWriter {
public:
    XdmfWriter(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh)
        : mesh_{mesh}, data_name_{path.stem().string() + ".h5"},
          data_{open_data(files, path).temporary(), (path.parent_path() / data_name_).string()},
          file_{files.open(path)} {}

    void write() {
        file_.write("<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n"
                    "<Xdmf Version=\"3.0\">\n<Domain>\n<Grid Name=\"mesh\" GridType=\"Uniform\">\n");
        write_topology();
        file_.write("<Geometry GeometryType=\"XYZ\">\n");
        write_item("/points", dataset<double>(Hdf5Type::float64, mesh_.points));
        file_.write("</Geometry>\n");
        write_fields();
        if (const Column<double>* times = times_of(mesh_)) {
            write_attribute("Node", "/", xdmf_space_time,
                            dataset<double>(Hdf5Type::float64, with_times(mesh_.points, *times)));
        }
        for (const DataColumn& data : mesh_.point_data) {
            write_attribute("Node", "/point_data/", data.name, dataset(data));
        }
        for (const DataColumn& data : mesh_.cell_data) {
            write_attribute("Cell", "/cell_data/", data.name, dataset(data));
        }
        file_.write("</Grid>\n</Domain>\n</Xdmf>\n");
        data_.close();
    }

private:
    /// Opens the data file before the XML, so that it gets its name first.
    AtomicFile& open_data(AtomicFiles& files, const std::filesystem::path& path) const {
        if (path.filename() == data_name_) {
            throw UsageError(
                fmt::format("{}: XDMF needs this name for its data; call the file .xdmf", path.string()));
        }
        return files.open(path.parent_path() / data_name_);
    }

    void write_topology() {
        const auto d = static_cast<std::size_t>(mesh_.dimension);
        file_.write(
            fmt::format("<Topology TopologyType=\"{}\" NumberOfElements=\"{}\" NodesPerElement=\"{}\">\n",
                        xdmf_topologies[d], mesh_.cells.rows(), d + 1));
        write_item("/cells", cells_dataset(mesh_));
        file_.write("</Topology>\n");
    }

    /// meshio requires XML as the text of any Information: a list of what it calls field data.
    void write_fields() {
        if (mesh_.field_data.empty()) {
            return;
        }
        file_.write(fmt::format("<Information Name=\"{}\">&lt;list/&gt;\n", xdmf_fields));
        for (const DataArray& array : mesh_.field_data) {
            const bool texts = std::holds_alternative<std::vector<std::string>>(array.values);
            file_.write(fmt::format("<Information Name=\"{}\" Value=\"{}\">\n", xml_name(array.name),
                                    texts ? xdmf_texts : ""));
            write_item(unique("/field_data/", array.name), dataset(array));
            file_.write("</Information>\n");
        }
        file_.write("</Information>\n");
    }

    void write_attribute(const char* center, const std::string& group, const std::string& name,
                         const Dataset& data) {
        file_.write(fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">\n",
                                xml_name(name), attribute_type(data.components), center));
        write_item(unique(group, name), data);
        file_.write("</Attribute>\n");
    }

    void write_item(const std::string& name, const Dataset& data) {
        const std::string width = data.components > 1 ? fmt::format(" {}", data.components) : "";
        file_.write(fmt::format("<DataItem Dimensions=\"{}{}\" NumberType=\"{}\" Precision=\"{}\" "
                                "Format=\"HDF\">{}:{}</DataItem>\n",
                                data.rows, width, number_type(data.type), precision(data.type),
                                escaped(data_name_), name));
        data_.write(name, data.type, data.rows, data.components, data.fill);
    }

    /// A unique path in the HDF5 file without characters special to HDF5, to XML, or to readers that split it
    /// at a colon.
    std::string unique(const std::string& group, std::string name) {
        std::replace_if(
            name.begin(), name.end(),
            [](char c) {
                return !((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                         c == '-');
            },
            '_');
        const std::string stem = group + (name.empty() ? "_" : name);
        std::string path = stem;
        for (int again = 2; !names_.insert(path).second; ++again) {
            path = fmt::format("{}_{}", stem, again);
        }
        return path;
    }

    const MeshColumns& mesh_;
    std::string data_name_;
    Hdf5Writer data_;
    AtomicFile& file_;
    std::set<std::string> names_{"/points", "/cells"};
};

} // namespace

void write_xdmf(AtomicFiles& files, const std::filesystem::path& path, const MeshColumns& mesh) {
    XdmfWriter{files, path, mesh}.write();
}

void write_xdmf(const std::filesystem::path& path, const MeshColumns& mesh) {
    AtomicFiles files;
    write_xdmf(files, path, mesh);
    files.commit();
}

} // namespace slabhull::io
