// How far the cells of rows are from a plane, with the vector instructions of each path.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "../../../tin/cpp/base/vector_paths.hpp"
#include "cell_rows.hpp"
#include "cell_triangle.hpp"

namespace tinsmith {

constexpr std::int32_t kMostLanes = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNoElevation = std::numeric_limits<double>::quiet_NaN();

// Added to the last vector of a run: nothing to its first lanes, no number to those beyond.
constexpr double kNoNumberFrom[2 * kMostLanes] = {
    0.0, 0.0, 0.0, 0.0, kNoElevation, kNoElevation, kNoElevation, kNoElevation};

// A plane over a raster, whose elevations stand row by row with kMostLanes - 1 values beyond the last.
struct PlaneOverRows {
  CellPlane plane;
  const double* z;
  std::int32_t columns;
  const double* steps;  // 0, 1, 2, ...

  double at(const CellRow& row) const { return plane.at(row.first, row.row); }
  const double* z_of(const CellRow& row) const {
    return z + static_cast<std::size_t>(row.row) * static_cast<std::size_t>(columns) + row.first;
  }
};

struct FarRow {
  const CellRow* row;  // the end if there is none
  double error;        // the largest in it
};

// The first row with a cell that is `least` or more above or below the plane. Cells without an
// elevation are left out.
using FindFarRow = FarRow (*)(const PlaneOverRows&, const CellRow*, const CellRow*, double least);

}  // namespace tinsmith

#define TINSMITH_LOOPS "../../../terrain/cpp/simplification/vector_errors.inc"
#include "../../../tin/cpp/base/each_vector_path.inc"

namespace tinsmith {

inline FindFarRow far_row_search(VectorPath path) {
  switch (path) {
    case VectorPath::kAvx2:
      return avx2::find_far_row;
    case VectorPath::kBase:
      return base::find_far_row;
    default:
      return plain::find_far_row;
  }
}

}  // namespace tinsmith
