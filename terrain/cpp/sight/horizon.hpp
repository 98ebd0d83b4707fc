// The horizon that edges throw: for each direction the one that rises highest, among those so far.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <vector>

#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/location/surface.hpp"
#include "arcs.hpp"
#include "directions.hpp"
#include "eye.hpp"
#include "seen_vertices.hpp"

namespace tinsmith::sight {

constexpr std::uint32_t kNoEdge = UINT32_MAX;

// A direction at which the horizon changes: that of vertices, or where two edges cross as seen from
// the eye. The farther one has the point where they do.
struct Ray {
  double key;          // grows from the first direction of the surface on
  Point towards;       // relative to the eye; of a crossing, the place itself
  std::int32_t slot;   // of vertices; kNoSlot for a crossing
  std::int64_t line;   // its number as a line
  std::uint32_t edge;  // of a crossing, with the other one
  std::uint32_t other;
};

// What stands above the horizon's start from one ray to the next.
struct Piece {
  Ray begin, end;
  std::uint32_t edge;  // kNoEdge for nothing
};

// A point of the ground as seen from the eye, so that one close to it keeps its digits.
// A place as seen from the eye, and the vertex that it is, kNoVertex if it is none.
struct Spot : Offset {
  Vertex vertex;
};

// Points of edges in directions, computed from nothing but the edge and the ray: whoever asks gets
// the same.
class SightGeometry {
 public:
  SightGeometry(const Surface& surface, const View& view, const Directions& directions,
                const Arcs& arcs)
      : surface_(surface), view_(view), directions_(directions), arcs_(arcs) {
    first_key_ = key_of(spot(directions.vertex(0)));
    keys_.resize(static_cast<std::size_t>(directions.size()));
    double last = first_key_;
    for (std::int32_t at = 0; at < directions.size(); ++at) {
      const Vertex v = directions.vertex(at);
      if (directions.slot(v) == at) last = std::max(last, key_of(spot(v)));
      keys_[at] = last;
    }
  }

  Spot eye() const { return {Offset(0.0, 0.0, 0.0), kNoVertex}; }
  double lift() const { return view_.target_height; }
  Spot spot(Vertex v) const { return {Offset(view_.eye, surface_.surface_point(v)), v}; }
  Point place(const Spot& s) const {
    if (s.vertex != kNoVertex) return surface_.point(s.vertex);
    return {view_.eye.at.x + s.x, view_.eye.at.y + s.y};
  }

  Ray ray(Vertex v, bool is_last = false) const {
    const std::int32_t slot = directions_.slot(v);
    const double key = is_last ? kLastKey : keys_[slot];
    const Spot to = spot(directions_.vertex(slot));
    return {key, {to.x, to.y}, slot, slot, kNoEdge, kNoEdge};
  }
  Ray begin(const Arc& arc) const {
    return ray(arc.begins_at_cut ? directions_.vertex(0) : arc.from);
  }
  Ray end(const Arc& arc) const {
    return arc.ends_at_cut ? ray(directions_.vertex(0), true) : ray(arc.to);
  }
  // From that of the first direction on.
  double key_of(const Spot& s) const {
    const double part = s.x / s.norm();
    const double key = s.y > 0.0 || (s.y == 0.0 && s.x > 0.0) ? 1.0 - part : 3.0 + part;
    return key < first_key_ ? key + 4.0 : key;
  }

  // Where a direction meets an edge.
  Spot point_on(std::uint32_t edge, const Ray& ray) const {
    const Vertex from = arcs_[edge].from, to = arcs_[edge].to;
    if (ray.slot != Directions::kNoSlot && directions_.slot(from) == ray.slot) return spot(from);
    if (ray.slot != Directions::kNoSlot && directions_.slot(to) == ray.slot) return spot(to);
    const Spot a = spot(from), b = spot(to);
    const Point towards = ray.towards;
    const double left = a.x * towards.y - a.y * towards.x;
    const double right = towards.x * b.y - towards.y * b.x;
    const double along = std::min(std::max(left / (left + right), 0.0), 1.0);
    Spot found = between(a, b, along);
    if (ray.edge == edge) {
      found.x = ray.towards.x;
      found.y = ray.towards.y;
    }
    return found;
  }

  // The height of a lifted point of a ray above the line of sight over an edge, 0 within rounding.
  double height(const Spot& x, std::uint32_t edge, const Ray& ray, double lift) const {
    if (edge == kNoEdge) return std::numeric_limits<double>::infinity();
    const Spot source = point_on(edge == ray.other ? ray.edge : edge, ray);
    if (source.x == x.x && source.y == x.y) return lift;
    const double line = source.z * (x.norm() / source.norm());
    return settle(x.z + lift - line, std::fabs(x.z) + lift + std::fabs(line));
  }

  // Where the plane through the eye and an edge cuts a lifted edge.
  Spot cut(std::uint32_t edge, std::uint32_t above, double lift) const {
    const Spot a = spot(arcs_[edge].from), b = spot(arcs_[edge].to);
    const double at_a = height_above_plane(a, above, lift);
    const double at_b = height_above_plane(b, above, lift);
    const double along = at_a / (at_a - at_b);
    return between(a, b, along >= 0.0 && along <= 1.0 ? along : 0.5);
  }

