// Landmarks: vertices spread over the mesh from which a walk may begin, instead of those that
// jump-and-walk draws at random (point_search.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../base/box.hpp"
#include "../base/ids.hpp"
#include "mesh.hpp"
#include "mesh_points.hpp"

namespace tinsmith {

// A square grid with a vertex in or beside most of its cells, of many drawn at regular intervals.
// Vertices may go later: what is found must be looked at before it is used.
class Landmarks {
 public:
  static constexpr std::int32_t kLeast = 8192;  // slots for which it is worth it

  bool are_set() const { return !vertex_.empty(); }

  void set(const Mesh& mesh, const MeshPoints& points) {
    const std::int32_t wanted = std::clamp(points.slots() / 8, kLeast, kMost);
    const std::vector<Vertex> drawn = draw(mesh, points.slots(), wanted);
    box_ = Box{};
    for (const Vertex v : drawn) box_.include(points[v]);
    side_ = static_cast<std::size_t>(std::sqrt(wanted / kDrawnInCell));
    vertex_.assign(side_ * side_, kGhost);
    for (const Vertex v : drawn) vertex_[cell_of(points[v])] = v;
    fill_from_beside();
  }

  // A vertex near p, or kGhost.
  Vertex near(Point p) const { return vertex_[cell_of(p)]; }

 private:
  static constexpr std::int32_t kMost = 65536;  // to draw them takes a share of making the mesh
  static constexpr double kDrawnInCell = 2.0;

  static std::vector<Vertex> draw(const Mesh& mesh, std::int32_t slots, std::int32_t wanted) {
    std::vector<Vertex> drawn;
    const std::int32_t stride = std::max(1, slots / wanted);
    for (std::int32_t slot = 0; slot < slots; slot += stride) {
      if (mesh.is_alive(Vertex{slot})) drawn.push_back(Vertex{slot});
    }
    return drawn;
  }

  // A cell without a vertex takes that of the cell on its left or right.
  void fill_from_beside() {
    const std::vector<Vertex> own = vertex_;
    for (std::size_t cell = 1; cell + 1 < own.size(); ++cell) {
      if (own[cell] == kGhost)
        vertex_[cell] = own[cell - 1] != kGhost ? own[cell - 1] : own[cell + 1];
    }
  }

  std::size_t cell_of(Point p) const {
    return side_ * along(p.y, box_.south, box_.north) + along(p.x, box_.west, box_.east);
  }
  std::size_t along(double value, double low, double high) const {
    const auto side = static_cast<double>(side_);
    const double share = high > low ? (value - low) / (high - low) : 0.0;
    return static_cast<std::size_t>(std::min(std::max(share * side, 0.0), side - 1.0));
  }

  std::size_t side_ = 0;        // in cells
  std::vector<Vertex> vertex_;  // of each cell
  Box box_;                     // around those drawn
};

}  // namespace tinsmith
