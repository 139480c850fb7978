// The usual length of an edge, by which thickness and distances are judged.
#pragma once

#include <algorithm>
#include <vector>

#include "kernels/index.h"
#include "sim/files/mesh.h"

namespace icloth {

/// The upper median of values; 0 of none.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Appends the lengths of the sides of all faces; an edge of two faces counts twice.
inline void add_side_lengths(const std::vector<Triangle>& faces,
                             const std::vector<Vec3d>& positions, std::vector<double>& lengths) {
  for (const Triangle& t : faces)
    for (std::size_t c = 0; c < 3; ++c)
      lengths.push_back(norm(positions[at(t[(c + 1) % 3])] - positions[at(t[c])]));
}

}  // namespace icloth
