// The quadratic surface through each vertex that fits the vertices within two edges best.
//
// Least squares of the differences in elevation, all of equal weight, by the normal equations and
// Cholesky's decomposition (Benoit, "Note sur une methode de resolution des equations normales",
// 1924). Sums run over a vertex's neighbours in the order of their coordinates and
// then over each one's that are new, in the same order: so the result does not depend on how
// vertices are numbered. Lengths are divided by their size, so that the equations have no unit.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "../../../tin/cpp/base/arrays.hpp"
#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/base/parallel.hpp"
#include "../../../tin/cpp/base/pulse.hpp"
#include "../../../tin/cpp/location/ordered_surface.hpp"
#include "vertex_neighbors.hpp"

namespace tinsmith {

// Factors from coordinates to lengths of one unit; those of eastings and northings may be one for
// each vertex.
struct VertexScales {
  const double* east;
  const double* north;
  double up;
  bool is_each;

  double east_at(Vertex v) const { return east[is_each ? number(v) : 0]; }
  double north_at(Vertex v) const { return north[is_each ? number(v) : 0]; }
};

class QuadraticFit {
 public:
  static constexpr int kTerms = 5;

  // The derivatives x, y, xx, xy, yy of the elevation at each vertex, `point_count` of each; NaN
  // where no one quadratic surface fits. Check `team.is_stopped()` afterwards.
  static void run(const Surface& given, const VertexScales& scales, double* derivatives,
                  Team& team) {
    const OrderedSurface copy(given);
    const Surface surface = copy.surface();
    const VertexNeighbors neighbors(surface, team);
    if (team.is_stopped()) return;
    std::atomic<std::int32_t> next{0};
    team.run([&](int part) {
      QuadraticFit fit(surface, neighbors, Pulse(team, part));
      for (std::int32_t begin; (begin = next.fetch_add(kAtATime)) < surface.point_count;) {
        const std::int32_t end = std::min(surface.point_count - begin, kAtATime) + begin;
        for (std::int32_t i = begin; i < end; ++i) {
          const Vertex v{i}, known_as = copy.given_number(v);
          const double factors[3] = {scales.east_at(known_as), scales.north_at(known_as),
                                     scales.up};
          if (!fit.find_neighbors(v)) return;
          fit.solve(v, factors);
          for (int k = 0; k < kTerms; ++k) {
            derivatives[static_cast<std::size_t>(k) * surface.point_count + number(known_as)] =
                fit.solved_[k];
          }
        }
      }
    });
  }

 private:
  static constexpr std::int32_t kAtATime = 1024;
  // A pivot that elimination leaves of so small a share of the diagonal is none: the neighbours
  // then lie on a conic, and many quadratic surfaces fit.
  static constexpr double kLeastPivot = 1e-10;

  struct Place {
    double x, y, z;
  };
  using Matrix = double[kTerms][kTerms];  // the lower half

  QuadraticFit(const Surface& surface, const VertexNeighbors& neighbors, Pulse pulse)
      : surface_(surface),
        neighbors_(neighbors),
        pulse_(pulse),
        seen_for_(scratch_array<std::int32_t>(static_cast<std::size_t>(surface.point_count))) {
    std::fill_n(seen_for_.get(), surface.point_count, number(kNoVertex));
  }

  // False if asked to stop.
  bool find_neighbors(Vertex v) {
    ring_.clear();
    places_.clear();
    seen_for_[number(v)] = number(v);
    add_neighbors(v, v);
    for (std::size_t i = 0, near = ring_.size(); i < near; ++i) {
      add_neighbors(v, ring_[i]);
      if (!pulse_.goes_on()) return false;
    }
    for (const Vertex w : ring_) places_.push_back(place_of(w));
    return true;
  }

  // The neighbours of w that were not yet seen for v.
  void add_neighbors(Vertex v, Vertex w) {
    for (const Vertex* other = neighbors_.begin(w); other != neighbors_.end(w); ++other) {
      if (std::exchange(seen_for_[number(*other)], number(v)) != number(v)) {
        ring_.push_back(*other);
      }
    }
  }

  Place place_of(Vertex v) const {
    const double* row = surface_.row(v);
    return {row[0], row[1], row[2]};
  }

  void solve(Vertex v, const double (&factors)[3]) {
    const Place center = place_of(v);
    double reach = 0.0;
    for (Place& p : places_) {
      p = {(p.x - center.x) * factors[0], (p.y - center.y) * factors[1],
           (p.z - center.z) * factors[2]};
      reach = std::max({reach, std::fabs(p.x), std::fabs(p.y)});
    }
    // A power of two, so that nothing is rounded.
    const double scale = reach > 0.0 ? std::ldexp(1.0, -std::ilogb(reach)) : 1.0;
    Matrix matrix{};
    double right[kTerms]{};
    for (const Place& p : places_) add(p, scale, matrix, right);
    double inverse[kTerms];
    decompose(matrix, inverse);
    substitute(matrix, inverse, right);
    for (int k = 0; k < kTerms; ++k) solved_[k] = right[k] * (k < 2 ? scale : scale * scale);
  }

  static void add(const Place& p, double scale, Matrix& matrix, double (&right)[kTerms]) {
    const double x = p.x * scale, y = p.y * scale;
    const double terms[kTerms] = {x, y, x * x / 2, x * y, y * y / 2};
    for (int i = 0; i < kTerms; ++i) {
      right[i] += terms[i] * p.z;
      for (int j = 0; j <= i; ++j) matrix[i][j] += terms[i] * terms[j];
    }
  }

  // Cholesky's decomposition without roots: rows of the lower triangle in place, and the pivots'
  // inverses, NaN from a pivot on that is none.
  static void decompose(Matrix& matrix, double (&inverse)[kTerms]) {
    for (int j = 0; j < kTerms; ++j) {
      const double least = kLeastPivot * matrix[j][j];
      double part[kTerms];  // the row times the pivots
      double pivot = matrix[j][j];
      for (int k = 0; k < j; ++k) {
        part[k] = matrix[j][k];
        for (int l = 0; l < k; ++l) part[k] -= part[l] * matrix[k][l];
        matrix[j][k] = part[k] * inverse[k];
        pivot -= matrix[j][k] * part[k];
      }
      inverse[j] = pivot > least ? 1.0 / pivot : std::numeric_limits<double>::quiet_NaN();
    }
  }

  static void substitute(const Matrix& lower, const double (&inverse)[kTerms],
                         double (&right)[kTerms]) {
    for (int j = 0; j < kTerms; ++j) {
      for (int k = 0; k < j; ++k) right[j] -= lower[j][k] * right[k];
    }
    for (int j = 0; j < kTerms; ++j) right[j] *= inverse[j];
    for (int j = kTerms - 1; j >= 0; --j) {
      for (int i = j + 1; i < kTerms; ++i) right[j] -= lower[i][j] * right[i];
    }
  }

  const Surface& surface_;
  const VertexNeighbors& neighbors_;
  Pulse pulse_;
  ScratchArray<std::int32_t> seen_for_;  // the vertex for which each was last found
  std::vector<Vertex> ring_;
  std::vector<Place> places_;
  double solved_[kTerms];
};

}  // namespace tinsmith
