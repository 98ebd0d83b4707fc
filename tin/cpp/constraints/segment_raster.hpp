// A bit for each cell of a square grid that says whether anything of interest may lie there.
//
// Most vertices of a survey are far from every line: a look at one bit rules them out.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "segments.hpp"

namespace tinsmith {

// Cells that come within `reach` of a segment, and some that do not quite.
class SegmentRaster {
 public:
  SegmentRaster(const Segments& segments, Reach reach, std::int64_t vertex_count) {
    const auto reach_of = [&](Segment s) {
      return Band::kRoom * reach.of(segments.point(s, 0), segments.point(s, 1));
    };
    for (std::int32_t i = 0; i < segments.count; ++i) {
      box_.include(segments.box_of(Segment{i}).grown_by(reach_of(Segment{i})));
    }
    if (segments.count == 0) return;  // the empty box holds nothing
    choose_side(segments, vertex_count);
    columns_per_unit_ = cells_per_unit(box_.width());
    rows_per_unit_ = cells_per_unit(box_.height());
    bits_.resize(static_cast<std::size_t>(side_) * (side_ / kWord));
    for (std::int32_t i = 0; i < segments.count; ++i) {
      const Segment s{i};
      mark(cell_of(segments.point(s, 0)), cell_of(segments.point(s, 1)), reach_of(s));
    }
  }

  bool may_hold(Point p) const {
    if (!box_.holds(p)) return false;
    const Point cell = cell_of(p);
    const auto column = static_cast<std::uint32_t>(cell.x);
    const auto row = static_cast<std::uint32_t>(cell.y);
    return (bits_[(row * side_ + column) / kWord] >> (column % kWord)) & 1;
  }

 private:
  static constexpr std::uint32_t kWord = 64;
  static constexpr std::uint32_t kLeastSide = kWord;
  static constexpr std::uint32_t kMostSide = 4096;      // the bits fit the second-level cache
  static constexpr std::int64_t kCellsPerSegment = 32;  // then few cells are near one
  static constexpr double kRounding = 0x1p-20;  // in cells; far more than the roundings make

  // Fine enough for the segments; not so fine that marking them costs more than it saves.
  void choose_side(const Segments& segments, std::int64_t vertex_count) {
    double rise = 0.0;
    for (std::int32_t i = 0; i < segments.count; ++i) {
      rise += std::fabs(segments.point(Segment{i}, 1).y - segments.point(Segment{i}, 0).y);
    }
    const double height = box_.height();
    const double heights = height > 0.0 ? rise / height : 0.0;
    const double most_rows = 2.0 * static_cast<double>(vertex_count + segments.count);
    while (side_ < kMostSide && std::int64_t{side_} * side_ < kCellsPerSegment * segments.count &&
           2.0 * side_ * heights < most_rows) {
      side_ *= 2;
    }
  }

  double cells_per_unit(double extent) const {
    constexpr double kBelowOne = 1.0 - 0x1p-30;  // the last point is in the last cell
    return extent > 0.0 ? kBelowOne * side_ / extent : 0.0;
  }

  Point cell_of(Point p) const {
    return {(p.x - box_.west) * columns_per_unit_, (p.y - box_.south) * rows_per_unit_};
  }

  std::uint32_t clamped(double cell) const {
    return static_cast<std::uint32_t>(std::min(std::max(cell, 0.0), side_ - 1.0));
  }

  void mark(Point a, Point b, double reach) {
    const double margin_x = reach * columns_per_unit_ + kRounding;
    const double margin_y = reach * rows_per_unit_ + kRounding;
    const double bottom = std::min(a.y, b.y), top = std::max(a.y, b.y);
    const double slope = top - bottom > 1.0 ? (b.x - a.x) / (b.y - a.y) : 0.0;
    const std::uint32_t last = clamped(top + margin_y);
    for (std::uint32_t row = clamped(bottom - margin_y); row <= last; ++row) {
      double west = std::min(a.x, b.x), east = std::max(a.x, b.x);
      if (top - bottom > 1.0) {
        const double from = a.x + (std::max(row - margin_y, bottom) - a.y) * slope;
        const double to = a.x + (std::min(row + 1.0 + margin_y, top) - a.y) * slope;
        west = std::min(from, to);
        east = std::max(from, to);
      }
      mark_run(row, clamped(west - margin_x), clamped(east + margin_x));
    }
  }

  void mark_run(std::uint32_t row, std::uint32_t first, std::uint32_t last) {
    std::uint64_t* words = bits_.data() + static_cast<std::size_t>(row) * (side_ / kWord);
    constexpr std::uint64_t kAll = ~std::uint64_t{0};
    for (std::uint32_t word = first / kWord; word <= last / kWord; ++word) {
      const std::uint64_t from = word == first / kWord ? kAll << (first % kWord) : kAll;
      const std::uint64_t to = word == last / kWord ? kAll >> (kWord - 1 - last % kWord) : kAll;
      words[word] |= from & to;
    }
  }

  Box box_;
  std::uint32_t side_ = kLeastSide;
  double columns_per_unit_ = 0.0, rows_per_unit_ = 0.0;
  std::vector<std::uint64_t> bits_;
};

// Few points, by the bits of their coordinates: a filter of Bloom, "Space/time trade-offs in hash
// coding with allowable errors" (1970), with one hash.
class PointFilter {
 public:
  PointFilter(const Point* points, std::int32_t count) : bits_(std::size_t{1} << (kBits - 6)) {
    for (std::int32_t i = 0; i < count; ++i) {
      const std::uint32_t key = key_of(points[i]);
      bits_[key >> 6] |= std::uint64_t{1} << (key & 63);
    }
  }
  bool may_hold(Point p) const {
    const std::uint32_t key = key_of(p);
    return (bits_[key >> 6] >> (key & 63)) & 1;
  }

 private:
  static constexpr int kBits = 18;

  // Multiplied by 2^64 / golden ratio: the high bits depend on all bits. -0.0 is 0.0.
  static std::uint32_t key_of(Point p) {
    const double x = p.x + 0.0, y = p.y + 0.0;
    std::uint64_t x_bits, y_bits;
    std::memcpy(&x_bits, &x, sizeof x);
    std::memcpy(&y_bits, &y, sizeof y);
    const std::uint64_t mixed = (x_bits ^ (y_bits >> 31)) * 0x9E3779B97F4A7C15u;
    return static_cast<std::uint32_t>(mixed >> (64 - kBits));
  }

  std::vector<std::uint64_t> bits_;
};

}  // namespace tinsmith
