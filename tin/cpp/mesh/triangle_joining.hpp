// Which triangles share an edge, of corners alone.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../location/surface.hpp"

namespace tinsmith {

// Sorts edges by their smaller vertex, or by its first digits where vertices are many more than
// edges (counting sort); then each few that are alike by both. False if an edge has more than two
// triangles, or two on one side of it; then neighbours are anything.
class TriangleJoining {
 public:
  // Of the surface its corners alone are looked at, which must be sound.
  explicit TriangleJoining(const Surface& surface)
      : surface_(surface), edges_(scratch_array<Edge>(std::size_t{3} * surface.triangle_count)) {
    const std::int64_t edge_count = std::int64_t{3} * surface.triangle_count;
    while (surface.point_count >> dropped_ > std::max(kLeast, edge_count)) ++dropped_;
    end_.assign((static_cast<std::size_t>(surface.point_count) >> dropped_) + 2, 0);
    gather_edges();
  }

  bool join(std::int32_t* neighbors) const {
    std::fill_n(neighbors, std::size_t{3} * surface_.triangle_count, kNoNeighbor);
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
    Vertex smaller, larger;
    HalfEdge edge;

    bool joins_same(const Edge& other) const {
      return smaller == other.smaller && larger == other.larger;
    }
    bool operator<(const Edge& other) const {
      return std::tie(smaller, larger, edge) < std::tie(other.smaller, other.larger, other.edge);
    }
  };

  Vertex from(HalfEdge e) const {
    return surface_.vertex(triangle_of(e), corner_after(corner_of(e)));
  }
  Vertex to(HalfEdge e) const {
    return surface_.vertex(triangle_of(e), corner_before(corner_of(e)));
  }
  bool is_forward(HalfEdge e) const { return from(e) < to(e); }

  std::size_t bucket_of(const Edge& edge) const {
    return static_cast<std::size_t>(number(edge.smaller) >> dropped_);
  }

  // Each bucket ends at its end_, and begins where the one before ends.
  void gather_edges() {
    for_each_edge([&](const Edge& edge) { ++end_[bucket_of(edge) + 1]; });
    for (std::size_t i = 1; i < end_.size(); ++i) end_[i] += end_[i - 1];
    for_each_edge([&](const Edge& edge) { edges_[end_[bucket_of(edge)]++] = edge; });
  }

  template <typename Visit>
  void for_each_edge(Visit&& visit) const {
    for (const Triangle t : Ids<Triangle>(surface_.triangle_count)) {
      for (const HalfEdge e : half_edges(t)) {
        visit(Edge{std::min(from(e), to(e)), std::max(from(e), to(e)), e});
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
      if (is_shared_by_more || is_forward(edge->edge) == is_forward(next.edge)) return false;
      neighbors[entry_of(edge->edge)] = index_of(triangle_of(next.edge));
      neighbors[entry_of(next.edge)] = index_of(triangle_of(edge->edge));
    }
    return true;
  }

  Surface surface_;
  ScratchArray<Edge> edges_;
  int dropped_ = 0;  // bits of a smaller vertex that its bucket does not tell
  std::vector<std::uint32_t> end_;
};

}  // namespace tinsmith
