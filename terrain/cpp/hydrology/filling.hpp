// The water of full depressions, as terrain/hydrology/filling.py finds it.
#pragma once

#include <cstdint>
#include <tuple>

#include "../../../tin/cpp/base/ids.hpp"

namespace tinsmith::hydrology {

// Of vertices; null pointers where nothing is filled.
struct Filling {
  const double* levels = nullptr;
  const std::int64_t* ponds = nullptr;
  const std::int64_t* nexts = nullptr;
  const std::int64_t* steps = nullptr;
  const std::int64_t* ranks = nullptr;

  bool is_there() const { return levels != nullptr; }
  double level(Vertex v) const { return levels[number(v)]; }
  bool is_under_water(Vertex v) const { return ponds[number(v)] >= 0; }
  Vertex next(Vertex v) const { return Vertex{static_cast<std::int32_t>(nexts[number(v)])}; }

  // Of two vertices of one level that with the shortest way; under water if any is.
  Vertex choose_way(Vertex one, Vertex other) const { return key(other) < key(one) ? other : one; }

 private:
  std::tuple<bool, std::int64_t, std::int64_t> key(Vertex v) const {
    return {!is_under_water(v), steps[number(v)], ranks[number(v)]};
  }
};

}  // namespace tinsmith::hydrology
