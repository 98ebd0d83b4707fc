// A triangle between three cells of a raster, and the plane through their elevations, in columns and
// rows: their differences are exact.
#pragma once

#include <cstdint>

#include "cell_rows.hpp"

namespace tinsmith {

// Three cells counter-clockwise, and their elevations.
struct CellTriangle {
  Cell cell[3];
  double z[3];

  std::int64_t twice_area() const { return twice_area_of(cell[0], cell[1], cell[2]); }

  // Turn it so that its lexicographically first cell comes first.
  void turn() {
    int first = 0;
    for (int k = 1; k < 3; ++k) {
      const bool is_west = cell[k].column < cell[first].column;
      const bool is_south = cell[k].column == cell[first].column && cell[k].row < cell[first].row;
      if (is_west || is_south) first = k;
    }
    for (; first > 0; --first) turn_once();
  }
  bool holds(Cell at) const {
    for (int k = 0; k < 3; ++k) {
      if (twice_area_of(cell[k], cell[(k + 1) % 3], at) < 0) return false;
    }
    return true;
  }

 private:
  void turn_once() {
    const Cell first = cell[0];
    cell[0] = cell[1];
    cell[1] = cell[2];
    cell[2] = first;
    const double first_z = z[0];
    z[0] = z[1];
    z[1] = z[2];
    z[2] = first_z;
  }
};

class CellPlane {
 public:
  // Of a triangle with an area, which was turned.
  explicit CellPlane(const CellTriangle& t) : first_(t.cell[0]), elevation_(t.z[0]) {
    const auto area = static_cast<double>(t.twice_area());
    const double ux = t.cell[1].column - first_.column, uy = t.cell[1].row - first_.row;
    const double vx = t.cell[2].column - first_.column, vy = t.cell[2].row - first_.row;
    const double uz = t.z[1] - t.z[0], vz = t.z[2] - t.z[0];
    east_ = (uz * vy - vz * uy) / area;
    north_ = (ux * vz - vx * uz) / area;
  }

  double east() const { return east_; }
  double at(std::int32_t column, std::int32_t row) const {
    return elevation_ + north_ * (row - first_.row) + east_ * (column - first_.column);
  }

 private:
  Cell first_;
  double elevation_, east_, north_;
};

}  // namespace tinsmith
