#include "sim/files/spool_export.h"

#include <deque>
#include <vector>

#include "sim/files/cache_frames.h"

namespace icloth {
namespace {

/// The frames of all objects, one after the other.
class SpoolFrames {
 public:
  explicit SpoolFrames(const Spool& spool) : spool_(spool) {
    for (const CachedMesh& object : spool.objects) {
      caches_.emplace_back(object.cache);
      positions_.emplace_back(object.vertices);
    }
  }

  /// The meshes of the next frame, which stay until the one after it.
  std::vector<NamedMesh> next() {
    std::vector<NamedMesh> meshes;
    for (std::size_t i = 0; i < caches_.size(); ++i) {
      caches_[i].next(positions_[i]);
      const CachedMesh& object = spool_.objects[i];
      meshes.push_back({object.name, positions_[i], object.faces, object.uv});
    }
    return meshes;
  }

 private:
  const Spool& spool_;
  std::deque<CacheFrames> caches_;
  std::vector<std::vector<Vec3f>> positions_;
};

}  // namespace

std::string export_spool(const Spool& spool, const std::string& folder, FrameFormat format) {
  const std::string caches = std::to_string(spool.objects.size());
  if (format == FrameFormat::mdd) {
    write_mdd(folder, spool.objects, spool.times());
    return caches + " .mdd";
  }
  if (format == FrameFormat::usda) {
    write_usda_scene(folder, spool.objects, spool.times());
    return "scene.usda";
  }

  // The other formats grow frame by frame.
  SpoolFrames frames(spool);
  CacheExport copies(folder);
  for (std::size_t f = 0; f < spool.frames.size(); ++f) {
    const std::vector<NamedMesh> meshes = frames.next();
    const std::string name = numbered_frame(folder, f), comment = frame_comment(spool.frames[f]);
    if (format == FrameFormat::obj) write_obj(name + ".obj", meshes, comment);
    if (format == FrameFormat::ply) write_ply(name + ".ply", meshes, comment);
    if (format == FrameFormat::pc2) {
      if (f == 0) copies.begin(meshes, 0);
      copies.append(meshes);
    }
  }
  if (format == FrameFormat::pc2) {
    // The copies are a spool as well.
    write_frame_list(folder, spool.frames);
    return caches + " .pc2";
  }
  return std::to_string(spool.frames.size()) + (format == FrameFormat::obj ? " .obj" : " .ply");
}

}  // namespace icloth
