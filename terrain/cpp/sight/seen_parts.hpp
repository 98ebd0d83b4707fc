// The parts of triangles that are seen from an eye, in the plane, as convex cells.
//
// Edges are taken from the eye outwards. Before one is added to the horizon, the triangle in front
// of it is cut: between two directions at which the horizon changes it is one edge, whose shadow
// ends on the triangle in a straight line. So each triangle is divided into cells by rays from the
// eye and such lines. This is the visibility map of a terrain, found front to back (Katz, Overmars
// and Sharir, "Efficient hidden surface removal for objects with small union size", 1992; Reif and
// Sen, "An efficient output-sensitive hidden-surface removal algorithm", 1988).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "../../../tin/cpp/base/arrays.hpp"
#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/base/parallel.hpp"
#include "../../../tin/cpp/base/pulse.hpp"
#include "../../../tin/cpp/location/surface.hpp"
#include "arcs.hpp"
#include "directions.hpp"
#include "horizon.hpp"
#include "seen_vertices.hpp"
#include "sight_edges.hpp"

namespace tinsmith::sight {

enum class Part : std::uint8_t { kHidden = 0, kSeen = 1, kDivided = 2, kNone = 3 };

// Cells of the triangles that are divided; the line of a corner is that of the side to the next
// corner: 3 * triangle + corner of an edge, beyond these a ray, kNoLine within a triangle.
struct Cells {
  static constexpr std::int64_t kNoLine = -1;

  std::vector<std::int64_t> offsets{0};
  std::vector<std::int32_t> triangles;
  std::vector<std::uint8_t> seen;
  std::vector<Point> corners;
  std::vector<std::int64_t> lines;
};

class PartFinder {
 public:
  PartFinder(const Surface& surface, const View& view, const Directions& directions,
             const SightEdges& edges, const Arcs& arcs)
      : surface_(surface),
        view_(view),
        directions_(directions),
        edges_(edges),
        arcs_(arcs),
        geometry_(surface, view, directions, arcs),
        first_ray_(std::int64_t{3} * surface.triangle_count),
        horizon_(geometry_, first_ray_ + directions.size()),
        parts_(arcs.size(), Part::kNone) {}

  // One part for each triangle, the cells of those that are divided.
  void run(const std::vector<std::uint32_t>& order, Part* parts, Cells& cells, Pulse& pulse) {
    cells_ = &cells;
    for (const std::uint32_t a : order) {
      if (!pulse.goes_on()) return;
      add(a);
    }
    summarise(parts);
    for (std::uint32_t a = 0; a < arcs_.size(); ++a) {
      const Triangle t = nearer_triangle(arcs_[a].edge);
      if (!surface_.is_triangle(t) || parts[number(t)] != Part::kDivided) continue;
      if (parts_[a] == Part::kHidden || parts_[a] == Part::kSeen) write_whole(a, t);
    }
  }

 private:
  // Of a triangle between two rays: from the near side to the far one.
  struct Wedge {
    Piece piece;
    std::uint32_t front, back;  // front: kNoEdge for the eye itself
    Spot near[2], far[2];
  };
  struct Front {
    std::uint32_t first, second;  // kNoEdge for the eye; the same but for triangles with two
    Vertex middle;                // between both
  };
  struct Corner {
    Spot spot;
    std::int64_t line;
    double height;
  };

  std::int64_t line_of(std::uint32_t edge) const {
    return static_cast<std::int64_t>(entry_of(edges_.half_edge(edge)));
  }

  // The triangle between an edge and the eye, kNoTriangle if there is none.
  Triangle nearer_triangle(std::uint32_t edge) const {
    const HalfEdge e = edges_.half_edge(edge);
    const Triangle t = triangle_of(e);
    const bool is_left = surface_.vertex(t, corner_after(corner_of(e))) == arcs_[edge].from;
    return is_left ? t : surface_.neighbor(t, corner_of(e));
  }

