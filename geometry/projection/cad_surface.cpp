// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/cad_surface.h"

#include "geometry/basics/vector_algebra.h"
#include "geometry/projection/parametric_search.h"

#include "slabhull/core/error.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Extrema_ExtPC.hxx>
#include <Extrema_ExtPS.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Precision.hxx>
#include <STEPConstruct_UnitContext.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <StepData_StepModel.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <fmt/core.h>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>
#include <gp_XYZ.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>
#include <streambuf>
#include <string>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

using namespace detail;

// --- closest points

/// The closest point so far. The tolerance of an edge is added to its distance: where the model's faces and
/// edges disagree by that much, the face is right.
struct Best {
    gp_Pnt point;
    double distance = std::numeric_limits<double>::infinity();

    void offer(const gp_Pnt& candidate, double candidate_distance) {
        if (candidate_distance < distance) {
            point = candidate;
            distance = candidate_distance;
        }
    }
};

Point<3> as_point(const gp_XYZ& p) {
    return {p.X(), p.Y(), p.Z()};
}

/// A closest-point query on a face, for one thread.
class FaceProbe {
public:
    explicit FaceProbe(const TopoDS_Face& face)
        : surface_{face, Standard_False}, inside_{face, Precision::PConfusion()} {
        ParametricSearch::Parameters low;
        ParametricSearch::Parameters high;
        BRepTools::UVBounds(face, low[0], high[0], low[1], high[1]);
        if (surface_.GetType() <= GeomAbs_Torus) {
            const double tolerance = std::min(BRep_Tool::Tolerance(face), Precision::Confusion());
            extrema_.SetFlag(Extrema_ExtFlag_MIN);
            extrema_.Initialize(surface_, low[0], high[0], low[1], high[1],
                                std::max(surface_.UResolution(tolerance), Precision::PConfusion()),
                                std::max(surface_.VResolution(tolerance), Precision::PConfusion()));
        } else {
            // OpenCASCADE's own search takes 0.4 ms on a spline.
            search_.emplace([this](const ParametricSearch::Parameters& at) { return jet(at); }, low, high,
                            samples());
        }
    }
    FaceProbe(const FaceProbe&) = delete; // extrema_ and search_ point to surface_
    FaceProbe& operator=(const FaceProbe&) = delete;

    void offer_closest(const gp_Pnt& x, Best& best) {
        if (search_) {
            search_->visit_feet(as_point(x.XYZ()), best.distance,
                                [&](const ParametricSearch::Parameters& at, const Point<3>&, double) {
                                    offer(x, at, best);
                                    return best.distance;
                                });
            return;
        }
        extrema_.Perform(x);
        for (int i = 1; extrema_.IsDone() && i <= extrema_.NbExt(); ++i) {
            ParametricSearch::Parameters at;
            extrema_.Point(i).Parameter(at[0], at[1]);
            offer(x, at, best);
        }
    }

private:
    void offer(const gp_Pnt& x, const ParametricSearch::Parameters& at, Best& best) const {
        const TopAbs_State state = inside_.Perform({at[0], at[1]});
        if (state == TopAbs_IN || state == TopAbs_ON) {
            const gp_Pnt foot = surface_.Value(at[0], at[1]);
            best.offer(foot, foot.Distance(x));
        }
    }

    SurfaceJet jet(const ParametricSearch::Parameters& at) const {
        gp_Pnt value;
        gp_Vec du, dv, duu, dvv, duv;
        surface_.D2(at[0], at[1], value, du, dv, duu, dvv, duv);
        return {as_point(value.XYZ()), as_point(du.XYZ()),  as_point(dv.XYZ()),
                as_point(duu.XYZ()),   as_point(duv.XYZ()), as_point(dvv.XYZ())};
    }

    /// Several samples per piece of the spline, so that no bend is missed.
    std::array<std::size_t, 2> samples() const {
        constexpr int per_span = 6;
        constexpr int least = 24;
        constexpr int most = 200;
        const auto enough = [&](int spans) {
            return static_cast<std::size_t>(std::clamp(per_span * spans + 1, least, most));
        };
        return {enough(surface_.NbUIntervals(GeomAbs_CN)), enough(surface_.NbVIntervals(GeomAbs_CN))};
    }

    BRepAdaptor_Surface surface_;
    BRepTopAdaptor_FClass2d inside_;
    Extrema_ExtPS extrema_;                  ///< for a simple shape ...
    std::optional<ParametricSearch> search_; ///< ... or for a spline
};

/// A closest-point query on an edge with its ends, for one thread.
class EdgeProbe {
public:
    explicit EdgeProbe(const TopoDS_Edge& edge)
        : curve_{edge}, tolerance_{BRep_Tool::Tolerance(edge)}, ends_{curve_.Value(curve_.FirstParameter()),
                                                                      curve_.Value(curve_.LastParameter())} {
        extrema_.Initialize(curve_, curve_.FirstParameter(), curve_.LastParameter());
    }
    EdgeProbe(const EdgeProbe&) = delete; // extrema_ points to curve_
    EdgeProbe& operator=(const EdgeProbe&) = delete;

