// The names of the formats of exported frames on the command line.
#pragma once

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "sim/files/frame_export.h"

namespace icloth {

/// In the order of FrameFormat.
inline const std::vector<std::string> kFrameFormats = {"obj", "ply", "pc2", "mdd", "usda"};

/// The formats of names that are all of kFrameFormats.
inline std::vector<FrameFormat> frame_formats(const std::vector<std::string>& names) {
  std::vector<FrameFormat> formats;
  for (const std::string& name : names)
    formats.push_back(
        static_cast<FrameFormat>(std::ranges::find(kFrameFormats, name) - kFrameFormats.begin()));
  return formats;
}

}  // namespace icloth
