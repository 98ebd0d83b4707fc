// A vertex within the surface goes, and its star is filled with Delaunay triangles at once: ear
// after ear whose circle holds no other corner of the star (Devillers, "On deletion in Delaunay
// triangulations", 1999). Nothing is left to flip.
#pragma once

#include "../base/ids.hpp"
#include "../predicates/predicates.hpp"
#include "mesh.hpp"
#include "mesh_points.hpp"

namespace tinsmith {

// The corners around the vertex are a polygon, counter-clockwise; an ear is called by its tip.
//
//      after --- tip       The ear becomes a triangle; the polygon goes on from `before` to `after`.
//         .     .
//          .   .           Of edges that are not Delaunay because they are fixed, no circle may be
//         before           empty: then this is no way, and nothing has been changed.
class StarFilling {
 public:
  // Whether v is within the surface, has few neighbours, and enough ears have empty circles.
  template <typename AnyMesh, typename Points>
  bool find(const AnyMesh& mesh, const Points& points, Vertex v) {
    return gather(mesh, points, v) && cut_ears();
  }

  // Fill the star that was found; returns the last triangle that was made.
  template <typename AnyMesh>
  Triangle fill(AnyMesh& mesh, Vertex v) {
    for (int i = 0; i < size_ - 3; ++i) {
      const int tip = ears_[i];
      const int before = before_[tip], after = after_[tip];
      const Triangle t = star_[i];
      make(mesh, t, before, tip, after);
      beyond_[before] = half_edge(t, 1);
    }
    const Triangle last = star_[size_ - 3];
    make(mesh, last, before_[left_], left_, after_[left_]);
    mesh.join(half_edge(last, 1), beyond_[after_[left_]]);
    keep_fixed(mesh, half_edge(last, 1));
    mesh.drop(v, star_[size_ - 2], star_[size_ - 1]);
    return last;
  }

 private:
  static constexpr int kMost = 16;

  template <typename AnyMesh, typename Points>
  bool gather(const AnyMesh& mesh, const Points& points, Vertex v) {
    size_ = 0;
    for (const HalfEdge e : mesh.around(v)) {
      const Vertex corner = mesh.to(e);
      if (size_ == kMost || corner == kGhost) return false;
      corner_[size_] = corner;
      point_[size_] = points[corner];
      star_[size_] = triangle_of(e);
      beyond_[size_] = mesh.twin(Mesh::after(e));
      ++size_;
    }
    return true;
  }

  bool cut_ears() {
    for (int i = 0; i < size_; ++i) {
      before_[i] = i == 0 ? size_ - 1 : i - 1;
      after_[i] = i == size_ - 1 ? 0 : i + 1;
    }
    int tip = 0;
    for (int left = size_; left > 3; --left) {
      for (int misses = 0; !is_delaunay_ear(tip); ++misses) {
        if (misses == left) return false;
        tip = after_[tip];
      }
      ears_[size_ - left] = tip;
      after_[before_[tip]] = after_[tip];
      before_[after_[tip]] = before_[tip];
      tip = after_[tip];
    }
    left_ = tip;
    return orientation(point_[before_[tip]], point_[tip], point_[after_[tip]]) > 0;
  }

  bool is_delaunay_ear(int tip) const {
    const int before = before_[tip], after = after_[tip];
    const Point a = point_[before], b = point_[tip], c = point_[after];
    if (orientation(a, b, c) <= 0) return false;
    for (int other = after_[after]; other != before; other = after_[other]) {
      if (is_in_circle(a, b, c, point_[other])) return false;
    }
    return true;
  }

  // The edge opposite the tip is not joined.
  template <typename AnyMesh>
  void make(AnyMesh& mesh, Triangle t, int before, int tip, int after) {
    mesh.reuse(t, corner_[before], corner_[tip], corner_[after]);
    mesh.join(half_edge(t, 2), beyond_[before]);
    mesh.join(half_edge(t, 0), beyond_[tip]);
    keep_fixed(mesh, half_edge(t, 2));
    keep_fixed(mesh, half_edge(t, 0));
  }

  template <typename AnyMesh>
  static void keep_fixed(AnyMesh& mesh, HalfEdge e) {
    if (mesh.is_fixed(mesh.twin(e))) mesh.fix(e, true);
  }

  int size_ = 0, left_ = 0;
  Vertex corner_[kMost];
  Point point_[kMost];
  Triangle star_[kMost];
  HalfEdge beyond_[kMost];  // across the edge from each corner to the next
  int before_[kMost], after_[kMost], ears_[kMost];
};

}  // namespace tinsmith
