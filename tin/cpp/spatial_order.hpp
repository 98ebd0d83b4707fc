// Order places so that neighbours in the order are neighbours in the plane.
//
// Places are sorted by square cells along Hilbert's curve. A cell that stays crowded is sorted the
// same way within its own bounds, so clusters within clusters are ordered as well as even data.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "predicates.hpp"

namespace tinsmith {

// Position along Hilbert's curve of cell (column, row) in a grid of 2^bits by 2^bits.
inline std::uint32_t hilbert_position(std::uint32_t column, std::uint32_t row, int bits) {
  struct Move {
    std::uint8_t digit;
    std::uint8_t turn;
  };
  // The curve in a square is one of four, by where it starts and ends; each visits the four
  // quadrants (2 * right half + upper half) in its own order, with one of the four in each.
  static constexpr Move kMoves[4][4] = {{{0, 1}, {1, 0}, {3, 3}, {2, 0}},
                                        {{0, 0}, {3, 2}, {1, 1}, {2, 1}},
                                        {{2, 2}, {3, 1}, {1, 2}, {0, 3}},
                                        {{2, 3}, {1, 3}, {3, 0}, {0, 2}}};
  std::uint32_t position = 0;
  std::uint32_t turn = 0;
  for (int bit = bits - 1; bit >= 0; --bit) {
    const std::uint32_t quadrant = 2 * ((column >> bit) & 1) + ((row >> bit) & 1);
    const Move move = kMoves[turn][quadrant];
    position = 4 * position + move.digit;
    turn = move.turn;
  }
  return position;
}

class SpatialOrder {
 public:
  // Places that are not finite are allowed: they come somewhere.
  SpatialOrder(const Point* places, std::int32_t count) : places_(places) {
    order_.resize(count);
    std::iota(order_.begin(), order_.end(), 0);
    cell_of_.resize(count);
    spare_.resize(count);
    crowded_.push_back({0, count});
    while (!crowded_.empty()) {
      const Range range = crowded_.back();
      crowded_.pop_back();
      sort(range);
    }
  }

  std::vector<std::int32_t> take() { return std::move(order_); }

 private:
  struct Range {
    std::int32_t begin;
    std::int32_t end;
    std::int32_t size() const { return end - begin; }
  };

  static constexpr std::int32_t kPlacesPerCell = 2;
  static constexpr std::int32_t kCrowd = 8 * kPlacesPerCell;
  static constexpr int kMostBits = 15;  // positions must fit in 31 bits

  void sort(Range range) {
    int bits = 1;
    while (bits < kMostBits && kPlacesPerCell * (std::int64_t{4} << (2 * bits)) <= range.size()) {
      ++bits;
    }
    if (!assign_cells(range, bits)) return;
    sort_by_cell(range, bits);
    for (std::size_t cell = 0; cell + 1 < start_.size(); ++cell) {
      const Range inside{start_[cell], start_[cell + 1]};
      // A cell that holds all cannot be split further.
      if (inside.size() > kCrowd && inside.size() < range.size()) crowded_.push_back(inside);
    }
  }

  // False if all places are at one place.
  bool assign_cells(Range range, int bits) {
    double west = std::numeric_limits<double>::infinity(), south = west;
    double east = -west, north = -west;
    for (std::int32_t i = range.begin; i < range.end; ++i) {
      const Point p = places_[order_[i]];
      west = p.x < west ? p.x : west;
      east = p.x > east ? p.x : east;
      south = p.y < south ? p.y : south;
      north = p.y > north ? p.y : north;
    }
    const double side = std::max(east - west, north - south);
    if (!(side > 0.0)) return false;
    const std::uint32_t across = 1u << bits;
    const double per_cell = across / side;
    for (std::int32_t i = range.begin; i < range.end; ++i) {
      const Point p = places_[order_[i]];
      cell_of_[i] = hilbert_position(clamped((p.x - west) * per_cell, across),
                                     clamped((p.y - south) * per_cell, across), bits);
    }
    return true;
  }

  static std::uint32_t clamped(double cell, std::uint32_t count) {
    if (!(cell > 0.0)) return 0;
    return cell < count ? static_cast<std::uint32_t>(cell) : count - 1;
  }

  void sort_by_cell(Range range, int bits) {
    start_.assign((std::size_t{1} << (2 * bits)) + 1, 0);
    for (std::int32_t i = range.begin; i < range.end; ++i) ++start_[cell_of_[i]];
    std::int32_t total = range.begin;
    for (auto& start : start_) {
      total += start;
      start = total;  // the end of the cell; filling backwards turns it into the begin
    }
    for (std::int32_t i = range.end; i-- > range.begin;) {
      spare_[--start_[cell_of_[i]]] = order_[i];
    }
    std::copy(spare_.begin() + range.begin, spare_.begin() + range.end,
              order_.begin() + range.begin);
  }

  const Point* places_;
  std::vector<std::int32_t> order_, spare_, start_;
  std::vector<std::uint32_t> cell_of_;
  std::vector<Range> crowded_;
};

}  // namespace tinsmith
