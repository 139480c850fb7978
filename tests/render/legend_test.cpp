// The legend of a coloured view.
#include "render/legend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace icloth {
namespace {

TEST(Legend, IsOfTheViewsWhoseColoursHaveAMeaning) {
  EXPECT_FALSE(legend_of(ViewMode::shaded, 0.1));
  EXPECT_FALSE(legend_of(ViewMode::wireframe, 0.1));
  const auto legend = legend_of(ViewMode::strain, 0.1);
  ASSERT_TRUE(legend);
  EXPECT_EQ(legend->marks, (std::vector<std::string>{"0 %", "5 %", "10 % or more"}));
}

TEST(Legend, HasTheColoursOfTheShader) {
  std::ifstream file(std::string(ICLOTH_TEST_FOLDER) + "/../render/shaders/mesh.frag.glsl");
  const std::string shader{std::istreambuf_iterator<char>(file), {}};
  for (const char* stop : {"0.09, 0.13, 0.30", "0.05, 0.34, 0.46", "0.25, 0.58, 0.26",
                           "0.93, 0.71, 0.10", "0.80, 0.07, 0.04"})
    EXPECT_NE(shader.find(stop), std::string::npos) << stop;
  EXPECT_EQ(scale_colour(0), scale_stops().front());
  EXPECT_EQ(scale_colour(0.5), scale_stops()[2]);
  EXPECT_EQ(scale_colour(7), scale_stops().back());
}

TEST(Legend, IsDrawnIntoTheCornerAlone) {
  Image image(640, 480);
  for (std::uint8_t& byte : image.pixels) byte = 255;
  const Image before = image;
  draw_legend(*legend_of(ViewMode::strain, 0.1), image);

  // The scale goes from its first colour on the left to its last one on the right.
  const auto near = [&](const std::uint8_t* pixel, std::size_t stop) {
    for (std::size_t c = 0; c < 3; ++c)
      if (std::abs(pixel[c] - scale_stops()[stop][c]) > 4) return false;
    return true;
  };
  int first = image.width, last = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (near(image.at(x, y), 0)) first = std::min(first, x);
      if (near(image.at(x, y), 4)) last = std::max(last, x);
      if (x < 260 && y > 390) continue;
      ASSERT_TRUE(std::equal(image.at(x, y), image.at(x, y) + 4, before.at(x, y)))
          << x << ", " << y;
    }
  }
  EXPECT_LT(first, 30);
  EXPECT_GT(last, 200);

  // A picture smaller than the legend takes what fits.
  Image small(20, 10);
  draw_legend(*legend_of(ViewMode::strain, 0.1), small);
  EXPECT_EQ(small.width, 20);
}

}  // namespace
}  // namespace icloth
