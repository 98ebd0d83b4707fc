// The triangles that would take the place of a vertex's star if the vertex went, found without
// changing the mesh.
//
// An ear of the star is one of them if no other corner lies in its circle; cut off, it leaves a
// smaller star (as in O. Devillers, "On deletion in Delaunay triangulations", 1999). Ties are
// decided by the points alone, so they are the triangles that the removal would leave.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "../base/ids.hpp"
#include "../mesh/mesh_editor.hpp"
#include "../predicates/predicates.hpp"

namespace tinsmith {

struct GapTriangle {
  Vertex corner[3];  // counter-clockwise
};

class StarGap {
 public:
  // For a vertex inside, without fixed edges. False if it cannot be told so, which is where fixed
  // edges hide corners from each other, or would take long: ears are looked for among all corners.
  bool find(const MeshEditor& editor, Vertex v) {
    ring_.clear();
    triangles_.clear();
    for (const HalfEdge e : editor.mesh().around(v)) {
      const Vertex end = editor.mesh().to(e);
      ring_.push_back({end, editor.point(end)});
      if (ring_.size() > kMostCorners) return false;
    }
    while (ring_.size() > 3) {
      if (!cut_ear()) return false;
    }
    const bool is_turned_right = orientation(ring_[0].at, ring_[1].at, ring_[2].at) > 0;
    if (is_turned_right) keep(0, 1, 2);
    return is_turned_right;
  }

  const std::vector<GapTriangle>& triangles() const { return triangles_; }

 private:
  static constexpr std::size_t kMostCorners = 64;

  struct Corner {
    Vertex vertex;
    Point at;
  };

  void keep(std::size_t a, std::size_t b, std::size_t c) {
    triangles_.push_back({{ring_[a].vertex, ring_[b].vertex, ring_[c].vertex}});
  }

  std::size_t after(std::size_t place) const { return place + 1 < ring_.size() ? place + 1 : 0; }

  bool cut_ear() {
    for (std::size_t a = 0; a < ring_.size(); ++a) {
      const std::size_t b = after(a), c = after(b);
      if (!is_ear(a, b, c)) continue;
      keep(a, b, c);
      ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(b));
      return true;
    }
    return false;
  }

  bool is_ear(std::size_t a, std::size_t b, std::size_t c) const {
    const Point p = ring_[a].at, q = ring_[b].at, r = ring_[c].at;
    if (orientation(p, q, r) <= 0) return false;
    for (std::size_t i = after(c); i != a; i = after(i)) {
      if (is_in_circle(p, q, r, ring_[i].at)) return false;
    }
    return true;
  }

  std::vector<Corner> ring_;
  std::vector<GapTriangle> triangles_;
};

}  // namespace tinsmith
