// What the colours of a view mean: for pictures as pixels, for the window as numbers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace icloth {

struct Legend {
  std::string title;
  std::vector<std::string> marks;  ///< along the scale at equal distances, its ends among them
};

/// The legend of a view; none where colours are those of the fabric. `strain_range`: see Frame.
std::optional<Legend> legend_of(ViewMode view, double strain_range);

/// Colours of the scale at equal distances, in sRGB; those of mesh.frag.glsl.
std::array<std::array<std::uint8_t, 3>, 5> scale_stops();
/// The colour at a share of the scale, 0 … 1, mixed as light is.
std::array<std::uint8_t, 3> scale_colour(double share);

/// Draws the legend into the lower left corner of a picture, in a size that suits the picture.
void draw_legend(const Legend& legend, Image& image);

}  // namespace icloth
