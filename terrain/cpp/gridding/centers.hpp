// The values of a surface at the centres of a grid's cells, triangle by triangle.
//
// Scan conversion: on each row the cells between the crossings of a triangle's sides, one more
// where rounding leaves it open. Whether a triangle holds a centre is decided exactly, and a centre
// on an edge or a vertex belongs to the smallest triangle: as point location has it, so that the
// values are those of interpolation to the last bit.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "../../../tin/cpp/location/ordered_surface.hpp"
#include "tiles.hpp"

namespace tinsmith {

class CenterScan {
 public:
  // `values` holds one value a triangle, as the caller numbers them; nullptr for elevations. Cells
  // outside become NaN. Check `team.is_stopped()` afterwards.
  static void run(const OrderedSurface& surface, const CellGrid& grid, const double* values,
                  double* cells, Team& team) {
    const Tiles tiles(surface.surface(), grid);
    tiles.share(team, [&](std::int32_t tile) {
      CenterScan scan(surface, grid, values, cells, tiles[tile]);
      tiles.for_each_triangle(tile, [&](Triangle t) { scan.draw(t); });
    });
  }

 private:
  CenterScan(const OrderedSurface& ordered, const CellGrid& grid, const double* values,
             double* cells, const Tile& tile)
      : ordered_(ordered),
        surface_(ordered.surface()),
        grid_(grid),
        values_(values),
        cells_(cells),
        tile_(tile) {
    for (std::int32_t row = tile.rows.begin; row < tile.rows.end; ++row) {
      double* const first = grid.row_of(cells, row);
      std::fill(first + tile.columns.begin, first + tile.columns.end,
                std::numeric_limits<double>::quiet_NaN());
    }
    const double largest = std::max(std::fabs(grid.x[0]), std::fabs(grid.x[grid.columns - 1]));
    slack_ = 1e-9 + 32.0 * std::numeric_limits<double>::epsilon() * largest / grid.spacing;
  }

  // A side of a triangle that is not level, from its southern end.
  struct Slanted {
    Point start;
    double north, run;  // easting gained for each unit of northing

    double easting_at(double northing) const { return start.x + (northing - start.y) * run; }
  };

  void draw(Triangle t) {
    const Point corner[3] = {surface_.corner(t, 0), surface_.corner(t, 1), surface_.corner(t, 2)};
    const double elevation[3] = {surface_.elevation(t, 0), surface_.elevation(t, 1),
                                 surface_.elevation(t, 2)};
    const double north = std::max({corner[0].y, corner[1].y, corner[2].y});
    const double south = std::min({corner[0].y, corner[1].y, corner[2].y});
    const std::int32_t first = std::max(tile_.rows.begin, clamped(grid_.row_at(north) - 1.0));
    const std::int32_t last = std::min(tile_.rows.end - 1, clamped(grid_.row_at(south) + 2.0));
    Slanted sides[3];
    const int count = find_sides(corner, sides);
    for (std::int32_t row = first; row <= last; ++row) {
      const double y = grid_.y[row];
      if (y < south || y > north) continue;
      draw_row(t, corner, elevation, row, columns_at(sides, count, y));
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

  void draw_row(Triangle t, const Point (&corner)[3], const double (&elevation)[3],
                std::int32_t row, Range columns) {
    double* const cells = grid_.row_of(cells_, row);
    for (std::int32_t column = columns.begin; column < columns.end; ++column) {
      const Point p{grid_.x[column], grid_.y[row]};
      const auto weights = CornerWeights::at(p, corner[0], corner[1], corner[2]);
      const double least = std::min({weights.of[0], weights.of[1], weights.of[2]});
      if (least < 0.0 || (least == 0.0 && !takes_edge(t, weights, row, column))) continue;
      cells[column] = values_ == nullptr ? weights.mean_of(elevation)
                                         : values_[number(ordered_.given_number(t))];
    }
  }

  // A centre on an edge or a vertex is the triangle's with the smallest number. One without area
  // holds nothing.
  bool takes_edge(Triangle t, const CornerWeights& weights, std::int32_t row, std::int32_t column) {
    if (weights.total() == 0.0) return false;
    if (holders_.empty()) {
      holders_.assign(static_cast<std::size_t>(tile_.columns.size()) * tile_.rows.size(),
                      kNoTriangle);
    }
    const std::size_t place =
        static_cast<std::size_t>(row - tile_.rows.begin) * tile_.columns.size() +
        (column - tile_.columns.begin);
    const Triangle known_as = ordered_.given_number(t);
    if (number(holders_[place]) < number(known_as)) return false;
    holders_[place] = known_as;
    return true;
  }

  const OrderedSurface& ordered_;
  const Surface surface_;
  const CellGrid& grid_;
  const double* values_;
  double* cells_;
  Tile tile_;
  double slack_;
  std::vector<Triangle> holders_;  // of centres on edges
};

}  // namespace tinsmith
