// Asking now and then, within loops of any length, whether work should go on.
#pragma once

#include <cstdint>

#include "parallel.hpp"

namespace tinsmith {

class Pulse {
 public:
  explicit Pulse(Team& team, int part = 0) : team_(team), part_(part) {}

  // False from when the team was stopped; asks at every 16,384th step alone.
  bool goes_on() {
    if ((++steps_ & (kStepsBetween - 1)) == 0) goes_on_ = team_.keeps_going(part_);
    return goes_on_;
  }

 private:
  static constexpr std::uint32_t kStepsBetween = 1u << 14;

  Team& team_;
  int part_;
  std::uint32_t steps_ = 0;
  bool goes_on_ = true;
};

}  // namespace tinsmith
