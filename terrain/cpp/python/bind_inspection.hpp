// Bindings of what a surface would be without single points.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../../../tin/cpp/python/conversion.hpp"
#include "../inspection/leave_one_out.hpp"

namespace tinsmith::python {

inline Surface joined_surface(const GivenXyz& points, const GivenTriples& triangles,
                              const GivenTriples& neighbors, const GivenNumbers& vertices) {
  const Surface surface = surface_of(points, triangles, &neighbors);
  require_exact_points(surface);
  if (!surface.has_sound_neighbors()) {
    throw std::invalid_argument("neighbors must be triangles or -1");
  }
  if (!are_all(vertices, [&](std::int32_t v) { return v >= 0 && v < surface.point_count; })) {
    throw std::invalid_argument("vertices must be numbers from 0 to n - 1");
  }
  return surface;
}

inline Xy leave_one_out(const GivenXyz& points, const GivenTriples& triangles,
                        const GivenTriples& neighbors, const GivenNumbers& vertices, int threads) {
  const Surface surface = joined_surface(points, triangles, neighbors, vertices);
  const std::int32_t count = row_count(vertices.shape(0));
  auto found = streamed_array<Interpolated>(vertices.shape(0));
  run_unlocked(threads, [&](Team& team) {
    tinsmith::leave_one_out(surface, vertices.data(), count, found.get(), team);
  });
  StreamedArray<double> numbers(reinterpret_cast<double*>(found.release()));
  return hand_over<Xy>(std::move(numbers), {vertices.shape(0), 2});
}

inline std::pair<Offsets, Numbers> list_neighbors(const GivenXyz& points,
                                                  const GivenTriples& triangles,
                                                  const GivenTriples& neighbors,
                                                  const GivenNumbers& vertices) {
  const Surface surface = joined_surface(points, triangles, neighbors, vertices);
  std::vector<std::int64_t> offsets{0};
  std::vector<std::int32_t> found;
  {
    nb::gil_scoped_release release;
    const auto corners = find_corners(surface);
    const LeaveOneOut local(surface, corners.get());
    for (std::size_t i = 0; i < vertices.shape(0); ++i) {
      local.list_neighbors(Vertex{vertices.data()[i]}, found);
      offsets.push_back(static_cast<std::int64_t>(found.size()));
    }
  }
  return {copy_over<Offsets, std::int64_t>(offsets, {offsets.size()}), hand_over(found)};
}

inline Xyz measure_neighbors(const GivenXyz& points, const GivenTriples& triangles) {
  const Surface surface = surface_of(points, triangles);
  auto found = streamed_array<double>(3 * points.shape(0));
  {
    nb::gil_scoped_release release;
    tinsmith::measure_neighbors(surface, found.get());
  }
  return hand_over<Xyz>(std::move(found), {points.shape(0), 3});
}

inline void bind_inspection(nb::module_& m) {
  m.def("leave_one_out", &leave_one_out, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "vertices"_a.noconvert(), "threads"_a = 1,
        "The elevation at some vertices without each, and the mean square to what gives it.");
  m.def("list_neighbors", &list_neighbors, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "neighbors"_a.noconvert(), "vertices"_a.noconvert(),
        "The vertices that edges join to some, counter-clockwise: offsets and vertices.");
  m.def("measure_neighbors", &measure_neighbors, "points"_a.noconvert(), "triangles"_a.noconvert(),
        "Lowest and highest neighbour of each vertex, and the squared distance to the nearest.");
}

}  // namespace tinsmith::python
