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
    inner_.clear();
    find_twice(mesh);
    std::reverse(left_rim_.begin(), left_rim_.end());
    const MeshEdge right = fill(mesh, points, right_rim_);
    const MeshEdge left = fill(mesh, points, left_rim_);
    mesh.join(right, left);
    join_rim(mesh);
    return left;
  }

  // After closing: the edges between new triangles, but for the one along the way. Only these can
  // fail to be Delaunay, because a new fixed edge hides points from each other and shows none.
  const std::vector<MeshEdge>& inner_edges() const { return inner_; }

 private:
  // An edge on the rim of the triangles that are replaced: as seen from within, from without, and
  // from the triangle that comes in their place.
  struct RimEdge {
    std::int32_t from, to;
    MeshEdge inner, outer, made;
    bool is_fixed, is_twice;  // is_twice: with the corridor on both of its sides
  };
  struct Open {
    std::int32_t from, to;
    MeshEdge beyond;  // of a triangle made already,
    RimEdge* rim;     // or on the rim
  };
  static RimEdge rim_edge(const Mesh& mesh, MeshEdge e) {
    return {mesh.from(e), mesh.to(e), e, mesh.twin(e), kNoMeshEdge, mesh.is_fixed(e), false};
  }

  // Triangulate between a rim, counter-clockwise, and the edge from its end to its start: wherever
  // two edges turn left, a triangle takes their place. Every vertex of the rim sees the closing
  // edge, so none lies in the way. Returns the closing edge, as seen from within.
  MeshEdge fill(Mesh& mesh, const Point* points, std::vector<RimEdge>& rim) {
    std::vector<Open>& open = open_;
    open.clear();
    const auto attach = [this, &mesh](const Open& edge, MeshEdge side) {
      if (edge.rim == nullptr) {
        mesh.join(side, edge.beyond);
        inner_.push_back(side);
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

  void find_twice(Mesh& mesh) {
    for (const std::uint32_t t : triangles_) mesh.mark(t);
    for (std::vector<RimEdge>* const rim : {&right_rim_, &left_rim_}) {
      for (RimEdge& edge : *rim) edge.is_twice = mesh.is_marked(triangle_of(edge.outer));
    }
  }

  void join_rim(Mesh& mesh) {
    twice_.clear();
    for (std::vector<RimEdge>* const rim : {&right_rim_, &left_rim_}) {
      for (RimEdge& edge : *rim) {
        if (edge.is_twice) {
          twice_.push_back(&edge);
        } else {
          mesh.join(edge.made, edge.outer);
          if (edge.is_fixed) mesh.fix(edge.made, true);
        }
      }
    }
    join_twice(mesh);
  }

  void join_twice(Mesh& mesh) {
    const auto is_before = [](const RimEdge* a, const RimEdge* b) { return a->inner < b->inner; };
    std::sort(twice_.begin(), twice_.end(), is_before);
    for (RimEdge* const edge : twice_) {
      const auto other = std::lower_bound(
          twice_.begin(), twice_.end(), edge->outer,
          [](const RimEdge* candidate, MeshEdge sought) { return candidate->inner < sought; });
      mesh.join(edge->made, (*other)->made);
      mesh.fix(edge->made, edge->is_fixed);
    }
  }

  std::vector<std::uint32_t> triangles_, spare_;
  std::vector<RimEdge> right_rim_, left_rim_;
  std::vector<RimEdge*> twice_;
  std::vector<MeshEdge> inner_;
  std::vector<Open> open_;
};

}  // namespace tinsmith
