// Stitching: the triangles of several threads become one list, the same as one thread's.
//
//      part 1     \  /\  /\  /        A triangle belongs to its first vertex. Part 1 also found
//      ------------\/--\/--\/---      triangles with a corner in part 0 (they were needed to go
//      part 0      /\  /\  /\         round its own vertices): those are dropped. Edges whose two
//                 /  \/  \/  \        triangles belong to different parts are joined at the end.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "triangle_store.hpp"

namespace tinsmith {

// One thread's triangles, by the first vertex in its range.
class alignas(kCacheLine) GrownPart {
 public:
  GrownPart() = default;
  GrownPart(Range own, Triangles triangles, std::uint32_t count, Triangle last_shared)
      : own_(own), triangles_(triangles), count_(count) {
    if (last_shared != kNoTriangle) number_seam(last_shared);
  }

  // Triangles whose first vertex is in the range.
  std::uint32_t kept() const { return count_ - dropped_; }

  // Write the kept triangles from number `base` on, with corners renumbered; edges across to
  // other parts are left open. `out` may be the part's own arrays if base is 0.
  template <typename RowOf>
  void write(std::uint32_t base, Triangles out, const RowOf& row_of) {
    shift_ = base - dropped_;
    for (Triangle& t : seam_number_) {
      if (t != kNoTriangle) t = Triangle{number(t) + base};
    }
    for (const Triangle t : Ids<Triangle>(count_)) {
      const Triangle written = number_of(t);
      if (written == kNoTriangle) continue;
      const Vertex corners[3] = {corner(t, 0), corner(t, 1), corner(t, 2)};
      for (std::uint32_t k = 0; k < 3; ++k) {
        out.corners[entry_of(written, k)] = number(row_of(corners[k]));
        const std::int32_t neighbor = neighbor_of(t, k);
        out.neighbors[entry_of(written, k)] = neighbor;
        if (neighbor == kUnknownNeighbor) {
          open_.push_back(
              {corners[corner_after(k)], corners[corner_before(k)], half_edge(written, k)});
        }
      }
    }
  }

  // An edge to another part: from vertex to vertex, as the half-edge of a written triangle.
  struct OpenEdge {
    Vertex from, to;
    HalfEdge edge;
  };
  const std::vector<OpenEdge>& open() const { return open_; }

 private:
  Vertex corner(Triangle t, std::uint32_t k) const {
    return Vertex{triangles_.corners[entry_of(t, k)]};
  }
  bool is_shared(Triangle t) const {
    return number(std::min(corner(t, 1), corner(t, 2))) < own_.begin;
  }

  // Number the triangles up to the last vertex that has shared ones.
  void number_seam(Triangle last_shared) {
    seam_number_.reserve(std::size_t{number(last_shared)} + 1);
    for (std::uint32_t begin = 0; begin <= number(last_shared);) {
      const Vertex vertex = corner(Triangle{begin}, 0);
      bool has_shared = false;
      std::uint32_t end = begin;
      for (; end < count_ && corner(Triangle{end}, 0) == vertex; ++end) {
        has_shared |= is_shared(Triangle{end});
        seam_number_.push_back(Triangle{end - dropped_});
      }
      if (has_shared) number_group(begin, end);
      begin = end;
    }
  }

  // Triangles of one vertex, some of them shared: the others in canonical order.
  void number_group(std::uint32_t begin, std::uint32_t end) {
    std::vector<Triangle> kept;
    for (std::uint32_t i = begin; i < end; ++i) {
      if (!is_shared(Triangle{i})) kept.push_back(Triangle{i});
      seam_number_[i] = kNoTriangle;
    }
    sort_canonically(kept);
    std::uint32_t next = begin - dropped_;
    for (const Triangle t : kept) seam_number_[number(t)] = Triangle{next++};
    dropped_ = end - next;
  }

  // Triangles of one vertex: sectors by the vertex they start at, then counter-clockwise.
  void sort_canonically(std::vector<Triangle>& kept) const {
    std::vector<Triangle> sorted;
    const auto starting_at = [&](Vertex vertex) {
      return std::find_if(kept.begin(), kept.end(),
                          [&](Triangle t) { return corner(t, 1) == vertex; });
    };
    std::vector<Triangle> starts;
    for (const Triangle t : kept) {
      const bool follows = std::any_of(kept.begin(), kept.end(), [&](Triangle before) {
        return corner(before, 2) == corner(t, 1);
      });
      if (!follows) starts.push_back(t);
    }
    std::sort(starts.begin(), starts.end(),
              [this](Triangle a, Triangle b) { return corner(a, 1) < corner(b, 1); });
    for (const Triangle start : starts) {
      auto at = std::find(kept.begin(), kept.end(), start);
      for (; at != kept.end(); at = starting_at(corner(sorted.back(), 2))) sorted.push_back(*at);
    }
    kept = std::move(sorted);
  }

  // Among those written, kNoTriangle if it is dropped.
  Triangle number_of(Triangle t) const {
    const bool is_at_seam = number(t) < seam_number_.size();
    return is_at_seam ? seam_number_[number(t)] : Triangle{number(t) + shift_};
  }

  std::int32_t neighbor_of(Triangle t, std::uint32_t k) const {
    const std::int32_t neighbor = triangles_.neighbors[entry_of(t, k)];
    if (neighbor < 0) return neighbor;
    const Triangle written = number_of(triangle_numbered(neighbor));
    return written == kNoTriangle ? kUnknownNeighbor : index_of(written);
  }

  Range own_{0, 0};
  Triangles triangles_{nullptr, nullptr};
  std::uint32_t count_ = 0;
  std::uint32_t dropped_ = 0;
  std::uint32_t shift_ = 0;            // of the triangles behind the seam, when they are written
  std::vector<Triangle> seam_number_;  // of the first triangles, from 0 until they are written
  std::vector<OpenEdge> open_;
};

// Join the open edges of all parts; one without a counterpart is on the hull.
inline void join_open_edges(const std::vector<GrownPart>& parts, Triangles out) {
  std::vector<GrownPart::OpenEdge> open;
  for (const GrownPart& part : parts) {
    open.insert(open.end(), part.open().begin(), part.open().end());
  }
  const auto ends = [](const GrownPart::OpenEdge& edge) {
    return std::pair(std::min(edge.from, edge.to), std::max(edge.from, edge.to));
  };
  std::sort(open.begin(), open.end(),
            [&](const auto& a, const auto& b) { return ends(a) < ends(b); });
  for (std::size_t i = 0; i < open.size(); ++i) {
    const bool is_joined = i + 1 < open.size() && ends(open[i]) == ends(open[i + 1]);
    if (!is_joined) {
      out.neighbors[entry_of(open[i].edge)] = kNoNeighbor;
      continue;
    }
    const HalfEdge e = open[i].edge, f = open[i + 1].edge;
    out.neighbors[entry_of(e)] = index_of(triangle_of(f));
    out.neighbors[entry_of(f)] = index_of(triangle_of(e));
    ++i;
  }
}

}  // namespace tinsmith
