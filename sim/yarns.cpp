#include "sim/yarns.h"

#include "kernels/parallel.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// How a face is deformed.
struct FaceDeformation {
  View<const Int3> face;
  View<const Topology::Inverse> inverse;
  View<const PlateRest> plate;  ///< empty where bending knows no faces
  View<const HingeRest> hinge;
  View<const Vec3r> x;

  ICLOTH_HD YarnAnchor operator()(Index i) const {
    const Int3 f = face[i];
    const Vec3r corner[3] = {x[f.v[0]], x[f.v[1]], x[f.v[2]]};
    YarnAnchor out{{0, 0, 0}, green_strain(face_frame(corner, inverse[i].m)).uv};
    if (plate.size() == 0) return out;
    Real angle[3] = {0, 0, 0};
    for (int a = 0; a < 3; ++a)
      if (const Index h = plate[i].hinge[a]; h >= 0)
        angle[a] = hinge_angle_of(hinge[h], x).theta - hinge[h].angle;
    out.curvature = plate_curvature(plate[i], angle);
    return out;
  }
};

struct EaseYarns {
  FaceDeformation deformation;
  View<YarnAnchor> anchor;
  ICLOTH_HD void operator()(Index i) const { anchor[i] = deformation(i); }
};

struct DragYarns {
  FaceDeformation deformation;
  View<YarnAnchor> anchor;
  ICLOTH_HD void operator()(Index i) const { anchor[i] = dragged(anchor[i], deformation(i)); }
};

FaceDeformation deformation_of(const Topology& mesh, const Parameters& p, const State& state) {
  const bool plates = mesh.bends && p.bending_model == BendingModel::plate;
  return {mesh.face.view(), mesh.face_inverse.view(),
          plates ? mesh.plate.view() : View<const PlateRest>{}, mesh.hinge.view(), state.x1.view()};
}

}  // namespace

void drag_yarns(const Topology& mesh, const Parameters& parameters, State& state) {
  for_each("step.drag_yarns", state.yarns.size(),
           DragYarns{deformation_of(mesh, parameters, state), state.yarns.view()});
}

void ease_yarns(const Topology& mesh, const Parameters& parameters, State& state) {
  state.yarns.resize(mesh.yarns_rub ? mesh.cloth_faces : 0);
  for_each("step.ease_yarns", state.yarns.size(),
           EaseYarns{deformation_of(mesh, parameters, state), state.yarns.view()});
}

}  // namespace icloth::ICLOTH_BUILD
