// From assimp's nodes, bones and morph targets to a rig. In the child process of read_body alone.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "sim/bodies/rig.h"

struct aiMesh;
struct aiNode;
struct aiScene;

namespace icloth {

/// A mesh under a node, and where its morph targets are among those of the rig.
struct MeshInstance {
  std::string node, mesh;  ///< names
  Index first_target = 0, targets = 0;
};

/// Collects the vertices of the meshes of a scene in the order in which they are added.
class RigReader {
 public:
  /// Takes the nodes of the scene. `use_morph_weights`: the weights of morph targets that the file
  /// gives hold in the bind pose; else they are 0.
  RigReader(const aiScene& scene, std::string path, bool use_morph_weights);

  /// Adds the vertices of a mesh under a node.
  void add(const aiMesh& mesh, const aiNode& node);
  /// Merges vertices at one place that move together: their numbers afterwards, in the order in
  /// which they were added.
  std::vector<Index> merge();
  /// Keeps the first vertex of each number. `number`: of each vertex afterwards, ascending where
  /// new; the others of a number are at the same place and follow the first.
  void keep_first(const std::vector<Index>& number);
  /// Reads the clips of the scene and hands out the rig.
  Rig take(const aiScene& scene);

  /// The first node of that name, kNone where there is none.
  Index node_of(const std::string& name) const;

 private:
  struct Weight {
    Index bone;
    double value;
  };

  void add_node(const aiNode& node, Index parent);
  Index bone_of(Index node, const Affine& inverse_bind);
  std::vector<std::vector<Weight>> weights_of(const aiMesh& mesh, const std::string& where);
  void add_weights(std::vector<Weight> weights, Index own_bone);
  void add_morphs(const aiMesh& mesh, unsigned vertex, Index first_target);
  int compare(std::size_t a, std::size_t b) const;

  std::string path_;
  bool use_morph_weights_;
  Rig rig_;
  std::map<const aiNode*, Index> number_;
  std::map<std::string, Index> named_;
  std::map<std::pair<Index, std::array<double, 12>>, Index> bones_;
  std::vector<MeshInstance> instances_;
};

/// The clips of a scene for the nodes of a rig. Throws InputError naming clip, node and key.
std::vector<Clip> read_clips(const aiScene& scene, const RigReader& rig,
                             const std::vector<MeshInstance>& instances, const std::string& path);

}  // namespace icloth
