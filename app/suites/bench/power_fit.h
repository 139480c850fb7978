// Power laws through measured points.
#pragma once

#include <cstddef>
#include <span>
#include <utility>

namespace icloth {

/// y = factor · x^exponent, by least squares of the logarithms.
struct PowerFit {
  double exponent = 0, factor = 0;
  double first = 0, last = 0;  ///< smallest and largest x that took part
  double worst = 1;            ///< largest ratio of a point to the law, or of the law to a point
  std::size_t points = 0;

  bool valid() const { return points > 0; }
};

/// Fits the points that are positive and finite in both coordinates. The fit has no points where
/// fewer than two different x are left.
PowerFit fit_power(std::span<const std::pair<double, double>> points);

}  // namespace icloth
