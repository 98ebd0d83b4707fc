// Bindings for points: checked copies, snapping, exact signs.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/tuple.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "../points/cleaning.hpp"
#include "../points/snapping.hpp"
#include "conversion.hpp"

namespace tinsmith::python {

// The clean copy, and whether it is sound.
inline auto clean(const GivenXyz& points, int threads) {
  const std::size_t size = points.shape(0);
  auto copy = streamed_array<double>(3 * size);
  bool is_sound = false;
  {
    ReleasedLock release;
    Team team(threads, [] { return true; });
    is_sound = copy_clean(points.data(), static_cast<std::int64_t>(size), copy.get(), team);
  }
  return std::make_tuple(hand_over<Xyz>(std::move(copy), {size, 3}), is_sound);
}

inline Numbers snap(const GivenXyz& points, double distance) {
  const PointRows rows = rows_of(points);
  const std::vector<std::int32_t> kept_row = [&] {
    ReleasedLock release;
    return snap_rows(rows, distance);
  }();
  return hand_over(kept_row);
}

// Whether predicates are exact for every coordinate but those that are not a number.
inline bool are_in_exact_range(const GivenXy& xy) {
  ReleasedLock release;
  return are_all(xy, [](double c) { return std::isnan(c) || is_in_exact_range(c); });
}

// The expansions of the exact stage hold finite numbers only.
inline void require_finite(const GivenXy& xy) {
  if (are_all(xy, [](double c) { return std::isfinite(c); })) return;
  throw std::invalid_argument("every coordinate must be finite");
}

// A predicate for every row: predicate(a, b, ...).
template <auto predicate, typename... More>
Signs signs_of(const GivenXy& a, const More&... more) {
  const std::size_t n = a.shape(0);
  if (((more.shape(0) != n) || ...)) {
    throw std::invalid_argument("the arrays must have the same number of rows");
  }
  require_finite(a);
  (require_finite(more), ...);
  auto result = streamed_array<std::int8_t>(n);
  for (std::size_t i = 0; i < n; ++i) {
    result[i] = static_cast<std::int8_t>(predicate(points_of(a)[i], points_of(more)[i]...));
  }
  return hand_over<Signs>(std::move(result), {n});
}

inline void bind_points(nb::module_& m) {
  m.attr("SMALLEST_COORDINATE") = kSmallestCoordinate;
  m.attr("LARGEST_COORDINATE") = kLargestCoordinate;
  m.attr("LARGEST_ELEVATION") = kLargestElevation;
  m.def("clean", &clean, "points"_a.noconvert(), "threads"_a = 1,
        "A copy without -0.0, and whether the growth can work with it.");
  m.def("are_in_exact_range", &are_in_exact_range, "xy"_a.noconvert(),
        "Whether predicates are exact for every coordinate but those that are not a number.");
  m.def("snap", &snap, "points"_a.noconvert(), "distance"_a,
        "For each row the row that it is merged into.");
  m.def("orientation", &signs_of<orientation, GivenXy, GivenXy>, "a"_a.noconvert(),
        "b"_a.noconvert(), "c"_a.noconvert(),
        "+1 where c lies left of the line from a to b, -1 right, 0 on it.");
  m.def("compare_distances", &signs_of<compare_distances, GivenXy, GivenXy>, "v"_a.noconvert(),
        "p"_a.noconvert(), "q"_a.noconvert(),
        "+1 where p is further from v than q is, -1 nearer, 0 equally far.");
  m.def(
      "in_circle", &signs_of<in_circle, GivenXy, GivenXy, GivenXy>, "a"_a.noconvert(),
      "b"_a.noconvert(), "c"_a.noconvert(), "d"_a.noconvert(),
      "+1 where d lies inside the circle through counter-clockwise a, b, c, -1 outside, 0 on it.");
}

}  // namespace tinsmith::python
