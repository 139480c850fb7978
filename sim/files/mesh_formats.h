// Parsers of the mesh formats, from memory. Used by read_mesh, read_point_cache and by tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "sim/files/mesh_io.h"

namespace icloth {

/// `path` is the name for messages. Both throw InputError naming file, line or element, and value.
MeshFile parse_obj(std::string_view text, const std::string& path);
MeshFile parse_ply(std::string_view bytes, const std::string& path);

/// Point caches of a mesh with that many vertices; the counts are checked against the size of
/// `bytes` before memory is taken. Both throw InputError naming file, frame, vertex and value.
PointCache parse_pc2(std::string_view bytes, const std::string& path, Index vertices);
PointCache parse_mdd(std::string_view bytes, const std::string& path, Index vertices);

inline constexpr double kLargestCoordinate = 1e9;          ///< of a position in any file [m]
inline constexpr std::size_t kLargestCount = 536'870'911;  ///< of vertices or triangles

/// Whether all three numbers are finite and within kLargestCoordinate.
inline bool is_coordinate(Vec3d p) {
  return std::abs(p.x) <= kLargestCoordinate && std::abs(p.y) <= kLargestCoordinate &&
         std::abs(p.z) <= kLargestCoordinate;
}

/// Throws InputError naming the first vertex of the frame that is not within kLargestCoordinate.
void check_frame(std::span<const Vec3f> frame, std::size_t number, const std::string& path);

/// Words of a line, separated by blanks.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}
  /// Next word, empty at the end.
  std::string_view next() {
    const std::size_t begin = rest_.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return rest_ = {};
    const std::size_t end = std::min(rest_.find_first_of(" \t\r", begin), rest_.size());
    const std::string_view word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return word;
  }

 private:
  std::string_view rest_;
};

}  // namespace icloth