  std::uint32_t find_edge(Vertex from, Vertex to) const {
    const std::int32_t at = directions_.position(from);
    for (std::uint32_t e = edges_.begin(at); e < edges_.end(at); ++e) {
      if (edges_.to(e) == to) return e;
    }
    return kNoEdge;
  }

  // The edges of a triangle through which it is seen before an edge of it.
  Front find_front(Triangle t, std::uint32_t back) const {
    const Vertex a = arcs_[back].from, b = arcs_[back].to;
    Vertex c = surface_.vertex(t, 0);
    for (std::uint32_t k = 1; c == a || c == b; ++k) c = surface_.vertex(t, k);
    const Point eye = view_.eye.at, p = surface_.point(a), q = surface_.point(b);
    const Point r = surface_.point(c);
    const bool by_b = orientation(q, r, eye) < 0, by_a = orientation(r, p, eye) < 0;
    const std::uint32_t to_b = by_b ? find_edge(c, b) : kNoEdge;
    const std::uint32_t to_a = by_a ? find_edge(a, c) : kNoEdge;
    if (by_a && by_b) return {to_a, to_b, c};
    return by_a ? Front{to_a, to_a, c} : Front{to_b, to_b, c};
  }

  void add(std::uint32_t arc) {
    const std::uint32_t edge = arcs_[arc].edge;
    const Ray begin = geometry_.begin(arcs_[arc]), end = geometry_.end(arcs_[arc]);
    if (!(begin.key < end.key)) return;  // too thin for doubles
    horizon_.list_pieces(begin, end, pieces_);
    const Triangle t = nearer_triangle(edge);
    if (surface_.is_triangle(t)) parts_[arc] = cut_triangle(arc, t);
    horizon_.raise(edge, pieces_);
  }

  Part cut_triangle(std::uint32_t arc, Triangle t) {
    list_wedges(arc, t);
    Part part = Part::kNone;
    for (const Wedge& wedge : wedges_) {
      const Part one = judge(wedge);
      part = part == Part::kNone || part == one ? one : Part::kDivided;
    }
    if (part != Part::kDivided) return part;
    for (const Wedge& wedge : wedges_) write(wedge, t);
    return part;
  }

  // Of the pieces of the horizon before an arc.
  void list_wedges(std::uint32_t arc, Triangle t) {
    const std::uint32_t back = arcs_[arc].edge;
    const Front front = find_front(t, back);
    const bool has_one = front.first == front.second;
    const Ray middle = has_one ? geometry_.end(arcs_[arc]) : find_middle(arcs_[arc], front.middle);
    wedges_.clear();
    for (const Piece& piece : pieces_) {
      if (has_one) {
        add_wedge(piece, front.first, back);
      } else if (piece.end.key <= middle.key) {
        add_wedge(piece, front.first, back);
      } else if (piece.begin.key >= middle.key) {
        add_wedge(piece, front.second, back);
      } else {
        add_wedge({piece.begin, middle, piece.edge}, front.first, back);
        add_wedge({middle, piece.end, piece.edge}, front.second, back);
      }
    }
  }

  // The direction of a vertex between the ends of an edge, of which the arc may be a part.
  Ray find_middle(const Arc& arc, Vertex middle) const {
    Ray ray = geometry_.ray(middle);
    const std::int32_t slot = directions_.slot(middle);
    if (arc.begins_at_cut && slot > directions_.slot(arc.to)) ray.key = -1.0;
    if (arc.ends_at_cut && slot < directions_.slot(arc.from)) ray.key = geometry_.end(arc).key;
    return ray;
  }

  void add_wedge(const Piece& piece, std::uint32_t front, std::uint32_t back) {
    Wedge wedge{piece, front, back, {}, {}};
    const Ray* const rays[2] = {&piece.begin, &piece.end};
    for (int side = 0; side < 2; ++side) {
      wedge.near[side] =
          front == kNoEdge ? geometry_.eye() : geometry_.point_on(front, *rays[side]);
      wedge.far[side] = geometry_.point_on(back, *rays[side]);
    }
    wedges_.push_back(wedge);
  }

