// What the bindings share: array types, handing arrays over, asking for signals.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../base/point.hpp"
#include "../predicates/predicates.hpp"

namespace tinsmith::python {

namespace nb = nanobind;
using namespace nb::literals;

// As they come from Python,
template <typename T, int... Shape>
using Given = nb::ndarray<const T, nb::shape<Shape...>, nb::c_contig, nb::device::cpu>;
using GivenXyz = Given<double, -1, 3>;
using GivenXy = Given<double, -1, 2>;
using GivenRows = Given<double, -1, -1>;  // x, y and perhaps more
using GivenTriples = Given<std::int32_t, -1, 3>;
using GivenPairs = Given<std::int32_t, -1, 2>;
using GivenNumbers = Given<std::int32_t, -1>;
using GivenFlags = Given<bool, -1, 3>;

// and as they go there.
template <typename T, int... Shape>
using Made = nb::ndarray<nb::numpy, T, nb::shape<Shape...>>;
using Xyz = Made<double, -1, 3>;
using Xy = Made<double, -1, 2>;
using Triples = Made<std::int32_t, -1, 3>;
using Pairs = Made<std::int32_t, -1, 2>;
using Numbers = Made<std::int32_t, -1>;
using Elevations = Made<double, -1>;
using Offsets = Made<std::int64_t, -1>;
using Signs = Made<std::int8_t, -1>;
using TripleFlags = Made<bool, -1, 3>;
using Flags = Made<bool, -1>;

template <typename Array, typename T>
Array hand_over(StreamedArray<T> data, std::initializer_list<std::size_t> shape) {
  T* raw = data.release();
  nb::capsule owner(raw, [](void* p) noexcept { FreeMemory()(p); });
  return Array(raw, shape, owner);
}

// The values' bytes as an array of numbers of type T.
template <typename Array, typename T, typename Value>
Array copy_over(const std::vector<Value>& values, std::initializer_list<std::size_t> shape) {
  static_assert(sizeof(Value) % sizeof(T) == 0, "a value is one or more numbers");
  auto data = streamed_array<T>(values.size() * (sizeof(Value) / sizeof(T)));
  // No bytes are to be copied from no address either: that is undefined.
  if (!values.empty()) std::memcpy(data.get(), values.data(), values.size() * sizeof(Value));
  return hand_over<Array>(std::move(data), shape);
}

inline Numbers hand_over(const std::vector<std::int32_t>& values) {
  return copy_over<Numbers, std::int32_t>(values, {values.size()});
}
inline Numbers hand_over(const std::vector<Vertex>& values) {
  return copy_over<Numbers, std::int32_t>(values, {values.size()});
}

inline std::int32_t row_count(std::size_t rows) {
  if (rows > static_cast<std::size_t>(INT32_MAX / 4)) {
    throw std::invalid_argument("more rows than 32-bit indices can number");
  }
  return static_cast<std::int32_t>(rows);
}

inline PointRows rows_of(const GivenXyz& points) {
  const auto count = static_cast<std::int64_t>(points.shape(0));
  if (count == 0) throw std::invalid_argument("at least one point is needed");
  if (count > kMostPoints) {
    throw std::invalid_argument("more points than 32-bit indices can number");
  }
  return {points.data(), count, 3};
}

inline const Point* points_of(const GivenXy& xy) {
  static_assert(sizeof(Point) == 2 * sizeof(double), "a row is a point");
  return reinterpret_cast<const Point*>(xy.data());
}

// Points that the predicates can compute with.
inline const Point* exact_points_of(const GivenXy& xy) {
  const double* end = xy.data() + 2 * static_cast<std::size_t>(row_count(xy.shape(0)));
  const auto is_exact = [](double c) { return std::fabs(c) <= kLargestCoordinate; };
  if (!std::all_of(xy.data(), end, is_exact)) {
    throw std::invalid_argument("every coordinate must be finite and within the exact range");
  }
  return points_of(xy);
}

// Ask Python whether Ctrl-C was pressed.
inline bool no_signal() {
  nb::gil_scoped_acquire gil;
  return PyErr_CheckSignals() == 0;
}

// What `search(team)` finds without Python's lock, unless it was stopped.
template <typename Search>
auto unlocked(int threads, Search&& search) {
  if (threads < 1) throw std::invalid_argument("at least one thread is needed");
  bool is_stopped = false;
  auto found = [&] {
    nb::gil_scoped_release release;
    Team team(threads, no_signal);
    auto result = search(team);
    is_stopped = team.is_stopped();
    return result;
  }();
  if (is_stopped) throw nb::python_error();
  return found;
}

}  // namespace tinsmith::python
