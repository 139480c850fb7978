// Point caches of a run: the positions of each object over time in a file that grows.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/files/mesh_io.h"
#include "sim/files/usda_io.h"

namespace icloth {

/// Writes NAME.pc2 for each object of a run, with NAME.obj of its first frame beside it for the
/// faces. NAME is that of the object, with `_` for all but letters, digits, `-` and `.`; objects
/// that would have the same get a number. A frame is appended and then counted in the head, so what
/// the head counts is whole at any moment.
class CacheExport {
 public:
  explicit CacheExport(std::string folder) : folder_(std::move(folder)) {}

  /// Appends a frame; the first one begins the files, or goes on after `kept` frames of those that
  /// are there. Throws InputError where they cannot be written, or are of another mesh.
  void append(std::span<const NamedMesh> meshes, std::int64_t kept);

  /// Writes NAME.mdd of each cache; `times` are those of its frames [s]. Throws InputError.
  void write_mdd(std::span<const double> times) const;
  /// Writes scene.usda of all caches. Throws InputError.
  void write_usda(std::span<const double> times) const;

 private:
  void begin(std::span<const NamedMesh> meshes, std::int64_t kept);

  std::string folder_;
  std::vector<CachedMesh> caches_;
  std::int64_t frames_ = 0;
};

}  // namespace icloth
