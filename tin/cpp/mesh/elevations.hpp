// Elevations of vertices that are edited, beside the rows that they come from.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
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
        pages_((count_ + kPage - 1) / kPage) {}
  Elevations(const Elevations&) = delete;
  Elevations& operator=(const Elevations&) = delete;

  double operator[](Vertex v) const {
    const std::size_t slot = slot_of(v);
    if (slot >= count_) return added_[slot - count_];
    const Page* const page = pages_[slot / kPage].get();
    return page != nullptr ? (*page)[slot % kPage] : given(slot);
  }

  void put(Vertex v, double z) {
    const std::size_t slot = slot_of(v);
    if (slot >= count_) {
      added_[slot - count_] = z;
    } else {
      own_page(slot / kPage)[slot % kPage] = z;
    }
  }
  void add(double z) { added_.push_back(z); }

 private:
  static constexpr std::size_t kPage = 32;
  using Page = std::array<double, kPage>;

  static std::size_t slot_of(Vertex v) { return static_cast<std::size_t>(number(v)); }
  double given(std::size_t slot) const { return rows_[3 * slot + 2]; }

  Page& own_page(std::size_t i) {
    if (pages_[i] == nullptr) {
      pages_[i] = std::make_unique<Page>();
      for (std::size_t k = 0; k < kPage && i * kPage + k < count_; ++k) {
        (*pages_[i])[k] = given(i * kPage + k);
      }
    }
    return *pages_[i];
  }

  const double* rows_;
  std::size_t count_;
  std::vector<std::unique_ptr<Page>> pages_;
  std::vector<double> added_;
};

}  // namespace tinsmith
