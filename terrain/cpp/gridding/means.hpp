// The mean of a surface over each cell of a grid, as far as the surface covers it: the integral over
// the parts into which its triangles cut the cell, by clipping (I. E. Sutherland and G. W. Hodgman,
// "Reentrant polygon clipping", 1974).
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

class MeanScan {
 public:
  // As CenterScan; `x_edges` and `y_edges` hold the sides of the columns and rows, one more than
  // there are.
  static void run(const OrderedSurface& surface, const CellGrid& grid, const double* x_edges,
                  const double* y_edges, const double* values, double* cells, Team& team) {
    const Tiles tiles(surface.surface(), grid);
    tiles.share(team, [&](std::int32_t tile) {
      MeanScan scan(surface, grid, x_edges, y_edges, values, tiles[tile]);
      tiles.for_each_triangle(tile, [&](Triangle t) { scan.list(t); });
      scan.draw_listed();
      scan.write(cells);
    });
  }

 private:
  // Where a polygon turns: relative to the tile's first cell, and its value.
  struct Turn {
    double x, y, value;
  };

  // Of a triangle after up to four cuts.
  struct Polygon {
    Turn turns[8];
    int size = 0;

    void add(const Turn& turn) { turns[size++] = turn; }
  };

  // Of the parts of a cell; the value's is relative to that of the first one.
  struct Sum {
    double area = 0.0;
    double integral = 0.0;
    double datum = 0.0;
  };

  // A triangle, and its first corner by easting, then northing.
  struct Listed {
    Point first;
    Triangle triangle;
    std::uint32_t corner;
  };

  MeanScan(const OrderedSurface& ordered, const CellGrid& grid, const double* x_edges,
           const double* y_edges, const double* values, const Tile& tile)
      : ordered_(ordered),
        surface_(ordered.surface()),
        grid_(grid),
        x_edges_(x_edges),
        y_edges_(y_edges),
        values_(values),
        tile_(tile),
        origin_{x_edges[tile.columns.begin], y_edges[tile.rows.begin]},
        sums_(static_cast<std::size_t>(tile.columns.size()) * tile.rows.size()) {}

  void list(Triangle t) {
    std::uint32_t first = 0;
    for (std::uint32_t k = 1; k < 3; ++k) {
      if (lexicographically_before(surface_.corner(t, k), surface_.corner(t, first))) first = k;
    }
    listed_.push_back({surface_.corner(t, first), t, first});
  }

  // In the order of their corners, so that sums are the same whatever other triangles the surface
  // has, and however they are numbered.
  void draw_listed() {
    std::sort(listed_.begin(), listed_.end(), [&](const Listed& a, const Listed& b) {
      if (!(a.first == b.first)) return lexicographically_before(a.first, b.first);
      for (std::uint32_t k = 1; k < 3; ++k) {
        const Point p = surface_.corner(a.triangle, (a.corner + k) % 3);
        const Point q = surface_.corner(b.triangle, (b.corner + k) % 3);
        if (!(p == q)) return lexicographically_before(p, q);
      }
      return false;
    });
    for (const Listed& one : listed_) draw(one.triangle, one.corner);
  }

  double value_at(Triangle t, std::uint32_t corner) const {
    return values_ == nullptr ? surface_.elevation(t, corner)
                              : values_[number(ordered_.given_number(t))];
  }

  void draw(Triangle t, std::uint32_t first) {
    Polygon whole;
    double reach_x = 0.0, reach_y = 0.0;
    datum_ = value_at(t, first);
    for (std::uint32_t k = 0, corner = first; k < 3; ++k, corner = corner_after(corner)) {
      const Point p = surface_.corner(t, corner);
      whole.add({p.x - origin_.x, p.y - origin_.y, value_at(t, corner) - datum_});
      reach_x = std::max(reach_x, std::fabs(p.x - origin_.x));
      reach_y = std::max(reach_y, std::fabs(p.y - origin_.y));
    }
    doubtful_ = kRounding * std::max((reach_x + grid_.width * Tiles::kSide) * grid_.height,
                                     (reach_y + grid_.height * Tiles::kSide) * grid_.width);
    const Box box = surface_.box_of(t);
    const Range rows = cells_between(grid_.row_at(box.north), grid_.row_at(box.south), tile_.rows);
    for (std::int32_t row = rows.begin; row < rows.end; ++row) {
      const double top = y_edges_[row] - origin_.y, bottom = y_edges_[row + 1] - origin_.y;
      const Polygon strip = cut(cut(whole, [top](const Turn& p) { return top - p.y; }),
                                [bottom](const Turn& p) { return p.y - bottom; });
      if (strip.size >= 3) draw_strip(t, strip, row);
    }
  }

