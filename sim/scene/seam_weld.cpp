#include "sim/scene/seam_weld.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "kernels/index.h"
#include "sim/files/disjoint_sets.h"

namespace icloth {
namespace {

using Corners = std::array<Vec2d, 3>;

/// Place of each vertex of a cloth after its pairs have become one vertex each, the first of them.
std::vector<Index> merge_pairs(const Seam& seam, std::size_t vertices, std::size_t& left) {
  DisjointSets sets(vertices);
  for (const auto& [a, b] : seam.pairs) sets.unite(at(a), at(b));

  // Those that are left keep their order.
  std::vector<Index> number(vertices);
  left = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    const std::size_t first = sets.find(v);
    number[v] = first == v ? static_cast<Index>(left++) : number[first];
  }
  return number;
}

std::vector<Vec3d> merged_means(const std::vector<Vec3d>& x, const std::vector<Index>& number,
                                std::size_t left) {
  std::vector<Vec3d> sum(left);
  std::vector<double> count(left);
  for (std::size_t v = 0; v < x.size(); ++v) sum[at(number[v])] += x[v], ++count[at(number[v])];
  for (std::size_t v = 0; v < left; ++v) sum[v] = (1 / count[v]) * sum[v];
  return sum;
}

/// The edge vectors of a face in its material frame, from Dm⁻¹.
Corners material_frame(const std::array<double, 4>& inverse) {
  const double det = inverse[0] * inverse[3] - inverse[1] * inverse[2];
  return {Vec2d{0, 0}, Vec2d{inverse[3] / det, -inverse[2] / det},
          Vec2d{-inverse[1] / det, inverse[0] / det}};
}

/// Material coordinates of the faces of a cloth whose rest shape lies in space: faces that lie in
/// one plane are laid out side by side, others each by itself. The deformation of no face changes.
std::vector<Corners> lay_out_faces(const Cloth& cloth, const World& world,
                                   const WorldObject& object) {
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> faces(cloth.mesh.positions.size());
  for (std::size_t f = 0; f < cloth.mesh.faces.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c) faces[at(cloth.mesh.faces[f][c])].push_back({f, c});

  // At first each face lies in a frame of its own.
  std::vector<Corners> uv;
  for (std::size_t f = 0; f < cloth.mesh.faces.size(); ++f)
    uv.push_back(material_frame(world.face_inverse[at(object.first_face) + f]));

  // A face is put where one corner meets that of a neighbour, if another corner then meets as well.
  std::vector<bool> placed(uv.size());
  for (std::size_t first = 0; first < uv.size(); ++first) {
    if (placed[first]) continue;
    placed[first] = true;
    std::queue<std::size_t> queue({first});
    while (!queue.empty()) {
      const std::size_t f = queue.front();
      queue.pop();
      for (std::size_t c = 0; c < 3; ++c) {
        const Index v = cloth.mesh.faces[f][c], w = cloth.mesh.faces[f][(c + 1) % 3];
        for (const auto& [g, d] : faces[at(v)]) {
          const Triangle& other = cloth.mesh.faces[g];
          const auto e = static_cast<std::size_t>(std::ranges::find(other, w) - other.begin());
          if (placed[g] || e == 3) continue;
          const Vec2d along = uv[f][(c + 1) % 3] - uv[f][c], there = uv[g][e] - uv[g][d];
          const Vec2d off = along - there;
          if (std::hypot(off.x, off.y) > 1e-6 * std::hypot(along.x, along.y)) continue;

          // Both corners meet, so the neighbour continues the material on this side.
          const Vec2d shift = uv[f][c] - uv[g][d];
          for (Vec2d& corner : uv[g]) corner = corner + shift;
          placed[g] = true;
          queue.push(g);
        }
      }
    }
  }
  return uv;
}

/// Makes the material space the rest shape of a cloth.
void rest_in_material(Cloth& cloth, const World& world, const WorldObject& object) {
  if (cloth.rest_in_uv) return;
  bool metric = !cloth.mesh.uv.empty();
  for (std::size_t f = 0; f < cloth.mesh.uv.size() && metric; ++f) {
    // The frame of a face is that of its texture coordinates, or it was laid flat from space.
    const Corners frame = material_frame(world.face_inverse[at(object.first_face) + f]);
    const Corners& u = cloth.mesh.uv[f];
    const Vec2d a = u[1] - u[0] - frame[1], b = u[2] - u[0] - frame[2];
    metric =
        std::hypot(a.x, a.y) + std::hypot(b.x, b.y) < 1e-6 * std::hypot(frame[1].x, frame[1].y);
  }
  if (!metric) cloth.mesh.uv = lay_out_faces(cloth, world, object);
  cloth.rest_in_uv = true;
}

}  // namespace

std::optional<WeldedScene> weld_seam(const Scene& scene, const World& world, Index seam_number) {
  const Seam& seam = scene.seams[at(seam_number)];
  if (seam.from != seam.to || seam.pairs.empty()) return std::nullopt;
  const WorldObject& object = world.objects[at(seam.from)];
  std::size_t left = 0;
  const std::vector<Index> number = merge_pairs(seam, at(object.vertex_count), left);

  // The cloth has the same faces as before, with other corners.
  WeldedScene welded{scene, {}, {}};
  Cloth& cloth = welded.scene.cloths[at(seam.from)];
  rest_in_material(cloth, world, object);
  for (Triangle& t : cloth.mesh.faces) {
    for (Index& v : t) v = number[at(v)];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return std::nullopt;
  }
  cloth.mesh.positions = merged_means(cloth.mesh.positions, number, left);
  if (!cloth.rest.empty()) cloth.rest = merged_means(cloth.rest, number, left);
  for (Index& v : cloth.pins) v = number[at(v)];
  std::ranges::sort(cloth.pins);
  cloth.pins.erase(std::unique(cloth.pins.begin(), cloth.pins.end()), cloth.pins.end());

  // Vertices behind the merged ones move up in the world.
  const Index removed = object.vertex_count - static_cast<Index>(left);
  for (Index v = 0; v < world.vertices; ++v) {
    const Index local = v - object.first_vertex;
    const bool before = local < 0, inside = !before && local < object.vertex_count;
    welded.vertex.push_back(before   ? v
                            : inside ? object.first_vertex + number[at(local)]
                                     : v - removed);
  }

  // Grabs and the pairs of other seams follow; pairs that have become one vertex are done.
  for (ScriptedGrab& grab : welded.scene.input)
    if (grab.cloth == seam.from) grab.vertex = number[at(grab.vertex)];
  Index pair = 0;
  for (std::size_t s = 0; s < scene.seams.size(); ++s) {
    Seam& other = welded.scene.seams[s];
    other.pairs.clear();
    for (auto p : scene.seams[s].pairs) {
      if (other.from == seam.from) p[0] = number[at(p[0])];
      if (other.to == seam.from) p[1] = number[at(p[1])];
      const bool done =
          static_cast<Index>(s) == seam_number || (other.from == other.to && p[0] == p[1]);
      if (!done) {
        other.pairs.push_back(p);
        welded.pairs.push_back(pair);
      }
      ++pair;
    }
  }
  return welded;
}

}  // namespace icloth
