// Triangles cut into cells along fall lines.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace tinsmith::hydrology {

// Of each triangle to be cut: the ends of its base and the corner opposite, and which of the places
// lie on its edges base, start to apex, and apex to end.
//
//              apex
//             .    .             a cut goes from a vertex of the base to one of
//         [1] .  |   . [2]       the other two edges; cuts are sorted along them
//           .    |     .
//       start ---|---- end
//               [0]
struct CutTriangles {
  std::size_t count;
  const std::int32_t* corners;  // three each: start, end, apex
  const std::int64_t* ranges;   // six each: of places on each edge, from its smaller vertex on
  std::int32_t first_place;     // the vertex that place 0 is
  const std::int64_t* offsets;  // of the cuts of each, and the end of the last
  const std::int32_t* lower;    // of cuts: on the base
  const std::int32_t* upper;    // on the other edges
};

struct CutCells {
  std::vector<std::int64_t> numbers;  // with every cell counted, those without an area, too
  std::vector<std::int64_t> offsets{0};
  std::vector<std::int32_t> vertices;
};

class CellCutter {
 public:
  explicit CellCutter(const CutTriangles& given) : given_(given) {}

  // Throws invalid_argument if a cut does not end on the edges of its triangle.
  CutCells run() {
    for (std::size_t i = 0; i < given_.count; ++i) {
      walk_around(i);
      cut(i);
    }
    return std::move(cells_);
  }

 private:
  using Chain = std::vector<std::int32_t>;

  // The vertices of the base, and those of the other edges, both from its start on.
  void walk_around(std::size_t i) {
    const std::int32_t start = given_.corners[3 * i], end = given_.corners[3 * i + 1];
    const std::int32_t apex = given_.corners[3 * i + 2];
    const std::int64_t* const ranges = given_.ranges + 6 * i;
    below_.clear();
    above_.clear();
    walk_edge(start, end, ranges, below_);
    walk_edge(start, apex, ranges + 2, above_);
    walk_edge(apex, end, ranges + 4, above_);
    below_.push_back(end);
    above_.push_back(end);
  }

  void walk_edge(std::int32_t start, std::int32_t end, const std::int64_t* range,
                 Chain& chain) const {
    chain.push_back(start);
    const std::size_t first = chain.size();
    for (std::int64_t i = range[0]; i < range[1]; ++i) {
      chain.push_back(given_.first_place + static_cast<std::int32_t>(i));
    }
    if (start > end) std::reverse(chain.begin() + static_cast<std::ptrdiff_t>(first), chain.end());
  }

  void cut(std::size_t i) {
    std::size_t low = 0, high = 0;
    for (std::int64_t k = given_.offsets[i]; k < given_.offsets[i + 1]; ++k) {
      const std::size_t to_low = find(below_, low, given_.lower[k]);
      const std::size_t to_high = find(above_, high, given_.upper[k]);
      add_cell(low, to_low, high, to_high);
      low = to_low;
      high = to_high;
    }
    add_cell(low, below_.size() - 1, high, above_.size() - 1);
  }

  // Where a vertex stands in a chain, not before `from`.
  static std::size_t find(const Chain& chain, std::size_t from, std::int32_t vertex) {
    const auto begin = chain.begin() + static_cast<std::ptrdiff_t>(from);
    const auto found = std::find(begin, chain.end(), vertex);
    if (found != chain.end()) return static_cast<std::size_t>(found - chain.begin());
    if (std::find(chain.begin(), begin, vertex) != begin) return from;
    throw std::invalid_argument("a cut must end on the edges of its triangle");
  }

  // Both chains have the ends of the base alone in common.
  void add_cell(std::size_t low, std::size_t to_low, std::size_t high, std::size_t to_high) {
    const std::int64_t number = next_++;
    const std::size_t begin = cells_.vertices.size();
    for (std::size_t i = low; i <= to_low; ++i) cells_.vertices.push_back(below_[i]);
    for (std::size_t j = to_high + 1; j-- > high;) {
      if (above_[j] == below_[low] || above_[j] == below_[to_low]) continue;
      cells_.vertices.push_back(above_[j]);
    }
    if (cells_.vertices.size() - begin < 3) {
      cells_.vertices.resize(begin);
      return;
    }
    cells_.numbers.push_back(number);
    cells_.offsets.push_back(static_cast<std::int64_t>(cells_.vertices.size()));
  }

  const CutTriangles& given_;
  CutCells cells_;
  Chain below_, above_;
  std::int64_t next_ = 0;
};

}  // namespace tinsmith::hydrology
