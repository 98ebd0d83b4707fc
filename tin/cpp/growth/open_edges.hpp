// Open edges: those with one triangle, kept at their earlier vertex until the other is found.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"

namespace tinsmith {

struct WaitingEdge {
  Vertex other;        // the later vertex
  HalfEdge half_edge;  // the edge as seen from its one triangle; kOutside for a hull edge
};

// Only edges with an end among the `own` positions are kept: those are finished in turn, and all
// others, in order, come after them.
class OpenEdges {
 public:
  explicit OpenEdges(Range own) : own_(own), head_(scratch_array<std::int32_t>(own.size())) {
    std::fill_n(head_.get(), own.size(), kUntouched);
  }

  // No edge has ever waited at v and no triangle has touched it.
  bool is_untouched(Vertex v) const { return head_[key(v)] == kUntouched; }

  // The edge u-w waits for the triangle on its left; its other side is `half_edge`.
  void add(Vertex u, Vertex w, HalfEdge half_edge) {
    const bool is_forward = key(u) < key(w);
    if (!is_own(is_forward ? u : w)) return;
    push(is_forward ? u : w, {is_forward ? w : u, half_edge, is_forward, kEmpty});
    touch(is_forward ? w : u);
  }

  // A triangle lies left of the edge u-w as `half_edge`. If the edge waited, it is closed and its
  // other side returned; if not, it waits from now on and kNoHalfEdge is returned.
  HalfEdge match_or_add(Vertex u, Vertex w, HalfEdge half_edge) {
    const bool is_forward = key(u) < key(w);
    const Vertex earlier = is_forward ? u : w, later = is_forward ? w : u;
    if (!is_own(earlier)) return kNoHalfEdge;
    std::int32_t* link = &head_[key(earlier)];
    while (*link >= 0) {
      const std::int32_t found = *link;
      if (edges_[found].other == later) {
        *link = edges_[found].next;
        edges_[found].next = free_;
        free_ = found;
        return edges_[found].half_edge;
      }
      link = &edges_[found].next;
    }
    add(w, u, half_edge);
    return kNoHalfEdge;
  }

  // Move the edges that wait at v out: `starts` are open on the left of v-other, `ends` on the
  // right.
  void take(Vertex v, std::vector<WaitingEdge>& starts, std::vector<WaitingEdge>& ends) {
    starts.clear();
    ends.clear();
    std::int32_t at = head_[key(v)];
    while (at >= 0) {
      Edge& edge = edges_[at];
      (edge.is_open_left ? starts : ends).push_back({edge.other, edge.half_edge});
      const std::int32_t next = edge.next;
      edge.next = free_;
      free_ = at;
      at = next;
    }
    head_[key(v)] = kEmpty;
  }

 private:
  // Place in the order in which vertices are finished.
  std::uint32_t key(Vertex v) const {
    return static_cast<std::uint32_t>(number(v)) - static_cast<std::uint32_t>(own_.begin);
  }
  bool is_own(Vertex v) const { return key(v) < static_cast<std::uint32_t>(own_.size()); }

  static constexpr std::int32_t kEmpty = -1;
  static constexpr std::int32_t kUntouched = -2;

  struct Edge {
    Vertex other;
    HalfEdge half_edge;
    bool is_open_left;  // of the direction from the earlier to the later vertex
    std::int32_t next;
  };

  void touch(Vertex v) {
    if (is_own(v) && head_[key(v)] == kUntouched) head_[key(v)] = kEmpty;
  }

  void push(Vertex v, Edge edge) {
    touch(v);
    edge.next = head_[key(v)];
    std::int32_t place = free_;
    if (place >= 0) {
      free_ = edges_[place].next;
      edges_[place] = edge;
    } else {
      place = static_cast<std::int32_t>(edges_.size());
      edges_.push_back(edge);
    }
    head_[key(v)] = place;
  }

  Range own_;
  ScratchArray<std::int32_t> head_;
  std::vector<Edge> edges_;
  std::int32_t free_ = -1;
};

}  // namespace tinsmith
