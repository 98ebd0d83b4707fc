// Exact arithmetic on sums of doubles.
//
// An expansion is an unevaluated sum of doubles, ordered by growing magnitude and non-overlapping,
// that holds a real number exactly. Its sign is the sign of its last component.
// Source: J. R. Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
// Predicates, Discrete & Computational Geometry 18 (1997), doi:10.1007/PL00009321.
#pragma once

#include <array>
#include <cstddef>

namespace tinsmith {

// high + low is exact, or good to twice the digits of a double (double_double.hpp).
struct TwoDoubles {
  double high, low;

  TwoDoubles() = default;
  TwoDoubles(double value) : TwoDoubles(value, 0.0) {}  // NOLINT: a double is one of them
  TwoDoubles(double high_part, double low_part) : high(high_part), low(low_part) {}

  explicit operator double() const { return high; }
};

inline TwoDoubles exact_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  const double a_part = sum - b_part;
  return {sum, (a - a_part) + (b - b_part)};
}

inline TwoDoubles exact_difference(double a, double b) { return exact_sum(a, -b); }

// Dekker's split into two halves of 26 bits, so that products of halves are exact.
inline TwoDoubles split(double a) {
  constexpr double kSplitter = 134217729.0;  // 2^27 + 1
  const double scaled = kSplitter * a;
  const double high = scaled - (scaled - a);
  return {high, a - high};
}

inline TwoDoubles exact_product(double a, double b) {
  const double product = a * b;
  const TwoDoubles x = split(a);
  const TwoDoubles y = split(b);
  const double error = ((product - x.high * y.high) - x.low * y.high) - x.high * y.low;
  return {product, x.low * y.low - error};
}

template <std::size_t Capacity>
struct Expansion {
  std::array<double, Capacity> part;
  std::size_t size = 0;

  void push_nonzero(double value) {
    if (value != 0.0) part[size++] = value;
  }
  int sign() const {
    if (size == 0) return 0;
    return part[size - 1] > 0.0 ? 1 : -1;
  }
  // Rounded: good to a unit or two in the last place.
  double value() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < size; ++i) sum += part[i];
    return sum;
  }
};

inline Expansion<2> expand(TwoDoubles value) {
  Expansion<2> result;
  result.push_nonzero(value.low);
  result.push_nonzero(value.high);
  return result;
}

template <std::size_t N, std::size_t M>
Expansion<N> widen(const Expansion<M>& value) {
  static_assert(M <= N);
  Expansion<N> result;
  for (std::size_t i = 0; i < value.size; ++i) result.push_nonzero(value.part[i]);
  return result;
}

// Parts do not overlap, so no expansion has more of them than doubles have places for bits.
constexpr std::size_t at_most(std::size_t parts) { return parts < 2098 ? parts : 2098; }

// Merge by magnitude, then carry upwards (fast expansion sum with zero elimination).
template <std::size_t N, std::size_t M>
Expansion<at_most(N + M)> operator+(const Expansion<N>& a, const Expansion<M>& b) {
  Expansion<at_most(N + M)> result;
  std::size_t i = 0;
  std::size_t j = 0;
  const auto magnitude = [](double v) { return v < 0.0 ? -v : v; };
  double carry = 0.0;
  while (i < a.size || j < b.size) {
    const bool take_a = j == b.size || (i < a.size && magnitude(a.part[i]) <= magnitude(b.part[j]));
    const double next = take_a ? a.part[i++] : b.part[j++];
    const TwoDoubles sum = exact_sum(carry, next);
    result.push_nonzero(sum.low);
    carry = sum.high;
  }
  result.push_nonzero(carry);
  return result;
}

template <std::size_t N>
Expansion<N> operator-(const Expansion<N>& a) {
  Expansion<N> result;
  result.size = a.size;
  for (std::size_t i = 0; i < a.size; ++i) result.part[i] = -a.part[i];
  return result;
}

template <std::size_t N, std::size_t M>
Expansion<at_most(N + M)> operator-(const Expansion<N>& a, const Expansion<M>& b) {
  return a + (-b);
}

// Scale by one double.
template <std::size_t N>
Expansion<at_most(2 * N)> operator*(const Expansion<N>& a, double factor) {
  Expansion<at_most(2 * N)> result;
  double carry = 0.0;
  for (std::size_t i = 0; i < a.size; ++i) {
    const TwoDoubles product = exact_product(a.part[i], factor);
    const TwoDoubles low = exact_sum(carry, product.low);
    result.push_nonzero(low.low);
    const TwoDoubles high = exact_sum(product.high, low.high);
    result.push_nonzero(high.low);
    carry = high.high;
  }
  result.push_nonzero(carry);
  return result;
}

template <std::size_t N, std::size_t M>
Expansion<at_most(2 * N * M)> operator*(const Expansion<N>& a, const Expansion<M>& b) {
  Expansion<at_most(2 * N * M)> total;
  for (std::size_t j = 0; j < b.size; ++j) {
    const auto sum = total + a * b.part[j];
    total.size = sum.size;
    for (std::size_t i = 0; i < sum.size; ++i) total.part[i] = sum.part[i];
  }
  return total;
}

}  // namespace tinsmith
