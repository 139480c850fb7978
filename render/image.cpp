#include "render/image.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "sim/files/error.h"
#include "sim/files/file_io.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace icloth {

namespace {

constexpr int kColours = 3;

std::size_t pixel_count(const Image& image) {
  return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

/// The largest difference of a colour channel of two pixels.
int largest_step(const std::uint8_t* a, const std::uint8_t* b) {
  int largest = 0;
  for (int c = 0; c < kColours; ++c) largest = std::max(largest, std::abs(a[c] - b[c]));
  return largest;
}

/// The size of the largest set of marked pixels that touch by side or corner. Clears the marks.
int largest_blob(std::vector<std::uint8_t>& marked, int width, int height) {
  const auto index = [width](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  };

  // Every marked pixel starts a flood fill, which clears the marks of its set.
  int largest = 0;
  std::vector<std::pair<int, int>> open;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!marked[index(x, y)]) continue;
      int size = 0;
      marked[index(x, y)] = 0;
      open.assign(1, {x, y});

      // The eight neighbours of a pixel join, as far as they are in the picture.
      while (!open.empty()) {
        const auto [px, py] = open.back();
        open.pop_back();
        ++size;
        for (int ny = std::max(0, py - 1); ny <= std::min(height - 1, py + 1); ++ny) {
          for (int nx = std::max(0, px - 1); nx <= std::min(width - 1, px + 1); ++nx) {
            if (!marked[index(nx, ny)]) continue;
            marked[index(nx, ny)] = 0;
            open.push_back({nx, ny});
          }
        }
      }

      largest = std::max(largest, size);
    }
  }
  return largest;
}

bool one_colour(const Image& image) {
  for (std::size_t i = 0; i < pixel_count(image); ++i)
    if (largest_step(&image.pixels[4 * i], image.pixels.data()) > 0) return false;
  return true;
}

}  // namespace

Image::Image(int image_width, int image_height) : width(image_width), height(image_height) {
  pixels.assign(4 * pixel_count(*this), 0);
}

void write_png(const std::string& path, const Image& image) {
  // The picture is packed in memory first, so that the file is whole or not there.
  std::string png;
  const auto append = [](void* text, void* bytes, int count) {
    static_cast<std::string*>(text)->append(static_cast<const char*>(bytes),
                                            static_cast<std::size_t>(count));
  };
  if (image.width < 1 || image.height < 1 ||
      !stbi_write_png_to_func(append, &png, image.width, image.height, 4, image.pixels.data(),
                              4 * image.width)) {
    throw InputError(path + ": " + std::to_string(image.width) + " x " +
                     std::to_string(image.height) + " pixels cannot be packed as PNG");
  }
  write_file(path, png);
}

Image read_png(const std::string& path) {
  // The size is checked before memory is taken, as files are untrusted.
  constexpr std::int64_t kMostPixels = 64'000'000;
  int width = 0, height = 0, channels = 0;
  if (!stbi_info(path.c_str(), &width, &height, &channels))
    throw InputError(path + ": missing or no PNG picture, expected a PNG file");
  if (static_cast<std::int64_t>(width) * height > kMostPixels) {
    throw InputError(path + ": " + std::to_string(width) + " x " + std::to_string(height) +
                     " pixels, expected at most 64 million");
  }

  std::uint8_t* data = stbi_load(path.c_str(), &width, &height, &channels, 4);
  if (!data) throw InputError(path + ": damaged PNG file (" + stbi_failure_reason() + ")");
  Image image(width, height);
  std::copy(data, data + image.pixels.size(), image.pixels.begin());
  stbi_image_free(data);
  return image;
}

bool ImageDifference::accepted(const ImageTolerance& tolerance) const {
  return same_size && !blank && fraction <= tolerance.fraction &&
         largest_blob <= tolerance.blob_pixels;
}

std::string ImageDifference::text() const {
  if (!same_size) return "the sizes differ";
  char line[160];
  std::snprintf(line, sizeof line,
                "%.3f %% of the pixels differ, largest blob %d px, by at most %d%s", 100 * fraction,
                largest_blob, largest_channel, blank ? ", and it is blank" : "");
  return line;
}

ImageDifference compare(const Image& actual, const Image& expected,
                        const ImageTolerance& tolerance) {
  // Pictures of one colour are told apart, as nothing may have been drawn.
  ImageDifference result;
  result.blank = one_colour(actual);
  result.same_size = actual.width == expected.width && actual.height == expected.height;
  if (!result.same_size || actual.pixels.empty()) return result;

  // Pixels beyond the tolerance are counted; those that the eye sees are marked, to find the
  // largest set.
  std::size_t beyond = 0;
  std::vector<std::uint8_t> seen(pixel_count(actual), 0);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const int step = largest_step(&actual.pixels[4 * i], &expected.pixels[4 * i]);
    beyond += step > tolerance.channel;
    seen[i] = step > tolerance.blob_channel;
    result.largest_channel = std::max(result.largest_channel, step);
  }

  result.fraction = static_cast<double>(beyond) / static_cast<double>(seen.size());
  result.largest_blob = largest_blob(seen, actual.width, actual.height);
  return result;
}

Image difference_image(const Image& actual, const Image& expected, int gain) {
  Image result(actual.width, actual.height);
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    const int step = std::abs(actual.pixels[i] - expected.pixels[i]);
    result.pixels[i] = static_cast<std::uint8_t>(i % 4 == 3 ? 255 : std::min(255, step * gain));
  }
  return result;
}

}  // namespace icloth
