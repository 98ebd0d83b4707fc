// Index types that cannot be mixed up.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tinsmith {

// A row of the caller's input.
enum class Row : std::int32_t {};

// A position in the sweep order: the order in which vertices are finished.
enum class Vertex : std::int32_t {};

// An edge as seen from one triangle: 3 * triangle + corner opposite the edge.
//
//              corner 2
//              .      .
//      edge 1 .        . edge 0
//            .          .
//      corner 0 ..edge 2.. corner 1
enum class HalfEdge : std::int32_t {};

constexpr Vertex kNoVertex{-1};
constexpr HalfEdge kOutside{-1};    // beyond the hull
constexpr HalfEdge kNoHalfEdge{-2};  // not known (yet)
constexpr std::int32_t kNoNeighbor = -1;
constexpr std::int32_t kUnknownNeighbor = -2;  // not known (yet)

// 2n triangles, three half-edges each, must fit in 31 bits.
constexpr std::int64_t kMostPoints = INT32_MAX / 6;

constexpr std::int32_t number(Row row) { return static_cast<std::int32_t>(row); }
constexpr std::int32_t number(Vertex v) { return static_cast<std::int32_t>(v); }
constexpr std::int32_t number(HalfEdge e) { return static_cast<std::int32_t>(e); }

constexpr HalfEdge half_edge(std::int32_t triangle, std::int32_t corner) {
  return static_cast<HalfEdge>(3 * triangle + corner);
}

}  // namespace tinsmith
