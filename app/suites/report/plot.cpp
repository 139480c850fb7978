#include "app/suites/report/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/suites/report/table.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr double kWidth = 760, kHeight = 360, kLeft = 70, kRight = 190, kTop = 36, kBottom = 52;
// These are Okabe and Ito's colours, told apart by people with any colour vision.
constexpr const char* kColours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                    "#E69F00", "#56B4E9", "#000000"};

std::string format(const char* pattern, double a, double b = 0, double c = 0, double d = 0) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, a, b, c, d);
  return text;
}

/// One axis: it maps values to places between 0 and 1.
class Axis {
 public:
  explicit Axis(bool logarithmic) : log_(logarithmic) {}

  bool usable(double value) const { return std::isfinite(value) && (!log_ || value > 0); }
  /// Extends the axis to a value.
  void cover(double value) {
    if (!usable(value)) return;
    low_ = std::min(low_, map(value));
    high_ = std::max(high_, map(value));
  }
  /// Ends the axis at round numbers. It starts at zero where that costs little room.
  void finish() {
    if (low_ > high_) {
      low_ = 0;
      high_ = 1;
    }
    if (!log_ && low_ > 0 && low_ < 0.5 * high_) low_ = 0;
    if (high_ - low_ < 1e-12 * std::max(1.0, std::fabs(high_))) {
      low_ -= 0.5;
      high_ += 0.5;
    }
    step_ = log_ ? std::max(1.0, std::ceil((high_ - low_) / 6)) : nice((high_ - low_) / 5);
    low_ = step_ * std::floor(low_ / step_ + 1e-9);
    high_ = step_ * std::ceil(high_ / step_ - 1e-9);
  }
  double place(double value) const { return (map(value) - low_) / (high_ - low_); }
  std::vector<double> ticks() const {
    std::vector<double> values;
    for (double t = low_; t <= high_ + 0.5 * step_; t += step_) {
      const double rounded = std::fabs(t) < 1e-9 * step_ ? 0 : t;
      values.push_back(log_ ? std::pow(10.0, rounded) : rounded);
    }
    return values;
  }

 private:
  double map(double value) const { return log_ ? std::log10(value) : value; }
  /// The smallest of 1, 2 and 5 times a power of ten that is at least `step`.
  static double nice(double step) {
    const double power = std::pow(10.0, std::floor(std::log10(step)));
    for (const double factor : {1.0, 2.0, 5.0})
      if (factor * power >= step) return factor * power;
    return 10 * power;
  }

  bool log_;
  double low_ = 1e300, high_ = -1e300, step_ = 1;
};

double to_x(double place) { return kLeft + place * (kWidth - kLeft - kRight); }
double to_y(double place) { return kHeight - kBottom - place * (kHeight - kTop - kBottom); }

std::string label(double x, double y, const char* style, const std::string& text) {
  return format("<text x=\"%.1f\" y=\"%.1f\" ", x, y) + style + ">" + markup_text(text) +
         "</text>\n";
}

/// The lines of the grid with their numbers.
std::string grid(const Axis& x, const Axis& y) {
  std::string out;
  const char* line = "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n";
  for (const double t : x.ticks()) {
    out += format(line, to_x(x.place(t)), to_y(0), to_x(x.place(t)), to_y(1));
    out += label(to_x(x.place(t)), to_y(0) + 16, "text-anchor=\"middle\"", format_number(t));
  }
  for (const double t : y.ticks()) {
    out += format(line, to_x(0), to_y(y.place(t)), to_x(1), to_y(y.place(t)));
    out += label(to_x(0) - 6, to_y(y.place(t)) + 4, "text-anchor=\"end\"", format_number(t));
  }
  return out;
}

}  // namespace

std::string Plot::svg() const {
  // The axes cover all points that can be drawn.
  Axis x(log_x), y(log_y);
  for (const Series& s : series)
    for (const auto& [px, py] : s.points)
      if (x.usable(px) && y.usable(py)) x.cover(px), y.cover(py);
  x.finish();
  y.finish();

  // The frame and the grid are drawn first, below the data.
  std::string out = format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n",
      kWidth, kHeight);
  out += format("<rect width=\"%.0f\" height=\"%.0f\" fill=\"white\"/>\n", kWidth, kHeight);
  out += grid(x, y);

  // Each series is a path with its dots, and a line in the legend.
  for (std::size_t k = 0; k < series.size(); ++k) {
    const std::string colour = kColours[k % std::size(kColours)];
    std::string path, dots;

    for (const auto& [px, py] : series[k].points) {
      if (!x.usable(px) || !y.usable(py)) continue;
      const double at_x = to_x(x.place(px)), at_y = to_y(y.place(py));
      path += format(path.empty() ? "M%.1f %.1f" : "L%.1f %.1f", at_x, at_y);
      if (markers)
        dots += format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"", at_x, at_y) + colour +
                "\"/>\n";
    }

    if (!series[k].line) path.clear();
    out += "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + colour +
           "\" stroke-width=\"1.5\"/>\n" + dots;

    // The legend lists the series from the top.
    const double row = kTop + 14 + 16 * static_cast<double>(k);
    out += format("<rect x=\"%.1f\" y=\"%.1f\" width=\"12\" height=\"3\" fill=\"", kWidth - 180,
                  row - 5) +
           colour + "\"/>\n";
    out += label(kWidth - 162, row, "text-anchor=\"start\"", series[k].name);
  }

  // The title and the names of the axes stand around the frame.
  out += label(to_x(0.5), 20, "text-anchor=\"middle\" font-size=\"14\"", title);
  out += label(to_x(0.5), kHeight - 12, "text-anchor=\"middle\"", x_label);
  out += "<g transform=\"translate(16," + format("%.1f", kHeight / 2) + ") rotate(-90)\">" +
         label(0, 0, "text-anchor=\"middle\"", y_label) + "</g>\n";
  return out + "</svg>\n";
}

}  // namespace icloth
