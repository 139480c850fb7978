#include "sim/mechanics/yarns.h"

#include "kernels/parallel/parallel.h"

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
    Real angle[3];
    plate_angles(plate[i], hinge, x, angle);
    out.curvature = plate_curvature(plate[i], angle);
    return out;
  }
};

struct ResetAnchors {
  FaceDeformation deformation;
  View<YarnAnchor> anchor;
  ICLOTH_HD void operator()(Index i) const { anchor[i] = deformation(i); }
};

struct UpdateAnchors {
  FaceDeformation deformation;
  View<YarnAnchor> anchor, start;
  ICLOTH_HD void operator()(Index i) const {
    start[i] = deformation(i);
    anchor[i] = dragged(anchor[i], start[i]);
  }
};

struct YarnWork {
  FaceDeformation end;
  View<const Real> area;
  View<const Index> face_fabric;
  View<const Fabric> fabric;
  View<const YarnAnchor> anchor, start;
  ICLOTH_HD double operator()(Index i) const {
    return static_cast<double>(
        area[i] * yarn_work_density(fabric[face_fabric[i]], anchor[i], start[i], end(i)));
  }
};

/// The law of the friction is a secant that was looked up at one deformation of a face and acts on
/// another one.
struct MarkWrongFriction {
  FaceDeformation predicted_end, at, end;
  Linearization point;
  View<const Real> area;
  View<const Index> face_fabric;
  View<const Fabric> fabric;
  View<const YarnAnchor> anchor;
  Real negligible;
  View<std::uint8_t> to_renew;

  ICLOTH_HD void operator()(Index i) const {
    const Fabric& f = fabric[face_fabric[i]];
    if (to_renew[i] != 0 || !(f.shear_friction > 0 || f.bending_friction > 0)) return;
    const bool first = !point.moved() || point.keeps(i);
    const YarnAnchor slack = anchor[i], used = first ? predicted_end(i) : at(i), now = end(i);

    // Shear.
    const Real used_shear = used.shear - slack.shear, shear = now.shear - slack.shear;
    const Real missed_shear = std::fabs(
        (shear_friction_stiffness(f, used_shear) - shear_friction_stiffness(f, shear)) * shear);

    // Bending.
    const Sym2 away = now.curvature - slack.curvature;
    const Real missed_modulus = bending_friction_moduli(f, used.curvature - slack.curvature).d11 -
                                bending_friction_moduli(f, away).d11;
    const Real missed_moment = std::fabs(missed_modulus) * curvature_size(away);
    if (missed_shear > negligible || missed_moment > negligible * std::sqrt(area[i]))
      to_renew[i] = 1;
  }
};

bool bend_as_plates(const Topology& mesh, const Parameters& p) {
  return mesh.bends && p.material.bending == BendingModel::plate;
}

FaceDeformation deformation_of(const Topology& mesh, const Parameters& p, View<const Vec3r> x) {
  return {.face = mesh.face.view(),
          .inverse = mesh.face_inverse.view(),
          .plate = bend_as_plates(mesh, p) ? mesh.plate.view() : View<const PlateRest>{},
          .hinge = mesh.hinge.view(),
          .x = x};
}

}  // namespace

void match_yarns(const Topology& mesh, const Parameters& parameters, State& state) {
  const Index rubbing = mesh.has_yarn_friction ? mesh.cloth_faces : 0;
  const bool bend = rubbing > 0 && bend_as_plates(mesh, parameters);
  if (state.yarns.size() == rubbing && state.yarns_bend == bend) return;
  state.yarns.resize(rubbing);
  state.yarns_bend = bend;
  for_each("step.reset_anchors", rubbing,
           ResetAnchors{deformation_of(mesh, parameters, state.x1.view()), state.yarns.view()});
}

void YarnFriction::begin_substep(const Topology& mesh, const Parameters& parameters, State& state) {
  state.yarns_start.resize(state.yarns.size());
  for_each("implicit.update_anchors", state.yarns.size(),
           UpdateAnchors{deformation_of(mesh, parameters, state.x0.view()), state.yarns.view(),
                         state.yarns_start.view()});
}

void mark_wrong_friction(const ForceContext& c, View<const Vec3r> predicted_end, Real negligible,
                         View<std::uint8_t> to_renew) {
  const Topology& mesh = c.mesh;
  const State& state = c.state;
  for_each("implicit.wrong_friction", state.yarns.size(),
           MarkWrongFriction{.predicted_end = deformation_of(mesh, c.parameters, predicted_end),
                             .at = deformation_of(mesh, c.parameters, c.point.at),
                             .end = deformation_of(mesh, c.parameters, state.candidate.view()),
                             .point = c.point,
                             .area = mesh.face_area.view(),
                             .face_fabric = mesh.face_fabric.view(),
                             .fabric = mesh.fabric.view(),
                             .anchor = state.yarns.view(),
                             .negligible = negligible,
                             .to_renew = to_renew});
}

double YarnFriction::work(const ForceContext& c, View<const Vec3r>) const {
  const Topology& mesh = c.mesh;
  const State& state = c.state;
  return reduce("implicit.yarn_work", state.yarns.size(), 0.0,
                YarnWork{.end = deformation_of(mesh, c.parameters, state.candidate.view()),
                         .area = mesh.face_area.view(),
                         .face_fabric = mesh.face_fabric.view(),
                         .fabric = mesh.fabric.view(),
                         .anchor = state.yarns.view(),
                         .start = state.yarns_start.view()},
                Sum{});
}

}  // namespace icloth::ICLOTH_BUILD
