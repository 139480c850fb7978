// A failed comparison of pictures, as files to look at.
#pragma once

#include <string>

#include "render/image.h"

namespace icloth {

/// Writes beside a picture NAME.png, which is there already, what it should have been:
/// NAME_expected.png, NAME_difference.png (× 16) where the sizes are equal, and NAME.html, which
/// shows them and swaps the first two under the pointer. `difference` is that of both pictures.
/// Returns the path of the page. Throws InputError when a file cannot be written.
std::string write_comparison_page(const std::string& path, const Image& actual,
                                  const Image& expected, const ImageDifference& difference);

}  // namespace icloth
