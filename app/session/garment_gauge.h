// How the sewn cloths of a running scene are: whether their seams are shut, and how far they
// stretch.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/scene/scene.h"
#include "sim/scene/world.h"

namespace icloth {

struct GarmentState {
  std::string name;            ///< of its cloth
  std::size_t pairs = 0;       ///< points that are stitched to each other
  std::size_t open_pairs = 0;  ///< of them, those that are not shut
  double gap = 0;              ///< largest distance of such a pair [m]
  double strain_p95 = 0;       ///< that 95 % of the faces do not exceed; gathers are left out
  double largest_strain = 0;   ///< gathers left out
};

/// One line: "sewn 124/124, max gap 0 mm, strain p95 3 %".
std::string garment_text(const GarmentState& state);
/// All garments as one; the strains are those of the worst.
GarmentState total(std::span<const GarmentState> garments);

class GarmentGauge {
 public:
  /// Both must outlive it.
  GarmentGauge(const Scene& scene, const World& world);

  /// `positions` of all vertices [m].
  std::vector<GarmentState> measure(std::span<const Vec3f> positions) const;

 private:
  struct Pair {
    Index a, b;  ///< vertices of the world
  };
  struct Gauge {
    GarmentState fixed;                ///< name, and pairs that are sewn in the mesh
    std::vector<Pair> open;            ///< pairs of seams that close while the cloth is simulated
    std::vector<std::size_t> counted;  ///< faces of the world outside gathers
  };

  void add(const Scene& scene, Index cloth);

  const World& world_;
  std::vector<Gauge> gauges_;  ///< one for each cloth with stitches
};

}  // namespace icloth
