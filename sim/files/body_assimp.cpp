// The one file that includes assimp.
#include "sim/files/body_assimp.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

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

/// Positions of a mesh under a node; a skin replaces the node's own transform.
std::vector<Vec3d> posed_vertices(const aiMesh& mesh, const aiMatrix4x4& node_pose,
                                  const NodePoses& poses) {
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
      sum[entry.mVertexId] += entry.mWeight * (pose * mesh.mVertices[entry.mVertexId]);
      weight[entry.mVertexId] += entry.mWeight;
    }
  }
  std::vector<Vec3d> positions;
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D p = weight[v] > 0 ? sum[v] / weight[v] : node_pose * mesh.mVertices[v];
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

void add_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent,
              const NodePoses& poses, const std::string& path, TriangleMesh& body) {
  const aiMatrix4x4 pose = parent * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    add_mesh(mesh, posed_vertices(mesh, pose, poses),
             shown_path(path) + ": mesh " + excerpt(mesh.mName.C_Str()), body);
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i)
    add_node(scene, *node.mChildren[i], pose, poses, path, body);
}

/// Vertices are split where texture or normal jump: merged again, so that the surface has no
/// cracks.
void merge_coinciding(TriangleMesh& body) {
  std::map<std::array<double, 3>, Index> first_at;
  std::vector<Vec3d> positions;
  std::vector<Index> number;

  // Vertices are merged where all digits agree, since split ones are copies of each other.
  for (Vec3d p : body.positions) {
    const auto [entry, is_new] =
        first_at.try_emplace({p.x, p.y, p.z}, static_cast<Index>(positions.size()));
    if (is_new) positions.push_back(p);
    number.push_back(entry->second);
  }

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
      : folder_(std::filesystem::weakly_canonical(body).parent_path()), body_(body) {}

  bool Exists(const char* name) const override { return may_open(name); }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    return may_open(name) && mode[0] == 'r' ? DefaultIOSystem::Open(name, mode) : nullptr;
  }

 private:
  bool may_open(const char* name) const {
    std::error_code error;
    if (!std::filesystem::is_regular_file(name, error)) return false;
    if (name == body_) return true;
    const auto inside = std::filesystem::canonical(name, error).lexically_relative(folder_);
    return !error && !inside.empty() && *inside.begin() != "..";
  }

  std::filesystem::path folder_;
  std::string body_;
};

std::vector<BodyClip> clips_of(const aiScene& scene) {
  std::vector<BodyClip> clips;
  for (unsigned i = 0; i < scene.mNumAnimations; ++i) {
    const aiAnimation& animation = *scene.mAnimations[i];
    const double rate = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : 0;
    const double seconds = rate > 0 ? animation.mDuration / rate : 0;
    clips.push_back({animation.mName.C_Str(), std::isfinite(seconds) ? seconds : 0});
  }
  return clips;
}

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

  // The nodes place the meshes, and the skins bend them.
  NodePoses poses;
  collect_poses(*scene->mRootNode, aiMatrix4x4(), poses);
  Body body;
  add_node(*scene, *scene->mRootNode, aiMatrix4x4(), poses, path, body.mesh);
  merge_coinciding(body.mesh);
  if (body.mesh.faces.empty())
    throw InputError(shown_path(path) + ": 0 triangles, expected at least one");

  // Clips and bones are read for notes, since they are not played.
  body.clips = clips_of(*scene);
  body.bones = bones_of(*scene);
  body.morphs = morphs_of(*scene);
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
