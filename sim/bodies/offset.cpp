#include "sim/bodies/offset.h"

#include "kernels/index.h"
#include "sim/bodies/eigen.h"
#include "sim/bodies/skinned_poses.h"

namespace icloth {
namespace {

std::vector<Vec3d> normals_of(const std::vector<Vec3d>& x,
                              const std::vector<std::array<Index, 3>>& faces) {
  std::vector<Vec3d> normals(x.size());
  for (const std::array<Index, 3>& f : faces) {
    const Vec3d n = cross(x[at(f[1])] - x[at(f[0])], x[at(f[2])] - x[at(f[0])]);
    for (const Index v : f) normals[at(v)] += n;
  }
  for (Vec3d& n : normals) n = normalized(n);
  return normals;
}

/// The map with which a vertex follows its bones.
Affine blended(const Rig& rig, const std::vector<Affine>& bones, std::size_t v) {
  Affine sum;
  for (double& entry : sum.m) entry = 0;
  for (Index w = rig.weight_first[v]; w < rig.weight_first[v + 1]; ++w) {
    const auto k = static_cast<std::size_t>(w);
    const Affine& bone = bones[static_cast<std::size_t>(rig.weight_bone[k])];
    for (int e = 0; e < 12; ++e) sum.m[e] += rig.weight[k] * bone.m[e];
  }
  return sum;
}

}  // namespace

void offset_along_normals(std::vector<Vec3d>& positions,
                          const std::vector<std::array<Index, 3>>& faces, double distance) {
  const std::vector<Vec3d> normals = normals_of(positions, faces);
  for (std::size_t v = 0; v < positions.size(); ++v) positions[v] += distance * normals[v];
}

void offset_along_normals(std::vector<Vec3f>& positions,
                          const std::vector<std::array<Index, 3>>& faces, double distance) {
  std::vector<Vec3d> exact;
  for (const Vec3f& p : positions) exact.push_back(convert<double>(p));
  offset_along_normals(exact, faces, distance);
  for (std::size_t v = 0; v < exact.size(); ++v) positions[v] = convert<float>(exact[v]);
}

void offset_rig(Rig& rig, const Affine& place, const std::vector<std::array<Index, 3>>& faces,
                double distance) {
  const SkinPose pose = bind_pose(rig, place);
  std::vector<Vec3d> bound;
  skin_vertices(rig, pose, bound);
  const std::vector<Vec3d> normals = normals_of(bound, faces);

  // The bones take the displacement to where it belongs, so the rest position gets it taken back.
  for (std::size_t v = 0; v < rig.rest.size(); ++v) {
    const Eigen::FullPivLU<Eigen::Matrix3d> follows(linear_part(blended(rig, pose.bones, v)));
    if (follows.isInvertible())
      rig.rest[v] += from_eigen(follows.solve(to_eigen(distance * normals[v])));
  }
}

}  // namespace icloth
