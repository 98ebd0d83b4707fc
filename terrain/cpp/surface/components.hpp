// Connected components, each named by its smallest member.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "../../../tin/cpp/base/arrays.hpp"

namespace tinsmith {

// A forest in which a root is smaller than all below it (Galler and Fischer, "An improved
// equivalence algorithm", 1964; paths are halved as in Tarjan and van Leeuwen, "Worst-case analysis
// of set union algorithms", 1984).
class Components {
 public:
  explicit Components(std::int32_t count)
      : count_(count), above_(scratch_array<std::int32_t>(static_cast<std::size_t>(count))) {
    for (std::int32_t i = 0; i < count; ++i) above_[i] = i;
  }

  void join(std::int32_t one, std::int32_t other) {
    one = find(one);
    other = find(other);
    above_[std::max(one, other)] = std::min(one, other);
  }

  // The smallest that each is connected to.
  void write(std::int64_t* roots) {
    for (std::int32_t i = 0; i < count_; ++i) roots[i] = above_[i] = above_[above_[i]];
  }

 private:
  std::int32_t find(std::int32_t i) {
    while (above_[i] != i) i = above_[i] = above_[above_[i]];
    return i;
  }

  std::int32_t count_;
  ScratchArray<std::int32_t> above_;
};

}  // namespace tinsmith
