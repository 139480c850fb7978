#include "render/image.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "sim/files/error.h"

namespace icloth {
namespace {

/// A gradient, so that the picture is not blank.
Image picture() {
  Image image(100, 80);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      std::uint8_t* p = image.at(x, y);
      p[0] = static_cast<std::uint8_t>(x);
      p[1] = static_cast<std::uint8_t>(y);
      p[2] = 40;
      p[3] = 255;
    }
  }
  return image;
}

void brighten(Image& image, int left, int top, int width, int height, int by) {
  for (int y = top; y < top + height; ++y)
    for (int x = left; x < left + width; ++x)
      image.at(x, y)[2] = static_cast<std::uint8_t>(image.at(x, y)[2] + by);
}

std::string temporary(const std::string& name) {
  return (std::filesystem::temp_directory_path() / ("icloth_image_test_" + name)).string();
}

TEST(Image, PngKeepsEveryByte) {
  const std::string path = temporary("a.png");
  Image image = picture();
  image.at(3, 5)[3] = 17;
  write_png(path, image);
  const Image read = read_png(path);
  EXPECT_EQ(read.width, image.width);
  EXPECT_EQ(read.height, image.height);
  EXPECT_EQ(read.pixels, image.pixels);
  std::filesystem::remove(path);
}

TEST(Image, BadFilesAreInputErrors) {
  EXPECT_THROW(read_png(temporary("missing.png")), InputError);
  EXPECT_THROW(write_png(temporary("no/such/folder.png"), picture()), InputError);
  EXPECT_THROW(write_png(temporary("empty.png"), Image()), InputError);
  const std::string path = temporary("cut.png");
  write_png(path, picture());
  std::filesystem::resize_file(path, 60);
  EXPECT_THROW(read_png(path), InputError);
  std::ofstream(path) << "no picture at all";
  EXPECT_THROW(read_png(path), InputError);
  std::filesystem::remove(path);
}

TEST(Image, SizesThatTakeTooMuchMemoryAreRefused) {
  // The head of a PNG file has its width and height at byte 16; no pixel has to follow.
  const std::string path = temporary("large.png");
  write_png(path, picture());
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(16);
  file.write("\0\0\x1f\x41\0\0\x1f\x40", 8);  // 8001 x 8000
  file.close();
  try {
    read_png(path);
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("8001 x 8000 pixels"), std::string::npos)
        << error.what();
  }
  std::filesystem::remove(path);
}

TEST(Compare, EqualPicturesAreAccepted) {
  const ImageDifference difference = compare(picture(), picture());
  EXPECT_TRUE(difference.accepted({}));
  EXPECT_EQ(difference.fraction, 0);
  EXPECT_EQ(difference.largest_blob, 0);
}

TEST(Compare, SmallStepsDoNotCount) {
  Image image = picture();
  brighten(image, 0, 0, 100, 80, 4);
  EXPECT_TRUE(compare(image, picture()).accepted({}));
  brighten(image, 0, 0, 100, 80, 1);
  const ImageDifference difference = compare(image, picture());
  EXPECT_FALSE(difference.accepted({}));
  EXPECT_EQ(difference.fraction, 1);
  EXPECT_EQ(difference.largest_channel, 5);
}

TEST(Compare, ScatteredPixelsUpToTheShare) {
  Image image = picture();  // 8000 pixels: 24 are 0.3 %
  for (int k = 0; k < 24; ++k) brighten(image, 4 * k, 10, 1, 1, 100);
  EXPECT_TRUE(compare(image, picture()).accepted({}));
  EXPECT_EQ(compare(image, picture()).largest_blob, 1);
  brighten(image, 0, 40, 1, 1, 100);
  EXPECT_FALSE(compare(image, picture()).accepted({}));
}

TEST(Compare, OneBlobIsRefusedWhereTheShareIsNot) {
  const ImageTolerance tolerance{.fraction = 0.5};
  Image image = picture();
  brighten(image, 20, 20, 12, 4, 60);
  EXPECT_EQ(compare(image, picture(), tolerance).largest_blob, 48);
  EXPECT_TRUE(compare(image, picture(), tolerance).accepted(tolerance));
  brighten(image, 32, 24, 1, 1, 60);  // touches by a corner
  EXPECT_EQ(compare(image, picture(), tolerance).largest_blob, 49);
  EXPECT_FALSE(compare(image, picture(), tolerance).accepted(tolerance));
}

TEST(Compare, OtherSizesAndBlankPicturesAreRefused) {
  EXPECT_FALSE(compare(Image(100, 79), picture()).accepted({}));
  Image blank(100, 80);
  const ImageDifference difference = compare(blank, blank);
  EXPECT_TRUE(difference.blank);
  EXPECT_FALSE(difference.accepted({}));
}

TEST(Compare, DifferenceIsAmplified) {
  Image image = picture();
  brighten(image, 1, 1, 1, 1, 3);
  brighten(image, 2, 1, 1, 1, 30);
  const Image difference = difference_image(image, picture());
  EXPECT_EQ(difference.at(1, 1)[2], 48);
  EXPECT_EQ(difference.at(2, 1)[2], 255);
  EXPECT_EQ(difference.at(5, 5)[2], 0);
  EXPECT_EQ(difference.at(5, 5)[3], 255);
}

}  // namespace
}  // namespace icloth
