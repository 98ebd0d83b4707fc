// Numbers of rows, vertices, triangles and edges: types that cannot be mixed up.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tinsmith {

// A row of the caller's input.
enum class Row : std::int32_t {};

// A vertex. Growth numbers them in the sweep order, the order in which they are finished;
// insertion along its curve; a mesh that can be changed in the order in which they came.
enum class Vertex : std::int32_t {};

enum class Triangle : std::uint32_t {};

// A segment of the caller's lines, in the order in which they were given.
enum class Segment : std::int32_t {};

// An edge as seen from one triangle: 4 * triangle + number of the corner opposite the edge. It is
// directed with that triangle on its left. So half-edges are the corners of a corner table
// (Rossignac, Safonova and Szymczak, "3D compression made simple: Edgebreaker on a corner table",
// 2001), with a number to spare for each triangle.
//
//              corner 2
//              .      .
//      edge 1 .        . edge 0
//            .          .
//      corner 0 ..edge 2.. corner 1
enum class HalfEdge : std::uint32_t {};

constexpr Vertex kNoVertex{-1};
constexpr Triangle kNoTriangle{UINT32_MAX};
constexpr HalfEdge kNoHalfEdge{UINT32_MAX};   // not known (yet)
constexpr HalfEdge kOutside{UINT32_MAX - 1};  // beyond the hull

// In arrays of neighbours, three a triangle.
constexpr std::int32_t kNoNeighbor = -1;
constexpr std::int32_t kUnknownNeighbor = -2;  // not known (yet)

// 2n triangles, three entries each, must fit in 31 bits; then their half-edges fit in 32.
constexpr std::int64_t kMostPoints = INT32_MAX / 6;
static_assert(4 * 2 * kMostPoints + 3 < UINT32_MAX - 1, "the last half-edge is no special one");

constexpr std::int32_t number(Row row) { return static_cast<std::int32_t>(row); }
constexpr std::int32_t number(Vertex v) { return static_cast<std::int32_t>(v); }
constexpr std::int32_t number(Segment s) { return static_cast<std::int32_t>(s); }
constexpr std::uint32_t number(Triangle t) { return static_cast<std::uint32_t>(t); }
constexpr std::uint32_t number(HalfEdge e) { return static_cast<std::uint32_t>(e); }

// As arrays of triangles hold them: kNoTriangle as kNoNeighbor.
constexpr std::int32_t index_of(Triangle t) { return static_cast<std::int32_t>(number(t)); }
constexpr Triangle triangle_numbered(std::int64_t index) {
  return Triangle{static_cast<std::uint32_t>(index)};
}
static_assert(index_of(kNoTriangle) == kNoNeighbor);

constexpr HalfEdge half_edge(Triangle triangle, std::uint32_t corner) {
  return HalfEdge{4 * number(triangle) + corner};
}
constexpr Triangle triangle_of(HalfEdge e) { return Triangle{number(e) >> 2}; }
constexpr std::uint32_t corner_of(HalfEdge e) { return number(e) & 3; }
constexpr std::uint32_t kNoCorner = 3;

// The corners 1, 2, 0 and 2, 0, 1 as digits of a number: a branch on the corner would be guessed
// wrongly half of the time.
constexpr std::uint32_t corner_after(std::uint32_t corner) { return (0x09u >> (2 * corner)) & 3; }
constexpr std::uint32_t corner_before(std::uint32_t corner) { return (0x12u >> (2 * corner)) & 3; }

// Where a half-edge stands in flat arrays of three entries a triangle.
constexpr std::size_t entry_of(Triangle triangle, std::uint32_t corner) {
  return std::size_t{3} * number(triangle) + corner;
}
constexpr std::size_t entry_of(HalfEdge e) { return entry_of(triangle_of(e), corner_of(e)); }
constexpr HalfEdge half_edge_at(std::size_t entry) {
  return half_edge(triangle_numbered(static_cast<std::int64_t>(entry / 3)),
                   static_cast<std::uint32_t>(entry % 3));
}

// for (const Id id : Ids<Id>(count)), from 0 on, or from `first` up to but without `beyond`
template <typename Id>
class Ids {
 public:
  using Number = decltype(number(Id{}));

  class Iterator {
   public:
    constexpr explicit Iterator(Number at) : at_(at) {}
    constexpr Id operator*() const { return Id{at_}; }
    constexpr Iterator& operator++() {
      ++at_;
      return *this;
    }
    constexpr bool operator!=(Iterator other) const { return at_ != other.at_; }

   private:
    Number at_;
  };

  constexpr explicit Ids(Number count) : Ids(0, count) {}
  constexpr Ids(Number first, Number beyond) : first_(first), beyond_(beyond) {}
  constexpr Iterator begin() const { return Iterator(first_); }
  constexpr Iterator end() const { return Iterator(beyond_); }

 private:
  Number first_, beyond_;
};

// for (const HalfEdge e : half_edges(triangle))
constexpr Ids<HalfEdge> half_edges(Triangle triangle) {
  const std::uint32_t first = 4 * number(triangle);
  return {first, first + 3};
}

}  // namespace tinsmith
