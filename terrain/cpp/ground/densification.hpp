// Progressive densification of a TIN: from points that are ground for certain to all that fit.
//
// Axelsson, "DEM generation from laser scanner data using adaptive TIN models", International
// Archives of Photogrammetry and Remote Sensing 33 B4 (2000):
//
//   1. The seeds are triangulated.
//   2. A candidate belongs to the ground if its distance from the plane of its triangle is small,
//      and so is the angle under which it is seen from the nearest corner. Of each triangle the one
//      nearest to its plane becomes a vertex.
//   3. The candidates of the triangles that changed are examined again, until none fits.
//
//                    .p
//              .   . |  distance        sine of the angle = distance / (p - nearest corner)
//          .  )angle |
//      corner -------+---------- plane of the triangle
//
// In small triangles the angle is smaller, in proportion to the longest edge: otherwise the surface
// would climb every bush and wall by steps of a few centimetres.
//
// Candidates wait in lists, one a triangle; only those of changed triangles are placed anew. What
// becomes ground depends on the points alone: the triangulation of given points is unique, the
// candidate nearest to a plane is chosen with its coordinates deciding ties, and one on an edge
// belongs to the triangle whose apex comes first.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/base/parallel.hpp"
#include "../../../tin/cpp/base/pulse.hpp"
#include "../../../tin/cpp/index/hilbert_order.hpp"
#include "../../../tin/cpp/mesh/mesh_arrays.hpp"
#include "../../../tin/cpp/mesh/mesh_editor.hpp"

namespace tinsmith {

// When a candidate belongs to the ground.
struct GroundLimits {
  double sine;       // of the angle, in a triangle with an edge of `full_edge` or longer
  double distance;   // from the plane of the triangle
  double full_edge;  // longest edge from which on the whole angle is allowed
};

class Densification {
 public:
  // Rows of x, y, z: the seeds with their triangles, and the points, which must outlive this.
  Densification(const PointRows& seeds, const GivenTriangles& triangles, const double* points,
                std::int32_t count, const GroundLimits& limits)
      : editor_(editor_of(seeds, triangles)),
        points_(points),
        count_(count),
        limits_(limits),
        order_(copy_places(points, count).data(), count) {
    for (std::int64_t i = 0; i < seeds.count; ++i) {
      elevations_.push_back(seeds.data[i * seeds.stride + 2]);
    }
  }

  // Add points of those that `is_candidate` marks until none fits; false if stopped.
  bool run(const bool* is_candidate, Team& team) {
    Pulse pulse(team);
    team.expect(kParts * std::int64_t{count_});
    if (!place_all(is_candidate, pulse)) return false;
    team.advance(count_);
    std::int64_t ahead = (kParts - 2) * std::int64_t{count_};  // of the rounds, however many
    editor_.watch();
    std::vector<Triangle> changed;
    for (const Triangle t : editor_.mesh().triangles()) changed.push_back(t);
    for (std::vector<std::int32_t> accepted; accept(changed, accepted, pulse);) {
      for (const std::int32_t point : accepted) insert(point);
      editor_.take_touched(changed);
      std::sort(changed.begin(), changed.end());
      changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
      place_again(changed);
      team.advance(ahead / kShareOfRound);
      ahead -= ahead / kShareOfRound;
    }
    team.advance(ahead);
    return pulse.goes_on();
  }

  // How high each point lies above the surface, and the tangent of the surface's slope there (0
  // at a vertex). Every point must lie within the hull of the seeds. False if stopped.
  bool measure(double* heights, double* slopes, Team& team) {
    Pulse pulse(team);
    HalfEdge near = kStart;
    for (std::int32_t i = 0; i < count_; ++i) {
      if (!pulse.goes_on()) return false;
      const std::int32_t point = order_[i];
      const MeshLocation at = canonical(editor_.locate(place(point), near));
      near = at.edge;
      const bool is_vertex = at.where == MeshLocation::Where::kAtVertex;
      const Plane plane = is_vertex ? Plane{} : plane_of(triangle_of(at.edge));
      slopes[point] = std::hypot(plane.east, plane.north);
      const double ground =
          is_vertex ? elevation(editor_.mesh().from(at.edge)) : plane.elevation_at(place(point));
      heights[point] = elevation(point) - ground;
    }
    return true;
  }

