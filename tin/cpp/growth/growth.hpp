// Growth: the triangulation, vertex by vertex in the order of the sweep.
//
// Incremental construction (McLain, "Two dimensional interpolation from random data", 1976), among
// the cells of a grid (Dwyer, "Higher-dimensional Voronoi diagrams in linear expected time", 1991).
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
//
// A thread finishes a range of vertices of its own. For it all other points come later: those
// after the range, and then those before it. So it makes all triangles at its vertices, and the
// ones that also have a corner before the range are found by another thread too (stitch.hpp).
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../index/grid.hpp"
#include "../search/full_search.hpp"
#include "../search/search_counts.hpp"
#include "open_edges.hpp"
#include "triangle_store.hpp"

namespace tinsmith {

// Every triangulation of n points with h of them on the hull has this many triangles.
inline std::int64_t triangle_count(std::int64_t points, std::int64_t on_hull) {
  return 2 * points - 2 - on_hull;
}

enum class Outcome { kComplete, kStopped, kTooCostly };

// `Near` is a VectorNeighborhood.
template <typename Near>
class Growth {
 public:
  // `hull` counter-clockwise.
  Growth(const PointGrid& grid, const std::vector<Vertex>& hull, Range own, TriangleStore& out)
      : level_(grid, own.begin),
        near_(grid, own),
        search_(grid, own),
        waiting_(own),
        out_(out),
        own_(own),
        count_(grid.count()) {
    for (std::size_t i = 0; i < hull.size(); ++i) {
      waiting_.add(hull[i], hull[(i + 1) % hull.size()], kOutside);
    }
  }

  // Finish the vertices of `next_block()` until it is empty. Stops when `keep_going` returns
  // false, or, if bounded, when the searches have cost more than another way of building the
  // triangulation would.
  template <typename KeepGoing, typename NextBlock>
  Outcome run(KeepGoing&& keep_going, bool is_bounded, NextBlock&& next_block) {
    try {
      for (Range block = next_block(); block.begin < block.end; block = next_block()) {
        if (!keep_going()) return Outcome::kStopped;
        if (is_bounded) search_.allow(budget_at(block.begin - own_.begin));
        for (std::int32_t i = block.begin; i < block.end; ++i) finish(static_cast<Vertex>(i));
      }
    } catch (const SearchTooCostly&) {
      return Outcome::kTooCostly;
    }
    return Outcome::kComplete;
  }

  // Finish all vertices, unless the searches take more work than this.
  bool is_grown_within(std::int64_t work) {
    search_.allow(work);
    try {
      for (const Vertex v : Ids<Vertex>(own_.begin, own_.end)) finish(v);
    } catch (const SearchTooCostly&) {
      return false;
    }
    return search_.counts().work() <= work;
  }

  const SearchCounts& counts() { return search_.counts(); }

  // The last triangle with a corner before the range, which another thread found too; or
  // kNoTriangle.
  Triangle last_shared() const { return last_shared_; }

 private:
  // In units of a search's work, a point: insertion, and what growth costs besides its searches.
  static constexpr std::int64_t kInsertion = 24, kGathering = 12;
  static constexpr std::int64_t kMostPerPoint = 36;  // so that giving up is never that dear
  static constexpr std::int64_t kAdvance = 64;  // at first a sixty-fourth of the points is granted
  static constexpr std::int64_t kLeastBudget = 20000;

  // As much as leaves the rest, if it takes the same a point, no dearer than inserting all points:
  // the budget grows with the vertices finished, so that hopeless data are given up early.
  std::int64_t budget_at(std::int64_t finished) const {
    const std::int64_t all = own_.size(), left = std::max<std::int64_t>(all - finished, 1);
    const std::int64_t granted = (kInsertion - kGathering) * (count_ / kAdvance);
    const std::int64_t per_point = kInsertion * all / left - kGathering;
    return kLeastBudget + granted + std::min(per_point * finished, kMostPerPoint * all);
  }

  void finish(Vertex v) {
    const Level& level = level_.at(number(v));
    near_.gather(number(v), level);
    search_.move_to(v, level.cell_size);
    if (waiting_.is_untouched(v)) {
      const Vertex w = search_.nearest();
      const HalfEdge first = half_edge(out_.next(), 2);
      const HalfEdge last = grow_sector(v, w, w, kNoHalfEdge);
      out_.join(first, last);
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
      const Vertex c = third_point(w, is_full_turn && w == first ? kNoVertex : hint);
      const Triangle triangle = out_.add(v, w, c);
      if (std::min(number(w), number(c)) < own_.begin) last_shared_ = triangle;
      const HalfEdge across = waiting_.match_or_add(w, c, half_edge(triangle, 0));
      out_.join(half_edge(triangle, 0), across);
      out_.join(half_edge(triangle, 2), behind);
      behind = half_edge(triangle, 1);
      if (is_full_turn ? c == first : reaches_end(c, behind)) return behind;
      w = c;
    }
  }

  bool reaches_end(Vertex c, HalfEdge behind) {
    for (WaitingEdge& end : ends_) {
      if (end.other != c) continue;
      out_.join(behind, end.half_edge);
      end = ends_.back();
      ends_.pop_back();
      return true;
    }
    return false;
  }

  Vertex third_point(Vertex b, Vertex hint) {
    SearchCounts& counts = search_.counts();
    ++counts.searches;
    const auto near = near_.third_point(number(b), counts);
    if (near.is_proven) return static_cast<Vertex>(near.point);
    return search_.third_point(b,
                               near.point == Near::kNone ? hint : static_cast<Vertex>(near.point));
  }

  PointGrid::LevelCursor level_;
  Near near_;
  ThirdPointSearch search_;
  OpenEdges waiting_;
  TriangleStore& out_;
  Range own_;
  std::int64_t count_;  // of all points
  Triangle last_shared_ = kNoTriangle;
  std::vector<WaitingEdge> starts_, ends_;
};

}  // namespace tinsmith
