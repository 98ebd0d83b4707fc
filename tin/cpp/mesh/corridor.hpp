// A corridor: the triangles that a straight way crosses, replaced by others along the way.
//
// Its two sides are triangulated as the pseudo-polygons of Anglada, "An improved incremental
// algorithm for constructing restricted Delaunay triangulations" (1997); here any triangulation
// will do, for edges that are not Delaunay are flipped afterwards.
//
//        .------.                     .------.
//       / \    / \                   /        \        all triangles that a-b crosses go; the
//      a---\--/---b     becomes     a----------b       boundaries on both sides are filled
//       \   \/   /                   \        /
//        .---.--.                     .---.--.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "../base/ids.hpp"
#include "../predicates/predicates.hpp"
#include "mesh.hpp"
#include "mesh_points.hpp"

namespace tinsmith {

class Corridor {
 public:
  // Collect the triangles that the way from a to b crosses, and their boundary on its right and
  // left; `e` is the first edge across, from right to left. False if a fixed edge is in the way.
  bool open(const Mesh& mesh, const MeshPoints& points, Vertex a, Vertex b, HalfEdge e) {
    triangles_.assign(1, triangle_of(e));
    right_boundary_.assign(1, boundary_edge(mesh, mesh.before(e)));
    left_boundary_.assign(1, boundary_edge(mesh, mesh.after(e)));
    for (std::uint32_t most = mesh.triangle_slots(); most > 0; --most) {
      if (mesh.is_fixed(e)) return false;
      const HalfEdge f = mesh.twin(e);
      const Vertex ahead = mesh.apex(f);
      const int side = ahead == b ? 0 : orientation(points[a], points[b], points[ahead]);
      triangles_.push_back(triangle_of(f));
      if (side <= 0) right_boundary_.push_back(boundary_edge(mesh, mesh.after(f)));
      if (side >= 0) left_boundary_.push_back(boundary_edge(mesh, mesh.before(f)));
      if (side == 0) return true;
      e = side > 0 ? mesh.after(f) : mesh.before(f);
    }
    throw std::logic_error("a corridor did not reach its end");
  }

  // Fill the corridor on both sides of the way; returns the edge along it.
  HalfEdge close(Mesh& mesh, const MeshPoints& points) {
    spare_ = triangles_;
    inner_.clear();
    find_twice(mesh);
    std::reverse(left_boundary_.begin(), left_boundary_.end());
    const HalfEdge right = fill(mesh, points, right_boundary_);
    const HalfEdge left = fill(mesh, points, left_boundary_);
    mesh.join(right, left);
    join_boundary(mesh);
    return left;
  }

  // After closing: the edges between new triangles, but for the one along the way. Only these can
  // fail to be Delaunay, because a new fixed edge hides points from each other and shows none.
  const std::vector<HalfEdge>& inner_edges() const { return inner_; }

 private:
  // An edge on the boundary of the triangles that are replaced: as seen from within, from without,
  // and from the triangle that comes in their place.
  struct BoundaryEdge {
    Vertex from, to;
    HalfEdge inner, outer, made;
    bool is_fixed, is_twice;  // is_twice: with the corridor on both of its sides
  };
  struct Open {
    Vertex from, to;
    HalfEdge beyond;         // of a triangle made already,
    BoundaryEdge* boundary;  // or on the boundary
  };
  static BoundaryEdge boundary_edge(const Mesh& mesh, HalfEdge e) {
    return {mesh.from(e), mesh.to(e), e, mesh.twin(e), kNoHalfEdge, mesh.is_fixed(e), false};
  }

  // Triangulate between a boundary, counter-clockwise, and the edge from its end to its start:
  // wherever two edges turn left, a triangle takes their place. Every vertex of the boundary sees
  // the closing edge, so none lies in the way. Returns the closing edge, as seen from within.
  HalfEdge fill(Mesh& mesh, const MeshPoints& points, std::vector<BoundaryEdge>& boundary) {
    std::vector<Open>& open = open_;
    open.clear();
    const auto attach = [this, &mesh](const Open& edge, HalfEdge side) {
      if (edge.boundary == nullptr) {
        mesh.join(side, edge.beyond);
        inner_.push_back(side);
      } else {
        edge.boundary->made = side;
      }
    };
    for (BoundaryEdge& next : boundary) {
      Open last{next.from, next.to, kNoHalfEdge, &next};
      while (!open.empty() &&
             orientation(points[open.back().from], points[last.from], points[last.to]) > 0) {
        const Open before = open.back();
        open.pop_back();
        const Triangle t = spare_.back();
        spare_.pop_back();
        mesh.reuse(t, before.from, last.from, last.to);
        attach(last, half_edge(t, 0));
        attach(before, half_edge(t, 2));
        last = {before.from, last.to, half_edge(t, 1), nullptr};
      }
      open.push_back(last);
    }
    return open.back().beyond;
  }

  void find_twice(Mesh& mesh) {
    for (const Triangle t : triangles_) mesh.mark(t);
    for (std::vector<BoundaryEdge>* const boundary : {&right_boundary_, &left_boundary_}) {
      for (BoundaryEdge& edge : *boundary) edge.is_twice = mesh.is_marked(triangle_of(edge.outer));
    }
  }

  void join_boundary(Mesh& mesh) {
    twice_.clear();
    for (std::vector<BoundaryEdge>* const boundary : {&right_boundary_, &left_boundary_}) {
      for (BoundaryEdge& edge : *boundary) {
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
    const auto is_before = [](const BoundaryEdge* a, const BoundaryEdge* b) {
      return a->inner < b->inner;
    };
    std::sort(twice_.begin(), twice_.end(), is_before);
    for (BoundaryEdge* const edge : twice_) {
      const auto other = std::lower_bound(
          twice_.begin(), twice_.end(), edge->outer,
          [](const BoundaryEdge* candidate, HalfEdge sought) { return candidate->inner < sought; });
      if (other == twice_.end() || (*other)->inner != edge->outer) {
        throw std::logic_error("a corridor's boundary is not closed");
      }
      mesh.join(edge->made, (*other)->made);
      mesh.fix(edge->made, edge->is_fixed);
    }
  }

  std::vector<Triangle> triangles_, spare_;
  std::vector<BoundaryEdge> right_boundary_, left_boundary_;
  std::vector<BoundaryEdge*> twice_;
  std::vector<HalfEdge> inner_;
  std::vector<Open> open_;
};

}  // namespace tinsmith
