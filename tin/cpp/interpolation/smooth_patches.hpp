// A smooth surface through the vertices: over each triangle a side-vertex patch.
//
// G. M. Nielson, "The side-vertex method for interpolation in triangles" (1979). From each corner a
// cubic runs through the point to the opposite side; there it meets the side's own cubic, with a
// slope across the side that changes linearly along it. The three cubics are blended so that on a
// side only its own counts. Patches that share the gradients at the ends of a side so have the same
// slopes all along it. Other than the Clough-Tocher element, the patch needs no common gradient at
// a corner: sides that are barriers stay straight.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "vertex_gradients.hpp"

namespace tinsmith {

class SmoothPatches {
 public:
  SmoothPatches(const Surface& surface, const bool* barriers, const VertexGradients& gradients)
      : surface_(surface), barriers_(barriers), gradients_(gradients) {}

  // The elevation at p, which the triangle holds.
  double operator()(Point p, Triangle t) const {
    const auto weights =
        CornerWeights::at(p, surface_.corner(t, 0), surface_.corner(t, 1), surface_.corner(t, 2));
    const std::uint32_t main = weights.heaviest();
    const double b[3] = {weights.of[0] / weights.total(), weights.of[1] / weights.total(),
                         weights.of[2] / weights.total()};
    if (b[corner_after(main)] == 0.0 && b[corner_before(main)] == 0.0) {
      return surface_.elevation(t, main);
    }
    double rise = 0.0, blends = 0.0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const double product = b[corner_after(k)] * b[corner_before(k)];
      const double blend = product * product;
      if (blend == 0.0) continue;
      rise += blend * cubic_through(t, k, b, main);
      blends += blend;
    }
    const double z = surface_.elevation(t, main) + rise / blends;
    return std::isfinite(z) ? z : elevation_at(surface_, p, t);
  }

  // The elevation at a share of the way along the edge opposite corner k.
  double on_edge(Triangle t, std::uint32_t k, double share) const {
    return surface_.elevation(t, corner_after(k)) + side(t, k).rise_at(share);
  }

 private:
  // The cubic along a side from its first end on: above the straight line it starts and ends with
  // these slopes.
  struct Side {
    Gradient step;
    double rise, start_excess, end_excess;

    double rise_at(double r) const {
      return r * (rise + (1.0 - r) * ((1.0 - r) * start_excess - r * end_excess));
    }
    double slope_at(double r) const {
      return rise + (1.0 - r) * (1.0 - 3.0 * r) * start_excess - r * (2.0 - 3.0 * r) * end_excess;
    }
  };

  Gradient step_between(Triangle t, std::uint32_t from, std::uint32_t to) const {
    const Point a = surface_.corner(t, from), b = surface_.corner(t, to);
    return {b.x - a.x, b.y - a.y};
  }

  Side side(Triangle t, std::uint32_t k) const {
    const std::uint32_t from = corner_after(k), to = corner_before(k);
    Side side{step_between(t, from, to), surface_.elevation(t, to) - surface_.elevation(t, from),
              0.0, 0.0};
    if (!barriers_[entry_of(t, k)]) {
      side.start_excess = gradients_.at(t, from).along(side.step) - side.rise;
      side.end_excess = gradients_.at(t, to).along(side.step) - side.rise;
    }
    return side;
  }

  // How far the cubic from corner k through the point lies above corner `main`.
  double cubic_through(Triangle t, std::uint32_t k, const double (&b)[3],
                       std::uint32_t main) const {
    const std::uint32_t from = corner_after(k), to = corner_before(k);
    const Side opposite = side(t, k);
    const double way = b[from] + b[to];  // of the way from corner k to the side
    const double r = b[to] / way;
    const Gradient to_start = step_between(t, k, from);
    const Gradient ray{to_start.x + r * opposite.step.x, to_start.y + r * opposite.step.y};
    const double length = opposite.step.along(opposite.step);
    const double share = ray.along(opposite.step) / length;
    const Gradient across{ray.x - share * opposite.step.x, ray.y - share * opposite.step.y};
    const double end_slope = share * opposite.slope_at(r) +
                             (1.0 - r) * gradients_.at(t, from).along(across) +
                             r * gradients_.at(t, to).along(across);
    const double z = surface_.elevation(t, k);
    const double rise = surface_.elevation(t, from) - z + opposite.rise_at(r);
    const Side cubic{ray, rise, gradients_.at(t, k).along(ray) - rise, end_slope - rise};
    return z - surface_.elevation(t, main) + cubic.rise_at(way);
  }

  Surface surface_;
  const bool* barriers_;
  const VertexGradients& gradients_;
};

}  // namespace tinsmith
