// Reading of point caches, and the checks that their formats share.
#include <string>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/mesh_formats.h"
#include "sim/files/text.h"

namespace icloth {

PointCache read_point_cache(const std::string& path, Index vertices) {
  const std::string name = shown_path(path), extension = lower_extension(path);
  if (extension != ".pc2" && extension != ".mdd")
    throw InputError(name + ": value " + in_quotes(extension) +
                     ", expected the extension .pc2 or .mdd");
  const std::string bytes = read_file(path);
  return extension == ".pc2" ? parse_pc2(bytes, name, vertices) : parse_mdd(bytes, name, vertices);
}

void check_frame(std::span<const Vec3f> frame, std::size_t number, const std::string& path) {
  for (std::size_t v = 0; v < frame.size(); ++v)
    for (float x : {frame[v].x, frame[v].y, frame[v].z})
      if (!(std::abs(x) <= static_cast<float>(kLargestCoordinate)))
        throw InputError(path + ": frame " + std::to_string(number) + ": vertex " +
                         std::to_string(v) + ": value " + number_text(x) +
                         ", expected three finite coordinates");
}

}  // namespace icloth
