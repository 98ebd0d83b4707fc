// Heights above rays from an eye, with exact signs.
#pragma once

#include <cmath>

#include "../../../tin/cpp/base/point.hpp"
#include "../../../tin/cpp/predicates/predicates.hpp"

namespace tinsmith::sight {

// From the eye to a place, rounded once each.
struct Offset {
  double x, y, z;

  Offset() = default;
  Offset(double east, double north, double up) : x(east), y(north), z(up) {}
  Offset(const SurfacePoint& eye, const SurfacePoint& place)
      : Offset(place.at.x - eye.at.x, place.at.y - eye.at.y, place.z - eye.z) {}

  // Along an edge within a quadrant a height is linear, and so is this: their ratio has its
  // extremes at the ends, which it has not if it is taken with the distance.
  double norm() const { return std::fabs(x) + std::fabs(y); }
  double square() const { return x * x + y * y; }
};

namespace detail {

// Shewchuk's bound for the first stage of the determinant.
constexpr double kVolumeBound = (7.0 + 56.0 * kUnitRoundoff) * kUnitRoundoff;

inline Expansion<64> exact_term(const SurfacePoint& eye, const SurfacePoint& a,
                                const SurfacePoint& b, const SurfacePoint& c) {
  const auto difference = [](double p, double q) { return expand(exact_difference(p, q)); };
  const auto ax = difference(a.at.x, eye.at.x), ay = difference(a.at.y, eye.at.y);
  const auto bx = difference(b.at.x, eye.at.x), by = difference(b.at.y, eye.at.y);
  return (ax * by - ay * bx) * difference(c.z, eye.z);
}

}  // namespace detail

// Of the plane through the eye, a and b above the place c, where a, b is counter-clockwise about
// the eye: the sign of the opposite of the volume that they span.
inline int sign_of_height(const SurfacePoint& eye, const SurfacePoint& a, const SurfacePoint& b,
                          const SurfacePoint& c) {
  const Offset p(eye, a), q(eye, b), r(eye, c);
  const double qx_ry = q.x * r.y, qy_rx = q.y * r.x, rx_py = r.x * p.y;
  const double ry_px = r.y * p.x, px_qy = p.x * q.y, py_qx = p.y * q.x;
  const double volume = p.z * (qx_ry - qy_rx) + q.z * (rx_py - ry_px) + r.z * (px_qy - py_qx);
  const double size = (std::fabs(qx_ry) + std::fabs(qy_rx)) * std::fabs(p.z) +
                      (std::fabs(rx_py) + std::fabs(ry_px)) * std::fabs(q.z) +
                      (std::fabs(px_qy) + std::fabs(py_qx)) * std::fabs(r.z);
  if (std::fabs(volume) > detail::kVolumeBound * size) return volume < 0.0 ? 1 : -1;
  if (size == 0.0) return 0;
  const auto exact = detail::exact_term(eye, b, c, a) + detail::exact_term(eye, c, a, b) +
                     detail::exact_term(eye, a, b, c);
  return -exact.sign();
}

// Of the ray from the eye to a below the one to b, where a and b lie in the same direction.
inline int compare_steepness(const SurfacePoint& eye, const SurfacePoint& a,
                             const SurfacePoint& b) {
  const bool by_x = a.at.x != eye.at.x;
  const double from = by_x ? eye.at.x : eye.at.y;
  const double to_a = by_x ? a.at.x : a.at.y, to_b = by_x ? b.at.x : b.at.y;
  const int sign =
      tinsmith::detail::sign_of_product_difference(a.z, eye.z, to_b, from, b.z, eye.z, to_a, from);
  return to_a > from ? sign : -sign;
}

}  // namespace tinsmith::sight
