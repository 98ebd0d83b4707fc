// A corridor: the triangles that a straight way crosses, replaced by others along the way.
//
//        .------.                     .------.
//       / \    / \                   /        \        all triangles that a-b crosses go; the
//      a---\--/---b     becomes     a----------b       rims on both sides are filled
//       \   \/   /                   \        /
//        .---.--.                     .---.--.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "../predicates/predicates.hpp"
#include "mesh.hpp"

namespace tinsmith {

class Corridor {
 public:
  // Collect the triangles that the way from a to b crosses, and their rim on its right and left;
  // `e` is the first edge across, from right to left. False if a fixed edge is in the way.
  bool open(const Mesh& mesh, const Point* points, std::int32_t a, std::int32_t b,
            MeshEdge e) {
    triangles_.assign(1, triangle_of(e));
    right_rim_.assign(1, rim_edge(mesh, mesh.before(e)));
    left_rim_.assign(1, rim_edge(mesh, mesh.after(e)));
    while (true) {
      if (mesh.is_fixed(e)) return false;
      const MeshEdge f = mesh.twin(e);
      const std::int32_t ahead = mesh.corner(f);
      const int side = ahead == b ? 0 : orientation(points[a], points[b], points[ahead]);
      triangles_.push_back(triangle_of(f));
      if (side <= 0) right_rim_.push_back(rim_edge(mesh, mesh.after(f)));
      if (side >= 0) left_rim_.push_back(rim_edge(mesh, mesh.before(f)));
      if (side == 0) return true;
      e = side > 0 ? mesh.after(f) : mesh.before(f);
    }
  }

  // Fill the corridor on both sides of the way; returns the edge along it.
  MeshEdge close(Mesh& mesh, const Point* points) {
    spare_ = triangles_;
    std::reverse(left_rim_.begin(), left_rim_.end());
    const MeshEdge right = fill(mesh, points, right_rim_);
    const MeshEdge left = fill(mesh, points, left_rim_);
    mesh.join(right, left);
    join_rim(mesh);
    return left;
  }

  // The triangles crossed, and after closing those in their place.
  const std::vector<std::uint32_t>& triangles() const { return triangles_; }

 private:
  // An edge on the rim of the triangles that are replaced: as seen from within, from without, and
  // from the triangle that comes in their place.
  struct RimEdge {
    std::int32_t from, to;
    MeshEdge inner, outer, made;
    bool is_fixed;
  };
  struct Open {
    std::int32_t from, to;
    MeshEdge beyond;  // of a triangle made already,
    RimEdge* rim;     // or on the rim
  };
  static RimEdge rim_edge(const Mesh& mesh, MeshEdge e) {
    return {mesh.from(e), mesh.to(e), e, mesh.twin(e), kNoMeshEdge, mesh.is_fixed(e)};
  }

  // Triangulate between a rim, counter-clockwise, and the edge from its end to its start: wherever
  // two edges turn left, a triangle takes their place. Every vertex of the rim sees the closing
  // edge, so none lies in the way. Returns the closing edge, as seen from within.
  MeshEdge fill(Mesh& mesh, const Point* points, std::vector<RimEdge>& rim) {
    std::vector<Open>& open = open_;
    open.clear();
    const auto attach = [&mesh](const Open& edge, MeshEdge side) {
      if (edge.rim == nullptr) {
        mesh.join(side, edge.beyond);
      } else {
        edge.rim->made = side;
      }
    };
    for (RimEdge& next : rim) {
      Open last{next.from, next.to, kNoMeshEdge, &next};
      while (!open.empty() && orientation(points[open.back().from], points[last.from], points[last.to]) > 0) {
        const Open before = open.back();
        open.pop_back();
        const std::uint32_t t = spare_.back();
        spare_.pop_back();
        mesh.reuse(t, before.from, last.from, last.to);
        attach(last, mesh_edge(t, 0));
        attach(before, mesh_edge(t, 2));
        last = {before.from, last.to, mesh_edge(t, 1), nullptr};
      }
      open.push_back(last);
    }
    return open.back().beyond;
  }

  // An edge may be on the rim twice, with the corridor on both of its sides.
  void join_rim(Mesh& mesh) {
    std::vector<RimEdge*>& rim = rim_;
    rim.clear();
    for (RimEdge& edge : right_rim_) rim.push_back(&edge);
    for (RimEdge& edge : left_rim_) rim.push_back(&edge);
    const auto is_before = [](const RimEdge* a, const RimEdge* b) { return a->inner < b->inner; };
    std::sort(rim.begin(), rim.end(), is_before);
    for (RimEdge* edge : rim) {
      const auto other = std::lower_bound(
          rim.begin(), rim.end(), edge->outer,
          [](const RimEdge* candidate, MeshEdge sought) { return candidate->inner < sought; });
      const bool is_twice = other != rim.end() && (*other)->inner == edge->outer;
      mesh.join(edge->made, is_twice ? (*other)->made : edge->outer);
    }
    for (RimEdge* edge : rim) mesh.fix(edge->made, edge->is_fixed);
  }

  std::vector<std::uint32_t> triangles_, spare_;
  std::vector<RimEdge> right_rim_, left_rim_;
  std::vector<RimEdge*> rim_;
  std::vector<Open> open_;
};

}  // namespace tinsmith
