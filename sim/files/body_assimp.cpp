// Reading with assimp. Only this file, body_rig.cpp and body_clips.cpp include it.
#include "sim/files/body_assimp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>

#include "sim/files/body_rig.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"

#if defined(ICLOTH_HAS_ASSIMP)
#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#endif

namespace icloth {
namespace {

#if defined(ICLOTH_HAS_ASSIMP)

using NodePoses = std::map<std::string, aiMatrix4x4>;

void collect_poses(const aiNode& node, const aiMatrix4x4& parent, NodePoses& poses) {
  const aiMatrix4x4 pose = parent * node.mTransformation;
  poses.emplace(node.mName.C_Str(), pose);
  for (unsigned i = 0; i < node.mNumChildren; ++i) collect_poses(*node.mChildren[i], pose, poses);
}

/// A vertex of a mesh with the weights that its morph targets have in the file.
aiVector3D morphed_vertex(const aiMesh& mesh, unsigned v) {
  aiVector3D p = mesh.mVertices[v];
  for (unsigned k = 0; k < mesh.mNumAnimMeshes; ++k) {
    const aiAnimMesh& target = *mesh.mAnimMeshes[k];
    if (target.mWeight != 0 && target.mVertices && v < target.mNumVertices)
      p += target.mWeight * (target.mVertices[v] - mesh.mVertices[v]);
  }
  return p;
}

/// Positions of a mesh under a node; a skin replaces the node's own transform.
std::vector<Vec3d> posed_vertices(const aiMesh& mesh, const aiMatrix4x4& node_pose,
                                  const NodePoses& poses, bool use_morph_weights) {
  std::vector<aiVector3D> base;
  for (unsigned v = 0; v < mesh.mNumVertices; ++v)
    base.push_back(use_morph_weights ? morphed_vertex(mesh, v) : mesh.mVertices[v]);

  // The bones of each vertex take it to its place, as far as the file has their nodes.
  std::vector<aiVector3D> sum(mesh.mNumVertices);
  std::vector<float> weight(mesh.mNumVertices, 0.0f);
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const aiBone& bone = *mesh.mBones[b];
    const auto found = poses.find(bone.mName.C_Str());
    if (found == poses.end()) continue;
    const aiMatrix4x4 pose = found->second * bone.mOffsetMatrix;
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
      const aiVertexWeight& entry = bone.mWeights[w];
      if (entry.mVertexId >= mesh.mNumVertices) continue;
      sum[entry.mVertexId] += entry.mWeight * (pose * base[entry.mVertexId]);
      weight[entry.mVertexId] += entry.mWeight;
    }
  }
  std::vector<Vec3d> positions;
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D p = weight[v] > 0 ? sum[v] / weight[v] : node_pose * base[v];
    positions.push_back({p.x, p.y, p.z});
  }
  return positions;
}

void add_mesh(const aiMesh& mesh, const std::vector<Vec3d>& positions, const std::string& where,
              TriangleMesh& body) {
  const auto first = static_cast<Index>(body.positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (!(std::abs(positions[v].x) + std::abs(positions[v].y) + std::abs(positions[v].z) < 1e9))
      throw InputError(where + ": vertex " + std::to_string(v) +
                       ": value is not finite, expected three finite coordinates");
  body.positions.insert(body.positions.end(), positions.begin(), positions.end());
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;  // points and lines
    Triangle triangle;
    for (unsigned c = 0; c < 3; ++c) {
      if (face.mIndices[c] >= mesh.mNumVertices)
        throw InputError(where + ": face " + std::to_string(f) + ": value " +
                         std::to_string(face.mIndices[c]) + ", expected the number of a vertex");
      triangle[c] = first + static_cast<Index>(face.mIndices[c]);
    }
    body.faces.push_back(triangle);
  }
}

/// The meshes of a scene on their way to a body.
struct MeshReader {
  const aiScene& scene;
  const std::string& path;
  bool use_morph_weights;
  bool keeps_rig;
  NodePoses poses;
  RigReader& rig;
  TriangleMesh mesh = {};

  void add(const aiNode& node, const aiMatrix4x4& parent) {
    const aiMatrix4x4 pose = parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const aiMesh& part = *scene.mMeshes[node.mMeshes[i]];
      add_mesh(part, posed_vertices(part, pose, poses, use_morph_weights),
               shown_path(path) + ": mesh " + excerpt(part.mName.C_Str()), mesh);
      if (keeps_rig) rig.add(part, node);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], pose);
  }
};

