// A plot of results as SVG: lines or points over linear or logarithmic axes.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace icloth {

/// One line of a plot.
struct Series {
  std::string name;
  std::vector<std::pair<double, double>>
      points;        ///< (x, y); those that cannot be drawn are left out
  bool line = true;  ///< joins them in their order
};

/// A plot with its axes.
struct Plot {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  bool markers = false;  ///< a dot at every point
  std::vector<Series> series;

  /// The plot as a stand-alone <svg> element.
  std::string svg() const;
};

}  // namespace icloth
