// Pictures compared with the ones in tests/goldens/.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "render/image.h"

namespace icloth {

inline std::string golden_path(const std::string& name) {
  return std::string(ICLOTH_TEST_FOLDER) + "/goldens/" + name + ".png";
}

/// Actual, expected, difference × 16, and a page that swaps the first two under the pointer.
inline void write_failure(const std::string& name, const Image& actual, const Image& expected) {
  const std::filesystem::path folder = ICLOTH_SCREENSHOT_FOLDER;
  std::filesystem::create_directories(folder);
  const auto file = [&](const char* kind) { return (folder / (name + kind)).string(); };
  write_png(file("_actual.png"), actual);
  write_png(file("_expected.png"), expected);
  const bool same_size = actual.width == expected.width && actual.height == expected.height;
  if (same_size) write_png(file("_difference.png"), difference_image(actual, expected));
  std::ofstream page(file(".html"));
  page << "<!doctype html><title>" << name << "</title>\n"
       << "<style>.swap{position:relative;display:inline-block}.swap img+img{position:absolute;"
          "left:0;top:0;opacity:0}.swap:hover img+img{opacity:1}</style>\n"
       << "<p>" << name << ": " << compare(actual, expected).text()
       << ". Left: actual, under the pointer expected. Right: difference &times; 16.</p>\n"
       << "<div class=swap><img src='" << name << "_actual.png'><img src='" << name
       << "_expected.png'></div>\n";
  if (same_size) page << "<img src='" << name << "_difference.png'>\n";
}

/// ICLOTH_UPDATE_GOLDEN=1 writes the golden instead. A missing golden fails.
inline ::testing::AssertionResult matches_golden(const std::string& name, const Image& actual,
                                                 const ImageTolerance& tolerance) {
  const std::string path = golden_path(name);
  const char* update = std::getenv("ICLOTH_UPDATE_GOLDEN");
  if (update && std::string(update) == "1") write_png(path, actual);
  if (!std::filesystem::exists(path)) {
    return ::testing::AssertionFailure()
           << path << " is missing; ICLOTH_UPDATE_GOLDEN=1 ./test.sh -L screenshot makes it";
  }
  const Image expected = read_png(path);
  const ImageDifference difference = compare(actual, expected, tolerance);
  if (difference.accepted(tolerance)) return ::testing::AssertionSuccess();
  write_failure(name, actual, expected);
  return ::testing::AssertionFailure() << name << ": " << difference.text() << "; see "
                                       << ICLOTH_SCREENSHOT_FOLDER << "/" << name << ".html";
}

}  // namespace icloth
