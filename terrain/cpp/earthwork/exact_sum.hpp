// A sum of doubles that no order of the summands changes.
//
// The superaccumulator of R. M. Neal, "Fast exact summation using small and large superaccumulators"
// (2015), arXiv:1505.05571: a fixed-point number as wide as the doubles' range, in 32-bit digits
// that are carried only now and then. Summed exactly and rounded at the end, so triangles may come
// in any order and from any number of threads.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace tinsmith {

class ExactSum {
 public:
  void add(double value) {
    if (value == 0.0) return;
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    const auto exponent = static_cast<std::uint32_t>(bits >> 52) & 0x7ff;
    if (exponent == 0x7ff) {
      is_finite_ = false;
      return;
    }
    const std::uint64_t fraction = bits & ((std::uint64_t{1} << 52) - 1);
    const std::uint64_t mantissa = exponent == 0 ? fraction : fraction | std::uint64_t{1} << 52;
    const std::uint32_t shift = exponent == 0 ? 0 : exponent - 1;
    add_digits(mantissa, shift, static_cast<std::int64_t>(bits >> 63 != 0 ? -1 : 1));
  }

  void add(const ExactSum& other) {
    ExactSum carried = other;
    carried.carry();
    carry();
    for (std::size_t i = 0; i < kDigits; ++i) digit_[i] += carried.digit_[i];
    is_finite_ = is_finite_ && other.is_finite_;
    carry();
  }

  static constexpr std::size_t kTerms = 68;

  // Doubles whose sum it is, exactly, the smallest first: what a sum is kept as and sent as. NaN if
  // a summand was not finite.
  std::array<double, kTerms> terms() const {
    std::array<double, kTerms> terms{};
    if (!is_finite_) {
      terms[0] = std::nan("");
      return terms;
    }
    ExactSum carried = *this;
    carried.carry();
    const bool is_negative = carried.digit_[kDigits - 1] < 0;
    if (is_negative) {  // a number and its opposite are rounded alike
      for (auto& digit : carried.digit_) digit = -digit;
      carried.carry();
    }
    for (std::size_t i = 0; i < kDigits; ++i) {
      if (carried.digit_[i] == 0) continue;
      const auto digit = static_cast<double>(is_negative ? -carried.digit_[i] : carried.digit_[i]);
      terms[i] = std::ldexp(digit, 32 * static_cast<int>(i) - 1074);
    }
    return terms;
  }

  // NaN if a summand was not finite.
  double value() const {
    double sum = 0.0;
    for (const double term : terms()) sum += term;
    return sum;
  }

 private:
  static constexpr std::size_t kDigits = kTerms;  // 2098 bits of doubles, and room above
  static constexpr std::uint32_t kAddsBetweenCarries = 1u << 29;
  static constexpr std::uint64_t kMask = 0xffffffff;

  // Digits take less than 2^33 each time.
  void add_digits(std::uint64_t mantissa, std::uint32_t shift, std::int64_t sign) {
    const std::size_t first = shift >> 5;
    const std::uint32_t within = shift & 31;
    const std::uint64_t low = (mantissa & kMask) << within, high = (mantissa >> 32) << within;
    digit_[first] += sign * static_cast<std::int64_t>(low & kMask);
    digit_[first + 1] += sign * static_cast<std::int64_t>((low >> 32) + (high & kMask));
    digit_[first + 2] += sign * static_cast<std::int64_t>(high >> 32);
    if (++adds_ == kAddsBetweenCarries) carry();
  }

  // All digits but the last from 0 to 2^32 - 1: a number has one such form.
  void carry() {
    for (std::size_t i = 0; i + 1 < kDigits; ++i) {
      const std::int64_t up = digit_[i] >> 32;  // rounds down, also below zero
      digit_[i] -= up * (std::int64_t{1} << 32);
      digit_[i + 1] += up;
    }
    adds_ = 0;
  }

  std::array<std::int64_t, kDigits> digit_{};
  std::uint32_t adds_ = 0;
  bool is_finite_ = true;
};

}  // namespace tinsmith
