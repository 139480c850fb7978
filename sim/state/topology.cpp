#include "sim/state/topology.h"

#include <algorithm>

#include "sim/state/upload.h"

namespace icloth::ICLOTH_BUILD {
namespace {

Real real(double value) { return static_cast<Real>(value); }

}  // namespace

void Topology::upload(const World& world) {
  cloth_vertices = world.cloth_vertices;
  vertices = world.vertices;
  cloth_edges = world.cloth_edges;
  edges = world.edges;
  cloth_faces = world.cloth_faces;
  faces = world.faces;
  hinge_count = static_cast<Index>(world.hinges.size());
  median_edge = real(world.median_edge);

  // The mesh comes with the measures of its elements at rest.
  upload_as(face, world.face, [](const Triangle& t) { return Int3{{t[0], t[1], t[2]}}; });
  upload_as(edge, world.edge, [](const std::array<Index, 2>& e) { return Int2{{e[0], e[1]}}; });
  upload_as(rest, world.rest, [](Vec3d x) { return convert<Real>(x); });
  upload_as(mass, world.mass, real);
  upload_as(vertex_area, world.area, real);
  upload_as(edge_area, world.edge_area, real);
  upload_as(face_area, world.face_area, real);
  upload_as(face_inverse, world.face_inverse, [](const std::array<double, 4>& m) {
    return Inverse{{real(m[0]), real(m[1]), real(m[2]), real(m[3])}};
  });

  // Distances at rest around the seams of sewn cloths.
  rest_panel.upload(world.rest_distances.panel);
  seam_first.upload(world.rest_distances.first);
  upload_as(seam, world.rest_distances.distances, [](const RestDistance& d) {
    return SeamDistance{d.vertex, real(d.squared)};
  });

  // A friction of its own is rare, and where no object has one the list stays empty.
  object.upload(world.object);
  const bool own_friction =
      std::any_of(world.objects.begin(), world.objects.end(),
                  [](const WorldObject& o) { return o.friction.has_value(); });
  object_friction.resize(0);
  if (own_friction)
    upload_as(object_friction, world.objects,
              [](const WorldObject& o) { return real(o.friction.value_or(-1)); });

  // Each face has the fabric of its cloth, and a hinge those of its two faces.
  face_fabric.upload(world.face_material);
  upload_as(hinge, world.hinges, [&](const Hinge& h) {
    const auto fabric_of = [&](Index f) {
      return world.face_material[static_cast<std::size_t>(f)];
    };
    const auto& v = h.vertices;
    return HingeRest{.v = {{v[0], v[1], v[2], v[3]}},
                     .fabric0 = fabric_of(h.face0),
                     .fabric1 = fabric_of(h.face1),
                     .angle = real(h.rest_angle),
                     .length = real(h.rest_length),
                     .area = real(h.rest_area),
                     .direction = real(h.direction),
                     .weight = real(h.weight)};
  });
}

}  // namespace icloth::ICLOTH_BUILD
