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
/// faces and the texture coordinates, and the list of all objects (sim/files/spool.h). NAME is that
/// of the object, with `_` for all but letters, digits, `-` and `.`; objects that would have the
/// same get a number. A frame is appended and then counted in the head, so what the head counts is
/// whole at any moment.
class CacheExport {
 public:
  explicit CacheExport(std::string folder) : folder_(std::move(folder)) {}

  /// Begins the files, or goes on after `kept` frames of those that are there; called once, before
  /// the rest. Throws InputError where they cannot be written, or are of another mesh.
  void begin(std::span<const NamedMesh> meshes, std::int64_t kept);
  /// Appends a frame. Throws InputError where it cannot be written.
  void append(std::span<const NamedMesh> meshes);

  const std::vector<CachedMesh>& caches() const { return caches_; }

 private:
  std::string folder_;
  std::vector<CachedMesh> caches_;
  std::int64_t frames_ = 0;
};

/// Writes NAME.mdd of each cache into a folder; `times` are those of its frames [s]. Throws
/// InputError.
void write_mdd(const std::string& folder, std::span<const CachedMesh> caches,
               std::span<const double> times);

/// Writes scene.usda of all caches into a folder. Throws InputError.
void write_usda_scene(const std::string& folder, std::span<const CachedMesh> caches,
                      std::span<const double> times);

}  // namespace icloth