  static Spot between(const Spot& a, const Spot& b, double along) {
    const Offset offset(a.x + along * (b.x - a.x), a.y + along * (b.y - a.y),
                        a.z + along * (b.z - a.z));
    return {offset, kNoVertex};
  }

 private:
  static constexpr double kRounding = 1e-12;  // of a height: what is less touches
  static constexpr double kLastKey = 16.0;    // beyond all, of the first direction once more

  static double settle(double height, double size) {
    return std::fabs(height) <= kRounding * size ? 0.0 : height;
  }

  double height_above_plane(const Spot& x, std::uint32_t edge, double lift) const {
    const Spot a = spot(arcs_[edge].from), b = spot(arcs_[edge].to);
    const auto cross = [](const Spot& p, const Spot& q) { return p.x * q.y - p.y * q.x; };
    return x.z + lift - (cross(x, b) * a.z + cross(a, x) * b.z) / cross(a, b);
  }

  const Surface& surface_;
  const View& view_;
  const Directions& directions_;
  const Arcs& arcs_;
  double first_key_ = 0.0;
  std::vector<double> keys_;
};

class Horizon {
 public:
  Horizon(const SightGeometry& geometry, std::int64_t first_line)
      : geometry_(geometry), next_line_(first_line) {}

  // From one ray to another, of a larger key.
  void list_pieces(const Ray& begin, const Ray& end, std::vector<Piece>& pieces) const {
    pieces.clear();
    auto at = changes_.upper_bound(begin.key);
    std::uint32_t edge = at == changes_.begin() ? kNoEdge : std::prev(at)->second.edge;
    Ray from = begin;
    for (; at != changes_.end() && at->first < end.key; ++at) {
      pieces.push_back({from, at->second.begin, edge});
      from = at->second.begin;
      edge = at->second.edge;
    }
    pieces.push_back({from, end, edge});
  }

  // Of an edge behind all so far; `pieces` are those of its range.
  void raise(std::uint32_t edge, const std::vector<Piece>& pieces) {
    std::vector<Piece> raised;
    bool is_changed = false;
    for (const Piece& piece : pieces) is_changed |= raise_piece(edge, piece, raised);
    if (!is_changed) return;
    const double begin = pieces.front().begin.key, end = pieces.back().end.key;
    const std::uint32_t after = edge_at(end);
    const auto before = changes_.lower_bound(begin);
    std::uint32_t last = before == changes_.begin() ? kNoEdge : std::prev(before)->second.edge;
    const auto old_end = changes_.find(end);
    const bool has_end = old_end != changes_.end();
    changes_.erase(before, changes_.lower_bound(end));
    for (const Piece& piece : raised) {
      if (piece.edge != last) changes_[piece.begin.key] = {piece.begin, piece.edge};
      last = piece.edge;
    }
    if (last == after && has_end) changes_.erase(end);
    if (last != after && !has_end) changes_[end] = {pieces.back().end, after};
  }

 private:
  struct Change {
    Ray begin;
    std::uint32_t edge;
  };

  std::uint32_t edge_at(double key) const {
    const auto after = changes_.upper_bound(key);
    return after == changes_.begin() ? kNoEdge : std::prev(after)->second.edge;
  }

  bool raise_piece(std::uint32_t edge, const Piece& piece, std::vector<Piece>& raised) {
    const auto height = [&](const Ray& ray) {
      return geometry_.height(geometry_.point_on(edge, ray), piece.edge, ray, 0.0);
    };
    const double at_begin = height(piece.begin), at_end = height(piece.end);
    if (at_begin <= 0.0 && at_end <= 0.0) {
      raised.push_back(piece);
      return false;
    }
    if (at_begin >= 0.0 && at_end >= 0.0) {
      raised.push_back({piece.begin, piece.end, edge});
      return true;
    }
    const Spot crossing = geometry_.cut(edge, piece.edge, 0.0);
    const Ray ray = make_ray(crossing, edge, piece.edge);
    if (ray.key <= piece.begin.key || ray.key >= piece.end.key) {  // too near to be told apart
      const bool is_above = at_begin + at_end > 0.0;
      raised.push_back({piece.begin, piece.end, is_above ? edge : piece.edge});
      return is_above;
    }
    raised.push_back({piece.begin, ray, at_begin > 0.0 ? edge : piece.edge});
    raised.push_back({ray, piece.end, at_end > 0.0 ? edge : piece.edge});
    return true;
  }

  Ray make_ray(const Spot& crossing, std::uint32_t edge, std::uint32_t other) {
    return {geometry_.key_of(crossing),
            {crossing.x, crossing.y},
            Directions::kNoSlot,
            next_line_++,
            edge,
            other};
  }

  const SightGeometry& geometry_;
  std::int64_t next_line_;
  std::map<double, Change> changes_;  // by key: the edge from there on
};

}  // namespace tinsmith::sight
