// Canonical order: triangles numbered as the growth would have made them.
//
// A triangle belongs to its first vertex in the sweep and begins with it. The triangles of a
// vertex form sectors; sectors are ordered by the vertex they start at, triangles within one
// counter-clockwise. A vertex that owns its whole star starts at its nearest neighbour.
//
// Triangles are dealt out to their owners by counting, in the order of the mesh, and put in order
// within each owner: two or three at a time, in place. No walk about a vertex is needed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "ghost_mesh.hpp"
#include "grid.hpp"
#include "triangle_store.hpp"
#include "large_array.hpp"
#include "predicates.hpp"

namespace tinsmith {

class CanonicalOrder {
 public:
  // Corners of the mesh are sweep numbers.
  CanonicalOrder(const PointGrid& grid, const GhostMesh& mesh)
      : grid_(grid),
        triangles_(mesh.triangles.get()),
        count_(mesh.count),
        number_of_(large_array<std::int32_t>(mesh.count)),
        end_of_(grid.count() + std::size_t{1}) {}

  void write(Triangles out) {
    write(out, [] { return true; });
  }

  // Returns false if `keep_going` did.
  template <typename KeepGoing>
  bool write(Triangles out, KeepGoing&& keep_going) {
    count_owned(keep_going);
    deal(out);
    order_stars(out);
    write_neighbors(out);
    return true;
  }

 private:
  // Place of the first vertex of the sweep, or of the ghost.
  static std::uint32_t first_place(const GhostTriangle& t) {
    const bool is_second = t.corner[1] < t.corner[0];
    const std::int32_t lower = is_second ? t.corner[1] : t.corner[0];
    return t.corner[2] < lower ? 2 : is_second;
  }

  template <typename K>
  void count_owned(K&&) {
    std::int32_t* const counts = end_of_.data();
    for (std::uint32_t t = 0; t < count_; ++t) {
      const GhostTriangle& triangle = triangles_[t];
      const std::int32_t owner = std::min({triangle.corner[0], triangle.corner[1], triangle.corner[2]});
      ++counts[owner + 1];  // ghosts in front
    }
    std::int32_t total = 0;
    counts[0] = 0;
    for (auto& end : end_of_) {
      const std::int32_t size = end;
      end = total;  // the begin, until all are dealt out
      total += size;
    }
  }

  void deal(Triangles out) {
    for (std::uint32_t t = 0; t < count_; ++t) {
      const GhostTriangle& triangle = triangles_[t];
      const std::uint32_t place = first_place(triangle);
      const std::int32_t owner = triangle.corner[place];
      if (owner == kGhost) {
        number_of_[t] = kNoNeighbor;
        continue;
      }
      const std::int32_t at = end_of_[owner + 1]++;
      std::int32_t* const corner = out.corners + 3 * static_cast<std::int64_t>(at);
      corner[0] = owner;
      corner[1] = triangle.corner[place_after(place)];
      corner[2] = triangle.corner[place_before(place)];
      out.neighbors[at] = static_cast<std::int32_t>(t);
    }
  }

  struct Ray { std::int32_t from, to, triangle, next; bool is_start; };

  void order_stars(Triangles out) {
    std::int32_t begin = 0;
    const std::int32_t* const triangle = out.neighbors;
    for (std::int32_t v = 0; v < grid_.count(); ++v) {
      const std::int32_t end = end_of_[v + 1];
      std::int32_t* const corner = out.corners + 3 * static_cast<std::int64_t>(begin);
      if (end - begin == 1) {
        number_of_[triangle[begin]] = begin;
      } else if (end - begin == 2) {
        const std::int32_t f0 = corner[1], t0 = corner[2], f1 = corner[4], t1 = corner[5];
        const bool swap = t1 == f0 || (t0 != f1 && f1 < f0);
        corner[1] = swap ? f1 : f0;
        corner[2] = swap ? t1 : t0;
        corner[4] = swap ? f0 : f1;
        corner[5] = swap ? t0 : t1;
        number_of_[triangle[begin]] = begin + swap;
        number_of_[triangle[begin + 1]] = begin + 1 - swap;
      } else if (end - begin > 2) {
        order_star(v, begin, end, out);
      }
      begin = end;
    }
  }

  void order_star(std::int32_t v, std::int32_t begin, std::int32_t end, Triangles out) {
    rays_.clear();
    for (std::int32_t i = begin; i < end; ++i) {
      rays_.push_back({out.corners[3 * static_cast<std::int64_t>(i) + 1], out.corners[3 * static_cast<std::int64_t>(i) + 2], out.neighbors[i], -1, true});
    }
    std::sort(rays_.begin(), rays_.end(), [](const Ray& a, const Ray& b) { return a.from < b.from; });
    bool any = false;
    for (auto& ray : rays_) {
      auto it = std::lower_bound(rays_.begin(), rays_.end(), ray.to, [](const Ray& a, std::int32_t to) { return a.from < to; });
      if (it != rays_.end() && it->from == ray.to) { it->is_start = false; ray.next = static_cast<std::int32_t>(it - rays_.begin()); }
    }
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(rays_.size()); ++i) {
      if (rays_[i].is_start) { begin = emit(i, begin, out); any = true; }
    }
    if (!any) emit(nearest_start(v), begin, out);
  }

  std::int32_t emit(std::int32_t start, std::int32_t at, Triangles out) {
    std::int32_t i = start;
    do {
      out.corners[3 * static_cast<std::int64_t>(at) + 1] = rays_[i].from;
      out.corners[3 * static_cast<std::int64_t>(at) + 2] = rays_[i].to;
      number_of_[rays_[i].triangle] = at++;
      i = rays_[i].next;
    } while (i >= 0 && i != start);
    return at;
  }

  std::int32_t nearest_start(std::int32_t v) const {
    const auto place = [this](std::int32_t u) { return grid_.point(static_cast<Vertex>(u)); };
    std::int32_t best = 0;
    for (std::int32_t i = 1; i < static_cast<std::int32_t>(rays_.size()); ++i) {
      const int order = compare_distances(place(v), place(rays_[i].from), place(rays_[best].from));
      if (order < 0 || (order == 0 && rays_[i].from < rays_[best].from)) best = i;
    }
    return best;
  }

  void write_neighbors(Triangles out) const {
    const std::int32_t* const number_of = number_of_.get();
    for (std::uint32_t t = 0; t < count_; ++t) {
      const std::int32_t number = number_of[t];
      if (number == kNoNeighbor) continue;
      const GhostTriangle& triangle = triangles_[t];
      const std::uint32_t place = first_place(triangle);
      std::int32_t* const neighbor = out.neighbors + 3 * static_cast<std::int64_t>(number);
      neighbor[0] = number_of[triangle_of(triangle.twin[place])];
      neighbor[1] = number_of[triangle_of(triangle.twin[place_after(place)])];
      neighbor[2] = number_of[triangle_of(triangle.twin[place_before(place)])];
    }
  }

  const PointGrid& grid_;
  const GhostTriangle* triangles_;
  std::uint32_t count_;
  LargeArray<std::int32_t> number_of_;  // of each triangle of the mesh; ghosts have none
  std::vector<std::int32_t> end_of_;
  std::vector<Ray> rays_;
};

}  // namespace tinsmith
