// Which triangles of a lattice's cells belong to a vertex, and in which order: by the eight places
// around it, where no hole gives it any.
//
//      NW   N   NE      Earlier and later in the sweep are known of each: N is later, S earlier.
//      W    v   E       SE is later if its row lies in the same stripe, and NW if its row does not.
//      SW   S   SE      So a table of all cases takes the place of sorting.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "../base/ids.hpp"
#include "../insertion/star_order.hpp"
#include "lattice_cells.hpp"

namespace tinsmith {

class StarTable {
 public:
  struct Own {
    std::int8_t cell;      // 0 to 3: north-east, north-west, south-east, south-west of the vertex
    std::int8_t triangle;  // of that cell
  };
  struct Star {
    std::int8_t count = 0;
    std::array<Own, 6> own;
  };

  StarTable() {
    for (int around = 0; around < kAround; ++around) {
      for (int stripe = 0; stripe < kStripes; ++stripe) {
        stars_[kStripes * around + stripe] = made(around, stripe);
      }
    }
  }

  const Star& star(const LatticeCells& cells, std::int32_t vertex, bool has_row_below,
                   bool has_row_above) const {
    const std::int32_t columns = cells.lattice().columns();
    const int around = (cells.corners(vertex - columns - 1) & 7) |
                       (cells.corners(vertex) >> 1) << 3 |
                       ((cells.corners(vertex - columns) & corner::kSE) != 0) << 6 |
                       ((cells.corners(vertex - 1) & corner::kNW) != 0) << 7;
    return stars_[kStripes * around + 2 * has_row_above + has_row_below];
  }

 private:
  static constexpr int kAround = 256, kStripes = 4;
  static constexpr int kAcross = 3, kCentre = 4;
  // Which of the nine places is the south-west corner of each cell; places are counted row by row.
  static constexpr int kFirst[4] = {4, 3, 1, 0};

  Star made(int around, int stripe) {
    const auto is_taken = [around](int place) {
      constexpr int kBit[9] = {0, 1, 6, 2, -1, 3, 7, 4, 5};
      return place == kCentre || (around >> kBit[place] & 1) != 0;
    };
    const auto order = [stripe](int place) {
      const int row = place / kAcross, column = place % kAcross;
      const bool is_below = row == 0 && (stripe & 1) == 0, is_above = row == 2 && (stripe & 2) == 0;
      return Vertex{100 * (1 + is_above - is_below) + 10 * column + row};
    };
    star_.clear();
    for (int cell = 0; cell < 4; ++cell) {
      const int place[4] = {kFirst[cell], kFirst[cell] + 1, kFirst[cell] + kAcross,
                            kFirst[cell] + kAcross + 1};
      int corners = 0;
      for (int k = 0; k < 4; ++k) corners |= is_taken(place[k]) << k;
      for (int which = 0; which < LatticeCells::triangles_of(corners); ++which) {
        const auto& ends = LatticeCells::corners_of(corners, which);
        for (std::uint32_t k = 0; k < 3; ++k) {
          const Vertex from = order(place[ends[corner_after(k)]]);
          const Vertex to = order(place[ends[corner_before(k)]]);
          const bool is_own = from > order(kCentre) && to > order(kCentre);
          if (place[ends[k]] == kCentre && is_own) star_.add({from, to, 2 * cell + which});
        }
      }
    }
    star_.put_in_order([](Vertex, Vertex) { return 0; });  // none has all around it
    Star made;
    for (const StarOrder::Ray& ray : star_) {
      made.own[made.count++] = {static_cast<std::int8_t>(ray.triangle / 2),
                                static_cast<std::int8_t>(ray.triangle % 2)};
    }
    return made;
  }

  StarOrder star_;
  std::array<Star, std::size_t{kAround} * kStripes> stars_;
};

}  // namespace tinsmith