  // Counter-clockwise, from the eye along the first ray.
  void list_corners(const Wedge& w, Corner (&corners)[4]) const {
    const Piece& p = w.piece;
    const auto height = [&](const Spot& spot, const Ray& ray) {
      return w.front == kNoEdge && spot.norm() == 0.0
                 ? geometry_.lift()
                 : geometry_.height(spot, p.edge, ray, geometry_.lift());
    };
    const std::int64_t front = w.front == kNoEdge ? Cells::kNoLine : line_of(w.front);
    corners[0] = {w.near[0], first_ray_ + p.begin.line, height(w.near[0], p.begin)};
    corners[1] = {w.far[0], line_of(w.back), height(w.far[0], p.begin)};
    corners[2] = {w.far[1], first_ray_ + p.end.line, height(w.far[1], p.end)};
    corners[3] = {w.near[1], front, height(w.near[1], p.end)};
  }

  Part judge(const Wedge& wedge) const {
    if (wedge.piece.edge == kNoEdge) return Part::kSeen;
    Corner corners[4];
    list_corners(wedge, corners);
    bool has_above = false, has_below = false;
    for (const Corner& corner : corners) {
      has_above |= corner.height > 0.0;
      has_below |= corner.height < 0.0;
    }
    return !has_below ? Part::kSeen : has_above ? Part::kDivided : Part::kHidden;
  }

  void write(const Wedge& wedge, Triangle t) {
    Corner corners[4];
    list_corners(wedge, corners);
    const Part part = judge(wedge);
    if (part != Part::kDivided) {
      for (const Corner& corner : corners) put(corner.spot, corner.line);
      close(t, part == Part::kSeen);
      return;
    }
    for (const double sign : {1.0, -1.0}) {
      clip(wedge, corners, sign);
      close(t, sign > 0.0);
    }
  }

  // The part of a wedge on one side of the shadow's end.
  void clip(const Wedge& wedge, const Corner (&corners)[4], double sign) {
    for (int i = 0; i < 4; ++i) {
      const Corner &one = corners[i], &next = corners[(i + 1) % 4];
      const double at = sign * one.height, at_next = sign * next.height;
      const bool leaves = at >= 0.0 && at_next < 0.0, enters = at < 0.0 && at_next > 0.0;
      if (at >= 0.0) put(one.spot, at == 0.0 && at_next < 0.0 ? Cells::kNoLine : one.line);
      if (leaves && at > 0.0) put(cross(wedge, corners, i), Cells::kNoLine);
      if (enters) put(cross(wedge, corners, i), one.line);
    }
  }

  // Where the shadow's end crosses a side; the same from both sides of it.
  Spot cross(const Wedge& wedge, const Corner (&corners)[4], int side) const {
    if (side == 1) return geometry_.cut(wedge.back, wedge.piece.edge, geometry_.lift());
    if (side == 3) return geometry_.cut(wedge.front, wedge.piece.edge, geometry_.lift());
    const Corner& near = corners[side == 0 ? 0 : 3];
    const Corner& far = corners[side == 0 ? 1 : 2];
    return SightGeometry::between(near.spot, far.spot, near.height / (near.height - far.height));
  }

  void put(const Spot& spot, std::int64_t line) {
    cells_->corners.push_back(geometry_.place(spot));
    cells_->lines.push_back(line);
  }

  void close(Triangle t, bool is_seen) {
    cells_->offsets.push_back(static_cast<std::int64_t>(cells_->corners.size()));
    cells_->triangles.push_back(index_of(t));
    cells_->seen.push_back(is_seen);
  }

