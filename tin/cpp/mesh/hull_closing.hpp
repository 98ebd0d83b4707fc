// A surface with any boundary becomes one of the whole convex hull: what is between them, and what
// is in holes, is filled with triangles.
//
//          a ----------- b         Where the boundary turns to the right, from a over v to b, the
//           .  made   .            triangle a-b-v comes in the place of two ghosts (Graham, "An
//             .     .              efficient algorithm for determining the convex hull of a finite
//      surface   v    surface      planar set", 1972).
//
// Whether such a triangle covers others nobody looks at. But if all triangles are turned the right
// way, and what bounds them in the end is one convex polygon, then every place within it is covered
// once: so they are a triangulation, and the boundary did not cross itself.
#pragma once

#include <cstddef>
#include <unordered_set>
#include <vector>

#include "../base/ids.hpp"
#include "../predicates/predicates.hpp"
#include "mesh.hpp"
#include "mesh_points.hpp"

namespace tinsmith {

class HullClosing {
 public:
  HullClosing(Mesh& mesh, const MeshPoints& points) : mesh_(mesh), points_(points) {}

  // The triangles of the surface are turned the right way. False if it cannot be closed so: then the
  // mesh is not to be used any more.
  bool close(std::vector<Triangle>& made) {
    std::vector<Ring> rings = find_rings();
    std::size_t outer = 0;
    for (Ring& ring : rings) {
      if (!straighten(ring, made)) continue;  // it was a hole, which is gone
      if (++outer > 1 || !is_convex(ring)) return false;
    }
    return outer == 1;
  }

 private:
  // Of edges as seen from their ghosts.
  struct Ring {
    HalfEdge edge;
    std::size_t size;
  };

  // Along the boundary: from(e) is the end of an edge, to(e) its start, the surface on the left.
  HalfEdge next(HalfEdge e) const { return Mesh::before(mesh_.twin(Mesh::before(e))); }
  HalfEdge previous(HalfEdge e) const { return Mesh::after(mesh_.twin(Mesh::after(e))); }

  HalfEdge edge_of(Triangle ghost) const {
    for (const HalfEdge e : half_edges(ghost)) {
      if (mesh_.apex(e) == kGhost) return e;
    }
    return kNoHalfEdge;
  }

  std::vector<Ring> find_rings() const {
    std::vector<Ring> rings;
    std::unordered_set<std::uint32_t> seen;
    for (const Triangle t : mesh_.triangles()) {
      if (mesh_.is_free(t) || !mesh_.is_ghost(t) || seen.count(number(t)) > 0) continue;
      Ring ring{edge_of(t), 0};
      HalfEdge e = ring.edge;
      do {
        seen.insert(number(triangle_of(e)));
        ++ring.size;
        e = next(e);
      } while (e != ring.edge);
      rings.push_back(ring);
    }
    return rings;
  }

  // Fill what turns right; false if nothing is left of the ring.
  bool straighten(Ring& ring, std::vector<Triangle>& made) {
    HalfEdge e = ring.edge;
    for (std::size_t straight = 0; straight < ring.size;) {
      const HalfEdge after = next(e);
      const Point a = points_[mesh_.to(e)], v = points_[mesh_.from(e)];
      if (orientation(a, v, points_[mesh_.from(after)]) >= 0) {
        e = after;
        ++straight;
        continue;
      }
      made.push_back(triangle_of(after));
      mesh_.flip(Mesh::before(e));
      e = edge_of(triangle_of(e));
      if (--ring.size == 2) {
        mesh_.drop_pair(e, next(e));
        return false;
      }
      e = previous(e);
      straight = 0;
    }
    ring.edge = e;
    return true;
  }

  // One that nowhere turns right, and goes round once: it turns back from east to west once.
  bool is_convex(const Ring& ring) const {
    std::size_t turns = 0;
    HalfEdge e = ring.edge;
    for (std::size_t i = 0; i < ring.size; ++i, e = next(e)) {
      const Point a = points_[mesh_.to(e)], v = points_[mesh_.from(e)];
      const Point b = points_[mesh_.from(next(e))];
      turns += lexicographically_before(a, v) && lexicographically_before(b, v);
    }
    return turns == 1;
  }

  Mesh& mesh_;
  const MeshPoints& points_;
};

}  // namespace tinsmith