  void draw_strip(Triangle t, const Polygon& strip, std::int32_t row) {
    double west = strip.turns[0].x, east = west;
    for (int i = 1; i < strip.size; ++i) {
      west = std::min(west, strip.turns[i].x);
      east = std::max(east, strip.turns[i].x);
    }
    const Range columns = cells_between(grid_.column_at(west + origin_.x),
                                        grid_.column_at(east + origin_.x), tile_.columns);
    for (std::int32_t column = columns.begin; column < columns.end; ++column) {
      const double left = x_edges_[column] - origin_.x, right = x_edges_[column + 1] - origin_.x;
      add(t,
          cut(cut(strip, [left](const Turn& p) { return p.x - left; }),
              [right](const Turn& p) { return right - p.x; }),
          row, column);
    }
  }

  // Cells that reach from one place between centres to another, and one more on both sides.
  static Range cells_between(double first, double last, Range within) {
    const double begin = std::max<double>(within.begin, std::floor(first) - 1.0);
    const double end = std::min<double>(within.end, std::ceil(last) + 2.0);
    if (!(begin < end)) return {0, 0};
    return {static_cast<std::int32_t>(begin), static_cast<std::int32_t>(end)};
  }

  // The part of a convex polygon where `inside` is not negative. A crossing is computed from the
  // inner end of the side: it is the same for the cell on the other side but for rounding.
  template <typename Inside>
  static Polygon cut(const Polygon& polygon, Inside&& inside) {
    Polygon kept;
    for (int i = 0; i < polygon.size; ++i) {
      const Turn& a = polygon.turns[i];
      const Turn& b = polygon.turns[i + 1 < polygon.size ? i + 1 : 0];
      const double here = inside(a), there = inside(b);
      if (here >= 0.0) kept.add(a);
      if ((here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0)) {
        const double share = here / (here - there);
        kept.add({a.x + share * (b.x - a.x), a.y + share * (b.y - a.y),
                  a.value + share * (b.value - a.value)});
      }
    }
    return kept;
  }

  // Rounding may leave a little of a triangle that only touches the cell: where there is no more,
  // it is decided exactly whether they overlap, and the mean of the corners stands for the value.
  void add(Triangle t, const Polygon& part, std::int32_t row, std::int32_t column) {
    double whole = 0.0, integral = 0.0;
    for (int i = 2; i < part.size; ++i) {
      const Turn &a = part.turns[0], &b = part.turns[i - 1], &c = part.turns[i];
      const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      whole += area;
      integral += area * ((a.value + b.value + c.value) / 3.0);
    }
    if (!(whole > 0.0)) return;
    if (whole <= doubtful_) {
      if (!overlap(t, row, column)) return;
      integral = whole * mean_of_turns(part);
    }
    Sum& sum = sums_[place(row, column)];
    if (sum.area == 0.0) sum.datum = datum_;
    sum.area += whole;
    sum.integral += integral + whole * (datum_ - sum.datum);
  }

  static double mean_of_turns(const Polygon& part) {
    double sum = 0.0;
    for (int i = 0; i < part.size; ++i) sum += part.turns[i].value;
    return sum / part.size;
  }

  // Whether a triangle and a cell have more in common than points or lines: neither a side of the
  // cell nor one of the triangle parts them.
  bool overlap(Triangle t, std::int32_t row, std::int32_t column) const {
    const double west = x_edges_[column], east = x_edges_[column + 1];
    const double north = y_edges_[row], south = y_edges_[row + 1];
    const Box box = surface_.box_of(t);
    if (!(box.west < east && west < box.east && box.south < north && south < box.north)) {
      return false;
    }
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Point a = surface_.corner(t, k), b = surface_.corner(t, corner_after(k));
      // The corner of the cell that lies furthest to the left of the side.
      const Point inmost{b.y > a.y ? west : east, b.x > a.x ? north : south};
      if (orientation(a, b, inmost) <= 0) return false;
    }
    return true;
  }

  std::size_t place(std::int32_t row, std::int32_t column) const {
    return static_cast<std::size_t>(row - tile_.rows.begin) * tile_.columns.size() +
           (column - tile_.columns.begin);
  }

  void write(double* cells) const {
    for (std::int32_t row = tile_.rows.begin; row < tile_.rows.end; ++row) {
      double* const first = grid_.row_of(cells, row);
      for (std::int32_t column = tile_.columns.begin; column < tile_.columns.end; ++column) {
        const Sum& sum = sums_[place(row, column)];
        first[column] = sum.area > 0.0 ? sum.datum + sum.integral / sum.area
                                       : std::numeric_limits<double>::quiet_NaN();
      }
    }
  }

  const OrderedSurface& ordered_;
  const Surface surface_;
  const CellGrid& grid_;
  const double* x_edges_;
  const double* y_edges_;
  const double* values_;
  Tile tile_;
  Point origin_;
  static constexpr double kRounding = 0x1p-44;  // of coordinates in the tile, and of cuts

  double doubtful_ = 0.0;  // twice the area that rounding may make of a touch of the triangle
  double datum_ = 0.0;     // of the triangle
  std::vector<Listed> listed_;
  std::vector<Sum> sums_;
};

}  // namespace tinsmith
