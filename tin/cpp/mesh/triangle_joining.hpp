// Which triangles share an edge, of corners alone.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"

namespace tinsmith {

// Sorts edges by their smaller vertex, or by its first digits where vertices are many more than
// edges (counting sort); then each few that are alike by both. False if an edge has more than two triangles, or two on one side of
// it; then neighbours are anything. Corners are numbers from 0 to vertex_count - 1.
class TriangleJoining {
 public:
  TriangleJoining(const std::int32_t* corners, std::uint32_t triangle_count,
                  std::int32_t vertex_count)
      : corners_(corners),
        triangle_count_(triangle_count),
        edges_(scratch_array<Edge>(std::size_t{3} * triangle_count)) {
    const std::int64_t most = std::max<std::int64_t>(kLeast, std::int64_t{3} * triangle_count);
    while (vertex_count >> dropped_ > most) ++dropped_;
    end_.assign((static_cast<std::size_t>(vertex_count) >> dropped_) + 2, 0);
    gather_edges();
  }

  bool join(std::int32_t* neighbors) {
    std::fill_n(neighbors, std::size_t{3} * triangle_count_, kNoNeighbor);
    std::uint32_t begin = 0;
    for (const std::uint32_t end : end_) {
      if (!join_edges(edges_.get() + begin, edges_.get() + end, neighbors)) return false;
      begin = end;
    }
    return true;
  }

 private:
  static constexpr std::int64_t kLeast = 1024;

  struct Edge {
    std::int32_t smaller, larger;  // vertex
    std::uint32_t place;           // 3 * triangle + corner opposite

    bool joins_same(const Edge& other) const {
      return smaller == other.smaller && larger == other.larger;
    }
    bool operator<(const Edge& other) const {
      return std::tie(smaller, larger, place) < std::tie(other.smaller, other.larger, other.place);
    }
  };

  std::int32_t start(Triangle t, std::uint32_t k) const {
    return corners_[entry_of(t, corner_after(k))];
  }
  std::int32_t end(Triangle t, std::uint32_t k) const {
    return corners_[entry_of(t, corner_before(k))];
  }
  bool is_forward(std::uint32_t place) const {
    const Triangle t{place / 3};
    return start(t, place % 3) < end(t, place % 3);
  }

  // Each bucket ends at its end_, and begins where the one before ends.
  void gather_edges() {
    for_each_edge([&](const Edge& edge) { ++end_[(edge.smaller >> dropped_) + 1]; });
    for (std::size_t i = 1; i < end_.size(); ++i) end_[i] += end_[i - 1];
    for_each_edge([&](const Edge& edge) { edges_[end_[edge.smaller >> dropped_]++] = edge; });
  }

  template <typename Visit>
  void for_each_edge(Visit&& visit) const {
    for (const Triangle t : Ids<Triangle>(triangle_count_)) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::int32_t a = start(t, k), b = end(t, k);
        visit(Edge{std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(entry_of(t, k))});
      }
    }
  }

  // Edges of a bucket.
  bool join_edges(Edge* begin, Edge* end, std::int32_t* neighbors) const {
    std::sort(begin, end);
    for (Edge* edge = begin; edge + 1 < end; ++edge) {
      const Edge& next = edge[1];
      if (!edge->joins_same(next)) continue;
      const bool is_shared_by_more = edge + 2 < end && edge[2].joins_same(next);
      if (is_shared_by_more || is_forward(edge->place) == is_forward(next.place)) return false;
      neighbors[edge->place] = static_cast<std::int32_t>(next.place / 3);
      neighbors[next.place] = static_cast<std::int32_t>(edge->place / 3);
    }
    return true;
  }

  const std::int32_t* corners_;
  std::uint32_t triangle_count_;
  ScratchArray<Edge> edges_;
  int dropped_ = 0;  // bits of a smaller vertex that its bucket does not tell
  std::vector<std::uint32_t> end_;
};

}  // namespace tinsmith
