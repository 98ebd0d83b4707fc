// What the border to Python shares: array types, handing arrays over, asking for signals.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/arrays.hpp"
#include "base/ids.hpp"
#include "index/grid.hpp"

namespace tinsmith::python {

namespace nb = nanobind;
using namespace nb::literals;

using Points = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Places = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Corners = nb::ndarray<nb::numpy, std::int32_t, nb::shape<-1, 3>>;
using Rows = nb::ndarray<nb::numpy, double, nb::shape<-1, 3>>;
using Numbers = nb::ndarray<nb::numpy, std::int32_t, nb::shape<-1>>;
using Heights = nb::ndarray<nb::numpy, double, nb::shape<-1>>;
using Signs = nb::ndarray<nb::numpy, std::int8_t, nb::shape<-1>>;

template <typename Array, typename T>
Array hand_over(StreamedArray<T> data, std::initializer_list<std::size_t> shape) {
  T* raw = data.release();
  nb::capsule owner(raw, [](void* p) noexcept { FreeMemory()(p); });
  return Array(raw, shape, owner);
}

inline Numbers hand_over(const std::vector<std::int32_t>& values) {
  auto data = streamed_array<std::int32_t>(values.size());
  // No bytes are to be copied from no address either: that is undefined.
  if (!values.empty()) {
    std::memcpy(data.get(), values.data(), values.size() * sizeof(std::int32_t));
  }
  return hand_over<Numbers>(std::move(data), {values.size()});
}

inline PointRows rows_of(const Points& points) {
  const auto count = static_cast<std::int64_t>(points.shape(0));
  if (count == 0) throw std::invalid_argument("at least one point is needed");
  if (count > kMostPoints) {
    throw std::invalid_argument("more points than 32-bit indices can number");
  }
  return {points.data(), count, 3};
}

// Ask Python whether Ctrl-C was pressed.
inline bool no_signal() {
  nb::gil_scoped_acquire gil;
  return PyErr_CheckSignals() == 0;
}

}  // namespace tinsmith::python
