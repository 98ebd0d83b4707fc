// A table of numbers by number, for few of very many.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tinsmith {

// Open addressing with linear probing (Knuth, "The Art of Computer Programming", vol. 3, 6.4), at
// most half full. Nothing is ever taken out. UINT32_MAX is no key.
class NumberTable {
 public:
  NumberTable() : entries_(kFirst, Entry{kNoKey, 0}) {}

  // What was put there last, or null; good until the next put.
  const std::uint32_t* find(std::uint32_t key) const {
    for (std::size_t i = first_of(key);; i = next(i)) {
      if (entries_[i].key == key) return &entries_[i].value;
      if (entries_[i].key == kNoKey) return nullptr;
    }
  }

  void put(std::uint32_t key, std::uint32_t value) {
    std::size_t i = first_of(key);
    while (entries_[i].key != key && entries_[i].key != kNoKey) i = next(i);
    if (entries_[i].key == kNoKey && 2 * ++count_ > entries_.size()) {
      grow();
      put_new(key, value);
    } else {
      entries_[i] = {key, value};
    }
  }

 private:
  static constexpr std::uint32_t kNoKey = UINT32_MAX;
  static constexpr std::size_t kFirst = 1024;

  struct Entry {
    std::uint32_t key, value;
  };

  // The high bits of the product with the golden ratio (Knuth, the same place), of eight keys in a
  // row at once: they lie in one line of the cache.
  std::size_t first_of(std::uint32_t key) const {
    return (((key >> 3) * 2654435769u) >> shift_ << 3) + (key & 7);
  }
  std::size_t next(std::size_t i) const { return (i + 1) & (entries_.size() - 1); }

  void put_new(std::uint32_t key, std::uint32_t value) {
    std::size_t i = first_of(key);
    while (entries_[i].key != kNoKey) i = next(i);
    entries_[i] = {key, value};
  }

  void grow() {
    std::vector<Entry> before(2 * entries_.size(), Entry{kNoKey, 0});
    before.swap(entries_);
    --shift_;
    for (const Entry& entry : before) {
      if (entry.key != kNoKey) put_new(entry.key, entry.value);
    }
  }

  std::vector<Entry> entries_;  // a power of two
  std::uint32_t shift_ = 25;    // 35 less the power
  std::size_t count_ = 0;
};

}  // namespace tinsmith
