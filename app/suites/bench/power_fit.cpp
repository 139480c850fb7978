#include "app/suites/bench/power_fit.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace icloth {

PowerFit fit_power(std::span<const std::pair<double, double>> points) {
  std::vector<std::pair<double, double>> logs;
  double mean_x = 0, mean_y = 0;
  for (const auto& [x, y] : points) {
    if (!(x > 0 && y > 0) || !std::isfinite(x) || !std::isfinite(y)) continue;
    logs.emplace_back(std::log(x), std::log(y));
    mean_x += logs.back().first;
    mean_y += logs.back().second;
  }
  const auto count = static_cast<double>(logs.size());
  if (logs.size() < 2) return {};
  mean_x /= count;
  mean_y /= count;

  // The slope of the straight line through the logarithms is the exponent.
  double spread = 0, common = 0;
  for (const auto& [x, y] : logs) {
    spread += (x - mean_x) * (x - mean_x);
    common += (x - mean_x) * (y - mean_y);
  }
  const auto [least, most] = std::ranges::minmax_element(logs);
  if (!(most->first - least->first > 1e-12)) return {};
  PowerFit fit;
  fit.exponent = common / spread;
  fit.factor = std::exp(mean_y - fit.exponent * mean_x);
  fit.first = std::exp(least->first);
  fit.last = std::exp(most->first);
  fit.points = logs.size();

  // How well the law holds is told by its worst point.
  double worst = 0;
  for (const auto& [x, y] : logs)
    worst = std::max(worst, std::fabs(y - mean_y - fit.exponent * (x - mean_x)));
  fit.worst = std::exp(worst);
  return fit;
}

}  // namespace icloth
