// The edges of a surface by the directions in which they begin and end, as seen from an eye.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../../../tin/cpp/base/arrays.hpp"
#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/location/surface.hpp"
#include "../../../tin/cpp/predicates/predicates.hpp"
#include "directions.hpp"

namespace tinsmith::sight {

// visit(from, to, half-edge), counter-clockwise about the eye, for every edge that is not in line
// with the eye and has a part within a distance.
template <typename Visit>
void visit_edges(const Surface& surface, Point eye, double radius, Visit&& visit) {
  constexpr double kRoom = 1.0 + 1e-9;
  for (const Triangle t : Ids<Triangle>(surface.triangle_count)) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (surface.neighbors[entry_of(t, k)] > index_of(t)) continue;  // it is visited from there
      const Vertex v = surface.vertex(t, corner_after(k)), w = surface.vertex(t, corner_before(k));
      const Point p = surface.point(v), q = surface.point(w);
      if (std::isfinite(radius)) {
        const double nearest =
            std::min(std::hypot(p.x - eye.x, p.y - eye.y), std::hypot(q.x - eye.x, q.y - eye.y));
        if (nearest > kRoom * (radius + std::hypot(q.x - p.x, q.y - p.y))) continue;
      }
      const int side = orientation(eye, p, q);
      if (side != 0) visit(side > 0 ? v : w, side > 0 ? w : v, half_edge(t, k));
    }
  }
}

// Edges are numbered by the positions at which they begin.
class SightEdges {
 public:
  enum class Extra { kNothing, kReach, kHalfEdges };

  SightEdges(const Surface& surface, Point eye, double radius, const Directions& directions,
             Extra extra = Extra::kNothing)
      : begins_(static_cast<std::size_t>(directions.size()) + 1, 0),
        end_begins_(static_cast<std::size_t>(directions.size()) + 1, 0) {
    visit_edges(surface, eye, radius, [&](Vertex from, Vertex to, HalfEdge) {
      ++begins_[directions.position(from)];
      ++end_begins_[directions.position(to)];
    });
    const std::int64_t count = add_up(begins_);
    add_up(end_begins_);
    to_ = scratch_array<Vertex>(count);
    ending_ = scratch_array<std::uint32_t>(count);
    if (extra == Extra::kReach) reach_ = scratch_array<float>(count);
    if (extra == Extra::kHalfEdges) half_edges_ = scratch_array<HalfEdge>(count);
    // Filled from the ends of the ranges, so that they begin where they are said to.
    visit_edges(surface, eye, radius, [&](Vertex from, Vertex to, HalfEdge e) {
      const std::uint32_t edge = --begins_[directions.position(from)];
      to_[edge] = to;
      ending_[--end_begins_[directions.position(to)]] = edge;
      if (reach_) reach_[edge] = measure_reach(surface, e);
      if (half_edges_) half_edges_[edge] = e;
    });
  }

  // Those that begin at a position, as a range of numbers.
  std::uint32_t begin(std::int32_t position) const { return begins_[position]; }
  std::uint32_t end(std::int32_t position) const { return begins_[position + 1]; }
  Vertex to(std::uint32_t edge) const { return to_[edge]; }
  std::uint32_t size() const { return begins_.back(); }
  HalfEdge half_edge(std::uint32_t edge) const { return half_edges_[edge]; }
  double reach(std::uint32_t edge) const { return reach_ ? reach_[edge] : 0.0; }

  // visit(edge) for those that end at a position.
  template <typename Visit>
  void visit_ending(std::int32_t position, Visit&& visit) const {
    for (std::uint32_t i = end_begins_[position]; i < end_begins_[position + 1]; ++i) {
      visit(ending_[i]);
    }
  }

 private:
  // Counts become the ends of their ranges.
  static std::int64_t add_up(std::vector<std::uint32_t>& counts) {
    std::uint32_t sum = 0;
    for (std::uint32_t& count : counts) count = sum += count;
    return sum;
  }

  // The longest side of the triangles at an edge, rounded up.
  static float measure_reach(const Surface& surface, HalfEdge e) {
    double longest = 0.0;
    for (const Triangle t : {triangle_of(e), surface.neighbor(triangle_of(e), corner_of(e))}) {
      if (!surface.is_triangle(t)) continue;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Point p = surface.corner(t, k), q = surface.corner(t, corner_after(k));
        longest = std::max(longest, std::hypot(q.x - p.x, q.y - p.y));
      }
    }
    return static_cast<float>(longest * (1.0 + 1e-6));
  }

  std::vector<std::uint32_t> begins_, end_begins_;
  ScratchArray<Vertex> to_;
  ScratchArray<std::uint32_t> ending_;
  ScratchArray<float> reach_;
  ScratchArray<HalfEdge> half_edges_;
};

}  // namespace tinsmith::sight
