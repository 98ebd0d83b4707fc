// Bindings of point location.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/tuple.h>

#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "../interpolation/batch.hpp"
#include "../location/locator.hpp"
#include "../location/segment_trace.hpp"
#include "arrays.hpp"

namespace tinsmith::python {

// The elevation at each point; make() gives each thread an evaluate(point, triangle of ordered()).
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

// Breaks of segments one after the other: where those of each begin, the arrays, and the first
// segment for which there are none, -1 if all have theirs.
using TraceArrays = std::tuple<Offsets, Xy, Elevations, Elevations, Numbers, Numbers, Numbers,
                               Numbers, std::int64_t>;

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
      return [surface = locator_.ordered().surface()](Point p, Triangle triangle) {
        return elevation_at(surface, p, triangle);
      };
    });
  }

  TraceArrays trace(const GivenXy& starts, const GivenXy& ends) const {
    const Point* from = exact_points_of(starts);
    const Point* to = exact_points_of(ends);
    const auto count = static_cast<std::int64_t>(starts.shape(0));
    if (ends.shape(0) != starts.shape(0)) {
      throw std::invalid_argument("starts and ends must have the same number of rows");
    }
    TraceBreaks breaks;
    std::vector<std::int64_t> offsets{0};
    bool is_stopped = false;
    {
      nb::gil_scoped_release release;
      SegmentTrace trace(locator_);
      for (std::int64_t i = 0; i < count && !is_stopped; ++i) {
        if (from[i] == to[i]) throw std::invalid_argument("ends of a segment must be apart");
        if (!trace.append(from[i], to[i], breaks)) break;
        offsets.push_back(static_cast<std::int64_t>(breaks.places.size()));
        is_stopped = i % kSegmentsAtATime == 0 && !no_signal();
      }
    }
    if (is_stopped) throw nb::python_error();
    const auto done = static_cast<std::int64_t>(offsets.size()) - 1;
    const std::size_t rows = offsets.back();
    shorten(breaks, rows);
    return {copy_over<Offsets, std::int64_t>(offsets, {offsets.size()}),
            copy_over<Xy, double>(breaks.places, {rows, 2}),
            copy_over<Elevations, double>(breaks.elevations, {rows}),
            copy_over<Elevations, double>(breaks.ratios, {rows}),
            hand_over(breaks.vertices),
            hand_over(breaks.edges),
            hand_over(breaks.triangles),
            hand_over(breaks.along),
            done < count ? done : -1};
  }

  const Locator& locator() const { return locator_; }
  const Surface& surface() const { return locator_.surface(); }

 private:
  static constexpr std::int64_t kSegmentsAtATime = 64;  // before Ctrl-C is asked for

  // Leave out what a segment that failed has begun.
  static void shorten(TraceBreaks& breaks, std::size_t rows) {
    breaks.places.resize(rows);
    breaks.elevations.resize(rows);
    breaks.ratios.resize(rows);
    breaks.vertices.resize(rows);
    breaks.edges.resize(rows);
    breaks.triangles.resize(rows);
    breaks.along.resize(rows);
  }

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
           "The elevation at each point, NaN outside.")
      .def("trace", &HeldLocator::trace, "starts"_a.noconvert(), "ends"_a.noconvert(),
           "The places along segments where they cross edges, and the triangles between them.");
}

}  // namespace tinsmith::python