    void offer_closest(const gp_Pnt& x, Best& best) {
        extrema_.Perform(x);
        for (int i = 1; extrema_.IsDone() && i <= extrema_.NbExt(); ++i) {
            const gp_Pnt foot = curve_.Value(refined(x, extrema_.Point(i).Parameter()));
            best.offer(foot, foot.Distance(x) + tolerance_);
        }
        for (const gp_Pnt& end : ends_) {
            best.offer(end, end.Distance(x) + tolerance_);
        }
    }

private:
    double refined(const gp_Pnt& x, double t) const {
        constexpr int most_steps = 4;
        for (int step = 0; step < most_steps; ++step) {
            gp_Pnt foot;
            gp_Vec d, dd;
            curve_.D2(t, foot, d, dd);
            const gp_Vec arm{x, foot};
            const double slope = d.Dot(d) + arm.Dot(dd);
            if (!(slope > 0)) {
                return t;
            }
            const double next =
                std::clamp(t - arm.Dot(d) / slope, curve_.FirstParameter(), curve_.LastParameter());
            if (!(curve_.Value(next).SquareDistance(x) <= foot.SquareDistance(x))) {
                return t;
            }
            t = next;
        }
        return t;
    }

    BRepAdaptor_Curve curve_;
    Extrema_ExtPC extrema_;
    double tolerance_;
    std::array<gp_Pnt, 2> ends_;
};

/// A face or an edge of the model, and a box around it.
struct Piece {
    TopoDS_Shape shape;
    Point<3> low;
    Point<3> high;

    double distance(const Point<3>& x) const {
        double square = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double out = std::max({low[k] - x[k], 0.0, x[k] - high[k]});
            square += out * out;
        }
        return std::sqrt(square);
    }
};

/// Queries all pieces, for one thread at a time. Probes of spline faces are slow to make, so each is made
/// when first needed.
class Probes {
public:
    explicit Probes(const std::vector<Piece>& pieces)
        : pieces_{&pieces}, faces_(pieces.size()), edges_(pieces.size()) {}

    Point<3> closest(const Point<3>& x) {
        nearest_.clear();
        for (std::size_t i = 0; i < pieces_->size(); ++i) {
            nearest_.emplace_back((*pieces_)[i].distance(x), i);
        }
        // A heap: only few pieces are examined, so most need not be sorted.
        const auto later = [](const auto& a, const auto& b) { return a > b; };
        std::make_heap(nearest_.begin(), nearest_.end(), later);
        Best best;
        while (!nearest_.empty() && nearest_.front().first <= best.distance) {
            offer(nearest_.front().second, {x[0], x[1], x[2]}, best);
            std::pop_heap(nearest_.begin(), nearest_.end(), later);
            nearest_.pop_back();
        }
        return as_point(best.point.XYZ());
    }

private:
    void offer(std::size_t i, const gp_Pnt& x, Best& best) {
        const TopoDS_Shape& shape = (*pieces_)[i].shape;
        if (shape.ShapeType() == TopAbs_FACE) {
            if (faces_[i] == nullptr) {
                faces_[i] = std::make_unique<FaceProbe>(TopoDS::Face(shape));
            }
            faces_[i]->offer_closest(x, best);
        } else {
            if (edges_[i] == nullptr) {
                edges_[i] = std::make_unique<EdgeProbe>(TopoDS::Edge(shape));
            }
            edges_[i]->offer_closest(x, best);
        }
    }

    const std::vector<Piece>* pieces_;
    std::vector<std::unique_ptr<FaceProbe>> faces_;
    std::vector<std::unique_ptr<EdgeProbe>> edges_;
    std::vector<std::pair<double, std::size_t>> nearest_;
};

Piece piece_of(const TopoDS_Shape& shape) {
    Bnd_Box box;
    BRepBndLib::Add(shape, box, Standard_False);
    Piece piece{shape, {}, {}};
    box.Get(piece.low[0], piece.low[1], piece.low[2], piece.high[0], piece.high[1], piece.high[2]);
    return piece;
}

class CadSurface final : public ProjectionSurface<3> {
public:
    explicit CadSurface(const TopoDS_Shape& shape) {
        TopTools_IndexedMapOfShape faces;
        TopTools_IndexedMapOfShape edges;
        TopExp::MapShapes(shape, TopAbs_FACE, faces);
        for (int i = 1; i <= faces.Extent(); ++i) {
            pieces_.push_back(piece_of(faces(i)));
            TopExp::MapShapes(faces(i), TopAbs_EDGE, edges);
        }
        for (int i = 1; i <= edges.Extent(); ++i) {
            const TopoDS_Edge& edge = TopoDS::Edge(edges(i));
            if (!BRep_Tool::Degenerated(edge)) {
                pieces_.push_back(piece_of(edge));
                tolerance_ = std::max(tolerance_, BRep_Tool::Tolerance(edge));
            }
        }
    }

