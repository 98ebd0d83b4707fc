// The values of a surface at the centres of a grid's cells, triangle by triangle.
//
// Scan conversion: on each row the cells between the crossings of a triangle's sides, one more
// where rounding leaves it open. Whether a triangle holds a centre is decided exactly, and a centre
// on an edge or a vertex belongs to the smallest triangle: as point location has it, so that the
// elevations are those of interpolation to the last bit. What has one value on each side of an edge
// needs to know these centres: they are listed on request.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "../../../tin/cpp/location/ordered_surface.hpp"
#include "tiles.hpp"

namespace tinsmith {

// A centre on an edge or on a vertex of a triangle.
struct SharedCenter {
  static constexpr int kPartBits = 3;  // of the part of a triangle

  std::int64_t place;  // row * columns + column
  std::int64_t part;   // 8 * triangle + the corner opposite the edge, or 4 + the corner
};

// What a scan writes: elevations, one value a triangle, or a vector that changes evenly between
// those of the vertices. `of(triangle)` returns what writes the cells of a triangle, by the centre's
// weights; cells outside the surface become NaN.
struct ElevationPaint {
  static constexpr int kNumbers = 1;                 // of a cell
  static constexpr bool kPutsVerticesFirst = false;  // on edges the same from both sides
  const OrderedSurface& surface;
  double* cells;

  auto of(Triangle t) const {
    const Surface its = surface.surface();
    return [to = cells, a = its.elevation(t, 0), b = its.elevation(t, 1), c = its.elevation(t, 2)](
               const CornerWeights& weights, std::size_t place) {
      to[place] = weights.mean_of({a, b, c});
    };
  }
};

struct TrianglePaint {
  static constexpr int kNumbers = 1;
  static constexpr bool kPutsVerticesFirst = true;
  const OrderedSurface& surface;
  const double* values;  // as the caller numbers the triangles
  double* cells;

  auto of(Triangle t) const {
    return [to = cells, value = values[number(surface.given_number(t))]](
               const CornerWeights&, std::size_t place) { to[place] = value; };
  }
};

struct VectorPaint {
  static constexpr int kNumbers = 3;
  static constexpr bool kPutsVerticesFirst = false;
  const OrderedSurface& surface;
  const double* vectors;  // three numbers each, as the caller numbers the vertices
  double* cells;

  auto of(Triangle t) const {
    const double* row[3];
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Vertex v = surface.given_number(surface.surface().vertex(t, k));
      row[k] = vectors + 3 * static_cast<std::size_t>(number(v));
    }
    return [to = cells, a = row[0], b = row[1], c = row[2]](const CornerWeights& weights,
                                                            std::size_t place) {
      for (int axis = 0; axis < 3; ++axis) {
        to[3 * place + axis] = weights.mean_of({a[axis], b[axis], c[axis]});
      }
    };
  }
};

template <typename Paint>
class CenterScan {
 public:
  // Centres on edges and vertices are appended to `shared`, if there is one: each once, on a vertex
  // if one is there, and of the smallest triangle. Check `team.is_stopped()` afterwards.
  static void run(const OrderedSurface& surface, const CellGrid& grid, const Paint& paint,
                  Team& team, std::vector<SharedCenter>* shared = nullptr) {
    const Tiles tiles(surface.surface(), grid);
    std::vector<std::vector<SharedCenter>> found(shared == nullptr ? 0 : tiles.count());
    tiles.share(team, [&](std::int32_t tile) {
      CenterScan scan(surface, grid, paint, tiles[tile]);
      tiles.for_each_triangle(tile, [&](Triangle t) { scan.draw(t); });
      if (shared != nullptr) found[tile] = scan.list_shared();
    });
    for (const auto& some : found) shared->insert(shared->end(), some.begin(), some.end());
  }

 private:
  CenterScan(const OrderedSurface& ordered, const CellGrid& grid, const Paint& paint,
             const Tile& tile)
      : ordered_(ordered), surface_(ordered.surface()), grid_(grid), paint_(paint), tile_(tile) {
    for (std::int32_t row = tile.rows.begin; row < tile.rows.end; ++row) {
      double* const first = paint.cells + Paint::kNumbers * place_of(row, tile.columns.begin);
      std::fill_n(first, Paint::kNumbers * static_cast<std::size_t>(tile.columns.size()),
                  std::numeric_limits<double>::quiet_NaN());
    }
    const double largest = std::max({std::fabs(grid.x[0]), std::fabs(grid.x[grid.columns - 1]),
                                     std::fabs(grid.y[0]), std::fabs(grid.y[grid.rows - 1])});
    slack_ = 1e-9 + 32.0 * std::numeric_limits<double>::epsilon() * largest /
                        std::min(grid.width, grid.height);
  }

  // A side of a triangle that is not level, from its southern end.
  struct Slanted {
    Point start;
    double north, run;  // easting gained for each unit of northing

    double easting_at(double northing) const { return start.x + (northing - start.y) * run; }
  };

  void draw(Triangle t) {
    const Point corner[3] = {surface_.corner(t, 0), surface_.corner(t, 1), surface_.corner(t, 2)};
    const Box box{std::min({corner[0].x, corner[1].x, corner[2].x}),
                  std::min({corner[0].y, corner[1].y, corner[2].y}),
                  std::max({corner[0].x, corner[1].x, corner[2].x}),
                  std::max({corner[0].y, corner[1].y, corner[2].y})};
    if (may_hold_centers(box)) draw(t, corner, box.south, box.north);
  }

  // Most triangles of a dense surface lie between centres.
  bool may_hold_centers(const Box& box) const {
    return may_hold_whole(grid_.column_at(box.west), grid_.column_at(box.east), grid_.columns) &&
           may_hold_whole(grid_.row_at(box.north), grid_.row_at(box.south), grid_.rows);
  }

