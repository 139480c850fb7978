#include "app/session/garment_fit.h"

#include <algorithm>
#include <limits>
#include <set>

#include "kernels/index.h"
#include "sim/garment/face_strain.h"

namespace icloth {
namespace {

/// The body that a garment is worn on if bones move it; null: none.
const Obstacle* body_with_bones(const Scene& scene, const Garment& garment) {
  for (const Obstacle& obstacle : scene.obstacles)
    if (obstacle.skinned() && (garment.body.empty() || obstacle.name == garment.body))
      return &obstacle;
  return nullptr;
}

Vec3d centroid(std::span<const Index> vertices, std::span<const Vec3d> x) {
  Vec3d sum{};
  for (const Index v : vertices) sum = sum + x[at(v)];
  return (1.0 / static_cast<double>(vertices.size())) * sum;
}

/// The bone that has the largest share in the motion of the skin nearest to these points.
std::size_t nearest_bone(const Obstacle& body, std::span<const Vec3d> points) {
  std::vector<Vec3d> skin;
  body.pose(0, skin);
  const Rig& rig = body.skinned()->rig();
  std::vector<double> share(rig.bone_node.size(), 0.0);

  // The nearest vertex of the skin gives its weights to the bones that move it.
  for (const Vec3d& point : points) {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < skin.size(); ++v) {
      const Vec3d d = skin[v] - point;
      if (dot(d, d) >= least) continue;
      least = dot(d, d);
      nearest = v;
    }
    for (Index k = rig.weight_first[nearest]; k < rig.weight_first[nearest + 1]; ++k)
      share[at(rig.weight_bone[at(k)])] += rig.weight[at(k)];
  }
  return static_cast<std::size_t>(std::ranges::max_element(share) - share.begin());
}

/// Where a bone carries a point from time 0 to another time.
Vec3d carried(const Obstacle& body, std::size_t bone, Vec3d point, double time) {
  const Affine before = body.skin_pose(0).bones[bone], after = body.skin_pose(time).bones[bone];
  const double* m = before.m;
  const Vec3d row0{m[0], m[1], m[2]}, row1{m[4], m[5], m[6]}, row2{m[8], m[9], m[10]};
  const Vec3d p = point - Vec3d{m[3], m[7], m[11]};

  // The place in the frame of the bone, by Cramer's rule.
  const double determinant = dot(row0, cross(row1, row2));
  const Vec3d own = (1 / determinant) *
                    (p.x * cross(row1, row2) + p.y * cross(row2, row0) + p.z * cross(row0, row1));
  return after(own);
}

}  // namespace

GarmentFitGauge::GarmentFitGauge(const Scene& scene) : scene_(scene), world_(make_world(scene)) {
  for (const Garment& garment : scene.garments) {
    const auto is_cloth = [&](const WorldObject& o) {
      return o.cloth && o.source == garment.cloth;
    };
    const WorldObject& object = *std::ranges::find_if(world_.objects, is_cloth);
    Gauge gauge{&garment, body_with_bones(scene, garment), object.first_face, {}, {}, {}};

    // Cloth that is gathered is stretched by the pattern itself.
    const std::vector<bool> gathered = gathered_faces(garment, scene.cloths[at(garment.cloth)]);
    for (std::size_t f = 0; f < gathered.size(); ++f)
      if (!gathered[f]) gauge.faces.push_back(at(object.first_face) + f);

    // The places of the borders are those at time 0, when the garment has settled.
    gauge.waist = find_border(gauge, kWaistLabel, object.first_vertex);
    gauge.collar = find_border(gauge, kCollarLabel, object.first_vertex);
    gauges_.push_back(std::move(gauge));
  }
}

std::optional<GarmentFitGauge::Border> GarmentFitGauge::find_border(const Gauge& gauge,
                                                                    const char* label,
                                                                    Index first_vertex) const {
  if (!gauge.body) return std::nullopt;
  std::set<Index> vertices;
  for (const LabelledEdge& edge : gauge.garment->sewn.labelled)
    if (edge.label == label)
      for (const Index v : edge.vertices) vertices.insert(first_vertex + v);
  if (vertices.empty()) return std::nullopt;

  Border border;
  border.vertices.assign(vertices.begin(), vertices.end());
  std::vector<Vec3d> points;
  for (const Index v : border.vertices) points.push_back(world_.position[at(v)]);
  border.bone = nearest_bone(*gauge.body, points);
  border.start = centroid(border.vertices, world_.position);
  return border;
}

std::optional<double> GarmentFitGauge::distance(const Gauge& gauge,
                                                const std::optional<Border>& border,
                                                std::span<const Vec3d> x, double time) const {
  if (!border) return std::nullopt;
  return norm(centroid(border->vertices, x) -
              carried(*gauge.body, border->bone, border->start, time));
}

std::vector<GarmentFit> GarmentFitGauge::measure(std::span<const Vec3f> positions,
                                                 double time) const {
  std::vector<Vec3d> x;
  for (const Vec3f& p : positions.first(at(world_.cloth_vertices))) x.push_back(convert<double>(p));
  const std::vector<double> strains = face_strains(world_, x);
  std::vector<GarmentFit> fits;

  // The strains are those of the faces outside gathers; the worst one names its panel.
  for (const Gauge& gauge : gauges_) {
    GarmentFit& fit = fits.emplace_back();
    fit.name = scene_.cloths[at(gauge.garment->cloth)].name;
    std::vector<double> counted;
    for (const std::size_t f : gauge.faces) counted.push_back(strains[f]);
    if (!counted.empty()) {
      const auto worst = std::ranges::max_element(counted);
      const std::size_t face = gauge.faces[static_cast<std::size_t>(worst - counted.begin())];
      const SewnGarment& sewn = gauge.garment->sewn;
      fit.largest_strain = *worst;
      fit.panel = sewn.panel_names[at(sewn.panel[face - at(gauge.first_face)])];
      fit.strain_p95 = percentile(std::move(counted), 0.95);
    }
    fit.waist = distance(gauge, gauge.waist, x, time);
    fit.collar = distance(gauge, gauge.collar, x, time);
  }
  return fits;
}

}  // namespace icloth
