#include "render/legend.h"

#include <stb/stb_easy_font.h>

#include <algorithm>
#include <cmath>

#include "sim/files/text.h"

namespace icloth {
namespace {

/// The linear colours of mesh.frag.glsl.
constexpr double kStops[5][3] = {{0.09, 0.13, 0.30},
                                 {0.05, 0.34, 0.46},
                                 {0.25, 0.58, 0.26},
                                 {0.93, 0.71, 0.10},
                                 {0.80, 0.07, 0.04}};

constexpr int kText[3] = {235, 235, 235};

std::uint8_t to_srgb(double linear) {
  const double s = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(s, 0., 1.)));
}

/// Pixels of a picture, of which those outside are left out.
struct Canvas {
  Image& image;

  void mix(int x, int y, const int colour[3], double share) {
    if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
    std::uint8_t* pixel = image.at(x, y);
    for (int c = 0; c < 3; ++c)
      pixel[c] = static_cast<std::uint8_t>(std::lround(pixel[c] + share * (colour[c] - pixel[c])));
  }
  void rectangle(int x, int y, int width, int height, const int colour[3], double share) {
    for (int j = y; j < y + height; ++j)
      for (int i = x; i < x + width; ++i) mix(i, j, colour, share);
  }

  /// Letters of `size` pixels a dot, from their upper left corner.
  void text(std::string words, int x, int y, int size) {
    struct Corner {
      float x, y, z;
      unsigned char colour[4];
    };
    std::vector<Corner> corners(4 * 64 * (words.size() + 1));
    const int quads = stb_easy_font_print(0, 0, words.data(), nullptr, corners.data(),
                                          static_cast<int>(corners.size() * sizeof(Corner)));
    for (std::size_t q = 0; q < static_cast<std::size_t>(quads); ++q) {
      const Corner &low = corners[4 * q], &high = corners[4 * q + 2];
      const auto at = [&](float dots) { return size * static_cast<int>(std::lround(dots)); };
      rectangle(x + at(low.x), y + at(low.y), at(high.x - low.x), at(high.y - low.y), kText, 1);
    }
  }
};

int width_of(std::string words) { return stb_easy_font_width(words.data()); }

}  // namespace

std::optional<Legend> legend_of(ViewMode view, double strain_range) {
  if (view != ViewMode::strain) return std::nullopt;
  const auto percent = [&](double share) {
    return rounded_text(100 * share * strain_range) + " %";
  };
  return Legend{"largest strain of a face", {percent(0), percent(0.5), percent(1) + " or more"}};
}

std::array<std::array<std::uint8_t, 3>, 5> scale_stops() {
  std::array<std::array<std::uint8_t, 3>, 5> stops;
  for (std::size_t k = 0; k < stops.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c) stops[k][c] = to_srgb(kStops[k][c]);
  return stops;
}

std::array<std::uint8_t, 3> scale_colour(double share) {
  const double x = 4 * std::clamp(share, 0., 1.);
  const int i = std::min(static_cast<int>(x), 3);
  std::array<std::uint8_t, 3> colour{};
  for (std::size_t c = 0; c < 3; ++c)
    colour[c] = to_srgb(kStops[i][c] + (x - i) * (kStops[i + 1][c] - kStops[i][c]));
  return colour;
}

void draw_legend(const Legend& legend, Image& image) {
  // All sizes are in dots of the letters, which get larger with the picture.
  const int dot = std::max(1, image.height / 600);
  constexpr int kMargin = 8, kLine = 12, kBar = 8, kWidth = 210;
  const int left = 2 * kMargin * dot;
  const int top = image.height - (3 * kMargin + 2 * kLine + kBar) * dot;
  Canvas canvas{image};
  constexpr int kShade[3] = {20, 22, 26};
  canvas.rectangle(left - kMargin * dot, top - kMargin * dot, (kWidth + 2 * kMargin) * dot,
                   (2 * kMargin + 2 * kLine + kBar - 2) * dot, kShade, 0.75);

  // The title, the scale, and its marks: the first at the left end, the last at the right end.
  canvas.text(legend.title, left, top, dot);
  for (int x = 0; x < kWidth * dot; ++x) {
    const auto colour = scale_colour((x + 0.5) / (kWidth * dot));
    const int bytes[3] = {colour[0], colour[1], colour[2]};
    canvas.rectangle(left + x, top + kLine * dot, 1, kBar * dot, bytes, 1);
  }
  const auto count = static_cast<int>(legend.marks.size());
  for (int k = 0; k < count; ++k) {
    const std::string& mark = legend.marks[static_cast<std::size_t>(k)];
    const int spare = kWidth - width_of(mark);
    const int shift = k == 0           ? 0
                      : k + 1 == count ? spare
                                       : kWidth * k / (count - 1) - width_of(mark) / 2;
    canvas.text(mark, left + shift * dot, top + (kLine + kBar + 4) * dot, dot);
  }
}

}  // namespace icloth