  // Whether one of the numbers 0 to `count` - 1 may lie in a range, which rounding put off.
  bool may_hold_whole(double low, double high, double count) const {
    low -= slack_;
    high += slack_;
    if (high < 0.0 || low > count - 1.0) return false;
    return !(static_cast<double>(static_cast<std::int32_t>(std::min(count, high))) < low);
  }

  void draw(Triangle t, const Point (&corner)[3], double south, double north) {
    const std::int32_t first = std::max(tile_.rows.begin, clamped(grid_.row_at(north) - 1.0));
    const std::int32_t last = std::min(tile_.rows.end - 1, clamped(grid_.row_at(south) + 2.0));
    Slanted sides[3];
    const int count = find_sides(corner, sides);
    for (std::int32_t row = first; row <= last; ++row) {
      const double y = grid_.y[row];
      if (y < south || y > north) continue;
      draw_row(t, corner, row, columns_at(sides, count, y));
    }
  }

  static std::int32_t clamped(double row) {
    constexpr double kMost = std::numeric_limits<std::int32_t>::max() / 2;
    return static_cast<std::int32_t>(std::min(std::max(row, 0.0), kMost));
  }

  static int find_sides(const Point (&corner)[3], Slanted (&sides)[3]) {
    int count = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      Point a = corner[k], b = corner[corner_after(k)];
      if (a.y == b.y) continue;
      if (a.y > b.y) std::swap(a, b);
      sides[count++] = {a, b.y, (b.x - a.x) / (b.y - a.y)};
    }
    return count;
  }

  // All columns whose centres the triangle may hold on a row.
  Range columns_at(const Slanted (&sides)[3], int count, double y) const {
    double west = std::numeric_limits<double>::infinity(), east = -west;
    for (int i = 0; i < count; ++i) {
      if (y < sides[i].start.y || y > sides[i].north) continue;
      const double x = sides[i].easting_at(y);
      west = std::min(west, x);
      east = std::max(east, x);
    }
    return {std::max(tile_.columns.begin, clamped(std::ceil(grid_.column_at(west) - slack_))),
            std::min(tile_.columns.end, clamped(std::floor(grid_.column_at(east) + slack_) + 1.0))};
  }

  void draw_row(Triangle t, const Point (&corner)[3], std::int32_t row, Range columns) {
    const auto write = paint_.of(t);
    for (std::int32_t column = columns.begin; column < columns.end; ++column) {
      const Point p{grid_.x[column], grid_.y[row]};
      const auto weights = CornerWeights::at(p, corner[0], corner[1], corner[2]);
      const double least = std::min({weights.of[0], weights.of[1], weights.of[2]});
      if (least > 0.0) {
        write(weights, place_of(row, column));
      } else if (least == 0.0 && takes_edge(t, weights, row, column)) {
        write(weights.settled(p, corner[0], corner[1], corner[2]), place_of(row, column));
      }
    }
  }

  // A centre on an edge or a vertex is the triangle's with the smallest number, if asked for one
  // whose vertex it is. A triangle without area holds nothing.
  bool takes_edge(Triangle t, const CornerWeights& weights, std::int32_t row, std::int32_t column) {
    if (weights.total() == 0.0) return false;
    if (holders_.empty()) {
      holders_.assign(static_cast<std::size_t>(tile_.columns.size()) * tile_.rows.size(), kNobody);
    }
    std::int64_t& holder =
        holders_[static_cast<std::size_t>(row - tile_.rows.begin) * tile_.columns.size() +
                 (column - tile_.columns.begin)];
    const std::int64_t claim = claim_of(t, weights);
    if (claim > holder) return false;
    holder = claim;
    return true;
  }

  // What is smaller has the centre.
  std::int64_t claim_of(Triangle t, const CornerWeights& weights) const {
    const std::int64_t triangle = number(ordered_.given_number(t));
    const bool is_zero[3] = {weights.of[0] == 0.0, weights.of[1] == 0.0, weights.of[2] == 0.0};
    const bool is_vertex = is_zero[0] + is_zero[1] + is_zero[2] == 2;
    const int corner = is_vertex == is_zero[0] ? is_vertex == is_zero[1] ? 2 : 1 : 0;
    const std::int64_t part = triangle << SharedCenter::kPartBits | (is_vertex ? 4 : 0) | corner;
    return Paint::kPutsVerticesFirst && !is_vertex ? part | kOnEdge : part;
  }

  std::vector<SharedCenter> list_shared() const {
    std::vector<SharedCenter> found;
    for (std::size_t i = 0; i < holders_.size(); ++i) {
      if (holders_[i] == kNobody) continue;
      const auto width = static_cast<std::size_t>(tile_.columns.size());
      const auto row = static_cast<std::int32_t>(i / width) + tile_.rows.begin;
      const auto column = static_cast<std::int32_t>(i % width) + tile_.columns.begin;
      found.push_back({static_cast<std::int64_t>(place_of(row, column)), holders_[i] & ~kOnEdge});
    }
    return found;
  }

  std::size_t place_of(std::int32_t row, std::int32_t column) const {
    return static_cast<std::size_t>(row) * grid_.columns + column;
  }

  static constexpr std::int64_t kNobody = std::numeric_limits<std::int64_t>::max();
  static constexpr std::int64_t kOnEdge = std::int64_t{1} << 62;

  const OrderedSurface& ordered_;
  const Surface surface_;
  const CellGrid& grid_;
  const Paint& paint_;
  Tile tile_;
  double slack_;
  std::vector<std::int64_t> holders_;  // of centres on edges and vertices: claims
};

}  // namespace tinsmith
