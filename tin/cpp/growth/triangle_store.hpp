// Triangles while they are made: corners and neighbours, three a triangle, numbered as found.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "../base/arrays.hpp"
#include "../base/ids.hpp"
#include "../base/parallel.hpp"

namespace tinsmith {

// Flat arrays, three entries a triangle.
struct Triangles {
  std::int32_t* corners;
  std::int32_t* neighbors;
};

// Writes into arrays of the caller's that are large enough, or into its own, which grow. Threads
// have one each, on cache lines of its own.
class alignas(kCacheLine) TriangleStore {
 public:
  explicit TriangleStore(Triangles enough) : arrays_(enough), capacity_(UINT32_MAX) {}
  explicit TriangleStore(std::int64_t expected) { enlarge(expected); }

  std::uint32_t size() const { return size_; }
  Triangle next() const { return Triangle{size_}; }
  Triangles arrays() const { return arrays_; }

  // The new triangle's edges have no neighbours yet.
  Triangle add(Vertex a, Vertex b, Vertex c) {
    if (size_ == capacity_) enlarge(std::int64_t{2} * capacity_);
    const std::size_t at = entry_of(next(), 0);
    arrays_.corners[at] = number(a);
    arrays_.corners[at + 1] = number(b);
    arrays_.corners[at + 2] = number(c);
    std::fill_n(arrays_.neighbors + at, 3, kUnknownNeighbor);
    return Triangle{size_++};
  }

  // Two half-edges are the sides of one edge; one of them may be the outside or unknown.
  void join(HalfEdge a, HalfEdge b) {
    if (a == kNoHalfEdge || b == kNoHalfEdge) return;
    if (a != kOutside) arrays_.neighbors[entry_of(a)] = neighbor_at(b);
    if (b != kOutside) arrays_.neighbors[entry_of(b)] = neighbor_at(a);
  }

 private:
  static std::int32_t neighbor_at(HalfEdge beyond) {
    return beyond == kOutside ? kNoNeighbor : index_of(triangle_of(beyond));
  }

  void enlarge(std::int64_t capacity) {
    StreamedArray<std::int32_t> corners = streamed_array<std::int32_t>(3 * capacity);
    StreamedArray<std::int32_t> neighbors = streamed_array<std::int32_t>(3 * capacity);
    std::copy_n(arrays_.corners, std::size_t{3} * size_, corners.get());
    std::copy_n(arrays_.neighbors, std::size_t{3} * size_, neighbors.get());
    corners_ = std::move(corners);
    neighbors_ = std::move(neighbors);
    arrays_ = {corners_.get(), neighbors_.get()};
    capacity_ = static_cast<std::uint32_t>(capacity);
  }

  StreamedArray<std::int32_t> corners_, neighbors_;
  Triangles arrays_{nullptr, nullptr};
  std::uint32_t capacity_ = 0;
  std::uint32_t size_ = 0;
};

}  // namespace tinsmith
