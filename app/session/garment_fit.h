// Whether the garments of a running scene stay where they are worn: how far they stretch outside
// gathers, and how far waist and collar have come from their place on the body.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/scene/scene.h"
#include "sim/scene/world.h"

namespace icloth {

/// Labels of the edges of a pattern whose centroids are followed.
inline constexpr const char* kWaistLabel = "lower_interface";
inline constexpr const char* kCollarLabel = "collar";

struct GarmentFit {
  std::string name;           ///< of its cloth
  double strain_p95 = 0;      ///< that 95 % of the faces do not exceed; gathers are left out
  double largest_strain = 0;  ///< gathers left out
  std::string panel;          ///< that the face of the largest strain belongs to
  /// Distance of the centroid of the waist and of the collar from where the bone that is nearest to
  /// them would have carried it since time 0 [m]. None where the pattern has no such edge, or the
  /// body has no bones.
  std::optional<double> waist, collar;
};

class GarmentFitGauge {
 public:
  /// `scene` is dressed, and must outlive the gauge.
  explicit GarmentFitGauge(const Scene& scene);

  /// One for each garment; `positions` of all vertices at a time of the scene [m], [s].
  std::vector<GarmentFit> measure(std::span<const Vec3f> positions, double time) const;

 private:
  /// The vertices of the edges with one label, and the bone that their centroid should follow.
  struct Border {
    std::vector<Index> vertices;  ///< of the world
    std::size_t bone = 0;
    Vec3d start;  ///< their centroid at time 0 [m]
  };
  struct Gauge {
    const Garment* garment = nullptr;
    const Obstacle* body = nullptr;  ///< null: none with bones
    Index first_face = 0;            ///< of the cloth in the world
    std::vector<std::size_t> faces;  ///< of the world, outside gathers
    std::optional<Border> waist, collar;
  };

  std::optional<Border> find_border(const Gauge& gauge, const char* label,
                                    Index first_vertex) const;
  std::optional<double> distance(const Gauge& gauge, const std::optional<Border>& border,
                                 std::span<const Vec3d> x, double time) const;

  const Scene& scene_;
  World world_;
  std::vector<Gauge> gauges_;
};

}  // namespace icloth
