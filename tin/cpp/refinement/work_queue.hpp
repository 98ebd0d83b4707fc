// What is still to be done, the most urgent first.
//
// The order is one of places, not of numbers: the same surface is refined alike however its
// vertices are numbered. Lengths count by steps of about a tenth only, and within these near comes
// after near along a curve: what is worked on next is in the cache.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "../mesh/mesh.hpp"
#include "../mesh/mesh_editor.hpp"
#include "../predicates/predicates.hpp"

namespace tinsmith {

// Tells how urgent a place is: smaller is sooner.
class Urgency {
 public:
  Urgency() = default;
  Urgency(Point low, Point high) : low_(low) {
    const double width = std::max(high.x - low.x, high.y - low.y);
    scale_ = width > 0.0 ? kCells / width : 0.0;
  }

  std::uint64_t of_shortest(double squared_length, Point place) const {
    return rank_of(squared_length) << (2 * kBits) | along_curve(place);
  }
  std::uint64_t of_longest(double squared_length, Point place) const {
    return (kLastRank - rank_of(squared_length)) << (2 * kBits) | along_curve(place);
  }

 private:
  static constexpr int kBits = 24;  // of each coordinate; the rank has the 16 that are left
  static constexpr double kCells = 1 << kBits;

  // The first bits of a positive double: its power of two, and which quarter of the way to the next.
  static constexpr std::uint64_t kLastRank = (1 << 14) - 1;
  static std::uint64_t rank_of(double squared_length) {
    std::uint64_t bits;
    std::memcpy(&bits, &squared_length, sizeof bits);
    return bits >> 50;
  }

  // The bits of both coordinates in turn.
  std::uint64_t along_curve(Point place) const {
    return spread(cell(place.x - low_.x)) | spread(cell(place.y - low_.y)) << 1;
  }
  std::uint64_t cell(double offset) const {
    return static_cast<std::uint64_t>(std::min(std::max(offset * scale_, 0.0), kCells - 1.0));
  }
  static std::uint64_t spread(std::uint64_t bits) {
    bits = (bits | bits << 16) & 0x0000FFFF0000FFFFu;
    bits = (bits | bits << 8) & 0x00FF00FF00FF00FFu;
    bits = (bits | bits << 4) & 0x0F0F0F0F0F0F0F0Fu;
    bits = (bits | bits << 2) & 0x3333333333333333u;
    return (bits | bits << 1) & 0x5555555555555555u;
  }

  Point low_{0.0, 0.0};
  double scale_ = 0.0;
};

struct SegmentWork {
  std::uint64_t urgency;
  MeshEdge edge;
  std::int32_t vertex[2];  // in lexicographic order
  bool is_ordered;         // to be split in any case
};

struct TriangleWork {
  std::uint64_t urgency;
  std::uint32_t triangle;
  std::int32_t vertex[3];  // from the shortest edge on
};

template <typename Work>
class WorkQueue {
 public:
  explicit WorkQueue(const MeshEditor& editor) : editor_(editor) {}

  bool is_empty() const { return heap_.empty(); }
  void push(const Work& work) {
    heap_.push_back(work);
    std::push_heap(heap_.begin(), heap_.end(), later());
  }
  Work pop() {
    std::pop_heap(heap_.begin(), heap_.end(), later());
    const Work first = heap_.back();
    heap_.pop_back();
    return first;
  }

 private:
  auto later() const {
    return [this](const Work& a, const Work& b) {
      return a.urgency != b.urgency ? a.urgency > b.urgency : is_place_before(b, a);
    };
  }

  bool is_place_before(const Work& a, const Work& b) const {
    constexpr int kVertices = sizeof(a.vertex) / sizeof(a.vertex[0]);
    for (int k = 0; k < kVertices; ++k) {
      const Point p = editor_.point(a.vertex[k]), q = editor_.point(b.vertex[k]);
      if (!(p == q)) return lexicographically_before(p, q);
    }
    return false;
  }

  const MeshEditor& editor_;
  std::vector<Work> heap_;
};

}  // namespace tinsmith
