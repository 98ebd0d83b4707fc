// Points of the plane, and the rows of a table that hold them.
#pragma once

#include <cstdint>

namespace tinsmith {

struct Point {
  double x;
  double y;
};

inline bool operator==(Point a, Point b) { return a.x == b.x && a.y == b.y; }

// Order by easting, then northing: the order that breaks ties between cocircular points.
inline bool lexicographically_before(Point a, Point b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

// A point of a surface, or a place above or below it.
struct SurfacePoint {
  Point at;
  double z;
};

// The caller's points: n rows of (x, y, ...), `stride` doubles apart.
struct PointRows {
  const double* data;
  std::int64_t count;
  std::int64_t stride;

  Point operator[](std::int64_t row) const { return {data[row * stride], data[row * stride + 1]}; }
};

}  // namespace tinsmith
