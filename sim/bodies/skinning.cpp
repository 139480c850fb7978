#include "sim/bodies/skinning.h"

#include "kernels/parallel/parallel.h"

namespace icloth::ICLOTH_BUILD {
namespace {

struct PlaceVertex {
  SkinArrays skin;
  const Affine* bone;
  const double* morph;
  View<Vec3r> x;  ///< of the body
  ICLOTH_HD void operator()(Index v) const {
    x[v] = convert<Real>(skinned_vertex(skin, bone, morph, v));
  }
};

}  // namespace

Skinning::Skinning(const Rig& rig, Index first_vertex) : first_vertex_(first_vertex) {
  rest_.upload(rig.rest);
  weight_first_.upload(rig.weight_first);
  weight_bone_.upload(rig.weight_bone);
  weight_.upload(rig.weight);
  morph_first_.upload(rig.morph_first);
  morph_target_.upload(rig.morph_target);
  morph_delta_.upload(rig.morph_delta);
}

void Skinning::place(const SkinPose& pose, View<Vec3r> x) {
  bone_.upload(pose.bones);
  morph_.upload(pose.morphs);
  const SkinArrays skin{.rest = rest_.view().data(),
                        .weight_first = weight_first_.view().data(),
                        .weight_bone = weight_bone_.view().data(),
                        .weight = weight_.view().data(),
                        .morph_first = morph_first_.empty() ? nullptr : morph_first_.view().data(),
                        .morph_target = morph_target_.view().data(),
                        .morph_delta = morph_delta_.view().data()};
  for_each("step.skinning", rest_.size(),
           PlaceVertex{.skin = skin,
                       .bone = bone_.view().data(),
                       .morph = morph_.view().data(),
                       .x = x.sub(first_vertex_, rest_.size())});
}

}  // namespace icloth::ICLOTH_BUILD
