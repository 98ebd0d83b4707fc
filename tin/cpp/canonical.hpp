// Canonical order: triangles numbered as the growth would have made them.
//
// A triangle belongs to its first vertex in the sweep and begins with it. The triangles of a
// vertex form sectors; sectors are ordered by the vertex they start at, triangles within one
// counter-clockwise. A vertex that owns its whole star starts at its nearest neighbour.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "growth.hpp"
#include "insertion.hpp"
#include "predicates.hpp"

namespace tinsmith {

class CanonicalOrder {
 public:
  CanonicalOrder(const PointGrid& grid, const GhostMesh& mesh)
      : grid_(grid), mesh_(mesh), number_of_(mesh.corners.size() / 3, kNoNeighbor) {
    bucket_by_owner();
  }

  void write(Triangles out) {
    for (std::int32_t v = 0; v < grid_.count(); ++v) {
      starts_.clear();
      for (std::int32_t i = begin_[v]; i < begin_[v + 1]; ++i) {
        if (!is_owned_by(v, mesh_.twins[side(owned_[i], 2)] / 3)) starts_.push_back(owned_[i]);
      }
      if (starts_.empty() && begin_[v] < begin_[v + 1]) starts_.push_back(nearest_start(v));
      std::sort(starts_.begin(), starts_.end(), [this](std::int32_t a, std::int32_t b) {
        return corner(a, 1) < corner(b, 1);
      });
      for (const std::int32_t start : starts_) number_sector(v, start, out);
    }
    write_neighbors(out);
  }

 private:
  // Place of the first vertex of the sweep within a triangle.
  std::int32_t turn(std::int32_t triangle) const {
    const std::int32_t* c = &mesh_.corners[3 * triangle];
    return c[0] < c[1] ? (c[0] < c[2] ? 0 : 2) : (c[1] < c[2] ? 1 : 2);
  }

  // Half-edge and corner k when the triangle begins with its first vertex.
  std::int32_t side(std::int32_t triangle, std::int32_t k) const {
    return 3 * triangle + (turn(triangle) + k) % 3;
  }
  std::int32_t corner(std::int32_t triangle, std::int32_t k) const {
    return mesh_.corners[side(triangle, k)];
  }
  bool is_owned_by(std::int32_t v, std::int32_t triangle) const {
    return !mesh_.is_ghost(triangle) && corner(triangle, 0) == v;
  }

  void bucket_by_owner() {
    begin_.assign(grid_.count() + 1, 0);
    const auto count = static_cast<std::int32_t>(number_of_.size());
    std::int32_t real = 0;
    for (std::int32_t t = 0; t < count; ++t) {
      if (mesh_.is_ghost(t)) continue;
      ++begin_[corner(t, 0)];
      ++real;
    }
    std::int32_t total = 0;
    for (auto& begin : begin_) {
      total += begin;
      begin = total;
    }
    owned_.resize(real);
    for (std::int32_t t = count; t-- > 0;) {
      if (!mesh_.is_ghost(t)) owned_[--begin_[corner(t, 0)]] = t;
    }
  }

  std::int32_t nearest_start(std::int32_t v) const {
    const auto place = [this](std::int32_t u) { return grid_.point(static_cast<Vertex>(u)); };
    const auto is_nearer = [&](std::int32_t a, std::int32_t b) {
      const int order = compare_distances(place(v), place(corner(a, 1)), place(corner(b, 1)));
      return order < 0 || (order == 0 && corner(a, 1) < corner(b, 1));
    };
    return *std::min_element(owned_.begin() + begin_[v], owned_.begin() + begin_[v + 1],
                             is_nearer);
  }

  void number_sector(std::int32_t v, std::int32_t start, Triangles out) {
    std::int32_t triangle = start;
    do {
      for (int k = 0; k < 3; ++k) out.corners[3 * made_ + k] = corner(triangle, k);
      number_of_[triangle] = made_++;
      triangle = mesh_.twins[side(triangle, 1)] / 3;
    } while (triangle != start && is_owned_by(v, triangle));
  }

  void write_neighbors(Triangles out) const {
    const auto count = static_cast<std::int32_t>(number_of_.size());
    for (std::int32_t t = 0; t < count; ++t) {
      if (mesh_.is_ghost(t)) continue;
      for (int k = 0; k < 3; ++k) {
        out.neighbors[3 * number_of_[t] + k] = number_of_[mesh_.twins[side(t, k)] / 3];
      }
    }
  }

  const PointGrid& grid_;
  const GhostMesh& mesh_;
  std::vector<std::int32_t> number_of_;  // of each triangle of the mesh; ghosts have none
  std::vector<std::int32_t> begin_, owned_;
  std::vector<std::int32_t> starts_;
  std::int32_t made_ = 0;
};

}  // namespace tinsmith
