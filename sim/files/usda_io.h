// Universal Scene Description as text: meshes whose points move.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/files/mesh.h"

namespace icloth {

/// A mesh of which a PC2 file has the positions over time.
struct CachedMesh {
  std::string name;   ///< any; letters, digits and `_` of it are kept
  std::string cache;  ///< PC2 file
  std::size_t vertices = 0;
  std::vector<Triangle> faces;
  std::vector<std::array<Vec2d, 3>> uv;  ///< of the corners of the faces; empty: none
};

/// Writes points, normals and extents of all frames, bit for bit, in metres with y up. Time codes
/// count the frames from 0; `times` [s] say how many of them make a second. Frames are read from
/// the caches one after the other. Throws InputError.
void write_usda(const std::string& path, std::span<const CachedMesh> meshes,
                std::span<const double> times);

}  // namespace icloth
