// Lines with fewer points or rounder corners, that stay within a vertical tolerance of their level
// and do not touch one another.
//
// Corners are cut after Chaikin, "An algorithm for high speed curve generation" (1974), vertices
// dropped after Visvalingam and Whyatt, "Line generalisation by repeated elimination of points"
// (1993).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "../../../tin/cpp/base/parallel.hpp"
#include "line_network.hpp"

namespace tinsmith::isolines {

class LineSmoother {
 public:
  LineSmoother(const Surface& surface, const Levels& levels, const TracedLines& lines,
               const std::int32_t* triangles, Team& team)
      : walk_(surface), levels_(levels), lines_(lines), network_(lines, triangles), team_(team) {}

  // Cut corners at a quarter of their sides, or at less where there is no room; then those that are
  // left.
  void smooth(double tolerance, int rounds) {
    for (int round = 0; round < rounds; ++round) {
      for (const Line& line : lines_.lines) {
        if (!team_.keeps_going(0)) return;
        smooth_line(line, tolerance);
      }
    }
  }

  // Drop vertices, those of the smallest triangle with their neighbours first, as long as the
  // tolerance allows. Where the line is straight those of the nearest neighbours are first: it
  // loses every second vertex, and again, so that no part of it is walked often.
  void simplify(double tolerance) {
    for (const Line& line : lines_.lines) {
      if (!team_.keeps_going(0)) return;
      simplify_line(line, tolerance);
    }
  }

  TracedLines take() const {
    TracedLines made;
    for (const Line& line : lines_.lines) {
      const std::size_t begin = made.points.size();
      for (const Node n : nodes_of(line)) made.points.push_back(network_.point(n));
      made.lines.push_back({begin, made.points.size(), line.level, line.is_closed});
      if (line.is_closed) turn_to_first(made.points, begin);
    }
    return made;
  }

 private:
  std::vector<Node> nodes_of(const Line& line) const {
    Node start{static_cast<std::int32_t>(line.begin)};
    if (line.is_closed) start = first_alive(line);
    std::vector<Node> nodes;
    Node n = start;
    do {
      nodes.push_back(n);
      n = network_.following(n);
    } while (n != kNoNode && n != start);
    return nodes;
  }

  // A given vertex that is left, or one that was made in the place of the first one.
  Node first_alive(const Line& line) const {
    for (std::size_t i = line.begin; i < line.end; ++i) {
      if (network_.is_alive(Node(i))) return Node(i);
    }
    // What was dropped still knows its neighbour of then.
    Node n{static_cast<std::int32_t>(line.begin)};
    while (!network_.is_alive(n)) n = network_.following(n);
    return n;
  }

  void smooth_line(const Line& line, double tolerance) {
    for (const Node b : nodes_of(line)) {
      if (network_.is_end(b) || !is_corner(b)) continue;
      for (const double share : {0.25, 0.125, 0.0625}) {
        if (cut_corner(b, share, line, tolerance)) break;
      }
    }
  }

  // Whether the line turns by more than the eye forgives.
  bool is_corner(Node b) const {
    constexpr double kStraight = 0.995;  // the cosine of 6 degrees
    const Point a = network_.point(network_.previous(b)), p = network_.point(b),
                c = network_.point(network_.following(b));
    const double ux = p.x - a.x, uy = p.y - a.y, vx = c.x - p.x, vy = c.y - p.y;
    return ux * vx + uy * vy < kStraight * std::hypot(ux, uy) * std::hypot(vx, vy);
  }

