// The measures that refinement goes by against angles computed by themselves: prints one word for
// each that is wrong.
#include <cmath>
#include <cstdio>
#include <random>

#include "../../tin/cpp/refinement/triangle_shape.hpp"

namespace {

using tinsmith::Point;
using tinsmith::RefinementGoal;
using tinsmith::ShapeTest;
using tinsmith::TurnedTriangle;

constexpr double kDegree = 3.14159265358979323846 / 180.0;

double distance(Point p, Point q) { return std::hypot(p.x - q.x, p.y - q.y); }

// In degrees, of the triangle's corner c.
double angle_at(Point c, Point a, Point b) {
  const double turn = std::atan2(b.y - c.y, b.x - c.x) - std::atan2(a.y - c.y, a.x - c.x);
  return std::fabs(std::remainder(turn, 360.0 * kDegree)) / kDegree;
}

void expect(bool is_so, const char* what) {
  if (!is_so) std::printf("%s\n", what);
}

ShapeTest shape_of(double least_angle, double area = INFINITY, double edge = INFINITY) {
  return ShapeTest(RefinementGoal{least_angle * kDegree, area, edge});
}

// A point encroaches where it sees the segment under 180 degrees less twice the least angle.
void examine_lens(double least_angle, Point a, Point b, Point c) {
  const double seen = angle_at(c, a, b), limit = 180.0 - 2.0 * least_angle;
  if (std::fabs(seen - limit) < 1e-6) return;
  expect(shape_of(least_angle).encroaches(c, a, b) == (seen > limit), "lens");
}

void examine_triangle(double least_angle, const Point (&corner)[3]) {
  const TurnedTriangle t = TurnedTriangle::of(corner);
  const double shortest = distance(t.p, t.q);
  expect(shortest <= distance(t.q, t.apex) && shortest <= distance(t.apex, t.p), "turned");
  const Point turned[3] = {corner[1], corner[2], corner[0]};
  const TurnedTriangle same = TurnedTriangle::of(turned);
  expect(same.apex == t.apex && same.p == t.p && same.q == t.q, "order of corners");

  const ShapeTest shape = shape_of(least_angle);
  const double angle = angle_at(t.apex, t.p, t.q);
  if (std::fabs(angle - least_angle) > 1e-6) {
    expect(shape.has_small_angle(t) == (angle < least_angle), "small angle");
  }
  const Point center = shape_of(0.0).remedy(t);
  const double radius = distance(center, t.p);
  expect(std::fabs(distance(center, t.q) - radius) < 1e-6 * radius, "center");
  expect(std::fabs(distance(center, t.apex) - radius) < 1e-6 * radius, "center");
  const Point remedy = shape.remedy(t);
  const double seen = angle_at(remedy, t.p, t.q);
  expect(std::fabs(distance(remedy, t.p) - distance(remedy, t.q)) < 1e-6 * radius, "off-center");
  expect(seen > least_angle || remedy == center, "off-center sees too little");
  expect(seen < 1.06 * least_angle || remedy == center, "off-center sees too much");
  expect(distance(remedy, t.p) <= radius * (1 + 1e-9), "off-center beyond the center");
}

void examine_lines(Point a, Point b, Point c, double twice_area) {
  const double height = std::fabs(twice_area) / distance(a, b);
  const double found = std::sqrt(tinsmith::squared_height(c, a, b));
  expect(std::fabs(found - height) < 1e-9 * (1.0 + height), "height");
  const Point m = tinsmith::midpoint(a, b);
  expect(std::fabs(distance(m, a) - 0.5 * distance(a, b)) < 1e-9, "midpoint");
  expect(std::fabs(distance(m, b) - 0.5 * distance(a, b)) < 1e-9, "midpoint");
}

void examine_size(const Point (&corner)[3]) {
  const TurnedTriangle t = TurnedTriangle::of(corner);
  double longest = 0.0;
  for (int k = 0; k < 3; ++k) {
    longest = std::fmax(longest, distance(corner[k], corner[(k + 1) % 3]));
  }
  const Point a = corner[0], b = corner[1], c = corner[2];
  const double area =
      0.5 * std::fabs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  expect(!shape_of(20, 1.001 * area).is_large(t) && shape_of(20, 0.999 * area).is_large(t), "area");
  expect(!shape_of(20, INFINITY, 1.001 * longest).is_large(t), "edge allowed");
  expect(shape_of(20, INFINITY, 0.999 * longest).is_large(t), "edge too long");
  const double edge = distance(a, b);
  expect(shape_of(20, INFINITY, 0.999 * edge).is_long(a, b), "segment too long");
  expect(!shape_of(20, INFINITY, 1.001 * edge).is_long(a, b), "segment allowed");
}

// What is just as long or as large as is allowed stays.
void examine_limits() {
  const Point corner[3] = {{0.0, 0.0}, {4.0, 0.0}, {0.0, 3.0}};
  expect(!shape_of(20, 6.0, 5.0).is_large(TurnedTriangle::of(corner)), "limits");
  expect(!shape_of(20, INFINITY, 5.0).is_long(corner[1], corner[2]), "limits");
}

}  // namespace

int main() {
  examine_limits();
  std::mt19937_64 rng(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int n = 0; n < 20000; ++n) {
    const double size = n % 2 == 0 ? 10.0 : 0.1;
    const auto place = [&] { return Point{size * unit(rng), size * unit(rng)}; };
    const Point corner[3] = {place(), place(), place()};
    const double cross = (corner[1].x - corner[0].x) * (corner[2].y - corner[0].y) -
                         (corner[1].y - corner[0].y) * (corner[2].x - corner[0].x);
    if (std::fabs(cross) < 1e-3 * size * size) continue;
    const Point turned[3] = {corner[0], cross > 0 ? corner[1] : corner[2],
                             cross > 0 ? corner[2] : corner[1]};
    const double least_angle = 1.0 + 16.0 * (unit(rng) + 1.0);
    examine_lens(least_angle, turned[0], turned[1], turned[2]);
    examine_triangle(least_angle, turned);
    examine_lines(turned[0], turned[1], turned[2], cross);
    examine_size(turned);
  }
}
