// Work stealing: the vertices of the sweep, dealt out to threads that take over from each other.
//
// After Blumofe and Leiserson, "Scheduling multithreaded computations by work stealing" (1999),
// with ranges for tasks. Every thread begins with a task of equal size and finishes it from the
// front, block by block. One that is through steals the later half of what the largest task still
// holds: so a core that is slow, or busy with something else, holds nobody up. (Which thread made
// which triangle shows nowhere in the result.)
//
//      task 0  |=====>        |             thread 1 is through, and takes the later half of
//      task 1  |=============>|             what is left of task 0:   |=====>  |      |
#pragma once

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <vector>

#include "../base/range.hpp"

namespace tinsmith {

class WorkStealing {
 public:
  static constexpr int kNone = -1;

  WorkStealing(std::int64_t count, int parts) {
    for (int part = 0; part < parts; ++part) {
      const Range whole = part_of(count, part, parts);
      tasks_.push_back({whole, whole.begin});
    }
  }

  // The next vertices of a task to be finished; none are left if the range is empty.
  Range next_block(int task) {
    constexpr std::int32_t kBlock = 4096;  // a millisecond
    const std::lock_guard<std::mutex> lock(mutex_);
    Task& from = tasks_[task];
    const Range block{from.next, std::min(from.whole.end, from.next + kBlock)};
    from.next = block.end;
    return block;
  }

  // Make a task of the later half of what the largest one still holds; kNone if none is worth it.
  int steal() {
    constexpr std::int32_t kWorthStealing = 32768;  // a seam costs as much as some hundred vertices
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto left = [](const Task& task) { return task.whole.end - task.next; };
    const auto largest =
        std::max_element(tasks_.begin(), tasks_.end(),
                         [&](const Task& a, const Task& b) { return left(a) < left(b); });
    if (left(*largest) < kWorthStealing) return kNone;
    const std::int32_t middle = largest->next + left(*largest) / 2;
    const Task stolen{{middle, largest->whole.end}, middle};
    largest->whole.end = middle;
    tasks_.push_back(stolen);
    return static_cast<int>(tasks_.size()) - 1;
  }

  Range range(int task) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return tasks_[task].whole;
  }

 private:
  struct Task {
    Range whole;
    std::int32_t next;
  };
  std::mutex mutex_;
  std::vector<Task> tasks_;
};

}  // namespace tinsmith
