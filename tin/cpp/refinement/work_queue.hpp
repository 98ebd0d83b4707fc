// What is still to be done, the most urgent first.
//
// Lengths count by steps of about a tenth only; within one the last that came is the first served:
// what is worked on next is near, and in the cache. Nothing here depends on how vertices are
// numbered, so a surface in canonical order is refined alike in any case.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "../base/ids.hpp"

namespace tinsmith {

struct SegmentWork {
  HalfEdge edge;
  Vertex from, to;
  bool is_ordered;  // to be split in any case
};

struct TriangleWork {
  Triangle triangle;
  Vertex vertex[3];
};

template <typename Work>
class WorkQueue {
 public:
  bool is_empty() const { return count_ == 0; }
  std::size_t size() const { return count_; }

  // Small ranks are served first.
  void push(std::uint32_t rank, const Work& work) {
    if (rank >= waiting_.size()) waiting_.resize(rank + std::size_t{1});
    waiting_[rank].push_back(work);
    first_ = count_ == 0 ? rank : std::min(first_, rank);
    ++count_;
  }

  Work pop() {
    while (waiting_[first_].empty()) ++first_;
    const Work next = waiting_[first_].back();
    waiting_[first_].pop_back();
    --count_;
    return next;
  }

 private:
  std::vector<std::vector<Work>> waiting_;  // by rank
  std::uint32_t first_ = 0;                 // no work has a smaller rank
  std::size_t count_ = 0;
};

// The first bits of the square: its power of two, and which quarter of the way to the next.
inline std::uint32_t rank_of_short(double squared_length) {
  std::uint64_t bits;
  std::memcpy(&bits, &squared_length, sizeof bits);
  return static_cast<std::uint32_t>(bits >> 50);
}
inline std::uint32_t rank_of_long(double squared_length) {
  constexpr std::uint32_t kLastRank = (1u << 13) - 1;  // of a positive number
  return kLastRank - rank_of_short(squared_length);
}

}  // namespace tinsmith
