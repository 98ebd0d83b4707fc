// What the bindings share: array types, handing arrays over, asking for signals.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"
#include "../base/point.hpp"
#include "../location/surface.hpp"
#include "../predicates/predicates.hpp"
#include "gil.hpp"

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
using GivenValues = Given<double, -1>;
using GivenFlags = Given<bool, -1, 3>;

// and as they go there.
template <typename T, int... Shape>
using Made = nb::ndarray<nb::numpy, T, nb::shape<Shape...>>;
using Xyz = Made<double, -1, 3>;
using Xy = Made<double, -1, 2>;
using Triples = Made<std::int32_t, -1, 3>;
using Quadruples = Made<std::int32_t, -1, 4>;
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

// Of numbers, vertices or triangles.
template <typename Id>
Numbers hand_over(const std::vector<Id>& values) {
  return copy_over<Numbers, std::int32_t>(values, {values.size()});
}

// A struct of arrays whose members Python reads by their names.
template <typename Struct>
class Result : public nb::class_<Struct> {
 public:
  using nb::class_<Struct>::class_;

  // The array owns its memory, so that it may outlive the struct.
  template <typename Array>
  Result& def_array(const char* name, Array Struct::* member, const char* text) {
    this->def_ro(name, member, nb::rv_policy::automatic, text);
    return *this;
  }
};

constexpr std::int32_t kMostRows = INT32_MAX / 4;
constexpr std::int32_t kMostTriangles = INT32_MAX / 3;

inline std::int32_t row_count(std::size_t rows, std::int32_t most = kMostRows) {
  if (rows > static_cast<std::size_t>(most)) {
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

template <typename Array, typename Test>
bool are_all(const Array& values, Test&& test) {
  return std::all_of(values.data(), values.data() + values.size(), test);
}

// Points that the predicates can compute with.
inline const Point* exact_points_of(const GivenXy& xy) {
  row_count(xy.shape(0));
  if (!are_all(xy, [](double c) { return std::fabs(c) <= kLargestCoordinate; })) {
    throw std::invalid_argument("every coordinate must be finite and within the exact range");
  }
  return points_of(xy);
}

// Triangles of vertices that are there.
inline Surface corners_of(const GivenTriples& triangles, std::int32_t vertex_count) {
  const auto count = static_cast<std::uint32_t>(row_count(triangles.shape(0), kMostTriangles));
  const Surface surface{nullptr, triangles.data(), nullptr, vertex_count, count};
  if (!surface.has_sound_corners()) {
    throw std::invalid_argument("triangles must hold vertex numbers from 0 to n - 1");
  }
  return surface;
}

// Points and neighbours, if they are given, as they come.
inline Surface surface_of(const GivenXyz& points, const GivenTriples& triangles,
                          const GivenTriples* neighbors = nullptr) {
  Surface surface = corners_of(triangles, row_count(points.shape(0)));
  surface.points = points.data();
  if (neighbors == nullptr) return surface;
  if (neighbors->shape(0) != triangles.shape(0)) {
    throw std::invalid_argument("triangles and neighbors must have the same number of rows");
  }
  surface.neighbors = neighbors->data();
  return surface;
}

inline void require_exact_points(const Surface& surface) {
  if (surface.has_sound_points()) return;
  throw std::invalid_argument("points must be finite and within the exact range");
}

// Ask Python whether Ctrl-C was pressed.
inline bool no_signal() {
  HeldLock gil;
  return PyErr_CheckSignals() == 0;
}

// Asks Python whether to go on, and tells a function of the caller's, if any, the fraction done.
class Listener {
 public:
  using Tell = std::optional<nb::callable>;

  explicit Listener(const Tell& tell) : tell_(tell) {}

  Progress* progress() { return tell_ ? &progress_ : nullptr; }

  // On the caller's thread; false with an error of Python's if one was raised.
  bool keeps_going() {
    if (!no_signal()) return false;
    const double fraction = progress_.fraction();
    if (!tell_ || fraction < told_ + kFineness) return true;
    told_ = fraction;
    HeldLock gil;
    try {
      (*tell_)(fraction);
      return true;
    } catch (nb::python_error& error) {
      error.restore();
      return false;
    }
  }

 private:
  static constexpr double kFineness = 0.005;

  const Tell& tell_;
  Progress progress_;
  double told_ = 0.0;
};

// work(team) without Python's lock; throws if it was stopped.
template <typename Work>
void run_unlocked(int threads, Work&& work, const Listener::Tell& tell = {}) {
  if (threads < 1) throw std::invalid_argument("at least one thread is needed");
  bool is_stopped = false;
  {
    ReleasedLock release;
    Listener listener(tell);
    Team team(threads, [&] { return listener.keeps_going(); }, listener.progress());
    work(team);
    is_stopped = team.is_stopped();
  }
  if (is_stopped) throw nb::python_error();
}

// What `search(team)` finds, likewise.
template <typename Search>
auto unlocked(int threads, Search&& search, const Listener::Tell& tell = {}) {
  std::optional<decltype(search(std::declval<Team&>()))> found;
  run_unlocked(threads, [&](Team& team) { found.emplace(search(team)); }, tell);
  return std::move(*found);
}

}  // namespace tinsmith::python
