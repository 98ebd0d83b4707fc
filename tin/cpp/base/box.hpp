// Boxes: the axis-parallel rectangles that bound points, cells, segments and triangles.
#pragma once

#include <algorithm>
#include <limits>

#include "point.hpp"

namespace tinsmith {

// Sides belong to it. One that was made without sides is empty: it grows as things are included.
struct Box {
  double west = std::numeric_limits<double>::infinity();
  double south = std::numeric_limits<double>::infinity();
  double east = -std::numeric_limits<double>::infinity();
  double north = -std::numeric_limits<double>::infinity();

  static Box of(Point a, Point b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::max(a.x, b.x), std::max(a.y, b.y)};
  }

  // A coordinate that is not a number changes nothing.
  void include(Point p) {
    west = p.x < west ? p.x : west;
    south = p.y < south ? p.y : south;
    east = p.x > east ? p.x : east;
    north = p.y > north ? p.y : north;
  }
  void include(const Box& other) {
    west = other.west < west ? other.west : west;
    south = other.south < south ? other.south : south;
    east = other.east > east ? other.east : east;
    north = other.north > north ? other.north : north;
  }

  // Without branches: these are asked for thousands of boxes.
  bool holds(Point p) const {
    return (p.x >= west) & (p.x <= east) & (p.y >= south) & (p.y <= north);
  }
  bool meets(const Box& other) const {
    return (other.west <= east) & (other.east >= west) & (other.south <= north) &
           (other.north >= south);
  }
  bool within(const Box& outer) const {
    return (west >= outer.west) & (east <= outer.east) & (south >= outer.south) &
           (north <= outer.north);
  }

  double width() const { return east - west; }
  double height() const { return north - south; }
  Point center() const { return {west + 0.5 * width(), south + 0.5 * height()}; }
  Box grown_by(double reach) const {
    return {west - reach, south - reach, east + reach, north + reach};
  }
};

}  // namespace tinsmith
