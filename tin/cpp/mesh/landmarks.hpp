// Landmarks: vertices spread over the mesh from which a walk may begin, instead of those that
// jump-and-walk draws at random (point_search.hpp).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../base/box.hpp"
#include "../base/ids.hpp"
#include "mesh.hpp"
#include "mesh_points.hpp"

namespace tinsmith {

// A square grid with a vertex in most of its cells, of some thousand drawn at regular intervals.
// Vertices may go later: what is found must be looked at before it is used.
class Landmarks {
 public:
  static constexpr std::int32_t kDrawn = 8192;

  bool are_set() const { return !vertex_.empty(); }

  void set(const Mesh& mesh, const MeshPoints& points) {
    const std::vector<Vertex> drawn = draw(mesh, points.slots());
    box_ = Box{};
    for (const Vertex v : drawn) box_.include(points[v]);
    vertex_.assign(kSide * kSide, kGhost);
    for (const Vertex v : drawn) vertex_[cell_of(points[v])] = v;
  }

  // A vertex near p, or kGhost.
  Vertex near(Point p) const { return vertex_[cell_of(p)]; }

 private:
  static constexpr std::int32_t kSide = 64;  // two drawn for each cell

  static std::vector<Vertex> draw(const Mesh& mesh, std::int32_t slots) {
    std::vector<Vertex> drawn;
    const std::int32_t stride = std::max(1, slots / kDrawn);
    for (std::int32_t slot = 0; slot < slots; slot += stride) {
      if (mesh.is_alive(Vertex{slot})) drawn.push_back(Vertex{slot});
    }
    return drawn;
  }

  std::size_t cell_of(Point p) const {
    return std::size_t{kSide} * along(p.y, box_.south, box_.north) +
           along(p.x, box_.west, box_.east);
  }
  static std::size_t along(double value, double low, double high) {
    const double share = high > low ? (value - low) / (high - low) : 0.0;
    return static_cast<std::size_t>(std::min(std::max(share * kSide, 0.0), kSide - 1.0));
  }

  std::vector<Vertex> vertex_;  // of each cell
  Box box_;                     // around those drawn
};

}  // namespace tinsmith
