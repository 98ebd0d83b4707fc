// Numbers of the vertices of an edited TIN: without gaps, while slots are lasting.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../base/ids.hpp"
#include "../base/range.hpp"

namespace tinsmith {

// Which slots hold a vertex, and how many of them come before each. Until the first gap a slot is
// its own rank and nothing is kept; then a bit for each slot, and sums over blocks of 64 in a tree
// of prefix sums (Fenwick, "A new data structure for cumulative frequency tables", 1994).
class HeldSlots {
 public:
  explicit HeldSlots(std::int32_t slots) : slots_(slots), count_(slots) {}

  std::int32_t slots() const { return slots_; }
  std::int32_t count() const { return count_; }

  bool holds(std::int32_t slot) const {
    return !has_gaps_ || (bits_[block_of(slot)] >> (slot % kBits) & 1) != 0;
  }

  void add(bool is_held) {
    if (has_gaps_ && slots_ % kBits == 0) add_block();
    ++slots_;
    ++count_;
    if (has_gaps_) put(slots_ - 1, 1);
    if (!is_held) empty(slots_ - 1);
  }

  // A slot that holds a vertex loses it, or gets one.
  void empty(std::int32_t slot) {
    if (!has_gaps_) set_up();
    put(slot, -1);
    --count_;
  }
  void fill(std::int32_t slot) {
    put(slot, 1);
    ++count_;
  }

  // Vertices in the slots before this one.
  std::int32_t rank(std::int32_t slot) const {
    if (!has_gaps_) return slot;
    const std::size_t block = block_of(slot);
    const std::uint64_t before = (std::uint64_t{1} << (slot % kBits)) - 1;
    return sum_before(block) + (block < bits_.size() ? count_bits(bits_[block] & before) : 0);
  }

  // The slot of the vertex with so many before it.
  std::int32_t at(std::int32_t rank) const {
    if (!has_gaps_) return rank;
    std::size_t block = 0;
    for (std::size_t step = largest_step_; step > 0; step /= 2) {
      if (block + step > bits_.size() || sums_[block + step - 1] > rank) continue;
      block += step;
      rank -= sums_[block - 1];
    }
    std::uint64_t bits = bits_[block];
    for (; rank > 0; --rank) bits &= bits - 1;
    return static_cast<std::int32_t>(block * kBits) + count_bits(~bits & (bits - 1));
  }

 private:
  static constexpr std::int32_t kBits = 64;

  static std::size_t block_of(std::int32_t slot) { return static_cast<std::size_t>(slot / kBits); }
  static std::int32_t count_bits(std::uint64_t bits) {
    return static_cast<std::int32_t>(std::bitset<kBits>(bits).count());
  }

  void set_up() {
    has_gaps_ = true;
    const auto blocks = static_cast<std::size_t>((slots_ + kBits - 1) / kBits);
    bits_.assign(blocks, ~std::uint64_t{0});
    if (slots_ % kBits != 0) bits_.back() = (std::uint64_t{1} << (slots_ % kBits)) - 1;
    sums_.resize(blocks);
    for (std::size_t position = 1; position <= blocks; ++position) {
      const auto low = static_cast<std::int32_t>(position & -position);  // blocks in the sum
      sums_[position - 1] = kBits * low;
    }
    if (slots_ % kBits != 0) sums_.back() -= kBits - slots_ % kBits;  // no other has the last block
    while (2 * largest_step_ <= blocks) largest_step_ *= 2;
  }

  // An empty one behind the others.
  void add_block() {
    const std::size_t position = bits_.size() + 1;
    sums_.push_back(sum_before(position - 1) - sum_before(position - (position & -position)));
    bits_.push_back(0);
    if (2 * largest_step_ <= bits_.size()) largest_step_ *= 2;
  }

  void put(std::int32_t slot, std::int32_t change) {
    bits_[block_of(slot)] ^= std::uint64_t{1} << (slot % kBits);
    add_to_sums(block_of(slot), change);
  }

  // Positions in the tree count from 1; each holds the sum over as many blocks up to its own as its
  // last bit that is set says.
  void add_to_sums(std::size_t block, std::int32_t change) {
    for (std::size_t position = block + 1; position <= sums_.size();
         position += position & -position) {
      sums_[position - 1] += change;
    }
  }
  std::int32_t sum_before(std::size_t block) const {
    std::int32_t sum = 0;
    for (std::size_t position = block; position > 0; position &= position - 1) {
      sum += sums_[position - 1];
    }
    return sum;
  }

  std::int32_t slots_, count_;
  bool has_gaps_ = false;
  std::vector<std::uint64_t> bits_;
  std::vector<std::int32_t> sums_;
  std::size_t largest_step_ = 1;  // the largest power of two that is no more than the blocks
};

// Vertices are numbered by slot, but those of lines alone come last: slots of rows, of lines, and
// of what was inserted are numbered as rows, inserted, lines.
class VertexNumbers {
 public:
  // `lines` are the slots of vertices of lines, none of which is ever emptied.
  VertexNumbers(std::int32_t slots, Range lines)
      : held_(slots), lines_(lines), rows_(lines.begin) {}

  const HeldSlots& held() const { return held_; }
  std::int32_t count() const { return held_.count(); }

  void add(bool is_held) { held_.add(is_held); }
  void empty(Vertex slot) {
    held_.empty(number(slot));
    rows_ -= number(slot) < lines_.begin;
  }
  void fill(Vertex slot) {
    held_.fill(number(slot));
    rows_ += number(slot) < lines_.begin;
  }

  bool is_vertex(std::int32_t vertex) const { return vertex >= 0 && vertex < count(); }
  std::int32_t of(Vertex slot) const {
    const std::int32_t rank = held_.rank(number(slot));
    if (rank < rows_) return rank;
    return rank < rows_ + lines_.size() ? rank + inserted() : rank - lines_.size();
  }
  Vertex slot_of(std::int32_t vertex) const {
    if (vertex < rows_) return Vertex{held_.at(vertex)};
    const bool is_of_line = vertex >= rows_ + inserted();
    return Vertex{held_.at(is_of_line ? vertex - inserted() : vertex + lines_.size())};
  }

  // Call `visit(slot, vertex)` for every vertex, in the order of their numbers.
  template <typename Visit>
  void for_each(Visit&& visit) const {
    std::int32_t vertex = 0;
    for (const Range part : {Range{0, lines_.begin}, Range{lines_.end, held_.slots()}, lines_}) {
      for (std::int32_t slot = part.begin; slot < part.end; ++slot) {
        if (held_.holds(slot)) visit(Vertex{slot}, vertex++);
      }
    }
  }

 private:
  std::int32_t inserted() const { return count() - rows_ - lines_.size(); }

  HeldSlots held_;
  Range lines_;
  std::int32_t rows_;  // vertices of rows
};

}  // namespace tinsmith
