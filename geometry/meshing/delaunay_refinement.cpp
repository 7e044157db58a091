// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/delaunay_refinement.h"

#include "geometry/meshing/delaunay_cavity.h"
#include "geometry/meshing/triangle_shape.h"
#include "geometry/meshing/vertex_star.h"

#include "slabhull/core/progress.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/measures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace slabhull {

namespace {

using plane::Bisector;
using plane::Corners;
using plane::next;
using plane::previous;
using plane::Shape;

/// A triangle is small enough if its circumradius is at most this multiple of the wanted spacing. An
/// equilateral one with the wanted edges has 0.577; this bound gives about as many triangles as if all were
/// equilateral.
constexpr double largest_radius = 0.83;
/// An edge up to this multiple of the wanted spacing may have points placed in front of it.
constexpr double front_edge = 1.2;
/// Least height of a triangle formed by a point in front of an edge, as a multiple of half the edge, whatever
/// the spacing.
constexpr double lowest = 1.2;
constexpr double highest = 3.2;
/// Least distance of a point in front of an edge from all others, as a multiple of the wanted spacing. Nearer
/// to others, where two fronts meet, a circumcentre fits better.
constexpr double elbow_room = 0.7;
/// The same for points that improve angles, unless the shortest edge of the triangle is shorter anyway.
constexpr double mending_room = 0.5;
constexpr double rescue_room = 0.3;
/// Angles are improved up to this many degrees above the wanted one, at next to no cost.
constexpr double ambition = 5;
/// Up to this angle, a circumcentre's distance from all points exceeds the shortest edge of its triangle, so
/// that the refinement terminates.
constexpr double ending = 30;
/// An off-centre makes the angle opposite to the shortest edge this multiple of the wanted one.
constexpr double angle_reserve = 1.15;
/// A rescue must increase the least sine of an angle by this factor.
constexpr double worthwhile = 1.4;
/// Heights tried in a rescue, as multiples of half the edge: angles at the edge of 27, 40, 60 and 70 degrees.
constexpr std::array<double, 4> rescue_heights{0.5, 0.84, 1.73, 2.75};
/// Largest number of moves of one vertex, and the factor by which each must increase the least sine around
/// it.
constexpr unsigned char most_moves = 8;
constexpr double worth_moving = 1.02;
/// Steps tried when moving a vertex, as fractions of the distance to its nearest neighbour.
constexpr std::array<double, 3> move_steps{0.4, 0.15, 0.05};
constexpr int move_directions = 8;
/// Square of the cosine of the largest angle, 120 degrees, of a point over a boundary edge.
constexpr double lens = 0.25;

double radians(double degrees) {
    return degrees * std::numbers::pi / 180;
}
/// Angle below which a triangle is improved, in degrees.
double aim(double min_angle) {
    return std::min(min_angle + ambition, ending);
}

class Refiner {
public:
    Refiner(CapMesh<2>& mesh, const CapSpacing& field, double min_angle)
        : mesh_{mesh}, field_{field}, given_{mesh.points.size()}, cavity_{mesh}, star_{mesh},
          least_sine_{std::sin(radians(std::min(min_angle, ending)))}, aimed_sine_{std::sin(
                                                                           radians(aim(min_angle)))},
          slenderest_{1 / std::tan(radians(angle_reserve * aim(min_angle) / 2))} {}

    void run() {
        for (const Point<2>& p : mesh_.points) {
            spacing_.push_back(field_(p));
        }
        version_.assign(mesh_.cells.size(), 0);
        for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
            enqueue(static_cast<Index>(c));
        }
        Index cell = no_index;
        for (;;) {
            if (take(front_, cell)) {
                make_smaller(cell, true);
            } else if (take(coarse_, cell)) {
                make_smaller(cell, false);
            } else if (take(skinny_, cell)) {
                mend(cell);
            } else if (take(stubborn_, cell)) {
                rescue(cell);
            } else if (take(last_, cell)) {
                relocate(cell);
            } else {
                return;
            }
        }
    }

private:
    /// A first-in, first-out queue, so that the front advances in layers. Entries of replaced cells are
    /// dropped.
    struct Queue {
        struct Entry {
            Index cell;
            Index version;
        };
        Array<Entry> entries;
        std::size_t head = 0;
    };

    void put(Queue& queue, Index cell) { queue.entries.push_back({cell, version_[cell]}); }

    bool take(Queue& queue, Index& cell) {
        while (queue.head < queue.entries.size()) {
            go_on();
            const Queue::Entry entry = queue.entries[queue.head++];
            if (version_[entry.cell] == entry.version) {
                cell = entry.cell;
                return true;
            }
        }
        return false;
    }

