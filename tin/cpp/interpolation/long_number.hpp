// Numbers of six times the digits of a double, for what is left when twice the digits are not
// enough: points a rounding off a straight line, circles as large as a planet's orbit.
//
// The sums, products and compressed expansions of J. R. Shewchuk (1997), cut off after six parts.
// Slow, and still for values only.
#pragma once

#include <algorithm>
#include <cstddef>

#include "../predicates/expansion.hpp"

namespace tinsmith {

class LongNumber {
 public:
  LongNumber() = default;
  LongNumber(double value) { value_.push_nonzero(value); }  // NOLINT: a double is one of them
  explicit LongNumber(TwoDoubles sum) {
    value_.push_nonzero(sum.low);
    value_.push_nonzero(sum.high);
  }

  explicit operator double() const { return value_.value(); }

  friend LongNumber operator-(const LongNumber& a) { return LongNumber(-a.value_); }
  friend LongNumber operator+(const LongNumber& a, const LongNumber& b) {
    return LongNumber(a.value_ + b.value_);
  }
  friend LongNumber operator-(const LongNumber& a, const LongNumber& b) {
    return LongNumber(a.value_ - b.value_);
  }
  friend LongNumber operator*(const LongNumber& a, const LongNumber& b) {
    return LongNumber(a.value_ * b.value_);
  }
  // Long division, a double of the quotient at a time.
  friend LongNumber operator/(const LongNumber& a, const LongNumber& b) {
    LongNumber quotient, rest = a;
    for (std::size_t i = 0; i < kParts && rest.value_.size > 0; ++i) {
      const double digit = static_cast<double>(rest) / static_cast<double>(b);
      quotient = quotient + LongNumber(digit);
      rest = LongNumber(rest.value_ - b.value_ * digit);
    }
    return quotient;
  }

 private:
  static constexpr std::size_t kParts = 6;

  // The largest parts of an expansion, compressed so that each holds 53 digits of its own.
  template <std::size_t N>
  explicit LongNumber(const Expansion<N>& sum) {
    if (sum.size == 0) return;
    double parts[kParts] = {};  // largest first
    std::size_t count = 0;
    double carry = sum.part[sum.size - 1];
    for (std::size_t i = sum.size - 1; i-- > 0 && count < kParts;) {
      const TwoDoubles both = exact_sum(carry, sum.part[i]);
      carry = both.high;
      if (both.low != 0.0) {
        parts[count++] = both.high;
        carry = both.low;
      }
    }
    if (count < kParts) parts[count++] = carry;
    while (count > 0) value_.push_nonzero(parts[--count]);
  }

  Expansion<kParts> value_;
};

}  // namespace tinsmith
