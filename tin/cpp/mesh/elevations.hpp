// Elevations of vertices that are edited, beside the rows that they come from.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../base/ids.hpp"

namespace tinsmith {

// By slot. The caller's rows (x, y, z) are never changed: a page of elevations is copied when the
// first of them changes.
class Elevations {
 public:
  Elevations(const double* rows, std::int32_t count)
      : rows_(rows),
        count_(static_cast<std::size_t>(count)),
        page_((count_ + kPage - 1) / kPage, kNoPage) {}

  double operator[](Vertex v) const {
    const std::size_t slot = slot_of(v);
    if (slot >= count_) return added_[slot - count_];
    return page_[slot / kPage] == kNoPage ? given(slot) : changed_[place_of(slot)];
  }

  void put(Vertex v, double z) {
    const std::size_t slot = slot_of(v);
    if (slot >= count_) {
      added_[slot - count_] = z;
    } else {
      if (page_[slot / kPage] == kNoPage) copy_page(slot / kPage);
      changed_[place_of(slot)] = z;
    }
  }
  void add(double z) { added_.push_back(z); }

 private:
  static constexpr std::size_t kPage = 8;
  static constexpr std::int32_t kNoPage = -1;

  static std::size_t slot_of(Vertex v) { return static_cast<std::size_t>(number(v)); }
  double given(std::size_t slot) const { return rows_[3 * slot + 2]; }
  std::size_t place_of(std::size_t slot) const {
    return static_cast<std::size_t>(page_[slot / kPage]) * kPage + slot % kPage;
  }

  void copy_page(std::size_t page) {
    page_[page] = static_cast<std::int32_t>(changed_.size() / kPage);
    const std::size_t begin = page * kPage, end = std::min(begin + kPage, count_);
    for (std::size_t slot = begin; slot < end; ++slot) changed_.push_back(given(slot));
    changed_.resize((changed_.size() + kPage - 1) / kPage * kPage);  // the last page may be short
  }

  const double* rows_;
  std::size_t count_;
  std::vector<std::int32_t> page_;  // among those that were copied
  std::vector<double> changed_;
  std::vector<double> added_;
};

}  // namespace tinsmith
