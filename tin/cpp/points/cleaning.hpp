// Points as they come in: a copy of the caller's rows, and whether the kernel can work with it.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>

#include "../base/parallel.hpp"
#include "../predicates/predicates.hpp"

namespace tinsmith {

// Copy rows of (x, y, z), with -0.0 turned into 0.0 so that equal coordinates are equal bytes.
// Returns whether x and y are within the range in which predicates are exact, and z within that of
// elevations.
inline bool copy_clean(const double* from, std::int64_t count, double* to, Team& team) {
  std::atomic<bool> is_sound{true};
  team.run([&](int part) {
    const std::int64_t begin = count * part / team.size(), end = count * (part + 1) / team.size();
    bool sound = true;
    for (std::int64_t i = 3 * begin; i < 3 * end; i += 3) {
      for (int k = 0; k < 3; ++k) to[i + k] = from[i + k] + 0.0;
      sound &=
          is_in_exact_range(from[i]) & is_in_exact_range(from[i + 1]) & is_elevation(from[i + 2]);
    }
    if (!sound) is_sound = false;
  });
  return is_sound;
}

}  // namespace tinsmith
