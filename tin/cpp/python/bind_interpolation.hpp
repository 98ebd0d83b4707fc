// Bindings of interpolation.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../interpolation/batch.hpp"
#include "../interpolation/natural_neighbors.hpp"
#include "../interpolation/nearest_boundary.hpp"
#include "../interpolation/nearest_vertex.hpp"
#include "../interpolation/smooth_patches.hpp"
#include "arrays.hpp"
#include "bind_location.hpp"

namespace tinsmith::python {

inline const bool* barriers_of(const HeldLocator& locator, const GivenFlags& barriers) {
  if (barriers.shape(0) != locator.surface().triangle_count) {
    throw std::invalid_argument("triangles and barriers must have the same number of rows");
  }
  return barriers.data();
}

// A surface that is Delaunay but for its barriers: the given one, or one of its own.
class HeldNaturalNeighbors {
 public:
  HeldNaturalNeighbors(const HeldLocator& locator, const GivenFlags& barriers)
      : given_(locator.locator()) {
    const bool* flags = barriers_of(locator, barriers);
    unlocked(1, [&](Team& team) {
      flipped_.build(given_.surface(), flags, [&] { return team.keeps_going(0); });
      if (flipped_.is_flipped()) own_ = std::make_unique<Locator>(flipped_.surface());
      barriers_ = now().ordered().order_flags(own_ ? flipped_.barriers() : flags);
      return 0;
    });
  }

  Elevations interpolate(const GivenXy& xy, NaturalWeights kind, int threads) const {
    return elevations_at(now(), xy, threads, [&] {
      return NaturalNeighbors(now().ordered().surface(), barriers_.get(), kind);
    });
  }

  bool is_flipped() const { return own_ != nullptr; }

 private:
  const Locator& now() const { return own_ ? *own_ : given_; }

  const Locator& given_;
  FlippedTriangles flipped_;
  std::unique_ptr<Locator> own_;
  ScratchArray<bool> barriers_;  // in the locator's order
};

class HeldSmoothPatches {
 public:
  HeldSmoothPatches(const HeldLocator& locator, const GivenFlags& barriers, int threads)
      : locator_(locator.locator()),
        ordered_(locator_.ordered().numbers()),
        barriers_(locator_.ordered().order_flags(barriers_of(locator, barriers))),
        gradients_(unlocked(threads,
                            [&](Team& team) {
                              return std::make_unique<VertexGradients>(locator_.ordered().surface(),
                                                                       barriers_.get(), team);
                            })),
        patches_(locator_.ordered().surface(), barriers_.get(), *gradients_) {}

  Elevations interpolate(const GivenXy& xy, int threads) const {
    return elevations_at(locator_, xy, threads, [&] { return patches_; });
  }

  // Edges as 3 * triangle + corner.
  Elevations on_edges(const GivenNumbers& edges, const Given<double, -1>& shares) const {
    const std::size_t count = edges.shape(0);
    const std::int64_t entries = std::int64_t{3} * locator_.surface().triangle_count;
    auto result = streamed_array<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t edge = edges.data()[i];
      if (edge < 0 || edge >= entries) throw std::invalid_argument("there is no such edge");
      result[i] = patches_.on_edge(ordered_[edge / 3], edge % 3, shares.data()[i]);
    }
    return hand_over<Elevations>(std::move(result), {count});
  }

  Xy gradients() const {
    const std::uint32_t count = locator_.surface().triangle_count;
    auto result = streamed_array<double>(std::size_t{6} * count);
    for (const Triangle t : Ids<Triangle>(count)) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Gradient gradient = gradients_->at(ordered_[number(t)], k);
        result[2 * entry_of(t, k)] = gradient.x;
        result[2 * entry_of(t, k) + 1] = gradient.y;
      }
    }
    return hand_over<Xy>(std::move(result), {std::size_t{3} * count, 2});
  }

 private:
  const Locator& locator_;
  ScratchArray<Triangle> ordered_;  // the locator's number of each triangle
  ScratchArray<bool> barriers_;     // in the locator's order
  std::unique_ptr<VertexGradients> gradients_;
  SmoothPatches patches_;
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
    unlocked(1, [&](Team& team) {
      const HilbertOrder order(points, row_count(count));
      HalfEdge last = kNoHalfEdge;
      for (std::size_t i = 0; i < count; ++i) {
        if (i % 4096 == 0 && !team.keeps_going(0)) break;
        const std::int32_t row = order[static_cast<std::int32_t>(i)];
        const BoundaryPlace place = boundary_.find(points[row], last);
        last = place.edge;
        edges[row] = static_cast<std::int32_t>(entry_of(place.edge));
        shares[row] = place.share;
      }
      return 0;
    });
    return {hand_over<Numbers>(std::move(edges), {count}),
            hand_over<Elevations>(std::move(shares), {count})};
  }

 private:
  NearestBoundary boundary_;
};

// Vertex numbers of a Delaunay triangulation, as doubles; NaN outside.
inline Elevations nearest_vertices(const HeldLocator& locator, const GivenXy& xy, int threads) {
  return elevations_at(locator.locator(), xy, threads, [&] {
    return [search = NearestVertex(locator.locator().ordered())](Point p, Triangle t) mutable {
      return static_cast<double>(number(search.find(p, t)));
    };
  });
}

inline void bind_interpolation(nb::module_& m) {
  nb::enum_<NaturalWeights>(m, "NaturalWeights", "How natural neighbours weigh.")
      .value("SIBSON", NaturalWeights::kSibson)
      .value("LAPLACE", NaturalWeights::kLaplace);
  m.def("nearest_vertices", &nearest_vertices, "locator"_a, "xy"_a.noconvert(), "threads"_a = 1,
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
