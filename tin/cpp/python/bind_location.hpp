// Bindings of point location.
#pragma once

#include <nanobind/nanobind.h>

#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../interpolation/batch.hpp"
#include "../location/locator.hpp"
#include "../location/segment_trace.hpp"
#include "conversion.hpp"

namespace tinsmith::python {

// The elevation at each point; make() gives each thread an evaluate(point, triangle of ordered()).
template <typename Make>
Elevations elevations_at(const Locator& locator, const GivenXy& xy, int threads, Make&& make) {
  const std::size_t count = xy.shape(0);
  auto result = streamed_array<double>(count);
  run_unlocked(threads, [&](Team& team) {
    interpolate_all(locator, points_of(xy), static_cast<std::int64_t>(count), result.get(), team,
                    make);
  });
  return hand_over<Elevations>(std::move(result), {count});
}

// Breaks of segments one after the other, as in TraceBreaks.
struct TraceArrays {
  Offsets offsets;
  Xy places;
  Elevations elevations, ratios;
  Numbers vertices, edges, triangles, along;
  std::int64_t failed;
};

// A locator with the arrays that it reads.
class HeldLocator {
 public:
  HeldLocator(const GivenXyz& points, const GivenTriples& triangles, const GivenTriples& neighbors)
      : points_(points), triangles_(triangles), neighbors_(neighbors), locator_(index()) {}

  Numbers locate(const GivenXy& xy) const {
    const std::size_t count = xy.shape(0);
    auto result = streamed_array<std::int32_t>(count);
    run_unlocked(1, [&](Team& team) {
      locator_.locate(points_of(xy), static_cast<std::int64_t>(count), result.get(),
                      [&] { return team.keeps_going(0); });
    });
    return hand_over<Numbers>(std::move(result), {count});
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
    const TracedSegments traced = unlocked(1, [&](Team& team) {
      return trace_segments(locator_, from, to, count, [&] { return team.keeps_going(0); });
    });
    const TraceBreaks& breaks = traced.breaks;
    return {copy_over<Offsets, std::int64_t>(traced.offsets, {traced.offsets.size()}),
            copy_over<Xy, double>(breaks.places, {breaks.size(), 2}),
            copy_over<Elevations, double>(breaks.elevations, {breaks.size()}),
            copy_over<Elevations, double>(breaks.ratios, {breaks.size()}),
            hand_over(breaks.vertices),
            hand_over(breaks.edges),
            hand_over(breaks.triangles),
            hand_over(breaks.along),
            traced.count() < count ? traced.count() : -1};
  }

  const Locator& locator() const { return locator_; }
  const Surface& surface() const { return locator_.surface(); }

 private:
  Locator index() const {
    ReleasedLock release;
    const Surface surface = surface_of(points_, triangles_, &neighbors_);
    require_exact_points(surface);
    return Locator(surface);
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
  Result<TraceArrays>(m, "Trace", "Breaks of segments, those of one after those of the other.")
      .def_array("offsets", &TraceArrays::offsets, "(s + 1,), where those of each segment begin.")
      .def_array("places", &TraceArrays::places, "(n, 2).")
      .def_array("elevations", &TraceArrays::elevations, "(n,), NaN where there is no surface.")
      .def_array("ratios", &TraceArrays::ratios, "(n,), 0 at the first end, 1 at the second.")
      .def_array("vertices", &TraceArrays::vertices, "(n,), that are there, else -1.")
      .def_array("edges", &TraceArrays::edges,
                 "(n,), crossed, or on which an end lies, as 3 * triangle + corner, else -1.")
      .def_array("triangles", &TraceArrays::triangles,
                 "(n,), through which the segment goes on, -1 outside.")
      .def_array("along", &TraceArrays::along, "(n,), the edge along which it goes on, else -1.")
      .def_ro("failed", &TraceArrays::failed,
              "The first segment whose triangles lie over each other, -1 for none; it has no "
              "breaks, nor have those after it.");
}

}  // namespace tinsmith::python