    bool empty() const { return pieces_.empty(); }

    Point<3> closest(const Point<3>& x) const override {
        Point<3> nowhere;
        nowhere.fill(std::numeric_limits<double>::quiet_NaN());
        if (!all_finite(x)) {
            return nowhere;
        }
        std::unique_ptr<Probes> probes = take_probes();
        try {
            const Point<3> foot = probes->closest(x);
            give_back(std::move(probes));
            return foot;
        } catch (const Standard_Failure&) {
            return nowhere; // the caller reports the point
        }
    }

    double tolerance() const override { return tolerance_; }

private:
    // OpenCASCADE's searches keep state, so a set of them serves one thread at a time. Their results do not
    // depend on earlier queries.
    std::unique_ptr<Probes> take_probes() const {
        const std::lock_guard lock{mutex_};
        if (idle_.empty()) {
            return std::make_unique<Probes>(pieces_);
        }
        std::unique_ptr<Probes> probes = std::move(idle_.back());
        idle_.pop_back();
        return probes;
    }

    void give_back(std::unique_ptr<Probes> probes) const {
        const std::lock_guard lock{mutex_};
        idle_.push_back(std::move(probes));
    }

    std::vector<Piece> pieces_;
    double tolerance_ = 0;
    mutable std::mutex mutex_;
    mutable std::vector<std::unique_ptr<Probes>> idle_;
};

// --- reading

/// The model's first unit of length in millimetres; without one, OpenCASCADE's own.
double length_unit(const STEPControl_Reader& reader) {
    using WithUnits = StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext;
    using WithUncertainty = StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx;
    const Handle(StepData_StepModel) model = reader.StepModel();
    for (int i = 1; i <= model->NbEntities(); ++i) {
        Handle(StepRepr_GlobalUnitAssignedContext) units;
        if (const auto context = Handle(WithUncertainty)::DownCast(model->Value(i)); !context.IsNull()) {
            units = context->GlobalUnitAssignedContext();
        } else if (const auto plain = Handle(WithUnits)::DownCast(model->Value(i)); !plain.IsNull()) {
            units = plain->GlobalUnitAssignedContext();
        }
        STEPConstruct_UnitContext factors;
        if (!units.IsNull() && factors.ComputeFactors(units) == 0 && factors.LengthDone()) {
            return factors.LengthFactor() * reader.SystemLengthUnit(); // relative to the system's unit
        }
    }
    return reader.SystemLengthUnit();
}

/// Null if there is no model.
TopoDS_Shape read_step(std::istream& in) {
    STEPControl_Reader reader;
    if (reader.ReadStream("model", in) != IFSelect_RetDone) {
        return {};
    }
    reader.SetSystemLengthUnit(length_unit(reader));
    reader.TransferRoots();
    return reader.OneShape();
}

TopoDS_Shape read_brep(std::istream& in) {
    TopoDS_Shape shape;
    BRepTools::Read(shape, in, BRep_Builder{});
    return shape;
}

/// Captures the complaints that OpenCASCADE's readers print to stdout, which is for results.
class Complaints {
public:
    Complaints() : stdout_{std::cout.rdbuf(text_.rdbuf())} {
        Message::DefaultMessenger()->ChangePrinters().Clear();
    }
    ~Complaints() { std::cout.rdbuf(stdout_); }
    Complaints(const Complaints&) = delete;
    Complaints& operator=(const Complaints&) = delete;

    /// The first line, in brackets.
    std::string first() const {
        std::string line;
        std::istringstream lines{text_.str()};
        std::getline(lines, line);
        return line.empty() ? "" : fmt::format(" ({})", line);
    }

private:
    std::ostringstream text_;
    std::streambuf* stdout_;
};

TopoDS_Shape read_shape(std::istream& in, CadFormat format, const std::string& name) {
    static std::mutex one_at_a_time; // the readers share global tables
    const std::lock_guard lock{one_at_a_time};
    const Complaints complaints;
    TopoDS_Shape shape;
    try {
        shape = format == CadFormat::step ? read_step(in) : read_brep(in);
    } catch (const Standard_Failure& failure) {
        throw InputError{fmt::format("{}: OpenCASCADE cannot read it: {}{}", name, failure.GetMessageString(),
                                     complaints.first())};
    }
    if (shape.IsNull()) {
        throw InputError{fmt::format("{}: OpenCASCADE finds no model in it{}", name, complaints.first())};
    }
    return shape;
}

} // namespace

bool has_cad_surfaces() {
    return true;
}

ProjectionSurfacePointer<3> cad_surface(std::istream& in, CadFormat format, const std::string& name) {
    auto surface = std::make_shared<const CadSurface>(read_shape(in, format, name));
    if (surface->empty()) {
        throw InputError{fmt::format("{}: the model has no faces to project on", name)};
    }
    return surface;
}

} // namespace slabhull
