// The order in which points are inserted: rounds in random sample, each round along one curve.
//
// The biased randomized insertion order of Amenta, Choi and Rote, "Incremental constructions con
// BRIO" (2003).
//
// Sorted along Hilbert's curve each point is found a few triangles from the one before. But a
// triangulation grown from one side has long, thin triangles at its front, and in the worst case
// all of them change again and again. So the points come in rounds, a sample of one point in
// eight (chosen at random among eight neighbours on the curve) before the others, a sample of the
// sample before that, and so on: as in a random order, the expected work a point is constant.
//
//      on the curve     o o o o o o o o  o o o o o o o o  o o o o o o o o  ...
//      last round       o o o   o o o o  o o o o o o   o    o o o o o o o  ...
//      round before           o                              o             ...
//      earlier still                                  o                    ...
//
// A point's position on the curve is its number while inserting: neighbours in the plane are near
// in memory, whatever round they come in.
#pragma once

#include <cstdint>
#include <vector>

namespace tinsmith {

class InsertionRounds {
 public:
  explicit InsertionRounds(std::uint32_t count) : sizes_{count} {
    while (sizes_.back() > kFirstRound) sizes_.push_back(sizes_.back() / kBlock);
  }

  // Visit every position on the curve once. Stops and returns false when `visit` does.
  template <typename Visit>
  bool for_each(Visit&& visit) const {
    const int first = static_cast<int>(sizes_.size()) - 1;
    for (int round = first; round >= 0; --round) {
      const std::uint32_t earlier = round == first ? 0 : sizes_[round + 1];
      for (std::uint32_t i = 0; i < sizes_[round]; ++i) {
        const std::uint32_t block = i / kBlock;
        if (block < earlier && i == chosen(round, block)) continue;
        if (!visit(position(round, i))) return false;
      }
    }
    return true;
  }

 private:
  static constexpr int kBlockBits = 3;
  static constexpr std::uint32_t kBlock = 1u << kBlockBits;
  static constexpr std::uint32_t kFirstRound = 64;

  // Position on the curve of the i-th point of a round and all earlier ones.
  static std::uint32_t position(int round, std::uint32_t i) {
    while (round-- > 0) i = chosen(round, i);
    return i;
  }

  // The member of a block that comes in an earlier round, by a multiplicative hash.
  static std::uint32_t chosen(int round, std::uint32_t block) {
    constexpr std::uint32_t kGolden = 0x9E3779B9u;     // 2^32 over the golden ratio
    constexpr std::uint32_t kRoundStep = 0x85EBCA6Bu;  // any odd number: each round chooses anew
    const std::uint32_t hash = block * kGolden + static_cast<std::uint32_t>(round) * kRoundStep;
    return block * kBlock + (hash >> (32 - kBlockBits));
  }

  std::vector<std::uint32_t> sizes_;  // of each round with all earlier ones
};

}  // namespace tinsmith