  bool cut_corner(Node b, double share, const Line& line, double tolerance) {
    const Node a = network_.previous(b), c = network_.following(b);
    const Point pa = network_.point(a), pb = network_.point(b), pc = network_.point(c);
    const auto towards = [&](Point end) {
      return Point{pb.x + share * (end.x - pb.x), pb.y + share * (end.y - pb.y)};
    };
    Place q{towards(pa), kNoTriangle}, r{towards(pc), kNoTriangle};
    if (a == c || !are_apart(pa, q.point, pb, r.point, pc)) return false;
    if (!network_.is_free(pa, q.point, pb, a, b, c) ||
        !network_.is_free(pb, r.point, pc, a, b, c) ||
        !network_.is_free(q.point, pb, r.point, a, b, c)) {
      return false;
    }
    const double level = levels_.values[line.level];
    Place end = network_.place(c);
    if (!reaches(network_.place(a), q, level, tolerance) || !reaches(q, r, level, tolerance) ||
        !passes(r, end, level, tolerance)) {
      return false;
    }
    network_.add_after(network_.add_after(a, q), r);
    // They stand before b now, as a, q, r, b, c; b goes.
    network_.drop(b);
    return true;
  }

  // Whether the three triangles that the line moves over meet in their common corners alone.
  static bool are_apart(Point a, Point q, Point b, Point r, Point c) {
    if (q == a || q == b || r == b || r == c || q == r) return false;
    return !is_in_closed_triangle(q, b, r, a) && !is_in_closed_triangle(b, r, c, a) &&
           !is_in_closed_triangle(q, b, r, c) && !is_in_closed_triangle(a, q, b, c) &&
           !is_in_closed_triangle(b, r, c, q) && !is_in_closed_triangle(a, q, b, r);
  }

  // Whether a segment, and its end, are within the tolerance; finds the triangle of the end.
  bool reaches(const Place& from, Place& to, double level, double tolerance) const {
    return passes(from, to, level, tolerance) && walk_.is_within(to, level, tolerance);
  }
  // From an end at the boundary, which may lie a rounding outside, the walk comes back to it.
  bool passes(const Place& from, Place& to, double level, double tolerance) const {
    if (walk_.stays_within(from, to, level, tolerance)) return true;
    Place back = from;
    return to.triangle != kNoTriangle && walk_.stays_within(to, back, level, tolerance);
  }

  using Candidate = std::tuple<double, double, std::int32_t, std::int32_t, std::int32_t>;

  void simplify_line(const Line& line, double tolerance) {
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<Candidate>> queue;
    const std::vector<Node> nodes = nodes_of(line);
    std::size_t left = nodes.size();
    const std::size_t least = line.is_closed ? 4 : 2;
    const auto offer = [&](Node n) {
      if (n == kNoNode || network_.is_end(n)) return;
      const Node a = network_.previous(n), c = network_.following(n);
      const Point pa = network_.point(a), pc = network_.point(c);
      const double area = std::fabs(measure_turn(pa, network_.point(n), pc).value);
      const double base = area > 0.0 ? 0.0 : std::hypot(pc.x - pa.x, pc.y - pa.y);
      queue.emplace(area, base, number(n), number(a), number(c));
    };
    for (const Node n : nodes) offer(n);
    while (!queue.empty() && left > least) {
      const auto [area, base, node, before, after] = queue.top();
      queue.pop();
      const Node b{node}, a{before}, c{after};
      if (!network_.is_alive(b) || network_.previous(b) != a || network_.following(b) != c)
        continue;
      if (!can_drop(a, b, c, line, tolerance)) continue;
      network_.drop(b);
      --left;
      offer(a);
      offer(c);
    }
  }

  bool can_drop(Node a, Node b, Node c, const Line& line, double tolerance) {
    const Point pa = network_.point(a), pb = network_.point(b), pc = network_.point(c);
    if (pa == pc || !network_.is_free(pa, pb, pc, a, b, c)) return false;
    Place end = network_.place(c);
    return passes(network_.place(a), end, levels_.values[line.level], tolerance);
  }

  ElevationWalk walk_;
  Levels levels_;
  const TracedLines& lines_;
  LineNetwork network_;
  Team& team_;
};

}  // namespace tinsmith::isolines
