#include "app/cli/commands/check.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "app/common/element_names.h"
#include "sim/files/error.h"
#include "sim/files/mesh_io.h"
#include "sim/files/text.h"
#include "sim/files/weld.h"

namespace icloth {
namespace {

/// Makes one of the vertices of a group that lie at exactly the same place, as the cloths of a
/// scene have them at their seams. Vertices of different groups stay apart. Returns how many there
/// were.
std::size_t weld_groups(MeshFile& file) {
  std::vector<Vec3d> group_of(file.mesh.positions.size());
  for (std::size_t g = 0; g < file.groups.size(); ++g) {
    const MeshGroup& group = file.groups[g];
    for (Index f = group.first_face; f < group.first_face + group.face_count; ++f)
      for (const Index v : file.mesh.faces[static_cast<std::size_t>(f)])
        group_of[static_cast<std::size_t>(v)].x = static_cast<double>(g);
  }
  FileLayout layout;
  return merge_vertices(file.mesh, group_of, true, layout).welded;
}

/// All files in one list of vertices and faces, numbered on from file to file.
struct Soup {
  std::vector<Vec3d> positions;
  std::vector<Triangle> faces;
  std::vector<int> group;  // −1: obstacle
  ElementNames names{Scene{}};
  std::size_t welded = 0;  ///< vertices at the place of another one of the same group

  /// Adds a file. With several files its path is part of the names.
  void add(const std::string& path, bool several) {
    MeshFile file = read_mesh(path);
    const auto first = static_cast<Index>(positions.size());
    TriangleMesh& mesh = file.mesh;
    welded += weld_groups(file);

    // Indices are 32 bits, and the sum of all files must fit.
    if (positions.size() + mesh.positions.size() > (1u << 30) ||
        faces.size() + mesh.faces.size() > (1u << 30))
      throw InputError(shown_path(path) + ": expected at most 2^30 vertices and faces together");

    positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const Triangle& t : mesh.faces)
      faces.push_back({t[0] + first, t[1] + first, t[2] + first});

    // Each group is named by itself; vertices are counted with the first group of the file.
    auto vertices = static_cast<Index>(mesh.positions.size());
    for (const MeshGroup& part : file.groups) {
      const std::string prefix = several || part.name.empty() ? path : "";
      const std::string colon = prefix.empty() || part.name.empty() ? "" : ":";
      names.add(prefix + colon + part.name, std::exchange(vertices, 0), part.face_count);
      group.resize(group.size() + static_cast<std::size_t>(part.face_count),
                   part.name.starts_with("obstacle:") ? -1 : 0);
    }
  }

  /// Degenerate faces, which the exact test passes over.
  std::size_t faces_without_area() const {
    return static_cast<std::size_t>(std::ranges::count_if(faces, [&](const Triangle& t) {
      const auto x = [&](std::size_t k) { return positions[static_cast<std::size_t>(t[k])]; };
      return norm2(cross(x(1) - x(0), x(2) - x(0))) == 0;
    }));
  }
};

}  // namespace

int run_check(const CheckOptions& options) {
  Soup soup;
  for (const std::string& path : options.meshes) soup.add(path, options.meshes.size() > 1);

  // Faces without a common vertex must not touch at all.
  const auto pairs = find_intersections(soup.positions, soup.faces, soup.group);
  for (std::size_t i = 0; i < std::min(pairs.size(), options.list); ++i)
    std::printf("%s\n", soup.names.pair(pairs[i]).c_str());
  if (pairs.size() > options.list) std::printf("… and %zu more\n", pairs.size() - options.list);
  if (soup.welded > 0)
    std::printf("vertices at the same place as another one of their group (taken as one) %zu\n",
                soup.welded);
  std::printf("faces %zu, without area (not tested) %zu, intersecting pairs %zu\n",
              soup.faces.size(), soup.faces_without_area(), pairs.size());

  // Neighbouring faces are listed by themselves, since other programs do not test them.
  const auto touches = find_touching_neighbours(soup.positions, soup.faces, soup.group);
  if (touches.empty()) return pairs.empty() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(touches.size(), options.list); ++i)
    std::printf("%s\n", soup.names.touch(touches[i]).c_str());
  std::printf("neighbouring faces that touch beside their common vertices: %zu places\n",
              touches.size());
  return 1;
}

}  // namespace icloth
