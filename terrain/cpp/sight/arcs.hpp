// The edges of a surface from the eye outwards.
//
// Edges that do not cross have an order in which each comes after all that it is behind of, if the
// plane is cut along one ray from the eye: turned to a half-plane they are arcs of which none lies
// above another in a circle (as segments, de Berg et al., "Computational Geometry", section 12.1).
// Two arcs that are neighbours at some direction are told so by a sweep; the rest follows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/base/pulse.hpp"
#include "../../../tin/cpp/location/surface.hpp"
#include "directions.hpp"
#include "edge_tree.hpp"
#include "seen_vertices.hpp"
#include "sight_edges.hpp"

namespace tinsmith::sight {

// A part of an edge on one side of the first direction, at which edges are cut.
struct Arc {
  std::uint32_t edge;
  Vertex from, to;
  bool begins_at_cut, ends_at_cut;
};

class Arcs {
 public:
  Arcs(const Surface& surface, const View& view, const Directions& directions,
       const SightEdges& edges)
      : surface_(surface), view_(view), directions_(directions), edges_(edges) {
    for (std::int32_t at = 0; at < directions.size(); ++at) {
      const Vertex from = directions.vertex(at);
      for (std::uint32_t e = edges.begin(at); e < edges.end(at); ++e) {
        const Vertex to = edges.to(e);
        arcs_.push_back({e, from, to, false, directions.slot(to) <= directions.slot(from)});
      }
    }
    for (std::uint32_t e = 0; e < edges.size(); ++e) {
      if (!arcs_[e].ends_at_cut || directions.slot(arcs_[e].to) == 0) continue;
      arcs_.push_back({e, arcs_[e].from, arcs_[e].to, true, false});
    }
  }

  std::size_t size() const { return arcs_.size(); }
  const Arc& operator[](std::uint32_t arc) const { return arcs_[arc]; }

  // The numbers of arcs, each after those that it is behind of; fewer if the pulse ends.
  std::vector<std::uint32_t> sort(Pulse& pulse) {
    relate_neighbors(pulse);
    return follow(pulse);
  }

 private:
  static constexpr std::uint32_t kNone = UINT32_MAX;

  // Those that are next to each other at some direction.
  void relate_neighbors(Pulse& pulse) {
    EdgeTree tree(view_.eye.at);
    std::vector<EdgeTree::Handle> handles(size(), EdgeTree::kNone);
    second_.assign(edges_.size(), kNone);
    for (auto a = static_cast<std::uint32_t>(edges_.size()); a < size(); ++a) {
      second_[arcs_[a].edge] = a;
      insert(tree, handles, a);
    }
    for (std::int32_t at = 0, next = 0; at < directions_.size() && pulse.goes_on(); at = next) {
      while (next < directions_.size() && directions_.slot(directions_.vertex(next)) == at) ++next;
      for (std::int32_t i = at; i < next; ++i) {
        edges_.visit_ending(i, [&](std::uint32_t e) { erase(tree, handles, e); });
      }
      for (std::int32_t i = at; i < next; ++i) {
        for (std::uint32_t e = edges_.begin(i); e < edges_.end(i); ++e) insert(tree, handles, e);
      }
    }
  }

  void relate(const EdgeTree& tree, EdgeTree::Handle near, EdgeTree::Handle far) {
    if (near == EdgeTree::kNone || far == EdgeTree::kNone) return;
    relations_.push_back({tree.number(near), tree.number(far)});
  }

  void insert(EdgeTree& tree, std::vector<EdgeTree::Handle>& handles, std::uint32_t arc) {
    const Arc& one = arcs_[arc];
    const SightEdge edge{surface_.surface_point(one.from), surface_.surface_point(one.to), 0.0,
                         0.0};
    const EdgeTree::Handle h = handles[arc] = tree.insert(edge, arc);
    relate(tree, tree.next_nearer(h), h);
    relate(tree, h, tree.next_farther(h));
  }

  void erase(EdgeTree& tree, std::vector<EdgeTree::Handle>& handles, std::uint32_t edge) {
    const std::uint32_t arc = second_[edge] != kNone ? second_[edge] : edge;
    const EdgeTree::Handle h = handles[arc];
    if (h == EdgeTree::kNone) return;  // it ends at the cut, and begins before
    relate(tree, tree.next_nearer(h), tree.next_farther(h));
    tree.erase(h);
    handles[arc] = EdgeTree::kNone;
  }

  // Topological order (Kahn, "Topological sorting of large networks", 1962).
  std::vector<std::uint32_t> follow(Pulse& pulse) {
    std::vector<std::uint32_t> begins(size() + 1, 0), before(size(), 0);
    for (const auto& [near, far] : relations_) {
      ++begins[near];
      ++before[far];
    }
    std::uint32_t sum = 0;
    for (std::uint32_t& begin : begins) begin = sum += begin;
    std::vector<std::uint32_t> behind(relations_.size());
    for (const auto& [near, far] : relations_) behind[--begins[near]] = far;
    decltype(relations_)().swap(relations_);  // lets go of the most memory of all
    std::vector<std::uint32_t> order, open;
    for (std::uint32_t a = 0; a < size(); ++a) {
      if (before[a] == 0) open.push_back(a);
    }
    while (!open.empty() && pulse.goes_on()) {
      const std::uint32_t a = open.back();
      open.pop_back();
      order.push_back(a);
      for (std::uint32_t i = begins[a]; i < begins[a + 1]; ++i) {
        if (--before[behind[i]] == 0) open.push_back(behind[i]);
      }
    }
    return order;
  }

  const Surface& surface_;
  const View& view_;
  const Directions& directions_;
  const SightEdges& edges_;
  std::vector<Arc> arcs_;  // by number of the edge, then the second parts of those that are cut
  std::vector<std::uint32_t> second_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> relations_;
};

}  // namespace tinsmith::sight
