// Which triangles meet a box, and which of them are near nothing that was not looked at?
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "../base/arrays.hpp"
#include "../base/box.hpp"
#include "../base/ids.hpp"
#include "../base/point.hpp"
#include "../base/rare.hpp"
#include "../predicates/predicates.hpp"
#include "plane_triangles.hpp"

namespace tinsmith {

// The triangles of a triangulation that meet a closed box, exactly, and of each its
// lexicographically first corner and whether the box owns it: without its eastern and northern
// side it holds this corner.
//
// Besides, those whose closed circumscribed disc is not shown by a quick test to lie within a
// second box. The disc of a triangle with the corner a lies in the square about a with the side
// 4 r. By r = |ab| |bc| |ca| / (2 cross), where cross is twice the area, 2 r is no more than the
// distance d of a from the sides of the second box if
//
//     |ab|^2 |bc|^2 |ca|^2  <=  d^2 cross^2,
//
// without a root or a quotient. The roundings of both sides, some 2^-48, are far below the room
// that is left for them.
class BoxTriangles {
 public:
  BoxTriangles(const PlaneTriangles& triangles, const Box& box, const Box& around)
      : triangles_(triangles),
        box_(box),
        around_(around),
        chosen_(streamed_array<std::int32_t>(triangles.count)),
        firsts_(streamed_array<std::uint8_t>(triangles.count)),
        is_owned_(streamed_array<bool>(triangles.count)),
        open_(streamed_array<std::int32_t>(triangles.count)) {
    const double east = std::min(box.east, kLargestCoordinate);
    const double west = std::max(box.west, -kLargestCoordinate);
    const double north = std::min(box.north, kLargestCoordinate);
    const double south = std::max(box.south, -kLargestCoordinate);
    const Point corners[4] = {{west, south}, {east, south}, {east, north}, {west, north}};
    std::copy(corners, corners + 4, corners_);
  }

  void find() {
    for (const Triangle t : Ids<Triangle>(triangles_.count)) {
      const Point a = triangles_.corner(t, 0), b = triangles_.corner(t, 1),
                  c = triangles_.corner(t, 2);
      if (!meets_box(a, b, c)) continue;
      const bool is_b = lexicographically_before(b, a);
      const bool is_c = lexicographically_before(c, is_b ? b : a);
      const Point first = is_c ? c : is_b ? b : a;
      chosen_[count_] = index_of(t);
      firsts_[count_] = static_cast<std::uint8_t>(is_c ? 2 : is_b);
      is_owned_[count_] = (first.x >= box_.west) & (first.x < box_.east) & (first.y >= box_.south) &
                          (first.y < box_.north);
      open_[open_count_] = static_cast<std::int32_t>(count_);
      open_count_ += is_disc_within(a, b, c) ? 0 : 1;
      ++count_;
    }
  }

  // So many are chosen, ascending; `open` tells their places among the chosen.
  std::size_t count() const { return count_; }
  std::size_t open_count() const { return open_count_; }
  StreamedArray<std::int32_t> take_chosen() { return std::move(chosen_); }
  StreamedArray<std::uint8_t> take_firsts() { return std::move(firsts_); }
  StreamedArray<bool> take_owned() { return std::move(is_owned_); }
  StreamedArray<std::int32_t> take_open() { return std::move(open_); }

 private:
  static constexpr double kRoom = 1.0 + 0x1p-17;
  static constexpr double kTrusted = 0x1p-20;  // largest relative error of a cross product
  static constexpr double kLeast = 0x1p-900;   // below it products lose digits,
  static constexpr double kMost = 0x1p900;     // and above it they may be infinite

  bool meets_box(Point a, Point b, Point c) const {
    const bool holds_one = box_.holds(a) | box_.holds(b) | box_.holds(c);
    if (holds_one) return true;
    Box own = Box::of(a, b);
    own.include(c);
    return own.meets(box_) && !is_beside(a, b, c);
  }

  // Of convex figures that do not meet, one lies beyond a side of the other.
  TINSMITH_RARE bool is_beside(Point a, Point b, Point c) const {
    return is_right_of(a, b) || is_right_of(b, c) || is_right_of(c, a);
  }
  bool is_right_of(Point start, Point end) const {
    return std::all_of(corners_, corners_ + 4,
                       [&](Point p) { return orientation(start, end, p) < 0; });
  }

  bool is_disc_within(Point a, Point b, Point c) const {
    const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    const double dx = c.x - b.x, dy = c.y - b.y;
    const double left = bx * cy, right = by * cx;
    const double cross = left - right;
    const double error = 4 * kUnitRoundoff * (std::fabs(left) + std::fabs(right));
    const double sides = (bx * bx + by * by) * (cx * cx + cy * cy) * (dx * dx + dy * dy);
    const double distance = std::min(std::min(a.x - around_.west, around_.east - a.x),
                                     std::min(a.y - around_.south, around_.north - a.y));
    const double reach = distance * cross;
    return (distance > 0.0) & (error <= kTrusted * cross) & (sides >= kLeast) & (sides <= kMost) &
           (sides * kRoom <= reach * reach);
  }

  PlaneTriangles triangles_;
  Box box_, around_;
  Point corners_[4];
  StreamedArray<std::int32_t> chosen_;
  StreamedArray<std::uint8_t> firsts_;
  StreamedArray<bool> is_owned_;
  StreamedArray<std::int32_t> open_;
  std::size_t count_ = 0, open_count_ = 0;
};

}  // namespace tinsmith
