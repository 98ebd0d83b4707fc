// How far the cells of a raster are from a surface between cells.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "cell_triangle.hpp"

namespace tinsmith {

// Triangles whose corners are cells, and elevations of these.
struct CellSurface {
  const Cell* cells;
  const double* elevations;
  const std::int32_t* triangles;
  std::size_t triangle_count;

  CellTriangle triangle(std::size_t t) const {
    CellTriangle found;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(triangles[3 * t + k]);
      found.cell[k] = cells[v];
      found.z[k] = elevations[v];
    }
    return found;
  }
};

// Elevations row by row from the south on, whose south-western cell is 0, 0; the errors of those that
// the surface holds are written. A cell on an edge has that of the last triangle.
class CellErrors {
 public:
  CellErrors(const double* z, std::int32_t columns, std::int32_t rows, double* errors)
      : z_(z), columns_(columns), rows_(rows), errors_(errors) {}

  void write(const CellSurface& surface) {
    for (std::size_t t = 0; t < surface.triangle_count; ++t) {
      const CellTriangle triangle = surface.triangle(t);
      if (meets(triangle)) write(triangle);
    }
  }

 private:
  bool meets(const CellTriangle& t) const {
    const auto [west, east] = std::minmax({t.cell[0].column, t.cell[1].column, t.cell[2].column});
    const auto [south, north] = std::minmax({t.cell[0].row, t.cell[1].row, t.cell[2].row});
    return east >= 0 && west < columns_ && north >= 0 && south < rows_;
  }

  void write(CellTriangle t) {
    if (t.twice_area() <= 0) return;
    t.turn();
    const CellPlane plane(t);
    list_.list(t.cell[0], t.cell[1], t.cell[2]);
    for (const CellRow& row : list_) {
      if (row.row < 0 || row.row >= rows_) continue;
      const std::int32_t first = std::max(row.first, 0), last = std::min(row.last, columns_ - 1);
      const std::size_t start = static_cast<std::size_t>(row.row) * columns_;
      const double base = plane.at(row.first, row.row);
      for (std::int32_t c = first; c <= last; ++c) {
        const std::size_t at = start + static_cast<std::size_t>(c);
        errors_[at] = std::fabs(z_[at] - (base + plane.east() * (c - row.first)));
      }
    }
  }

  const double* z_;
  std::int32_t columns_, rows_;
  double* errors_;
  CellRows list_;
};

}  // namespace tinsmith
