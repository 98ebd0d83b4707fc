// Smooth patches over a located surface, asked by the numbers of its caller.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "../location/locator.hpp"
#include "smooth_patches.hpp"

namespace tinsmith {

class SmoothSurface {
 public:
  // The locator must outlive it; barriers are the caller's, three flags a triangle. Check
  // `team.is_stopped()` afterwards.
  SmoothSurface(const Locator& locator, const bool* barriers, Team& team)
      : locator_(locator),
        ordered_(locator.ordered().numbers()),
        barriers_(locator.ordered().order_flags(barriers)),
        gradients_(locator.ordered().surface(), barriers_.get(), team) {}

  const Locator& locator() const { return locator_; }
  // In the locator's order.
  SmoothPatches patches() const {
    return {locator_.ordered().surface(), barriers_.get(), gradients_};
  }

  // Elevations at shares of the way along edges, each 3 * triangle + corner.
  void write_on_edges(const std::int32_t* edges, const double* shares, std::size_t count,
                      double* result) const {
    const std::int64_t entries = std::int64_t{3} * locator_.surface().triangle_count;
    const SmoothPatches patches = this->patches();
    for (std::size_t i = 0; i < count; ++i) {
      if (edges[i] < 0 || edges[i] >= entries) {
        throw std::invalid_argument("there is no such edge");
      }
      const HalfEdge e = half_edge_at(static_cast<std::size_t>(edges[i]));
      result[i] = patches.on_edge(ordered_[number(triangle_of(e))], corner_of(e), shares[i]);
    }
  }

  // Two numbers for each corner of each triangle.
  void write_gradients(double* result) const {
    for (const Triangle t : Ids<Triangle>(locator_.surface().triangle_count)) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Gradient gradient = gradients_.at(ordered_[number(t)], k);
        result[2 * entry_of(t, k)] = gradient.x;
        result[2 * entry_of(t, k) + 1] = gradient.y;
      }
    }
  }

 private:
  const Locator& locator_;
  ScratchArray<Triangle> ordered_;  // the locator's number of each triangle
  ScratchArray<bool> barriers_;     // in the locator's order
  VertexGradients gradients_;
};

}  // namespace tinsmith