/// The first vertex at each place, all digits of which agree, stands for all there.
std::vector<Index> merge_places(const std::vector<Vec3d>& positions) {
  std::map<std::array<double, 3>, Index> first_at;
  std::vector<Index> number;
  for (const Vec3d p : positions) {
    const auto next = static_cast<Index>(first_at.size());
    number.push_back(first_at.try_emplace({p.x, p.y, p.z}, next).first->second);
  }
  return number;
}

/// Vertices are split where texture or normal jump: merged again, so that the surface has no
/// cracks. `number`: of each vertex afterwards, ascending where new.
void merge_coinciding(const std::vector<Index>& number, TriangleMesh& body) {
  std::vector<Vec3d> positions;
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] == static_cast<Index>(positions.size())) positions.push_back(body.positions[v]);

  // A face that loses a corner by that has no area.
  for (Triangle& face : body.faces)
    for (Index& v : face) v = number[static_cast<std::size_t>(v)];
  std::erase_if(body.faces,
                [](const Triangle& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; });
  body.positions = std::move(positions);
}

/// Opens regular files of one folder and below it: a body must not make us read a device, wait for
/// a pipe, or look at what lies elsewhere.
class FilesOfFolder : public Assimp::DefaultIOSystem {
 public:
  explicit FilesOfFolder(const std::string& body)
      : folder_(std::filesystem::path(body).parent_path().string()), body_(body) {}

  bool Exists(const char* name) const override { return may_open(name); }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    return may_open(name) && mode[0] == 'r' ? DefaultIOSystem::Open(name, mode) : nullptr;
  }

 private:
  bool may_open(const char* name) const {
    std::error_code error;
    if (!std::filesystem::is_regular_file(name, error)) return false;
    return name == body_ || lies_below(name, folder_);
  }

  std::string folder_, body_;
};

std::size_t morphs_of(const aiScene& scene) {
  std::size_t morphs = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) morphs += scene.mMeshes[m]->mNumAnimMeshes;
  return morphs;
}

/// Bones with weights of all meshes.
std::size_t bones_of(const aiScene& scene) {
  std::size_t bones = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m)
    for (unsigned b = 0; b < scene.mMeshes[m]->mNumBones; ++b)
      bones += scene.mMeshes[m]->mBones[b]->mNumWeights > 0 ? 1 : 0;
  return bones;
}

}  // namespace

Body read_with_assimp(const std::string& path) {
  Assimp::Importer importer;
  importer.SetIOHandler(new FilesOfFolder(path));  // the importer deletes it
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);

  // A lack of memory has its own message, because it is no fault in the file's format.
  if (!scene || !scene->mRootNode) {
    const std::string reason = importer.GetErrorString();
    if (reason.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
    throw InputError(shown_path(path) + ": cannot be read as a body (" + excerpt(reason) + ")");
  }

  // The nodes place the meshes, and the skins bend them; a body with bones keeps them. glTF alone
  // says which weights its morph targets have.
  const std::string extension = lower_extension(path);
  const bool is_gltf = extension == ".glb" || extension == ".gltf";
  RigReader rig(*scene, path, is_gltf);
  const std::size_t bones = bones_of(*scene);
  const bool moves = scene->mNumAnimations > 0, keeps_rig = moves || bones > 0;
  MeshReader meshes{.scene = *scene,
                    .path = path,
                    .use_morph_weights = is_gltf,
                    .keeps_rig = keeps_rig,
                    .poses = {},
                    .rig = rig};
  collect_poses(*scene->mRootNode, aiMatrix4x4(), meshes.poses);
  meshes.add(*scene->mRootNode, aiMatrix4x4());

  // In a file without clips vertices at one place stay there, and follow the bones of the first of
  // them when a motion from elsewhere is played; else they have to move together.
  Body body{.mesh = std::move(meshes.mesh), .bones = bones, .morphs = morphs_of(*scene)};
  const std::vector<Index> number = moves ? rig.merge() : merge_places(body.mesh.positions);
  merge_coinciding(number, body.mesh);
  if (keeps_rig && !moves) rig.keep_first(number);
  if (keeps_rig) body.rig = rig.take(*scene);
  if (body.mesh.faces.empty())
    throw InputError(shown_path(path) + ": 0 triangles, expected at least one");
  return body;
}

#else

}  // namespace

Body read_with_assimp(const std::string& path) {
  throw InputError(shown_path(path) + ": value " + in_quotes(lower_extension(path)) +
                   ", expected .obj or .ply: this program was built without assimp");
}

#endif

}  // namespace icloth
