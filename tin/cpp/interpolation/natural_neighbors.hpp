// Natural neighbour interpolation: Sibson's areas and Laplace's ratios of lengths.
//
// R. Sibson, "A brief description of natural neighbour interpolation" (1981): a neighbour weighs as
// the area that the point's Voronoi cell would take from the neighbour's. V. Belikov et al., "The
// non-Sibsonian interpolation" (1997): as the length of the side that both cells would share,
// divided by the distance. Both reproduce planes, both are linear along the boundary and barriers.
//
// With barriers the cells are those of the extended Voronoi diagram (R. Seidel, "Constrained
// Delaunay triangulations and Voronoi diagrams with obstacles", 1988): beyond a barrier lies a sheet
// of its own, in which only the vertices on this side count. Its areas are taken by the same sums.
//
// Which vertices are neighbours is decided exactly. Areas are computed from the corners of the
// cells, relative to the point: in doubles, or, where too much would cancel, in twice or six times
// their digits.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "../predicates/double_double.hpp"
#include "long_number.hpp"
#include "neighbor_ring.hpp"

namespace tinsmith {

// The difference of two coordinates; exact but in doubles.
template <typename Real>
Real difference(double a, double b) {
  return Real(exact_difference(a, b));
}
template <>
inline double difference<double>(double a, double b) {
  return a - b;
}

// Digits that sums and products of a type keep, with room for some roundings.
template <typename Real>
constexpr int kKeptDigits = 53;
template <>
inline constexpr int kKeptDigits<TwoDoubles> = 104;
template <>
inline constexpr int kKeptDigits<LongNumber> = 300;

enum class NaturalWeights { kSibson, kLaplace };

// One for a thread.
class NaturalNeighbors {
 public:
  NaturalNeighbors(const Surface& surface, const bool* barriers, NaturalWeights kind)
      : surface_(surface), barriers_(barriers), kind_(kind) {}

  // The elevation at p, which the triangle holds.
  double operator()(Point p, Triangle t) {
    const auto weights =
        CornerWeights::at(p, surface_.corner(t, 0), surface_.corner(t, 1), surface_.corner(t, 2));
    if (is_settled(weights, t) || !cavity_.collect(surface_, barriers_, p, t)) {
      return elevation_at(surface_, p, t);
    }
    const bool is_weighed =
        weigh(doubles_, p) || weigh(double_doubles_, p) || weigh(long_numbers_, p);
    // So near a barrier or the boundary that no digits are left: there the limit is linear.
    return is_weighed ? weighted_mean() : elevation_at(surface_, p, t);
  }

 private:
  template <typename Real>
  struct Vector {
    Real x, y;
  };

  // What is computed on the way, kept for the next point.
  template <typename Real>
  struct Scratch {
    std::vector<Vector<Real>> neighbors;  // relative to the point, as the corners
    std::vector<Vector<Real>> corners;    // of the point's cell, one for each edge of the ring
    std::vector<Vector<Real>> centers;    // of the cavity's circles
    std::vector<Real> weights;
    double cancelled = 0.0;  // the largest ratio of terms to the area that is their difference
    double extent = 0.0;     // squared, of corners and centres
  };

  // Relative errors of weights stay below 2^-39 or so.
  static constexpr int kWantedDigits = 39;

  // At a corner, and on an edge that is not looked across, the elevation is that of the line.
  bool is_settled(const CornerWeights& weights, Triangle t) const {
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (weights.of[k] != 0.0) continue;
      if (!is_open(surface_, barriers_, t, k)) return true;
      if (weights.of[corner_after(k)] == 0.0 || weights.of[corner_before(k)] == 0.0) return true;
    }
    return false;
  }

  template <typename Real>
  bool weigh(Scratch<Real>& scratch, Point p) {
    const auto& ring = cavity_.ring();
    scratch.neighbors.clear();
    for (const auto& edge : ring) {
      const Point v = surface_.point(edge.start);
      scratch.neighbors.push_back({difference<Real>(v.x, p.x), difference<Real>(v.y, p.y)});
    }
    scratch.weights.assign(ring.size(), Real(0.0));
    scratch.cancelled = scratch.extent = 0.0;
    if (kind_ == NaturalWeights::kSibson) return weigh_areas(scratch, p) && take(scratch.weights);
    return weigh_ratios(scratch) && take(scratch.weights);
  }