 private:
  static constexpr HalfEdge kStart = half_edge(Triangle{0}, 0);
  static constexpr std::int32_t kNone = -1;

  // Of the work as it is told: placing and measuring are a part each, and every round a share of
  // what is ahead of it.
  static constexpr int kParts = 4, kShareOfRound = 4;

  // z = base.z + east * (x - base.x) + north * (y - base.y)
  struct Plane {
    SurfacePoint base{};
    double east = 0.0, north = 0.0;

    double elevation_at(Point p) const {
      return base.z + east * (p.x - base.at.x) + north * (p.y - base.at.y);
    }
  };

  static std::vector<Point> copy_places(const double* points, std::int32_t count) {
    std::vector<Point> places(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < places.size(); ++i) {
      places[i] = {points[3 * i], points[3 * i + 1]};
    }
    return places;
  }

  const double* row(std::int32_t point) const { return points_ + 3 * std::size_t(point); }
  Point place(std::int32_t point) const { return {row(point)[0], row(point)[1]}; }
  double elevation(std::int32_t point) const { return row(point)[2]; }
  double elevation(Vertex v) const { return elevations_[std::size_t(number(v))]; }
  SurfacePoint corner(Vertex v) const { return {editor_.point(v), elevation(v)}; }

  // ------------------------------------------------------------------ lists of candidates

  bool place_all(const bool* is_candidate, Pulse& pulse) {
    first_.assign(2 * std::size_t{editor_.mesh().triangle_slots()}, kNone);
    next_.assign(std::size_t(count_), kNone);
    triangle_of_.assign(std::size_t(count_), kNoTriangle);
    HalfEdge near = kStart;
    for (std::int32_t i = 0; i < count_; ++i) {
      if (!pulse.goes_on()) return false;
      const std::int32_t point = order_[i];
      if (is_candidate[point]) near = put(point, near);
    }
    return true;
  }

  // The point in the list of its triangle; one at a vertex in none. Returns an edge near it.
  HalfEdge put(std::int32_t point, HalfEdge near) {
    const MeshLocation at = canonical(editor_.locate(place(point), near));
    if (at.where == MeshLocation::Where::kAtVertex) return at.edge;
    const std::size_t t = number(triangle_of(at.edge));
    if (t >= first_.size()) first_.resize(t + t / 2 + 1, kNone);
    triangle_of_[std::size_t(point)] = triangle_of(at.edge);
    next_[std::size_t(point)] = first_[t];
    first_[t] = point;
    return at.edge;
  }

  // On an edge: in that of its two triangles whose apex comes first.
  MeshLocation canonical(MeshLocation at) const {
    if (at.where != MeshLocation::Where::kOnEdge) return at;
    const Mesh& mesh = editor_.mesh();
    const HalfEdge twin = mesh.twin(at.edge);
    const Vertex own = mesh.apex(at.edge), other = mesh.apex(twin);
    if (other == kGhost) return at;
    const bool is_first =
        own != kGhost && lexicographically_before(editor_.point(own), editor_.point(other));
    return is_first ? at : MeshLocation{at.where, twin};
  }

  void place_again(const std::vector<Triangle>& changed) {
    moved_.clear();
    for (const Triangle t : changed) {
      if (number(t) >= first_.size()) continue;
      for (std::int32_t point = std::exchange(first_[number(t)], kNone); point != kNone;
           point = next_[std::size_t(point)]) {
        moved_.push_back(point);
      }
    }
    for (const std::int32_t point : moved_) {
      put(point, half_edge(triangle_of_[std::size_t(point)], 0));
    }
  }

  void insert(std::int32_t point) {
    const HalfEdge near = half_edge(triangle_of_[std::size_t(point)], 0);
    const MeshLocation at = editor_.locate(place(point), near);
    editor_.insert_at(at, place(point), editor_.add_slot());
    elevations_.push_back(elevation(point));
  }

