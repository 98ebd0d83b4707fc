// A grid of cells in square tiles, and the triangles that may meet each tile.
//
// A tile's cells stay in the cache while its triangles are drawn; tiles are shared among threads.
// Within a tile triangles come in the order of the surface, whatever the tiles, so that results are
// the same for any number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../../../tin/cpp/base/arrays.hpp"
#include "../../../tin/cpp/base/ids.hpp"
#include "../../../tin/cpp/base/parallel.hpp"
#include "../../../tin/cpp/base/range.hpp"
#include "../../../tin/cpp/location/ordered_surface.hpp"

namespace tinsmith {

// Cells by the coordinates of their centres, columns from west to east, rows from north to south.
struct CellGrid {
  const double* x;
  const double* y;
  std::int32_t columns;
  std::int32_t rows;
  double width, height;  // of a cell

  // Places between centres, as real numbers; they are off by rounding.
  double column_at(double easting) const { return (easting - x[0]) / width; }
  double row_at(double northing) const { return (y[0] - northing) / height; }
  double* row_of(double* cells, std::int32_t row) const {
    return cells + static_cast<std::size_t>(row) * columns;
  }
};

struct Tile {
  Range columns;
  Range rows;
};

class Tiles {
 public:
  static constexpr std::int32_t kSide = 256;  // cells; a tile's values fill half a megabyte

  Tiles(const Surface& surface, const CellGrid& grid) : grid_(grid) {
    across_ = (grid.columns + kSide - 1) / kSide;
    down_ = (grid.rows + kSide - 1) / kSide;
    begin_.assign(static_cast<std::size_t>(count()) + 1, 0);
    auto spans = scratch_array<Span>(surface.triangle_count);
    for (const Triangle t : Ids<Triangle>(surface.triangle_count)) {
      spans[number(t)] = span_of(surface.box_of(t));
      for_each_tile(spans[number(t)], [&](std::int32_t tile) { ++begin_[tile + 1]; });
    }
    for (std::int32_t tile = 0; tile < count(); ++tile) begin_[tile + 1] += begin_[tile];
    triangles_ = scratch_array<Triangle>(begin_.back());
    std::vector<std::int64_t> end(begin_.begin(), begin_.end() - 1);
    for (const Triangle t : Ids<Triangle>(surface.triangle_count)) {
      for_each_tile(spans[number(t)], [&](std::int32_t tile) { triangles_[end[tile]++] = t; });
    }
  }

  std::int32_t count() const { return across_ * down_; }

  Tile operator[](std::int32_t tile) const {
    return {side(tile % across_, grid_.columns), side(tile / across_, grid_.rows)};
  }

  // visit(triangle) in ascending order.
  template <typename Visit>
  void for_each_triangle(std::int32_t tile, Visit&& visit) const {
    for (std::int64_t i = begin_[tile]; i < begin_[tile + 1]; ++i) visit(triangles_[i]);
  }

  // draw(tile number) for every tile, by the threads of a team.
  template <typename Draw>
  void share(Team& team, Draw&& draw) const {
    std::atomic<std::int32_t> next{0};
    team.expect(count());
    team.run([&](int part) {
      while (team.keeps_going(part)) {
        const std::int32_t tile = next++;
        if (tile >= count()) return;
        draw(tile);
        team.advance(1);
      }
    });
  }

 private:
  struct Span {
    std::int32_t west, east, north, south;  // of tiles, empty if west > east
  };

  static Range side(std::int32_t place, std::int32_t cells) {
    return {place * kSide, std::min((place + 1) * kSide, cells)};
  }

  Span span_of(const Box& box) const {
    const double west = grid_.column_at(box.west) - 2.0;
    const double east = grid_.column_at(box.east) + 2.0;
    const double north = grid_.row_at(box.north) - 2.0;
    const double south = grid_.row_at(box.south) + 2.0;
    if (!(east >= 0.0 && west < grid_.columns && south >= 0.0 && north < grid_.rows)) {
      return {1, 0, 1, 0};
    }
    return {tile_of(west, grid_.columns), tile_of(east, grid_.columns), tile_of(north, grid_.rows),
            tile_of(south, grid_.rows)};
  }
  static std::int32_t tile_of(double cell, std::int32_t cells) {
    return static_cast<std::int32_t>(std::min(std::max(cell, 0.0), cells - 1.0)) / kSide;
  }

  template <typename Visit>
  void for_each_tile(const Span& span, Visit&& visit) const {
    for (std::int32_t row = span.north; row <= span.south; ++row) {
      for (std::int32_t column = span.west; column <= span.east; ++column) {
        visit(row * across_ + column);
      }
    }
  }

  CellGrid grid_;
  std::int32_t across_ = 0, down_ = 0;
  std::vector<std::int64_t> begin_;
  ScratchArray<Triangle> triangles_;
};

}  // namespace tinsmith
