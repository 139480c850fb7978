// Pictures in memory, as PNG files, and compared with each other.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace icloth {

/// 8-bit sRGB with alpha, rows from top to bottom.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  ///< RGBA (height)(width)(4)

  Image() = default;
  Image(int image_width, int image_height);

  std::uint8_t* at(int x, int y) { return &pixels[index(x, y)]; }
  const std::uint8_t* at(int x, int y) const { return &pixels[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(x));
  }
};

/// Writes a PNG file. Throws InputError when it cannot be written.
void write_png(const std::string& path, const Image& image);
/// Reads a PNG file. Throws InputError when it is missing, is no PNG, or has more than 64 million
/// pixels.
Image read_png(const std::string& path);

/// The differences with which two pictures still count as the same. The defaults suit one software
/// rasteriser on processors of different makers.
struct ImageTolerance {
  int channel = 4;          ///< difference of a channel that counts [1/255]
  double fraction = 0.003;  ///< largest share of the pixels with such a channel
  int blob_channel = 32;    ///< difference of a channel that is seen [1/255]
  int blob_pixels = 48;     ///< largest connected (8 neighbours) set of such pixels
};

/// A tolerance that users choose by its name.
struct NamedTolerance {
  std::string_view name;
  ImageTolerance tolerance;
};
inline constexpr NamedTolerance kTolerances[] = {
    {"exact", {.channel = 0, .fraction = 0, .blob_channel = 0, .blob_pixels = 0}},
    {"software", {}},                                     ///< one rasteriser, other processors
    {"device", {.fraction = 0.015, .blob_pixels = 200}},  ///< a GPU and a software rasteriser
};

struct ImageDifference {
  bool same_size = false;
  bool blank = false;       ///< the actual picture has one colour only
  double fraction = 0;      ///< of the pixels beyond `channel`
  int largest_blob = 0;     ///< pixels
  int largest_channel = 0;  ///< largest difference of a channel [1/255]

  bool accepted(const ImageTolerance& tolerance) const;
  /// One line with the numbers.
  std::string text() const;
};

/// Compares two pictures.
ImageDifference compare(const Image& actual, const Image& expected,
                        const ImageTolerance& tolerance = {});

/// The picture |actual − expected| × gain per colour channel, opaque. Sizes must be equal.
Image difference_image(const Image& actual, const Image& expected, int gain = 16);

}  // namespace icloth
