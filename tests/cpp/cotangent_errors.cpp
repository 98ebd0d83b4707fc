// The bounds of CotangentErrors against arithmetic of 113 bits: what rounding does stays within
// them, and comes near enough to them that bounds much tighter would be found out.
#include <cmath>
#include <cstdio>
#include <random>

#include "../../tin/cpp/search/circle_on_edge.hpp"

namespace {

using Wide = __float128;  // differences and products of these coordinates are exact in it
constexpr Wide kWideNothing = 0;

double size(Wide value) { return static_cast<double>(value < kWideNothing ? -value : value); }

struct Offset {
  double x, y;
};

struct Product {
  double cross, dot;
  Wide exact_cross, exact_dot;
};

Product product(double ax, double ay, double bx, double by, double x, double y) {
  const double ex = bx - ax, ey = by - ay, px = x - ax, py = y - ay;
  const Wide wex = Wide(bx) - ax, wey = Wide(by) - ay, wpx = Wide(x) - ax, wpy = Wide(y) - ay;
  return {ex * py - ey * px, px * (px - ex) + py * (py - ey), wex * wpy - wey * wpx,
          wpx * (wpx - wex) + wpy * (wpy - wey)};
}

struct Worst {
  double cross = 0.0, tolerance_of_dot = 0.0, tolerance = 0.0, widened = 0.0;
  bool is_circle_too_small = false;
};

void raise(double& worst, double value) {
  if (value > worst) worst = value;
}

void examine(std::mt19937_64& rng, double origin, double edge, double reach, Worst& worst) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double ax = origin + unit(rng), ay = origin + unit(rng);
  const double bx = ax + edge * unit(rng), by = ay + edge * unit(rng);
  const double ex = bx - ax, ey = by - ay, edge_sum = std::fabs(ex) + std::fabs(ey);
  const bool is_on_thales = unit(rng) < 0.0;
  const double turn = 3.14159265358979 * unit(rng), radius = 0.5 * std::hypot(ex, ey);
  const Offset best =
      is_on_thales ? Offset{0.5 * ex + radius * std::cos(turn), 0.5 * ey + radius * std::sin(turn)}
                   : Offset{reach * unit(rng), reach * unit(rng)};
  const double qx = ax + best.x, qy = ay + best.y;
  const double px = ax + reach * unit(rng), py = ay + reach * unit(rng);
  const double largest = std::fmax(std::fmax(std::fabs(px - ax), std::fabs(py - ay)),
                                   std::fmax(std::fabs(qx - ax), std::fabs(qy - ay)));
  const tinsmith::CotangentErrors errors(edge_sum, std::fmax(largest, edge_sum));
  const Product p = product(ax, ay, bx, by, px, py), q = product(ax, ay, bx, by, qx, qy);
  raise(worst.cross, size(p.cross - p.exact_cross) / errors.cross());
  const double computed = p.dot * q.cross - p.cross * q.dot;
  const Wide exact = p.exact_dot * q.exact_cross - p.exact_cross * q.exact_dot;
  const double share = size(computed - exact) / errors.tolerance(q.dot, q.cross);
  raise(is_on_thales ? worst.tolerance_of_dot : worst.tolerance, share);
  if (q.cross > 2.0 * errors.cross()) {
    const double widened = errors.widened(q.dot, q.cross);
    const Wide cotangent = q.exact_dot / q.exact_cross;
    worst.is_circle_too_small |= widened < cotangent;
    raise(worst.widened, size(q.dot / q.cross - cotangent) / size(widened - cotangent));
  }
}

}  // namespace

int main() {
  std::mt19937_64 rng(1);
  Worst worst;
  for (const double origin : {0.0, 1.0, 512345.0, 5.4e6}) {
    for (const double edge : {1e-6, 1e-3, 1.0, 100.0}) {
      for (const double share : {1.0, 3.0, 30.0}) {
        for (int i = 0; i < 20000; ++i) examine(rng, origin, edge, share * edge, worst);
      }
    }
  }
  std::printf("%.6g %.6g %.6g %.6g %d\n", worst.cross, worst.tolerance_of_dot, worst.tolerance,
              worst.widened, static_cast<int>(worst.is_circle_too_small));
}
