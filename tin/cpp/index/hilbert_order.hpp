// Order points so that neighbours in the order are neighbours in the plane.
//
// Points are sorted by square cells along the curve of Hilbert, "Ueber die stetige Abbildung einer
// Linie auf ein Flaechenstueck" (1891), digit by digit (radix sort). A cell that stays crowded is
// sorted the same way within its own bounds, so clusters within clusters are ordered as well as
// even data.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "../base/arrays.hpp"
#include "../base/box.hpp"
#include "../base/point.hpp"
#include "../base/range.hpp"

namespace tinsmith {

// Position along Hilbert's curve of a cell in a grid of 2^16 by 2^16 cells.
class HilbertCurve {
 public:
  static constexpr int kBits = 16;  // of a column or row; a position has twice as many

  std::uint32_t position(std::uint32_t column, std::uint32_t row) const {
    std::uint32_t position = 0;
    std::uint32_t turn = 0;
    for (int bit = kBits - kStride; bit >= 0; bit -= kStride) {
      const std::uint32_t block = ((column >> bit) & kMask) << kStride | ((row >> bit) & kMask);
      const Move move = moves_[turn][block];
      position = position << (2 * kStride) | move.digits;
      turn = move.turn;
    }
    return position;
  }

  // The curve in a square is one of four, by where it starts and ends; each visits the four
  // quadrants (2 * right half + upper half) in its own order, with one of the four in each.
  constexpr HilbertCurve() : moves_{} {
    constexpr std::uint8_t kDigit[4][4] = {{0, 1, 3, 2}, {0, 3, 1, 2}, {2, 3, 1, 0}, {2, 1, 3, 0}};
    constexpr std::uint8_t kTurn[4][4] = {{1, 0, 3, 0}, {0, 2, 1, 1}, {2, 1, 2, 3}, {3, 3, 0, 2}};
    for (std::uint32_t start = 0; start < 4; ++start) {
      for (std::uint32_t block = 0; block < (1u << (2 * kStride)); ++block) {
        std::uint32_t digits = 0, turn = start;
        for (int bit = kStride - 1; bit >= 0; --bit) {
          const std::uint32_t right = (block >> (kStride + bit)) & 1, upper = (block >> bit) & 1;
          digits = 4 * digits + kDigit[turn][2 * right + upper];
          turn = kTurn[turn][2 * right + upper];
        }
        moves_[start][block].digits = static_cast<std::uint8_t>(digits);
        moves_[start][block].turn = static_cast<std::uint8_t>(turn);
      }
    }
  }

 private:
  static constexpr int kStride = 4;  // levels of the curve taken at once
  static constexpr std::uint32_t kMask = (1u << kStride) - 1;
  struct Move {
    std::uint8_t digits = 0;
    std::uint8_t turn = 0;
  };

  Move moves_[4][1 << (2 * kStride)];
};

inline constexpr HilbertCurve kHilbertCurve;

class HilbertOrder {
 public:
  // Points that are not finite are allowed: they come somewhere.
  HilbertOrder(const Point* points, std::int32_t count, int cells_per_point = kCellsPerPoint)
      : HilbertOrder(count, [points](std::int32_t i) { return points[i]; }, cells_per_point) {}

  template <typename PointOf>
  HilbertOrder(std::int32_t count, PointOf&& point_of, int cells_per_point = kCellsPerPoint)
      : count_(count),
        cells_per_point_(cells_per_point),
        entries_(scratch_array<Entry>(count)),
        spare_(scratch_array<Entry>(count)) {
    for (std::int32_t i = 0; i < count; ++i) entries_[i].item = i;
    crowded_.push_back({0, count});
    while (!crowded_.empty()) {
      const Range range = crowded_.back();
      crowded_.pop_back();
      if (!assign_positions(range, point_of)) continue;
      sort(range);
      list_crowded(range);
    }
    spare_.reset();
  }

  std::int32_t operator[](std::int32_t i) const { return entries_[i].item; }

 private:
  struct Entry {
    std::uint32_t position;  // along the curve
    std::int32_t item;
  };

  static constexpr std::int32_t kCrowd = 16;
  static constexpr std::int32_t kShort = 256;  // ranges that are sorted by comparing
  static constexpr int kDigitBits = 11;        // so many counters fit the first-level cache
  static constexpr int kCellsPerPoint = 16;    // crowds along lines need many cells

  // False if all points are at one point.
  template <typename PointOf>
  bool assign_positions(Range range, PointOf&& point_of) {
    Box box;
    for (std::int32_t i = range.begin; i < range.end; ++i) box.include(point_of(entries_[i].item));
    const double side = std::max(box.width(), box.height());
    if (!(side > 0.0)) return false;
    constexpr double kAcross = 1u << HilbertCurve::kBits;
    const double per_cell = kAcross / side;
    const int dropped = 2 * HilbertCurve::kBits - position_bits(range.size());
    for (std::int32_t i = range.begin; i < range.end; ++i) {
      const Point p = point_of(entries_[i].item);
      const std::uint32_t column = cell((p.x - box.west) * per_cell);
      const std::uint32_t row = cell((p.y - box.south) * per_cell);
      entries_[i].position = kHilbertCurve.position(column, row) >> dropped;
    }
    return true;
  }

  static std::uint32_t cell(double value) {
    constexpr std::uint32_t kLast = (1u << HilbertCurve::kBits) - 1;
    if (!(value > 0.0)) return 0;
    return value < kLast ? static_cast<std::uint32_t>(value) : kLast;
  }

  // At least so many cells a point, and as many as fill the digits.
  int position_bits(std::int32_t count) const {
    if (count <= kShort) return 2 * HilbertCurve::kBits;
    int bits = kDigitBits;
    while (bits < 2 * HilbertCurve::kBits &&
           (std::int64_t{1} << bits) < std::int64_t{cells_per_point_} * count) {
      bits += kDigitBits;
    }
    return std::min(bits, 2 * HilbertCurve::kBits);
  }

  void sort(Range range) {
    if (range.size() <= kShort) {
      std::sort(entries_.get() + range.begin, entries_.get() + range.end,
                [](const Entry& a, const Entry& b) { return a.position < b.position; });
      return;
    }
    const int bits = position_bits(range.size());
    for (int shift = 0; shift < bits; shift += kDigitBits) sort_by_digit(range, shift);
  }

  void sort_by_digit(Range range, int shift) {
    std::array<std::int32_t, 1 << kDigitBits> start{};
    const auto digit = [shift](const Entry& entry) {
      return (entry.position >> shift) & ((1u << kDigitBits) - 1);
    };
    for (std::int32_t i = range.begin; i < range.end; ++i) ++start[digit(entries_[i])];
    std::int32_t total = range.begin;
    for (auto& s : start) total += std::exchange(s, total);
    for (std::int32_t i = range.begin; i < range.end; ++i) {
      spare_[start[digit(entries_[i])]++] = entries_[i];
    }
    if (range.size() == count_) {
      entries_.swap(spare_);
    } else {
      std::copy(spare_.get() + range.begin, spare_.get() + range.end, entries_.get() + range.begin);
    }
  }

  void list_crowded(Range range) {
    for (std::int32_t begin = range.begin, end; begin < range.end; begin = end) {
      end = begin + 1;
      while (end < range.end && entries_[end].position == entries_[begin].position) ++end;
      // A cell that holds all cannot be split further.
      if (end - begin > kCrowd && end - begin < range.size()) crowded_.push_back({begin, end});
    }
  }

  std::int32_t count_;
  int cells_per_point_;
  ScratchArray<Entry> entries_, spare_;
  std::vector<Range> crowded_;
};

}  // namespace tinsmith