    Corners corners(Index cell) const { return corners_of<2, 2>(mesh_.cells[cell], mesh_.points); }

    void enqueue(Index cell) {
        const Corners p = corners(cell);
        const Shape shape{p};
        if (too_large(cell, p, shape)) {
            const double wanted = front_edge * spacing_of_base(cell, shape);
            put(shape.shortest <= wanted * wanted ? front_ : coarse_, cell);
        } else if (shape.sine() < aimed_sine_) {
            put(skinny_, cell);
        }
    }

    bool too_large(Index cell, const Corners& p, const Shape& shape) const {
        const Simplex<2>& c = mesh_.cells[cell];
        const double radius = shape.circumradius();
        if (radius <= largest_radius * (spacing_[c[0]] + spacing_[c[1]] + spacing_[c[2]]) / 3) {
            return false;
        }
        // In the middle of a large triangle the spacing may be larger than at its corners.
        return radius > largest_radius *
                            field_({(p[0][0] + p[1][0] + p[2][0]) / 3, (p[0][1] + p[1][1] + p[2][1]) / 3});
    }

    /// Mean wanted spacing at the shortest edge.
    double spacing_of_base(Index cell, const Shape& shape) const {
        const Simplex<2>& c = mesh_.cells[cell];
        return (spacing_[c[next(shape.apex)]] + spacing_[c[previous(shape.apex)]]) / 2;
    }

    static Bisector base(const Corners& p, const Shape& shape) {
        return {p[next(shape.apex)], p[previous(shape.apex)]};
    }
    static double height_of_circumcentre(const Shape& shape) {
        const double radius = shape.circumradius();
        return std::sqrt(std::max(0.0, radius * radius - shape.shortest / 4));
    }

    void make_smaller(Index cell, bool from_front) {
        const Corners p = corners(cell);
        const Shape shape{p};
        const Bisector above = base(p, shape);
        const double centre = height_of_circumcentre(shape);
        if (from_front) {
            const double height = height_of_front(above, spacing_of_base(cell, shape));
            if (height < centre && insert(cell, above.at(height), elbow_room, 0)) {
                return;
            }
        }
        if (!insert(cell, above.at(centre), 0, 0) && shape.sine() < aimed_sine_) {
            put(skinny_, cell);
        }
    }

    /// Height over an edge at which new edges have the wanted length.
    double height_of_front(const Bisector& above, double at_edge) const {
        const double half = above.half_length();
        const double wanted = (at_edge + field_(above.at(at_edge * std::numbers::sqrt3 / 2))) / 2;
        const double height = std::sqrt(std::max(0.0, wanted * wanted - half * half));
        return std::clamp(height, lowest * half, highest * half);
    }

    void mend(Index cell) {
        const Corners p = corners(cell);
        const Shape shape{p};
        const Bisector above = base(p, shape);
        const double centre = height_of_circumcentre(shape);
        const double off_centre = slenderest_ * above.half_length();
        if (off_centre < centre &&
            insert(cell, above.at(off_centre), mending_room, std::sqrt(shape.shortest))) {
            return;
        }
        if (!insert(cell, above.at(centre), 0, 0) && shape.sine() < least_sine_) {
            put(stubborn_, cell);
        }
    }

