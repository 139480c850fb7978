// Pictures compared with the ones in tests/goldens/.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "render/comparison_page.h"
#include "render/image.h"

namespace icloth {

inline std::string golden_path(const std::string& name) {
  return std::string(ICLOTH_TEST_FOLDER) + "/goldens/" + name + ".png";
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
  const std::filesystem::path folder = ICLOTH_SCREENSHOT_FOLDER;
  std::filesystem::create_directories(folder);
  const std::string picture = (folder / (name + ".png")).string();
  write_png(picture, actual);
  return ::testing::AssertionFailure()
         << name << ": " << difference.text() << "; see "
         << write_comparison_page(picture, actual, expected, difference);
}

}  // namespace icloth
