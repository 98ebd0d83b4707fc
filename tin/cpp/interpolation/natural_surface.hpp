// A surface ready for natural neighbours: Delaunay but for its barriers, as it is given or after
// flips.
#pragma once

#include <memory>

#include "natural_neighbors.hpp"

namespace tinsmith {

class NaturalSurface {
 public:
  // The locator must outlive it; barriers are the caller's, three flags a triangle. Incomplete if
  // asked to stop.
  template <typename KeepGoing>
  NaturalSurface(const Locator& given, const bool* barriers, KeepGoing&& keep_going)
      : given_(given) {
    if (!flipped_.build(given.surface(), barriers, keep_going)) return;
    if (flipped_.is_flipped()) own_ = std::make_unique<Locator>(flipped_.surface());
    barriers_ = locator().ordered().order_flags(own_ ? flipped_.barriers() : barriers);
  }

  // Whether triangles of its own were made.
  bool is_flipped() const { return own_ != nullptr; }
  const Locator& locator() const { return own_ ? *own_ : given_; }
  NaturalNeighbors neighbors(NaturalWeights kind) const {
    return {locator().ordered().surface(), barriers_.get(), kind};
  }

 private:
  const Locator& given_;
  FlippedTriangles flipped_;
  std::unique_ptr<Locator> own_;
  ScratchArray<bool> barriers_;  // in the locator's order
};

}  // namespace tinsmith
