// Half-open ranges of positions, and how they are divided.
#pragma once

#include <cstdint>

namespace tinsmith {

struct Range {
  std::int32_t begin, end;

  std::int32_t size() const { return end - begin; }
};

// Part number `part` of `parts` nearly equal parts of 0 .. count - 1.
inline Range part_of(std::int64_t count, int part, int parts) {
  return {static_cast<std::int32_t>(count * part / parts),
          static_cast<std::int32_t>(count * (part + 1) / parts)};
}

}  // namespace tinsmith
