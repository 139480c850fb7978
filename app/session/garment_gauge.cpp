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
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) add(scene, static_cast<Index>(c));
}

/// Adds a gauge for a cloth that is a garment or has open seams; the seam between two cloths is
/// that of the first.
void GarmentGauge::add(const Scene& scene, Index cloth) {
  const auto is_of_cloth = [&](const Garment& g) { return g.cloth == cloth; };
  const auto garment = std::ranges::find_if(scene.garments, is_of_cloth);
  const bool is_sewn = garment != scene.garments.end();
  const WorldObject& object = object_of(world_, cloth);
  Gauge gauge;
  gauge.fixed.name = scene.cloths[at(cloth)].name;
  if (is_sewn)
    for (const SewnSeam& seam : garment->sewn.seams) gauge.fixed.pairs += seam.points.size();

  // The pairs of open seams are followed one by one.
  for (const Seam& seam : scene.seams) {
    if (seam.from != cloth) continue;
    const Index to = object_of(world_, seam.to).first_vertex;
    for (const auto& [a, b] : seam.pairs) gauge.open.push_back({object.first_vertex + a, to + b});
  }
  gauge.fixed.pairs += gauge.open.size();
  if (gauge.fixed.pairs == 0) return;

  // Cloth that is gathered is stretched by the pattern itself.
  const std::vector<bool> gathered = is_sewn ? gathered_faces(*garment, scene.cloths[at(cloth)])
                                             : std::vector<bool>(at(object.face_count));
  for (std::size_t f = 0; f < gathered.size(); ++f)
    if (!gathered[f]) gauge.counted.push_back(at(object.first_face) + f);
  gauges_.push_back(std::move(gauge));
}

std::vector<GarmentState> GarmentGauge::measure(std::span<const Vec3f> positions) const {
  std::vector<GarmentState> states;
  if (gauges_.empty()) return states;
  std::vector<Vec3d> x;
  for (const Vec3f& p : positions.first(at(world_.cloth_vertices))) x.push_back(convert<double>(p));
  const std::vector<double> all = face_strains(world_, x);

  // Each cloth with stitches has a state of its own.
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
