// Stitching: the triangles of several threads become one list, the same as one thread's.
//
//      part 1     \  /\  /\  /        A triangle belongs to its first vertex. Part 1 also found
//      ------------\/--\/--\/---      triangles with a corner in part 0 (they were needed to go
//      part 0      /\  /\  /\         round its own vertices): those are dropped. Edges whose two
//                 /  \/  \/  \        triangles belong to different parts are joined at the end.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "triangle_store.hpp"

namespace tinsmith {

// One thread's triangles, by the first vertex in its range.
class alignas(kCacheLine) GrownPart {
 public:
  GrownPart() = default;
  GrownPart(Range own, Triangles triangles, std::int32_t count, Triangle last_shared)
      : own_(own), triangles_(triangles), count_(count) {
    if (last_shared != kNoTriangle) number_seam(static_cast<std::int32_t>(number(last_shared)));
  }

  // Triangles whose first vertex is in the range.
  std::int32_t kept() const { return count_ - dropped_; }

  // Write the kept triangles from number `base` on, with corners renumbered; edges across to
  // other parts are left open. `out` may be the part's own arrays if base is 0.
  template <typename RowOf>
  void write(std::int32_t base, Triangles out, const RowOf& row_of) {
    base_ = base;
    for (std::int32_t triangle = 0; triangle < count_; ++triangle) {
      const std::int32_t at = number_of(triangle);
      if (at == kDropped) continue;
      const std::size_t from = 3 * static_cast<std::size_t>(triangle);
      const std::int32_t corners[3] = {triangles_.corners[from], triangles_.corners[from + 1],
                                       triangles_.corners[from + 2]};
      const std::size_t to = 3 * static_cast<std::size_t>(base + at);
      for (int k = 0; k < 3; ++k) {
        out.corners[to + k] = row_of(corners[k]);
        const std::int32_t neighbor = neighbor_of(from + k);
        out.neighbors[to + k] = neighbor;
        if (neighbor == kUnknownNeighbor) {
          open_.push_back({corners[(k + 1) % 3], corners[(k + 2) % 3],
                           half_edge(Triangle{static_cast<std::uint32_t>(base + at)},
                                     static_cast<std::uint32_t>(k))});
        }
      }
    }
  }

  // An edge to another part: from vertex to vertex, as the half-edge of a written triangle.
  struct OpenEdge {
    std::int32_t from, to;
    HalfEdge edge;
  };
  const std::vector<OpenEdge>& open() const { return open_; }

 private:
  static constexpr std::int32_t kDropped = -1;

  std::int32_t corner(std::int32_t triangle, int k) const {
    return triangles_.corners[3 * static_cast<std::size_t>(triangle) + k];
  }
  bool is_shared(std::int32_t triangle) const {
    return std::min(corner(triangle, 1), corner(triangle, 2)) < own_.begin;
  }

  // Number the triangles up to the last vertex that has shared ones.
  void number_seam(std::int32_t last_shared) {
    seam_number_.reserve(last_shared + 1);
    for (std::int32_t begin = 0; begin <= last_shared;) {
      const std::int32_t vertex = corner(begin, 0);
      bool has_shared = false;
      std::int32_t end = begin;
      for (; end < count_ && corner(end, 0) == vertex; ++end) {
        has_shared |= is_shared(end);
        seam_number_.push_back(end - dropped_);
      }
      if (has_shared) number_group(begin, end);
      begin = end;
    }
  }

  // Triangles of one vertex, some of them shared: the others in canonical order.
  void number_group(std::int32_t begin, std::int32_t end) {
    std::vector<std::int32_t> kept;
    for (std::int32_t triangle = begin; triangle < end; ++triangle) {
      if (!is_shared(triangle)) kept.push_back(triangle);
      seam_number_[triangle] = kDropped;
    }
    sort_canonically(kept);
    std::int32_t next = begin - dropped_;
    for (const std::int32_t triangle : kept) seam_number_[triangle] = next++;
    dropped_ = end - next;
  }

  // Triangles of one vertex: sectors by the vertex they start at, then counter-clockwise.
  void sort_canonically(std::vector<std::int32_t>& kept) const {
    std::vector<std::int32_t> sorted;
    const auto starting_at = [&](std::int32_t vertex) {
      return std::find_if(kept.begin(), kept.end(),
                          [&](std::int32_t t) { return corner(t, 1) == vertex; });
    };
    std::vector<std::int32_t> starts;
    for (const std::int32_t t : kept) {
      const bool follows = std::any_of(kept.begin(), kept.end(), [&](std::int32_t before) {
        return corner(before, 2) == corner(t, 1);
      });
      if (!follows) starts.push_back(t);
    }
    std::sort(starts.begin(), starts.end(),
              [this](std::int32_t a, std::int32_t b) { return corner(a, 1) < corner(b, 1); });
    for (const std::int32_t start : starts) {
      auto at = std::find(kept.begin(), kept.end(), start);
      for (; at != kept.end(); at = starting_at(corner(sorted.back(), 2))) sorted.push_back(*at);
    }
    kept = std::move(sorted);
  }

  std::int32_t number_of(std::int32_t triangle) const {
    const bool is_at_seam = triangle < static_cast<std::int32_t>(seam_number_.size());
    return is_at_seam ? seam_number_[triangle] : triangle - dropped_;
  }

  std::int32_t neighbor_of(std::size_t half_edge) const {
    const std::int32_t neighbor = triangles_.neighbors[half_edge];
    if (neighbor < 0) return neighbor;
    const std::int32_t at = number_of(neighbor);
    return at == kDropped ? kUnknownNeighbor : base_ + at;
  }

  Range own_{0, 0};
  Triangles triangles_{nullptr, nullptr};
  std::int32_t count_ = 0;
  std::int32_t dropped_ = 0;
  std::int32_t base_ = 0;
  std::vector<std::int32_t> seam_number_;  // of the first triangles; the rest follow on
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
    out.neighbors[entry_of(e)] = static_cast<std::int32_t>(number(triangle_of(f)));
    out.neighbors[entry_of(f)] = static_cast<std::int32_t>(number(triangle_of(e)));
    ++i;
  }
}

}  // namespace tinsmith
