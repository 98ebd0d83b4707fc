// Bindings of what a surface would be without single points.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../screening/leave_one_out.hpp"
#include "../screening/quick_looks.hpp"
#include "conversion.hpp"

namespace tinsmith::python {

// A surface prepared for any number of questions about a few of its vertices. Its elevations may
// be changed between them.
class HeldLeaveOneOut {
 public:
  HeldLeaveOneOut(const GivenXyz& points, const GivenTriples& triangles,
                  const GivenTriples& neighbors)
      : points_(points),
        triangles_(triangles),
        neighbors_(neighbors),
        surface_(joined_surface(points_, triangles_, neighbors_)),
        corners_(find_corners(surface_)) {}

  Xy interpolate(const GivenNumbers& vertices, int threads) const {
    require_vertices(vertices);
    auto found = streamed_array<Interpolated>(vertices.shape(0));
    run_unlocked(threads, [&](Team& team) {
      leave_one_out(surface_, corners_.get(), vertices.data(), row_count(vertices.shape(0)),
                    found.get(), team);
    });
    StreamedArray<double> numbers(reinterpret_cast<double*>(found.release()));
    return hand_over<Xy>(std::move(numbers), {vertices.shape(0), 2});
  }

  std::pair<Offsets, Numbers> list_neighbors(const GivenNumbers& vertices) const {
    require_vertices(vertices);
    std::vector<std::int64_t> offsets{0};
    std::vector<std::int32_t> found;
    {
      ReleasedLock release;
      const LeaveOneOut local(surface_, corners_.get());
      for (std::size_t i = 0; i < vertices.shape(0); ++i) {
        local.list_neighbors(Vertex{vertices.data()[i]}, found);
        offsets.push_back(static_cast<std::int64_t>(found.size()));
      }
    }
    return {copy_over<Offsets, std::int64_t>(offsets, {offsets.size()}), hand_over(found)};
  }

 private:
  static Surface joined_surface(const GivenXyz& points, const GivenTriples& triangles,
                                const GivenTriples& neighbors) {
    const Surface surface = surface_of(points, triangles, &neighbors);
    require_exact_points(surface);
    if (!surface.has_sound_neighbors()) {
      throw std::invalid_argument("neighbors must be triangles or -1");
    }
    return surface;
  }

  void require_vertices(const GivenNumbers& vertices) const {
    const std::int32_t count = surface_.point_count;
    if (!are_all(vertices, [&](std::int32_t v) { return v >= 0 && v < count; })) {
      throw std::invalid_argument("vertices must be numbers from 0 to n - 1");
    }
  }

  GivenXyz points_;
  GivenTriples triangles_, neighbors_;
  Surface surface_;
  ScratchArray<HalfEdge> corners_;
};

inline Xyz measure_neighbors(const GivenXyz& points, const GivenTriples& triangles) {
  const Surface surface = surface_of(points, triangles);
  auto found = streamed_array<double>(3 * points.shape(0));
  {
    ReleasedLock release;
    tinsmith::measure_neighbors(surface, found.get());
  }
  return hand_over<Xyz>(std::move(found), {points.shape(0), 3});
}

inline TripleFlags find_long_edges(const GivenXyz& points, const GivenTriples& triangles,
                                   double length) {
  const Surface surface = surface_of(points, triangles);
  auto found = streamed_array<bool>(3 * triangles.shape(0));
  {
    ReleasedLock release;
    tinsmith::find_long_edges(surface, length * length, found.get());
  }
  return hand_over<TripleFlags>(std::move(found), {triangles.shape(0), 3});
}

inline Numbers find_peaks_and_pits(const GivenXyz& points, const GivenTriples& triangles) {
  const Surface surface = surface_of(points, triangles);
  const std::vector<std::int32_t> found = [&] {
    ReleasedLock release;
    return tinsmith::find_peaks_and_pits(surface);
  }();
  return hand_over(found);
}

inline void bind_screening(nb::module_& m) {
  nb::class_<HeldLeaveOneOut>(m, "LeaveOneOut", "Tells of a surface without single vertices.")
      .def(nb::init<const GivenXyz&, const GivenTriples&, const GivenTriples&>(),
           "points"_a.noconvert(), "triangles"_a.noconvert(), "neighbors"_a.noconvert())
      .def("interpolate", &HeldLeaveOneOut::interpolate, "vertices"_a.noconvert(), "threads"_a = 1,
           "The elevation at vertices without each, and the mean square to what gives it.")
      .def("list_neighbors", &HeldLeaveOneOut::list_neighbors, "vertices"_a.noconvert(),
           "The vertices that edges join to some, counter-clockwise: offsets and vertices.");
  m.def("measure_neighbors", &measure_neighbors, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "Lowest and highest neighbour of each vertex, and the squared distance to the nearest.");
  m.def("find_long_edges", &find_long_edges, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "length"_a, "Whether the edge opposite each corner is longer in the plane.");
  m.def("find_peaks_and_pits", &find_peaks_and_pits, "points"_a.noconvert(),
        "triangles"_a.noconvert(),
        "The vertices further beyond all their neighbours than these are apart.");
}

}  // namespace tinsmith::python
