// Bindings of interpolation.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "../interpolation/batch.hpp"
#include "../interpolation/natural_surface.hpp"
#include "../interpolation/nearest_boundary.hpp"
#include "../interpolation/nearest_vertex.hpp"
#include "../interpolation/smooth_surface.hpp"
#include "bind_location.hpp"
#include "conversion.hpp"

namespace tinsmith::python {

inline const bool* barriers_of(const HeldLocator& locator, const GivenFlags& barriers) {
  if (barriers.shape(0) != locator.surface().triangle_count) {
    throw std::invalid_argument("triangles and barriers must have the same number of rows");
  }
  return barriers.data();
}

class HeldNaturalNeighbors {
 public:
  HeldNaturalNeighbors(const HeldLocator& locator, const GivenFlags& barriers)
      : surface_(unlocked(1, [&, flags = barriers_of(locator, barriers)](Team& team) {
          return NaturalSurface(locator.locator(), flags, [&] { return team.keeps_going(0); });
        })) {}

  Elevations interpolate(const GivenXy& xy, NaturalWeights kind, int threads) const {
    return elevations_at(surface_.locator(), xy, threads, [&] { return surface_.neighbors(kind); });
  }

  bool is_flipped() const { return surface_.is_flipped(); }

 private:
  NaturalSurface surface_;
};

class HeldSmoothPatches {
 public:
  HeldSmoothPatches(const HeldLocator& locator, const GivenFlags& barriers, int threads)
      : surface_(unlocked(threads, [&, flags = barriers_of(locator, barriers)](Team& team) {
          return SmoothSurface(locator.locator(), flags, team);
        })) {}

  Elevations interpolate(const GivenXy& xy, int threads) const {
    return elevations_at(surface_.locator(), xy, threads, [&] { return surface_.patches(); });
  }

  // Edges as 3 * triangle + corner.
  Elevations on_edges(const GivenNumbers& edges, const GivenValues& shares) const {
    const std::size_t count = edges.shape(0);
    if (shares.shape(0) != count) throw std::invalid_argument("each edge needs a share");
    auto result = streamed_array<double>(count);
    surface_.write_on_edges(edges.data(), shares.data(), count, result.get());
    return hand_over<Elevations>(std::move(result), {count});
  }

  Xy gradients() const {
    const std::size_t corners = std::size_t{3} * surface_.locator().surface().triangle_count;
    auto result = streamed_array<double>(2 * corners);
    surface_.write_gradients(result.get());
    return hand_over<Xy>(std::move(result), {corners, 2});
  }

 private:
  SmoothSurface surface_;
};

class HeldNearestBoundary {
 public:
  explicit HeldNearestBoundary(const HeldLocator& locator) : boundary_(locator.surface()) {}

  // Edges as 3 * triangle + corner, and shares of the way along them. Points must be finite.
  std::pair<Numbers, Elevations> find(const GivenXy& xy) const {
    const std::size_t count = xy.shape(0);
    const Point* points = exact_points_of(xy);
    auto edges = streamed_array<std::int32_t>(count);
    auto shares = streamed_array<double>(count);
    run_unlocked(1, [&](Team& team) {
      boundary_.find_all(points, row_count(count), edges.get(), shares.get(),
                         [&] { return team.keeps_going(0); });
    });
    return {hand_over<Numbers>(std::move(edges), {count}),
            hand_over<Elevations>(std::move(shares), {count})};
  }

 private:
  NearestBoundary boundary_;
};

// Vertex numbers of a Delaunay triangulation, as doubles; NaN outside.
inline Elevations nearest_vertices(const HeldLocator& locator, const GivenXy& xy, bool from_west,
                                   int threads) {
  return elevations_at(locator.locator(), xy, threads, [&] {
    return
        [search = NearestVertex(locator.locator().ordered(), from_west)](
            Point p, Triangle t) mutable { return static_cast<double>(number(search.find(p, t))); };
  });
}

inline void bind_interpolation(nb::module_& m) {
  nb::enum_<NaturalWeights>(m, "NaturalWeights", "How natural neighbours weigh.")
      .value("SIBSON", NaturalWeights::kSibson)
      .value("LAPLACE", NaturalWeights::kLaplace);
  m.def("nearest_vertices", &nearest_vertices, "locator"_a, "xy"_a.noconvert(), "from_west"_a,
        "threads"_a = 1,
        "The nearest vertex of a Delaunay triangulation at each point, NaN outside.");
  nb::class_<HeldNaturalNeighbors>(m, "NaturalNeighbors", "Natural neighbour interpolation.")
      .def(nb::init<const HeldLocator&, const GivenFlags&>(), "locator"_a, "barriers"_a.noconvert(),
           nb::keep_alive<1, 2>())
      .def("interpolate", &HeldNaturalNeighbors::interpolate, "xy"_a.noconvert(), "kind"_a,
           "threads"_a = 1, "The elevation at each point, NaN outside.")
      .def_prop_ro("is_flipped", &HeldNaturalNeighbors::is_flipped,
                   "Whether triangles of its own were made, for open edges that are not Delaunay.");
  nb::class_<HeldSmoothPatches>(m, "SmoothPatches", "A smooth surface through the vertices.")
      .def(nb::init<const HeldLocator&, const GivenFlags&, int>(), "locator"_a,
           "barriers"_a.noconvert(), "threads"_a = 1, nb::keep_alive<1, 2>())
      .def("interpolate", &HeldSmoothPatches::interpolate, "xy"_a.noconvert(), "threads"_a = 1,
           "The elevation at each point, NaN outside.")
      .def("on_edges", &HeldSmoothPatches::on_edges, "edges"_a.noconvert(), "shares"_a.noconvert(),
           "The elevation along edges, 3 * triangle + corner opposite.")
      .def("gradients", &HeldSmoothPatches::gradients, "The gradient at each corner.");
  nb::class_<HeldNearestBoundary>(m, "NearestBoundary", "Finds places of the boundary.")
      .def(nb::init<const HeldLocator&>(), "locator"_a, nb::keep_alive<1, 2>())
      .def("find", &HeldNearestBoundary::find, "xy"_a.noconvert(),
           "The nearest edge of each point, and the share of the way along it.");
}

}  // namespace tinsmith::python
