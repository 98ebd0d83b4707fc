// Numbers of twice the digits of a double: sums of two doubles.
//
// T. J. Dekker, "A floating-point technique for extending the available precision", Numerische
// Mathematik 18 (1971). About 31 digits, not exact: for values, never for decisions.
#pragma once

#include "../predicates/expansion.hpp"

namespace tinsmith {

struct DoubleDouble {
  double high = 0.0;
  double low = 0.0;

  DoubleDouble() = default;
  DoubleDouble(double value) : high(value) {}  // NOLINT: a double is one of them
  explicit DoubleDouble(TwoDoubles sum) : high(sum.high), low(sum.low) {}

  explicit operator double() const { return high; }
};

// |small| <= |large|.
inline DoubleDouble quick_sum(double large, double small) {
  const double sum = large + small;
  DoubleDouble result(sum);
  result.low = small - (sum - large);
  return result;
}

inline DoubleDouble operator-(DoubleDouble a) {
  a.high = -a.high;
  a.low = -a.low;
  return a;
}
inline DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  const TwoDoubles high = exact_sum(a.high, b.high);
  const TwoDoubles low = exact_sum(a.low, b.low);
  const DoubleDouble sum = quick_sum(high.high, high.low + low.high);
  return quick_sum(sum.high, sum.low + low.low);
}
inline DoubleDouble operator-(DoubleDouble a, DoubleDouble b) { return a + -b; }
inline DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
  const TwoDoubles high = exact_product(a.high, b.high);
  return quick_sum(high.high, high.low + (a.high * b.low + a.low * b.high));
}
inline DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
  const double first = a.high / b.high;
  const DoubleDouble left = a - b * DoubleDouble(first);
  const double second = left.high / b.high;
  const DoubleDouble rest = left - b * DoubleDouble(second);
  return quick_sum(first, second) + DoubleDouble(rest.high / b.high);
}

}  // namespace tinsmith