  // -------------------------------------------------------------------------- acceptance

  // The candidates that become vertices, one a triangle at most; false if there is none, or the
  // work was stopped.
  bool accept(const std::vector<Triangle>& changed, std::vector<std::int32_t>& accepted,
              Pulse& pulse) const {
    accepted.clear();
    for (const Triangle t : changed) {
      if (!pulse.goes_on()) return false;
      if (number(t) >= first_.size() || first_[number(t)] == kNone) continue;
      const std::int32_t best = nearest_that_fits(t);
      if (best != kNone) accepted.push_back(best);
    }
    return !accepted.empty();
  }

  std::int32_t nearest_that_fits(Triangle t) const {
    const Plane plane = plane_of(t);
    const double tilt = std::sqrt(1.0 + plane.east * plane.east + plane.north * plane.north);
    const std::array<SurfacePoint, 3> corners = corners_of(t);
    const double sine = limits_.sine * std::min(1.0, longest_edge(corners) / limits_.full_edge);
    std::int32_t best = kNone;
    double least = std::numeric_limits<double>::infinity();
    for (std::int32_t point = first_[number(t)]; point != kNone;
         point = next_[std::size_t(point)]) {
      const double rise = elevation(point) - plane.elevation_at(place(point));
      const double distance = std::fabs(rise) / tilt;
      if (!(distance <= limits_.distance) || distance > least) continue;
      const double square = squared_distance_to_nearest(corners, point);
      if (distance * distance > sine * sine * square) continue;
      if (distance < least || comes_before(point, best)) best = point;
      least = distance;
    }
    return best;
  }

  bool comes_before(std::int32_t a, std::int32_t b) const {
    return std::lexicographical_compare(row(a), row(a) + 3, row(b), row(b) + 3);
  }

  std::array<SurfacePoint, 3> corners_of(Triangle t) const {
    const auto& vertices = editor_.mesh()[t].corner;
    return {corner(vertices[0]), corner(vertices[1]), corner(vertices[2])};
  }

  // Corners are taken in the order of their coordinates, so that equal triangles have equal planes
  // to the last bit.
  Plane plane_of(Triangle t) const {
    std::array<SurfacePoint, 3> c = corners_of(t);
    std::sort(c.begin(), c.end(), [](const SurfacePoint& a, const SurfacePoint& b) {
      return lexicographically_before(a.at, b.at);
    });
    const double ux = c[1].at.x - c[0].at.x, uy = c[1].at.y - c[0].at.y;
    const double vx = c[2].at.x - c[0].at.x, vy = c[2].at.y - c[0].at.y;
    const double uz = c[1].z - c[0].z, vz = c[2].z - c[0].z;
    const double area = ux * vy - uy * vx;
    if (area == 0.0) return {c[0], 0.0, 0.0};  // a sliver: its sides cancel in doubles
    return {c[0], (uz * vy - vz * uy) / area, (vz * ux - uz * vx) / area};
  }

  static double longest_edge(const std::array<SurfacePoint, 3>& c) {
    double square = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point a = c[k].at, b = c[(k + 1) % 3].at;
      square = std::max(square, (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
    }
    return std::sqrt(square);
  }

  double squared_distance_to_nearest(const std::array<SurfacePoint, 3>& corners,
                                     std::int32_t point) const {
    double least = std::numeric_limits<double>::infinity();
    for (const SurfacePoint& c : corners) {
      const double dx = row(point)[0] - c.at.x, dy = row(point)[1] - c.at.y;
      const double dz = row(point)[2] - c.z;
      least = std::min(least, dx * dx + dy * dy + dz * dz);
    }
    return least;
  }

  MeshEditor editor_;
  const double* points_;
  std::int32_t count_;
  GroundLimits limits_;
  HilbertOrder order_;
  std::vector<double> elevations_;     // by vertex
  std::vector<std::int32_t> first_;    // candidate of each triangle
  std::vector<std::int32_t> next_;     // candidate in the same triangle
  std::vector<Triangle> triangle_of_;  // in whose list a candidate is, or was last
  std::vector<std::int32_t> moved_;
};

}  // namespace tinsmith
