// Shares: the vertices of the sweep, dealt out to threads, which take over from each other.
//
// Every thread begins with an equal share and finishes it from the front, block by block. One that
// is through takes the later half of what the largest share still holds: so a core that is slow,
// or busy with something else, holds nobody up. (Which thread made which triangle shows nowhere in
// the result.)
//
//      share 0  |=====>        |            share 1 is through, and takes the later half of
//      share 1  |=============>|            what is left of share 0:   |=====>  |      |
#pragma once

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <vector>

#include "../base/ids.hpp"
#include "../base/parallel.hpp"

namespace tinsmith {

class Shares {
 public:
  static constexpr int kNone = -1;

  Shares(std::int64_t count, int parts) {
    for (int part = 0; part < parts; ++part) {
      const Range own = part_of(count, part, parts);
      shares_.push_back({own, own.begin});
    }
  }

  // The next vertices of a share to be finished; none are left if the range is empty.
  Range next_block(int share) {
    constexpr std::int32_t kBlock = 4096;  // a millisecond
    const std::lock_guard<std::mutex> lock(mutex_);
    Share& from = shares_[share];
    const Range block{from.next, std::min(from.own.end, from.next + kBlock)};
    from.next = block.end;
    return block;
  }

  // Make a share of the later half of what the largest one still holds; kNone if none is worth it.
  int split_largest() {
    constexpr std::int32_t kWorthSharing = 32768;  // a seam costs as much as some hundred vertices
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto left = [](const Share& share) { return share.own.end - share.next; };
    const auto largest = std::max_element(
        shares_.begin(), shares_.end(),
        [&](const Share& a, const Share& b) { return left(a) < left(b); });
    if (left(*largest) < kWorthSharing) return kNone;
    const std::int32_t middle = largest->next + left(*largest) / 2;
    const Share taken{{middle, largest->own.end}, middle};
    largest->own.end = middle;
    shares_.push_back(taken);
    return static_cast<int>(shares_.size()) - 1;
  }

  Range range(int share) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return shares_[share].own;
  }

 private:
  struct Share {
    Range own;
    std::int32_t next;
  };
  std::mutex mutex_;
  std::vector<Share> shares_;
};

}  // namespace tinsmith
