// Contour lines that change while no two of them ever touch.
//
// Vertices are dropped and added one at a time. Dropping b between a and c moves the line over the
// triangle abc. If the closed triangle holds no other vertex of any line, nothing else can be in
// it: a segment that came in would have to end there, to cross a-b or b-c, which it does not, or
// to cross a-c twice, which it cannot. So lines that did not touch before do not afterwards. Adding
// b between a and c is the same step backwards. Both are decided by exact predicates.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <vector>

#include "../../../tin/cpp/base/box.hpp"
#include "../../../tin/cpp/predicates/predicates.hpp"
#include "elevation_walk.hpp"
#include "line_tracing.hpp"

namespace tinsmith::isolines {

enum class Node : std::int32_t {};
constexpr Node kNoNode{-1};
constexpr std::int32_t number(Node n) { return static_cast<std::int32_t>(n); }

// Whether a point lies in the closed triangle, which may be flat and turn either way.
inline bool is_in_closed_triangle(Point a, Point b, Point c, Point p) {
  const int ab = orientation(a, b, p);
  const int bc = orientation(b, c, p);
  const int ca = orientation(c, a, p);
  if (ab == 0 && bc == 0 && ca == 0) {  // a flat triangle, and p on its line
    const auto [least, greatest] = std::minmax({a, b, c}, lexicographically_before);
    return !lexicographically_before(p, least) && !lexicographically_before(greatest, p);
  }
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

// Vertices by the cells of a grid.
class NodeGrid {
 public:
  explicit NodeGrid(const std::vector<Point>& points) {
    if (points.empty()) return;
    for (const Point p : points) box_.include(p);
    const double width = box_.width(), height = box_.height();
    const double cells = std::max<double>(1.0, static_cast<double>(points.size()));
    size_ = std::max(std::sqrt(width * height / cells), std::max(width, height) / cells);
    if (!(size_ > 0.0)) size_ = 1.0;
    columns_ = static_cast<std::int64_t>(width / size_) + 1;
    rows_ = static_cast<std::int64_t>(height / size_) + 1;
    first_.assign(static_cast<std::size_t>(columns_ * rows_), kNoNode);
  }

  void add(Node node, Point p) {
    const std::size_t cell = std::size_t(row(p.y) * columns_ + column(p.x));
    if (std::size_t(number(node)) >= next_.size()) next_.resize(std::size_t(number(node)) + 1);
    next_[number(node)] = first_[cell];
    first_[cell] = node;
  }

  // Whether a test holds for any vertex whose cell meets the box of some points.
  template <typename Test>
  bool any_near(std::initializer_list<Point> around, const Test& test) const {
    Box box;
    for (const Point p : around) box.include(p);
    for (std::int64_t r = row(box.south); r <= row(box.north); ++r) {
      for (std::int64_t c = column(box.west); c <= column(box.east); ++c) {
        for (Node n = first_[std::size_t(r * columns_ + c)]; n != kNoNode; n = next_[number(n)]) {
          if (test(n)) return true;
        }
      }
    }
    return false;
  }

 private:
  std::int64_t column(double x) const { return clamp((x - box_.west) / size_, columns_); }
  std::int64_t row(double y) const { return clamp((y - box_.south) / size_, rows_); }
  static std::int64_t clamp(double cell, std::int64_t count) {
    return std::min(std::max(static_cast<std::int64_t>(cell), std::int64_t{0}), count - 1);
  }

  Box box_;
  double size_ = 1.0;
  std::int64_t columns_ = 0, rows_ = 0;
  std::vector<Node> first_;
  std::vector<Node> next_;
};

class LineNetwork {
 public:
  static constexpr std::size_t kMostNodes = INT32_MAX / 16;  // smoothing doubles them, twice

  // `triangles` holds one for each point: one that it lies in.
  LineNetwork(const TracedLines& lines, const std::int32_t* triangles)
      : points_(lines.points.begin(), lines.points.end()), grid_(points_) {
    const std::size_t count = points_.size();
    if (count > kMostNodes) throw std::length_error("too many points of lines");
    previous_.resize(count);
    following_.resize(count);
    triangle_.resize(count);
    is_alive_.assign(count, 1);
    for (std::size_t i = 0; i < count; ++i) {
      triangle_[i] = triangle_numbered(triangles[i]);
      grid_.add(Node(i), points_[i]);
    }
    for (const Line& line : lines.lines) {
      for (std::size_t i = line.begin; i < line.end; ++i) {
        previous_[i] = i > line.begin ? Node(i - 1) : line.is_closed ? Node(line.end - 1) : kNoNode;
        following_[i] = i + 1 < line.end ? Node(i + 1)
                        : line.is_closed ? Node(line.begin)
                                         : kNoNode;
      }
    }
  }

  Point point(Node n) const { return points_[number(n)]; }
  Place place(Node n) const { return {points_[number(n)], triangle_[number(n)]}; }
  Node previous(Node n) const { return previous_[number(n)]; }
  Node following(Node n) const { return following_[number(n)]; }
  bool is_alive(Node n) const { return is_alive_[number(n)] != 0; }
  bool is_end(Node n) const { return previous(n) == kNoNode || following(n) == kNoNode; }
  std::size_t size() const { return points_.size(); }

  // Whether a closed triangle holds no vertices but the three given.
  bool is_free(Point p, Point q, Point r, Node a, Node b, Node c) const {
    return !grid_.any_near({p, q, r}, [&](Node n) {
      return n != a && n != b && n != c && is_alive(n) && is_in_closed_triangle(p, q, r, point(n));
    });
  }

  void drop(Node n) {
    is_alive_[number(n)] = 0;
    following_[number(previous(n))] = following(n);
    previous_[number(following(n))] = previous(n);
  }

  Node add_after(Node before, const Place& place) {
    const Node after = following(before);
    const Node made{static_cast<std::int32_t>(points_.size())};
    points_.push_back(place.point);
    triangle_.push_back(place.triangle);
    previous_.push_back(before);
    following_.push_back(after);
    is_alive_.push_back(1);
    following_[number(before)] = made;
    previous_[number(after)] = made;
    grid_.add(made, place.point);
    return made;
  }

 private:
  std::vector<Point> points_;
  NodeGrid grid_;
  std::vector<Node> previous_, following_;
  std::vector<Triangle> triangle_;
  std::vector<char> is_alive_;
};

}  // namespace tinsmith::isolines
