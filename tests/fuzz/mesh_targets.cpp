// Meshes and point caches, read from memory.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "sim/files/mesh_formats.h"
#include "sim/scene/scene_io.h"
#include "tests/fuzz/support.h"
#include "tests/fuzz/targets.h"

namespace icloth::fuzz {
namespace {

using ParseMesh = MeshFile (*)(std::string_view, const std::string&);
using ParseCache = PointCache (*)(std::string_view, const std::string&, Index);

std::string read(ParseMesh parse, std::string_view bytes, const std::string& name) {
  MeshFile file;
  const std::string reason = refusal([&] { file = parse(bytes, name); });
  if (!reason.empty()) return reason;
  require_valid(file.mesh);
  const auto faces = static_cast<Index>(file.mesh.faces.size());
  Index end = 0;
  for (const MeshGroup& group : file.groups) {
    require(group.first_face == end && group.face_count >= 0, "groups one after the other");
    end += group.face_count;
  }
  require(end == faces, "every face in a group");
  if (!refusal([&] { check_cloth_mesh(file.mesh, name); }).empty()) return "";
  // A cloth: it can be a scene by itself, hung by its top.
  // Its seams are welded before its edges are counted: that may still refuse it.
  std::shared_ptr<const Scene> scene;
  if (!refusal([&] { scene = load_scene(write_scratch(name, bytes), {}); }).empty()) return "";
  require(scene->cloths.size() == 1 && scene->cameras.size() == 1, "a cloth and a camera");
  require(!scene->cloths[0].pins.empty(), "a cloth that hangs");
  for (Index v : scene->cloths[0].pins)
    require(v >= 0 && static_cast<std::size_t>(v) < file.mesh.positions.size(), "pins");
  const Vec3d eye = scene->cameras[0].eye;
  require(std::isfinite(eye.x + eye.y + eye.z), "a finite camera");
  return "";
}

/// `count` is the number of vertices that the file announces: a mesh of another size is refused at
/// once, so that most of the calls go on.
std::string read(ParseCache parse, std::string_view bytes, const std::string& name,
                 std::uint32_t count) {
  const auto vertices = static_cast<Index>(std::min<std::uint32_t>(count, 0x7fffffff));
  PointCache cache;
  const std::string reason = refusal([&] { cache = parse(bytes, name, vertices); });
  if (!reason.empty()) return reason;
  require(!cache.frames.empty(), "a frame at least");
  require(cache.frame_rate >= 0 && cache.frame_rate <= 1e6, "a frame rate");
  for (const auto& frame : cache.frames) {
    require(frame.size() == static_cast<std::size_t>(vertices), "whole frames");
    for (Vec3f p : frame) require(std::abs(p.x) + std::abs(p.y) + std::abs(p.z) < 1e10f, "numbers");
  }
  return "";
}

/// Four bytes at a place, 0 where the file ends before them.
std::uint32_t load(std::string_view bytes, std::size_t at, bool big_endian) {
  unsigned char b[4] = {};
  if (bytes.size() >= at + 4) std::memcpy(b, bytes.data() + at, 4);
  if (big_endian) std::reverse(b, b + 4);
  return b[0] | static_cast<std::uint32_t>(b[1]) << 8 | static_cast<std::uint32_t>(b[2]) << 16 |
         static_cast<std::uint32_t>(b[3]) << 24;
}

}  // namespace

std::string read_obj(std::string_view bytes) { return read(parse_obj, bytes, "fuzz.obj"); }
std::string read_ply(std::string_view bytes) { return read(parse_ply, bytes, "fuzz.ply"); }
std::string read_pc2(std::string_view bytes) {
  return read(parse_pc2, bytes, "fuzz.pc2", load(bytes, 16, false));
}
std::string read_mdd(std::string_view bytes) {
  return read(parse_mdd, bytes, "fuzz.mdd", load(bytes, 4, true));
}

}  // namespace icloth::fuzz
