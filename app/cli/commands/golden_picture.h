// The picture that a picture is compared with (icloth render --compare).
#pragma once

#include <optional>
#include <string>

#include "render/image.h"

namespace icloth {

struct GoldenPicture {
  std::string path;
  std::optional<Image> image;  ///< none where it is going to be made for the first time
  ImageTolerance tolerance;
  bool update = false;  ///< to be written anew
};

/// Whether a picture of so many pixels can be drawn.
bool is_picture_size(int width, int height);

/// Reads the golden picture, before anything takes time. `out`: where the picture will be written;
/// `tolerance`: a name of kTolerances. Throws InputError when it is missing and not `update`, is no
/// PNG file, has a size that cannot be drawn, or is `out` itself.
GoldenPicture open_golden(const std::string& path, const std::string& out,
                          const std::string& tolerance, bool update);

/// Compares a picture that was written to `out` with the golden one, and says what was found; false
/// where they differ, with a page beside `out`. With `update` the golden picture is written anew,
/// unless the run was not `clean`.
bool check_golden(const GoldenPicture& golden, const std::string& out, const Image& picture,
                  bool clean, bool quiet);

}  // namespace icloth
