// Vertices of lines in a tree of boxes, to which vertices are added and from which they are taken.
//
// Cells are halved at the median of what they hold, as in a k-d tree (Bentley, "Multidimensional
// binary search trees used for associative searching", 1975), so the tree follows the vertices
// however uneven they are. Each cell knows a box around what it holds; a triangle is compared with
// the boxes themselves, for that of a long and thin triangle meets much that the triangle does not.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../../../tin/cpp/base/box.hpp"
#include "elevation_walk.hpp"

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

// A closed triangle that boxes and points are compared with.
class SearchTriangle {
 public:
  SearchTriangle(Point a, Point b, Point c) : corner_{a, b, c} {
    for (const Point p : corner_) box_.include(p);
    for (int i = 0; i < 3; ++i) {
      side_[i] = sign_of(measure_turn(corner_[i], corner_[(i + 1) % 3], corner_[(i + 2) % 3]));
    }
  }

  // Whether a box may hold a point of the triangle; where rounding leaves it open, it may. Of a
  // small one it is not looked at closely.
  bool may_meet(const Box& box, bool is_small) const {
    if (!box_.meets(box)) return false;
    if (is_small || box_.within(box)) return true;
    const Point corners[4] = {
        {box.west, box.south}, {box.east, box.south}, {box.east, box.north}, {box.west, box.north}};
    for (int i = 0; i < 3; ++i) {
      int sum = 0;
      for (const Point p : corners) {
        sum += sign_of(measure_turn(corner_[i], corner_[(i + 1) % 3], p));
      }
      const bool is_beside = sum == 4 || sum == -4;
      if (is_beside && sum != 4 * side_[i] && is_told(i)) return false;
    }
    return true;
  }

  bool holds(Point p) const {
    return box_.holds(p) && is_in_closed_triangle(corner_[0], corner_[1], corner_[2], p);
  }

 private:
  // 0 where rounding leaves it open.
  static int sign_of(Turn turn) {
    return turn.value > turn.error ? 1 : turn.value < -turn.error ? -1 : 0;
  }

  // Whether the third corner is on the side that is known, or on the line through the others.
  bool is_told(int i) const {
    return side_[i] != 0 || orientation(corner_[0], corner_[1], corner_[2]) == 0;
  }

  Point corner_[3];
  int side_[3];  // of the edge from corner i that the third corner is on
  Box box_;
};

class NodeTree {
 public:
  explicit NodeTree(const std::vector<Point>& points) : points_(points) {
    cells_.emplace_back();
    add_all();
  }

  // A vertex whose point is the last.
  void add(Node n) {
    const Point p = points_[number(n)];
    std::int32_t c = 0;
    while (true) {
      Cell& cell = cells_[c];
      cell.box.include(p);
      ++cell.count;
      if (cell.left < 0) break;
      c = cell.left + (cell.is_right(p) ? 1 : 0);
    }
    put(c, n);
    if (cells_[c].count > cells_[c].most) split(c);
  }

  void drop(Node n) {
    Node* link = &cells_[cell_of_[number(n)]].first;
    while (*link != n) link = &next_[number(*link)];
    *link = next_[number(n)];
    for (std::int32_t c = cell_of_[number(n)]; c >= 0; c = cells_[c].parent) --cells_[c].count;
  }

  // Whether a test holds for any vertex in a triangle.
  template <typename Test>
  bool any_in(const SearchTriangle& triangle, const Test& test) {
    pending_.assign(1, 0);
    while (!pending_.empty()) {
      const Cell& cell = cells_[pending_.back()];
      pending_.pop_back();
      if (cell.left >= 0) {
        for (const std::int32_t half : {cell.left, cell.left + 1}) {
          const Cell& other = cells_[half];
          if (other.count > 0 && triangle.may_meet(other.box, other.left < 0)) {
            pending_.push_back(half);
          }
        }
        continue;
      }
      for (Node n = cell.first; n != kNoNode; n = next_[number(n)]) {
        if (triangle.holds(points_[number(n)]) && test(n)) return true;
      }
    }
    return false;
  }

 private:
  static constexpr std::int32_t kMost = 12;  // vertices of a cell that is not halved

  struct Cell {
    Box box;
    double at = 0.0;  // from here on a vertex belongs to the right one of the halves
    bool is_across = false;
    std::int32_t left = -1, parent = -1;  // the right one follows the left one
    std::int32_t count = 0, most = kMost;
    Node first = kNoNode;

    double along(Point p) const { return is_across ? p.y : p.x; }
    bool is_right(Point p) const { return along(p) >= at; }
  };

  void add_all() {
    next_.reserve(points_.size());
    cell_of_.reserve(points_.size());
    Cell& root = cells_[0];
    for (std::size_t i = 0; i < points_.size(); ++i) {
      root.box.include(points_[i]);
      put(0, Node(i));
    }
    root.count = static_cast<std::int32_t>(points_.size());
    for (std::size_t c = 0; c < cells_.size(); ++c) {  // halves are halved in their turn
      if (cells_[c].count > kMost) split(static_cast<std::int32_t>(c));
    }
  }

  void put(std::int32_t c, Node n) {
    const auto needed = static_cast<std::size_t>(number(n)) + 1;
    if (needed > next_.size()) {
      next_.resize(needed);
      cell_of_.resize(needed);
    }
    next_[number(n)] = cells_[c].first;
    cell_of_[number(n)] = c;
    cells_[c].first = n;
  }

  // Halve a cell at the median along its longer side; one place alone cannot be halved.
  void split(std::int32_t c) {
    Cell& cell = cells_[c];
    held_.clear();
    cell.box = {};
    for (Node n = cell.first; n != kNoNode; n = next_[number(n)]) {
      held_.push_back(n);
      cell.box.include(points_[number(n)]);
    }
    cell.is_across = cell.box.height() > cell.box.width();
    cell.most *= 2;
    const double least = cell.is_across ? cell.box.south : cell.box.west;
    const double greatest = cell.is_across ? cell.box.north : cell.box.east;
    if (!(least < greatest)) return;
    const auto along = [&](Node n) { return cell.along(points_[number(n)]); };
    const auto middle = held_.begin() + static_cast<std::ptrdiff_t>(held_.size() / 2);
    std::nth_element(held_.begin(), middle, held_.end(),
                     [&](Node a, Node b) { return along(a) < along(b); });
    cell.at = along(*middle);
    if (cell.at == least) {  // most are there: the others are the right half
      cell.at = greatest;
      for (const Node n : held_) {
        if (along(n) > least) cell.at = std::min(cell.at, along(n));
      }
    }
    divide(c);
  }

  void divide(std::int32_t c) {
    const auto left = static_cast<std::int32_t>(cells_.size());
    cells_.resize(cells_.size() + 2);
    Cell& cell = cells_[c];
    cell.left = left;
    cell.first = kNoNode;
    cells_[left].parent = cells_[left + 1].parent = c;
    for (const Node n : held_) {
      const Point p = points_[number(n)];
      const std::int32_t half = left + (cell.is_right(p) ? 1 : 0);
      put(half, n);
      cells_[half].box.include(p);
      ++cells_[half].count;
    }
  }

  const std::vector<Point>& points_;
  std::vector<Cell> cells_;
  std::vector<Node> next_;  // of the same cell
  std::vector<std::int32_t> cell_of_;
  std::vector<Node> held_;             // of the cell that is halved
  std::vector<std::int32_t> pending_;  // of the search at hand
};

}  // namespace tinsmith::isolines