    /// Inserts p, unless it is nearer to others than both `room` times the spacing there and `enough`, or too
    /// near to a boundary edge. A circumcentre needs no room: it is as far from all others as from its own
    /// corners.
    bool insert(Index cell, const Point<2>& p, double room, double enough) {
        if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !cavity_.dig(cell, p)) {
            return false;
        }
        const double spacing = field_(p);
        double distance = room * spacing;
        if (enough > 0) {
            distance = std::min(distance, enough);
        }
        for (const DelaunayCavity::Edge& edge : cavity_.rim()) {
            const Point<2>& a = mesh_.points[edge.from];
            const Point<2>& b = mesh_.points[edge.to];
            if (squared_distance(a, p) < distance * distance || (edge.boundary() && encroaches(p, a, b))) {
                return false;
            }
        }
        fill(p, spacing);
        return true;
    }

    /// Whether p is too near to a boundary edge: inside its diametral circle, and in a flat or skinny
    /// triangle.
    bool encroaches(const Point<2>& p, const Point<2>& a, const Point<2>& b) const {
        const Point<2> to_a = minus(a, p);
        const Point<2> to_b = minus(b, p);
        const double cosine = dot(to_a, to_b);
        if (cosine >= 0) {
            return false;
        }
        const bool flat = cosine * cosine > lens * dot(to_a, to_a) * dot(to_b, to_b);
        return flat || Shape{{a, b, p}}.sine() < least_sine_;
    }

    void fill(const Point<2>& p, double spacing) {
        cavity_.fill(p);
        spacing_.push_back(spacing);
        moves_.push_back(0);
        work_done(2); // a point makes two cells more
        version_.resize(mesh_.cells.size(), 0);
        for (const Index cell : cavity_.cells()) {
            ++version_[cell];
            enqueue(cell);
        }
    }

    /// Moves a vertex of a skinny triangle if that improves the angles around it.
    bool relocate(Index cell) {
        for (const Index v : Simplex<2>{mesh_.cells[cell]}) {
            if (v >= given_ && moves_[v - given_] < most_moves && star_.gather(cell, v) &&
                relocate_centre(v)) {
                return true;
            }
        }
        return false;
    }

    bool relocate_centre(Index v) {
        const Point<2> old = mesh_.points[v];
        const double room = std::min(star_.clearance(old), rescue_room * spacing_[v]);
        const double before = star_.least_sine(old);
        double best = before;
        Point<2> place = old;
        const auto attempt = [&](const Point<2>& p) {
            const double sine = star_.least_sine(p);
            if (sine > best && star_.clearance(p) >= room) {
                best = sine;
                place = p;
            }
        };
        attempt(star_.centroid());
        for (const double step : move_steps) {
            const Point<2> middle = place;
            for (int k = 0; k < move_directions; ++k) {
                const double angle = 2 * std::numbers::pi * k / move_directions;
                const double reach = step * star_.clearance(old);
                attempt({middle[0] + reach * std::cos(angle), middle[1] + reach * std::sin(angle)});
            }
        }
        if (best < worth_moving * before) {
            return false;
        }
        ++moves_[v - given_];
        star_.move(place);
        for (const Index cell : star_.cells()) {
            ++version_[cell];
            if (Shape{corners(cell)}.sine() < least_sine_) {
                put(last_, cell);
            }
        }
        return true;
    }

    /// For a skinny triangle protected by boundary edges: inserts the best of a few points over its edges, on
    /// both sides, if that is a clear improvement.
    void rescue(Index cell) {
        const Corners p = corners(cell);
        const Shape shape{p};
        const double shortest = std::sqrt(shape.shortest);
        double best = worthwhile * shape.sine();
        Point<2> place{};
        bool found = false;
        for (std::size_t i = 0; i < 3; ++i) {
            const Bisector above{p[next(i)], p[previous(i)]};
            for (const double height : rescue_heights) {
                for (const double side : {1.0, -1.0}) {
                    const Point<2> q = above.at(side * height * above.half_length());
                    const double gained = gain(cell, q, shortest);
                    if (gained > best) {
                        best = gained;
                        place = q;
                        found = true;
                    }
                }
            }
        }
        if (found && cavity_.dig(cell, place)) {
            fill(place, field_(place));
        } else {
            put(last_, cell);
        }
    }

    /// Least sine of an angle after inserting p; 0 if that is not worthwhile.
    double gain(Index cell, const Point<2>& p, double enough) {
        if (!cavity_.dig(cell, p)) {
            return 0;
        }
        double before = 1;
        for (const Index old : cavity_.cells()) {
            before = std::min(before, Shape{corners(old)}.sine());
        }
        const double distance = std::min(rescue_room * field_(p), enough);
        double after = 1;
        for (const DelaunayCavity::Edge& edge : cavity_.rim()) {
            const Point<2>& a = mesh_.points[edge.from];
            if (squared_distance(a, p) < distance * distance) {
                return 0;
            }
            after = std::min(after, Shape{{a, mesh_.points[edge.to], p}}.sine());
        }
        return after > worthwhile * before ? after : 0;
    }

    CapMesh<2>& mesh_;
    const CapSpacing& field_;
    std::size_t given_;
    DelaunayCavity cavity_;
    VertexStar star_;
    double least_sine_;
    double aimed_sine_;
    double slenderest_; ///< height of an off-centre, as a multiple of half the edge

    Array<double> spacing_;      ///< wanted spacing, by vertex
    Array<Index> version_;       ///< by cell: number of times it was replaced
    Array<unsigned char> moves_; ///< number of moves of each new vertex
    Queue front_;                ///< too large, on an edge of about the wanted length
    Queue coarse_;               ///< too large, all edges too long
    Queue skinny_;               ///< small enough, an angle too small
    Queue stubborn_;             ///< boundary edges forbid the usual points
    Queue last_;                 ///< inserting points does not help
};

} // namespace

void refine_delaunay(CapMesh<2>& mesh, const CapSpacing& field, double min_angle) {
    Refiner{mesh, field, min_angle}.run();
}

} // namespace slabhull
