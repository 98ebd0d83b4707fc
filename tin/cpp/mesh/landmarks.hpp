// Landmarks: vertices spread over the mesh from which a walk may begin.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "../predicates/predicates.hpp"
#include "mesh.hpp"
#include "mesh_walk.hpp"

namespace tinsmith {

// A square grid with a vertex in most of its cells, of some thousand drawn at regular intervals.
// Vertices may go later: what is found must be looked at before it is used.
class Landmarks {
 public:
  static constexpr std::int32_t kDrawn = 8192;

  bool are_set() const { return !vertex_.empty(); }

  void set(const Mesh& mesh, const MeshPoints& points) {
    const std::vector<std::int32_t> drawn = draw(mesh, points.size());
    low_ = high_ = drawn.empty() ? Point{0.0, 0.0} : points[drawn[0]];
    for (const std::int32_t v : drawn) {
      low_ = {std::min(low_.x, points[v].x), std::min(low_.y, points[v].y)};
      high_ = {std::max(high_.x, points[v].x), std::max(high_.y, points[v].y)};
    }
    vertex_.assign(kSide * kSide, kGhost);
    for (const std::int32_t v : drawn) vertex_[cell_of(points[v])] = v;
  }

  // A vertex near p, or kGhost.
  std::int32_t near(Point p) const { return vertex_[cell_of(p)]; }

 private:
  static constexpr std::int32_t kSide = 64;  // two drawn for each cell

  static std::vector<std::int32_t> draw(const Mesh& mesh, std::size_t slots) {
    std::vector<std::int32_t> drawn;
    const std::size_t stride = std::max<std::size_t>(1, slots / kDrawn);
    for (std::size_t v = 0; v < slots; v += stride) {
      if (mesh.is_alive(static_cast<std::int32_t>(v))) drawn.push_back(static_cast<std::int32_t>(v));
    }
    return drawn;
  }

  std::size_t cell_of(Point p) const {
    return std::size_t{kSide} * along(p.y, low_.y, high_.y) + along(p.x, low_.x, high_.x);
  }
  static std::size_t along(double value, double low, double high) {
    const double share = high > low ? (value - low) / (high - low) : 0.0;
    return static_cast<std::size_t>(std::min(std::max(share * kSide, 0.0), kSide - 1.0));
  }

  std::vector<std::int32_t> vertex_;  // of each cell
  Point low_{0.0, 0.0}, high_{0.0, 0.0};
};

}  // namespace tinsmith