  // A triangle in front of an arc that is seen or hidden as a whole there.
  void write_whole(std::uint32_t arc, Triangle t) {
    pieces_.assign(1, {geometry_.begin(arcs_[arc]), geometry_.end(arcs_[arc]), kNoEdge});
    list_wedges(arc, t);
    for (const Wedge& wedge : wedges_) {
      Corner corners[4];
      list_corners(wedge, corners);
      for (const Corner& corner : corners) put(corner.spot, corner.line);
      close(t, parts_[arc] == Part::kSeen);
    }
  }

  // Triangles with an edge in line with the eye are always divided: along a ray, as others are.
  void summarise(Part* parts) const {
    for (const Triangle t : Ids<Triangle>(surface_.triangle_count)) {
      parts[number(t)] = Part::kNone;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Point p = surface_.corner(t, corner_after(k)),
                    q = surface_.corner(t, corner_before(k));
        if (orientation(view_.eye.at, p, q) == 0) parts[number(t)] = Part::kDivided;
      }
    }
    for (std::uint32_t a = 0; a < arcs_.size(); ++a) {
      const Triangle t = nearer_triangle(arcs_[a].edge);
      if (!surface_.is_triangle(t) || parts_[a] == Part::kNone) continue;
      Part& part = parts[number(t)];
      part = part == Part::kNone || part == parts_[a] ? parts_[a] : Part::kDivided;
    }
  }

  const Surface& surface_;
  const View& view_;
  const Directions& directions_;
  const SightEdges& edges_;
  const Arcs& arcs_;
  SightGeometry geometry_;
  std::int64_t first_ray_;  // as a line
  Horizon horizon_;
  std::vector<Part> parts_;  // of the triangle before each arc, in its range
  std::vector<Piece> pieces_;
  std::vector<Wedge> wedges_;
  Cells* cells_ = nullptr;
};

// A surface with its vertices in the order of their directions: those that are looked at one after
// the other lie near each other in memory.
class SortedSurface {
 public:
  SortedSurface(const Surface& given, const Directions& directions)
      : points_(scratch_array<double>(3 * static_cast<std::size_t>(given.point_count))),
        corners_(scratch_array<std::int32_t>(std::size_t{3} * given.triangle_count)),
        surface_(given) {
    const auto count = static_cast<std::size_t>(given.point_count);
    const auto numbers = scratch_array<std::int32_t>(count);
    std::fill_n(numbers.get(), count, -1);
    std::int32_t next = 0;
    const auto take = [&](Vertex v) {
      std::copy_n(given.row(v), 3, points_.get() + 3 * static_cast<std::size_t>(next));
      numbers[number(v)] = next++;
    };
    for (std::int32_t at = 0; at < directions.size(); ++at) take(directions.vertex(at));
    for (const Vertex v : Ids<Vertex>(given.point_count)) {
      if (numbers[number(v)] < 0) take(v);
    }
    for (std::size_t i = 0; i < std::size_t{3} * given.triangle_count; ++i) {
      corners_[i] = numbers[static_cast<std::size_t>(given.corners[i])];
    }
    surface_.points = points_.get();
    surface_.corners = corners_.get();
  }

  const Surface& surface() const { return surface_; }

 private:
  ScratchArray<double> points_;
  ScratchArray<std::int32_t> corners_;
  Surface surface_;
};

// Check `team.is_stopped()` afterwards.
inline void find_seen_parts(const Surface& given, const View& view, Part* parts, Cells& cells,
                            Team& team) {
  auto directions = sort_ends(given, view, team);
  if (!directions) return;
  const SortedSurface sorted(given, *directions);
  const Surface& surface = sorted.surface();
  directions->renumber();
  const SightEdges edges(surface, view.eye.at, view.radius, *directions,
                         SightEdges::Extra::kHalfEdges);
  Pulse pulse(team);
  Arcs arcs(surface, view, *directions, edges);
  const auto order = arcs.sort(pulse);
  if (team.is_stopped()) return;
  if (order.size() < arcs.size()) throw std::runtime_error("edges of the surface cross");
  PartFinder(surface, view, *directions, edges, arcs).run(order, parts, cells, pulse);
}

}  // namespace tinsmith::sight
