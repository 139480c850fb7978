#include "app/session/garment_gauge.h"

#include <algorithm>
#include <cstdio>

#include "kernels/index.h"
#include "sim/garment/face_strain.h"

namespace icloth {
namespace {

constexpr double kShut = 1e-3;  // [m] points that are nearer than this look sewn

/// The part of the world that a cloth of the scene has become.
const WorldObject& object_of(const World& world, Index cloth) {
  return *std::ranges::find_if(world.objects,
                               [&](const WorldObject& o) { return o.cloth && o.source == cloth; });
}

}  // namespace

std::string garment_text(const GarmentState& state) {
  char text[120];
  std::snprintf(text, sizeof text, "sewn %zu/%zu, max gap %.0f mm, strain p95 %.1f %%",
                state.pairs - state.open_pairs, state.pairs, 1000 * state.gap,
                100 * state.strain_p95);
  return text;
}

GarmentState total(std::span<const GarmentState> garments) {
  GarmentState sum;
  for (const GarmentState& one : garments) {
    sum.pairs += one.pairs;
    sum.open_pairs += one.open_pairs;
    sum.gap = std::max(sum.gap, one.gap);
    sum.strain_p95 = std::max(sum.strain_p95, one.strain_p95);
    sum.largest_strain = std::max(sum.largest_strain, one.largest_strain);
  }
  return sum;
}

GarmentGauge::GarmentGauge(const Scene& scene, const World& world) : world_(world) {
  for (const Garment& garment : scene.garments) {
    const Cloth& cloth = scene.cloths[at(garment.cloth)];
    Gauge& gauge = gauges_.emplace_back();
    gauge.fixed.name = cloth.name;
    for (const SewnSeam& seam : garment.sewn.seams) gauge.fixed.pairs += seam.points.size();

    // Cloth that is gathered is stretched by the pattern itself.
    const std::vector<bool> gathered = gathered_faces(garment, cloth);
    const std::size_t first = at(object_of(world, garment.cloth).first_face);
    for (std::size_t f = 0; f < gathered.size(); ++f)
      if (!gathered[f]) gauge.counted.push_back(first + f);
  }

  // A seam that is open at the start belongs to the garment that it starts from.
  for (const Seam& seam : scene.seams)
    for (std::size_t g = 0; g < scene.garments.size(); ++g) {
      if (scene.garments[g].cloth != seam.from) continue;
      const Index from = object_of(world, seam.from).first_vertex;
      const Index to = object_of(world, seam.to).first_vertex;
      for (const auto& pair : seam.pairs) gauges_[g].open.push_back({from + pair[0], to + pair[1]});
      gauges_[g].fixed.pairs += seam.pairs.size();
    }
}

std::vector<GarmentState> GarmentGauge::measure(std::span<const Vec3f> positions) const {
  std::vector<GarmentState> states;
  if (gauges_.empty()) return states;
  std::vector<Vec3d> x;
  for (const Vec3f& p : positions.first(at(world_.cloth_vertices))) x.push_back(convert<double>(p));
  const std::vector<double> all = face_strains(world_, x);

  for (const Gauge& gauge : gauges_) {
    GarmentState& state = states.emplace_back(gauge.fixed);
    for (const Pair& pair : gauge.open) {
      const double gap = norm(x[at(pair.a)] - x[at(pair.b)]);
      if (gap > kShut) ++state.open_pairs;
      state.gap = std::max(state.gap, gap);
    }
    std::vector<double> strains;
    for (const std::size_t f : gauge.counted) strains.push_back(all[f]);
    state.strain_p95 = percentile(strains, 0.95);
    state.largest_strain = percentile(std::move(strains), 1);
  }
  return states;
}

}  // namespace icloth
