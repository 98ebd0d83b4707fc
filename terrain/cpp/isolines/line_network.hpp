// Contour lines that change while no two of them ever touch.
//
// Vertices are dropped and added one at a time. Dropping b between a and c moves the line over the
// triangle abc. If the closed triangle holds no other vertex of any line, nothing else can be in
// it: a segment that came in would have to end there, to cross a-b or b-c, which it does not, or
// to cross a-c twice, which it cannot. So lines that did not touch before do not afterwards. Adding
// b between a and c is the same step backwards. Both are decided by exact predicates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "elevation_walk.hpp"
#include "line_tracing.hpp"
#include "node_tree.hpp"

namespace tinsmith::isolines {

class LineNetwork {
 public:
  static constexpr std::size_t kMostNodes = INT32_MAX / 16;  // smoothing doubles them, twice

  // `triangles` holds one for each point: one that it lies in.
  LineNetwork(const TracedLines& lines, const std::int32_t* triangles)
      : points_(lines.points.begin(), lines.points.end()), tree_(points_) {
    const std::size_t count = points_.size();
    if (count > kMostNodes) throw std::length_error("too many points of lines");
    previous_.resize(count);
    following_.resize(count);
    triangle_.resize(count);
    is_alive_.assign(count, 1);
    for (std::size_t i = 0; i < count; ++i) {
      triangle_[i] = triangle_numbered(triangles[i]);
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
  bool is_free(Point p, Point q, Point r, Node a, Node b, Node c) {
    return !tree_.any_in(SearchTriangle(p, q, r),
                         [&](Node n) { return n != a && n != b && n != c; });
  }

  void drop(Node n) {
    is_alive_[number(n)] = 0;
    tree_.drop(n);
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
    tree_.add(made);
    return made;
  }

 private:
  std::vector<Point> points_;
  NodeTree tree_;
  std::vector<Node> previous_, following_;
  std::vector<Triangle> triangle_;
  std::vector<char> is_alive_;
};

}  // namespace tinsmith::isolines
