// How far the cells of rows are from a plane: with the vector instructions of the processor, chosen
// when it runs, as in tin/cpp/search/vector_paths.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "cell_rows.hpp"
#include "cell_triangle.hpp"

#if defined(__GNUC__) && defined(__x86_64__)  // Clang says __GNUC__ too
#define TINSMITH_ERRORS_WITH_AVX
#include <immintrin.h>
#endif

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

#define TINSMITH_PATH plain
#define TINSMITH_LANES 1
#include "vector_errors.inc"

#if defined(__GNUC__)
#define TINSMITH_PATH base
#define TINSMITH_LANES 2
#include "vector_errors.inc"
#endif

#ifdef TINSMITH_ERRORS_WITH_AVX
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
#define TINSMITH_PATH avx2
#define TINSMITH_LANES 4
#include "vector_errors.inc"
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

namespace tinsmith {

// For the fastest instructions that the processor has.
inline FindFarRow fastest_search() {
#ifdef TINSMITH_ERRORS_WITH_AVX
  if (__builtin_cpu_supports("avx2")) return avx2::find_far_row;
#endif
#if defined(__GNUC__)
  return base::find_far_row;
#else
  return plain::find_far_row;
#endif
}

}  // namespace tinsmith
