// Where the vertices of a mesh are.
#pragma once

#include <cstddef>
#include <cstdint>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/point.hpp"

namespace tinsmith {

// By slot: the number of a vertex that is there, was there, or will be. One without a vertex holds
// anything.
class MeshPoints {
 public:
  const Point& operator[](Vertex v) const { return points_[static_cast<std::size_t>(number(v))]; }
  void put(Vertex v, Point p) { points_[static_cast<std::size_t>(number(v))] = p; }
  const Point* begin() const { return points_.data(); }
  std::int32_t slots() const { return static_cast<std::int32_t>(points_.size()); }

  void reserve(std::size_t slots) { points_.reserve(slots); }
  Vertex add(Point p) {
    points_.push_back(p);
    return Vertex{slots() - 1};
  }
  void drop_last() { points_.pop_back(); }

 private:
  ScratchVector<Point> points_;
};

}  // namespace tinsmith