  // Twice the area that the cell takes from each neighbour's, by the sums of cross products along
  // the outlines; each side of an outline is summed once for the neighbours on both its sides.
  template <typename Real>
  bool weigh_areas(Scratch<Real>& scratch, Point p) {
    const auto& ring = cavity_.ring();
    const std::size_t size = ring.size();
    find_corners(scratch, p);
    double total = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t after = i + 1 < size ? i + 1 : 0;
      const Real side = cross(scratch.centers[ring[i].triangle], scratch.corners[i]);
      scratch.weights[i] = scratch.weights[i] - side;
      scratch.weights[after] = scratch.weights[after] + side;
      const Real part = cross(scratch.corners[i], scratch.corners[after]);
      scratch.weights[after] = scratch.weights[after] + part;
      total += static_cast<double>(part);
    }
    for (const auto& edge : cavity_.inner_edges()) {
      const Real side = cross(scratch.centers[edge.triangle], scratch.centers[edge.beyond]);
      scratch.weights[edge.start] = scratch.weights[edge.start] - side;
      scratch.weights[edge.end] = scratch.weights[edge.end] + side;
    }
    return is_precise<Real>(scratch.cancelled * scratch.extent, total);
  }

  // Twice the length of each shared side over the distance: the cotangents of the two angles
  // under which it is seen.
  template <typename Real>
  bool weigh_ratios(Scratch<Real>& scratch) {
    const auto& neighbors = scratch.neighbors;
    const std::size_t size = neighbors.size();
    double largest = 0.0, total = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t after = i + 1 < size ? i + 1 : 0;
      const Vector<Real> a = neighbors[i], b = neighbors[after];
      const Vector<Real> along = minus(b, a);
      const Real area = cross(a, b);
      note_cancelled(scratch, std::max(square_of(a), square_of(b)), area);
      const Real at_b = (b.x * along.x + b.y * along.y) / area;
      const Real at_a = -(a.x * along.x + a.y * along.y) / area;
      scratch.weights[i] = scratch.weights[i] + at_b;
      scratch.weights[after] = scratch.weights[after] + at_a;
      const double first = static_cast<double>(at_a), second = static_cast<double>(at_b);
      largest = std::max({largest, std::fabs(first), std::fabs(second)});
      total += first + second;
    }
    return is_precise<Real>(scratch.cancelled * std::max(largest, 1.0), total);
  }

  template <typename Real>
  void find_corners(Scratch<Real>& scratch, Point p) {
    const auto& neighbors = scratch.neighbors;
    const std::size_t size = neighbors.size();
    scratch.corners.clear();
    scratch.centers.clear();
    for (std::size_t i = 0; i < size; ++i) {
      scratch.corners.push_back(
          circumcenter(scratch, neighbors[i], neighbors[i + 1 < size ? i + 1 : 0]));
      note_extent(scratch, scratch.corners.back());
    }
    for (const Triangle t : cavity_.triangles()) {
      const Point a = surface_.corner(t, 0), b = surface_.corner(t, 1), c = surface_.corner(t, 2);
      const Vector<Real> ab{difference<Real>(b.x, a.x), difference<Real>(b.y, a.y)};
      const Vector<Real> ac{difference<Real>(c.x, a.x), difference<Real>(c.y, a.y)};
      const Vector<Real> center = circumcenter(scratch, ab, ac);
      scratch.centers.push_back(
          {center.x + difference<Real>(a.x, p.x), center.y + difference<Real>(a.y, p.y)});
      note_extent(scratch, scratch.centers.back());
    }
  }

  // Of the circle through the origin, a and b.
  template <typename Real>
  static Vector<Real> circumcenter(Scratch<Real>& scratch, Vector<Real> a, Vector<Real> b) {
    const Real a_square = a.x * a.x + a.y * a.y, b_square = b.x * b.x + b.y * b.y;
    const Real area = cross(a, b);
    note_cancelled(scratch, std::sqrt(square_of(a)) * std::sqrt(square_of(b)), area);
    const Real half = Real(0.5) / area;
    return {(b.y * a_square - a.y * b_square) * half, (a.x * b_square - b.x * a_square) * half};
  }

  // Rounding of the squares and products is divided by the area too.
  template <typename Real>
  static void note_cancelled(Scratch<Real>& scratch, double terms, const Real& area) {
    // A negative area is the work of rounding, and nothing can be built on it.
    const double divisor = static_cast<double>(area);
    scratch.cancelled = divisor > 0.0 ? std::max(scratch.cancelled, terms / divisor)
                                      : std::numeric_limits<double>::infinity();
  }
  template <typename Real>
  static void note_extent(Scratch<Real>& scratch, const Vector<Real>& corner) {
    scratch.extent = std::max(scratch.extent, square_of(corner));
  }
  template <typename Real>
  static double square_of(const Vector<Real>& vector) {
    const double x = static_cast<double>(vector.x), y = static_cast<double>(vector.y);
    return x * x + y * y;
  }

  // Not where something overflowed or is no number.
  template <typename Real>
  static bool is_precise(double cancelled, double total) {
    const double most = std::ldexp(1.0, kKeptDigits<Real> - kWantedDigits);
    return total > 0.0 && total < std::numeric_limits<double>::infinity() &&
           cancelled <= most * total;
  }

  template <typename Real>
  bool take(const std::vector<Real>& weights) {
    weights_.clear();
    for (const Real& weight : weights) weights_.push_back(static_cast<double>(weight));
    return true;
  }

  template <typename Real>
  static Real cross(const Vector<Real>& a, const Vector<Real>& b) {
    return a.x * b.y - a.y * b.x;
  }
  template <typename Real>
  static Vector<Real> minus(const Vector<Real>& a, const Vector<Real>& b) {
    return {a.x - b.x, a.y - b.y};
  }

  // Differences from the neighbour of largest weight, as in CornerWeights.
  double weighted_mean() const {
    const auto& ring = cavity_.ring();
    const std::size_t main = std::max_element(weights_.begin(), weights_.end()) - weights_.begin();
    const double z = surface_.elevation(ring[main].start);
    double half_rise = 0.0, total = 0.0, lowest = z, highest = z;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const double z_i = surface_.elevation(ring[i].start);
      half_rise += weights_[i] * (0.5 * z_i - 0.5 * z);
      total += weights_[i];
      lowest = std::min(lowest, z_i);
      highest = std::max(highest, z_i);
    }
    return std::min(std::max(z + 2.0 * (half_rise / total), lowest), highest);
  }

  Surface surface_;
  const bool* barriers_;
  NaturalWeights kind_;
  NeighborRing cavity_;
  Scratch<double> doubles_;
  Scratch<TwoDoubles> double_doubles_;
  Scratch<LongNumber> long_numbers_;
  std::vector<double> weights_;
};

}  // namespace tinsmith
