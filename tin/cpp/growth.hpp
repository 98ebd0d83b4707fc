// Growth: the triangulation, vertex by vertex in the order of the sweep.
//
// All triangles around a vertex are made before the next vertex is begun: finished vertices are a
// prefix of the order, so removing them from the search costs nothing. Each triangle is found
// once, when its first vertex is finished, from the open edges at that vertex:
//
//      c ---- w        start at an open edge v-w, its left side open; grow it to c; the edge w-c
//       \    / \       waits at its earlier end for its other triangle, or closes if it waited
//        \  /   \      already; go on with v-c until that edge too was waiting.
//         v ---- (triangle made earlier)
//
// Hull edges wait from the start, with the outside as their other triangle, so no search ever
// looks for a point where there is none.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "grid.hpp"
#include "ids.hpp"
#include "open_edges.hpp"
#include "search.hpp"

namespace tinsmith {

// Flat arrays, three entries a triangle, numbered by sweep order while growing.
struct Triangles {
  std::int32_t* corners;
  std::int32_t* neighbors;
};

class Growth {
 public:
  // `hull` counter-clockwise; `out` has room for triangle_count(...) triangles.
  Growth(const PointGrid& grid, const std::vector<Vertex>& hull, Triangles out)
      : search_(grid), waiting_(grid.count()), out_(out), count_(grid.count()) {
    for (std::size_t i = 0; i < hull.size(); ++i) {
      waiting_.add(hull[i], hull[(i + 1) % hull.size()], kOutside);
    }
  }

  // Every triangulation of n points with h of them on the hull has this many triangles.
  static std::int64_t triangle_count(std::int64_t points, std::int64_t on_hull) {
    return 2 * points - 2 - on_hull;
  }

  enum class Outcome { kComplete, kStopped, kTooCostly };

  // Stops when `keep_going` returns false, or, if bounded, when the searches have cost more than
  // another way of building the triangulation would.
  template <typename KeepGoing>
  Outcome run(KeepGoing&& keep_going, bool is_bounded) {
    constexpr std::int32_t kVerticesPerQuestion = 4096;
    for (std::int32_t i = 0; i < count_; ++i) {
      if (i % kVerticesPerQuestion == 0 && !keep_going()) return Outcome::kStopped;
      if (is_bounded && search_.counts().work() > budget_at(i)) return Outcome::kTooCostly;
      finish(static_cast<Vertex>(i));
    }
    return Outcome::kComplete;
  }

  const SearchCounts& counts() const { return search_.counts(); }

 private:
  // Even data need about 30 units of work a point, rasters 100; beyond the budget insertion is
  // quicker. It grows with the vertices finished, so that hopeless data are given up early.
  static constexpr std::int64_t kBudgetPerPoint = 500;
  static constexpr std::int64_t kAdvance = 32;  // at first a thirty-second of the points is granted
  static constexpr std::int64_t kLeastBudget = 20000;

  std::int64_t budget_at(std::int64_t finished) const {
    return kLeastBudget + kBudgetPerPoint * (finished + count_ / kAdvance);
  }

  void finish(Vertex v) {
    search_.move_to(v);
    if (waiting_.is_untouched(v)) {
      const Vertex w = search_.nearest();
      const HalfEdge first = half_edge(made_, 2);
      const HalfEdge last = grow_sector(v, w, w, kNoHalfEdge);
      join(first, last);
      return;
    }
    waiting_.take(v, starts_, ends_);
    std::sort(starts_.begin(), starts_.end(),
              [](const WaitingEdge& a, const WaitingEdge& b) { return a.other < b.other; });
    for (const WaitingEdge& start : starts_) {
      const Vertex hint = ends_.size() == 1 ? ends_.front().other : kNoVertex;
      grow_sector(v, start.other, hint, start.half_edge);
    }
  }

  // Grow counter-clockwise about v from the edge v-w until an edge that waits (or, about a vertex
  // without triangles, until w again). Returns the last triangle's edge to its end.
  HalfEdge grow_sector(Vertex v, Vertex w, Vertex hint, HalfEdge behind) {
    const bool is_full_turn = behind == kNoHalfEdge;
    const Vertex first = w;
    while (true) {
      const Vertex c = search_.third_point(w, is_full_turn && w == first ? kNoVertex : hint);
      const std::int32_t triangle = made_++;
      out_.corners[3 * triangle] = number(v);
      out_.corners[3 * triangle + 1] = number(w);
      out_.corners[3 * triangle + 2] = number(c);
      const HalfEdge across = waiting_.match_or_add(w, c, half_edge(triangle, 0));
      join(half_edge(triangle, 0), across);
      join(half_edge(triangle, 2), behind);
      behind = half_edge(triangle, 1);
      if (is_full_turn ? c == first : reaches_end(c, behind)) return behind;
      w = c;
    }
  }

  bool reaches_end(Vertex c, HalfEdge behind) {
    for (WaitingEdge& end : ends_) {
      if (end.other != c) continue;
      join(behind, end.half_edge);
      end = ends_.back();
      ends_.pop_back();
      return true;
    }
    return false;
  }

  void join(HalfEdge a, HalfEdge b) {
    if (a == kNoHalfEdge || b == kNoHalfEdge) return;
    if (a != kOutside) out_.neighbors[number(a)] = b == kOutside ? kNoNeighbor : number(b) / 3;
    if (b != kOutside) out_.neighbors[number(b)] = a == kOutside ? kNoNeighbor : number(a) / 3;
  }

  ThirdPointSearch search_;
  OpenEdges waiting_;
  Triangles out_;
  std::int32_t count_;
  std::int32_t made_ = 0;
  std::vector<WaitingEdge> starts_, ends_;
};

}  // namespace tinsmith
