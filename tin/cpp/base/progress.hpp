// How much of a piece of work is done, counted by threads and read by the one that asks.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

namespace tinsmith {

class Progress {
 public:
  // Before the work begins: so many steps, blocks or tiles, there are.
  void expect(std::int64_t steps) { expected_ = steps; }
  void advance(std::int64_t steps) { done_.fetch_add(steps, std::memory_order_relaxed); }

  // 0 while it is not known how much there is.
  double fraction() const {
    const std::int64_t expected = expected_;
    if (expected <= 0) return 0.0;
    const auto done = static_cast<double>(done_.load(std::memory_order_relaxed));
    return std::min(done / static_cast<double>(expected), 1.0);
  }

 private:
  std::atomic<std::int64_t> expected_{0};
  std::atomic<std::int64_t> done_{0};
};

}  // namespace tinsmith
