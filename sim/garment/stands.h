// How the panels of a garment may stand at its start, other than as the pattern has them: further
// away from the body, higher, bent otherwise, sleeves turned down.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/pattern/sewing.h"

namespace icloth {

/// How a panel stands against its place in the pattern.
struct Stand {
  double distance = 0, lift = 0;  ///< outwards and upwards [m]
  double spread = 0;              ///< of a sleeve or leg, away from the middle plane [m]
  double tilt = 0;                ///< of a sleeve or leg, its outer end downwards [degrees]
  std::optional<double> radius;   ///< of bending [m], 0: flat; none: the pattern's own
  bool operator==(const Stand&) const = default;
};

/// Panels that move together: one panel, a panel and its mirror image, those of the trunk or those
/// of the limbs.
struct PanelGroup {
  std::vector<std::size_t> panels;
  bool limb = false;  ///< beside the middle plane: it may be tilted
};

/// The stands that the panels of one pattern can take.
class PanelStands {
 public:
  explicit PanelStands(const MeshedPattern& meshed);

  std::size_t size() const { return panels_.size(); }
  bool has_limbs() const;
  bool is_limb(std::size_t panel) const { return side_[panel] != 0; }

  /// Each panel with the one that stands where its mirror image does, then trunk and limbs.
  std::vector<PanelGroup> groups() const;

  /// Where a panel stands then.
  PanelPlacement placed(std::size_t panel, const Stand& stand) const;
  /// Where all panels stand then.
  std::vector<PanelPlacement> placed(std::span<const Stand> stands) const;

  /// "panel 'front' is 4 cm further out, 2 cm higher and flat", for each panel that moves.
  std::vector<std::string> in_words(std::span<const Stand> stands) const;

 private:
  std::span<const Panel> panels_;
  std::vector<int> side_;  ///< of each panel: 1 left of the middle plane, −1 right, 0 across it
  std::vector<Vec3d> joint_;  ///< of each panel: the point about which it is tilted [m]
};

}  // namespace icloth
