// Bindings of point location.
#pragma once

#include <nanobind/nanobind.h>

#include <cstdint>
#include <stdexcept>
#include <utility>

#include "../interpolation/batch.hpp"
#include "../location/locator.hpp"
#include "arrays.hpp"

namespace tinsmith::python {

// The elevation at each point; make() gives each thread an evaluate(point, triangle).
template <typename Make>
Elevations elevations_at(const Locator& locator, const GivenXy& xy, int threads, Make&& make) {
  const std::size_t count = xy.shape(0);
  auto result = streamed_array<double>(count);
  unlocked(threads, [&](Team& team) {
    interpolate_all(locator, points_of(xy), static_cast<std::int64_t>(count), result.get(), team,
                    make);
    return 0;
  });
  return hand_over<Elevations>(std::move(result), {count});
}

// A locator with the arrays that it reads.
class HeldLocator {
 public:
  HeldLocator(const GivenXyz& points, const GivenTriples& triangles, const GivenTriples& neighbors)
      : points_(points), triangles_(triangles), neighbors_(neighbors), locator_(index()) {}

  Numbers locate(const GivenXy& xy) const {
    return answer<Numbers, std::int32_t>(xy, [&](std::int64_t count, std::int32_t* result) {
      return locator_.locate(points_of(xy), count, result, no_signal);
    });
  }

  Elevations interpolate(const GivenXy& xy, int threads) const {
    return elevations_at(locator_, xy, threads, [&] {
      return [&](Point p, Triangle triangle) { return elevation_at(surface(), p, triangle); };
    });
  }

  const Locator& locator() const { return locator_; }
  const Surface& surface() const { return locator_.surface(); }

 private:
  Locator index() const {
    if (triangles_.shape(0) != neighbors_.shape(0)) {
      throw std::invalid_argument("triangles and neighbors must have the same number of rows");
    }
    if (triangles_.shape(0) > INT32_MAX / 3 || points_.shape(0) > INT32_MAX / 3) {
      throw std::invalid_argument("more triangles or points than 32-bit indices can number");
    }
    const Surface surface{points_.data(), triangles_.data(), neighbors_.data(),
                          static_cast<std::int32_t>(points_.shape(0)),
                          static_cast<std::uint32_t>(triangles_.shape(0))};
    nb::gil_scoped_release release;
    if (!surface.has_sound_points()) {
      throw std::invalid_argument("points must be finite and within the exact range");
    }
    if (!surface.has_sound_corners()) {
      throw std::invalid_argument("triangles must hold vertex numbers from 0 to n - 1");
    }
    return Locator(surface);
  }

  template <typename Array, typename T, typename Run>
  static Array answer(const GivenXy& xy, Run run) {
    const std::size_t count = xy.shape(0);
    auto result = streamed_array<T>(count);
    bool is_complete = false;
    {
      nb::gil_scoped_release release;
      is_complete = run(static_cast<std::int64_t>(count), result.get());
    }
    if (!is_complete) throw nb::python_error();
    return hand_over<Array>(std::move(result), {count});
  }

  GivenXyz points_;
  GivenTriples triangles_, neighbors_;
  Locator locator_;
};

inline void bind_location(nb::module_& m) {
  nb::class_<HeldLocator>(m, "Locator", "Finds the triangle and the elevation at any point.")
      .def(nb::init<const GivenXyz&, const GivenTriples&, const GivenTriples&>(),
           "points"_a.noconvert(), "triangles"_a.noconvert(), "neighbors"_a.noconvert())
      .def("locate", &HeldLocator::locate, "xy"_a.noconvert(),
           "The triangle at each point, -1 outside; the smallest one where several meet.")
      .def("interpolate", &HeldLocator::interpolate, "xy"_a.noconvert(), "threads"_a = 1,
           "The elevation at each point, NaN outside.");
}

}  // namespace tinsmith::python
