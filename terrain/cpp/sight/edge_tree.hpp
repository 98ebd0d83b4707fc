// The edges that a direction crosses, from the eye outwards, with the highest of each part.
//
// A treap (Seidel and Aragon, "Randomized search trees", 1996), whose priorities are made of the
// numbers of edges: it has one shape for one set of edges.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "../../../tin/cpp/predicates/predicates.hpp"
#include "eye.hpp"

namespace tinsmith::sight {

// An edge, counter-clockwise about the eye.
struct SightEdge {
  SurfacePoint from, to;
  double bound;  // the steepest ray that it may block, by the rule
  double reach;  // for the rule: how far the triangles beside it extend
};

class EdgeTree {
 public:
  using Handle = std::int32_t;
  static constexpr Handle kNone = -1;

  explicit EdgeTree(Point eye) : eye_(eye) {}

  Handle root() const { return root_; }
  const SightEdge& edge(Handle h) const { return nodes_[h].edge; }
  double highest(Handle h) const { return h == kNone ? kNothing : nodes_[h].highest; }
  Handle nearer(Handle h) const { return nodes_[h].child[kNearer]; }
  Handle farther(Handle h) const { return nodes_[h].child[kFarther]; }
  std::uint32_t number(Handle h) const { return nodes_[h].number; }

  // The edge next to one, nearer or farther; kNone if there is none.
  Handle next_nearer(Handle h) const { return next(h, kNearer); }
  Handle next_farther(Handle h) const { return next(h, kFarther); }

  void clear() {
    nodes_.clear();
    free_.clear();
    root_ = kNone;
  }

  // All edges of the tree cross one direction, or begin there.
  Handle insert(const SightEdge& edge, std::uint32_t number) {
    const Handle h = make(edge, number);
    if (root_ == kNone) {
      root_ = h;
      return h;
    }
    for (Handle at = root_;;) {
      Node& node = nodes_[at];
      node.highest = std::max(node.highest, edge.bound);
      const int side = is_nearer(edge, node.edge) ? kNearer : kFarther;
      if (node.child[side] == kNone) {
        node.child[side] = h;
        nodes_[h].parent = at;
        break;
      }
      at = node.child[side];
    }
    while (nodes_[h].parent != kNone && nodes_[nodes_[h].parent].priority < nodes_[h].priority) {
      rotate_up(h);
    }
    return h;
  }

  void erase(Handle h) {
    for (;;) {
      const Handle near = nearer(h), far = farther(h);
      if (near == kNone && far == kNone) break;
      const bool take_near =
          far == kNone || (near != kNone && nodes_[near].priority > nodes_[far].priority);
      rotate_up(take_near ? near : far);
    }
    const Handle parent = nodes_[h].parent;
    replace(parent, h, kNone);
    for (Handle at = parent; at != kNone && update(at);) at = nodes_[at].parent;
    free_.push_back(h);
  }

 private:
  static constexpr double kNothing = -std::numeric_limits<double>::infinity();
  enum Side { kNearer, kFarther };

  struct Node {
    SightEdge edge;
    double highest;  // of the bounds of it and of all below
    Handle child[2], parent;
    std::uint32_t priority, number;
  };

  Handle next(Handle h, int side) const {
    Handle at = nodes_[h].child[side];
    if (at != kNone) {
      while (nodes_[at].child[1 - side] != kNone) at = nodes_[at].child[1 - side];
      return at;
    }
    for (at = nodes_[h].parent; at != kNone && nodes_[at].child[side] == h;) {
      h = at;
      at = nodes_[h].parent;
    }
    return at;
  }

  Handle make(const SightEdge& edge, std::uint32_t number) {
    std::uint32_t mixed = number * 0x9e3779b9u;  // bits of the number, mixed (MurmurHash3)
    mixed = (mixed ^ (mixed >> 16)) * 0x85ebca6bu;
    mixed = (mixed ^ (mixed >> 13)) * 0xc2b2ae35u;
    const Node node{edge, edge.bound, {kNone, kNone}, kNone, mixed ^ (mixed >> 16), number};
    if (free_.empty()) {
      nodes_.push_back(node);
      return static_cast<Handle>(nodes_.size()) - 1;
    }
    const Handle h = free_.back();
    free_.pop_back();
    nodes_[h] = node;
    return h;
  }

  // Where both are crossed the one comes first; of two that begin or end together, beside it.
  bool is_nearer(const SightEdge& one, const SightEdge& other) const {
    const Point a = one.from.at, b = one.to.at, c = other.from.at, d = other.to.at;
    if (orientation(eye_, c, a) >= 0) {
      const int side = orientation(c, d, a);
      return (side != 0 ? side : orientation(c, d, b)) > 0;
    }
    const int side = orientation(a, b, c);
    return (side != 0 ? side : orientation(a, b, d)) < 0;
  }

  void replace(Handle parent, Handle old, Handle now) {
    if (parent == kNone) {
      root_ = now;
    } else {
      nodes_[parent].child[nearer(parent) == old ? kNearer : kFarther] = now;
    }
    if (now != kNone) nodes_[now].parent = parent;
  }

  void rotate_up(Handle h) {
    const Handle parent = nodes_[h].parent;
    const int side = nearer(parent) == h ? kNearer : kFarther;
    const Handle inner = nodes_[h].child[1 - side];
    replace(nodes_[parent].parent, parent, h);
    nodes_[parent].child[side] = inner;
    if (inner != kNone) nodes_[inner].parent = parent;
    nodes_[h].child[1 - side] = parent;
    nodes_[parent].parent = h;
    update(parent);
    update(h);
  }

  // Whether it has changed.
  bool update(Handle h) {
    const double old = nodes_[h].highest;
    nodes_[h].highest = std::max({nodes_[h].edge.bound, highest(nearer(h)), highest(farther(h))});
    return nodes_[h].highest != old;
  }

  Point eye_;
  Handle root_ = kNone;
  std::vector<Node> nodes_;
  std::vector<Handle> free_;
};

}  // namespace tinsmith::sight
