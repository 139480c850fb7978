#include "sim/garment/stands.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/index.h"
#include "sim/files/box.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr double kRadians = std::numbers::pi / 180;  // of a degree
constexpr double kMiddle = 0.005;  // a panel may cross the middle plane by so much [m]
constexpr double kMirror = 0.02;   // mirrored panels may stand so far from their image [m]

Box box_of(const Panel& panel) { return box_around(place_points(panel.corners, panel.placement)); }

/// Outside of a panel in space, where its right side faces.
Vec3d outside_of(const Panel& panel) {
  PanelPlacement turn = panel.placement;
  turn.translation = {};
  turn.bend_radius = 0;
  const Vec2d corners[] = {{0, 0}, {1, 0}, {0, 1}};
  const std::vector<Vec3d> x = place_points(corners, turn);
  const Vec3d normal = cross(x[1] - x[0], x[2] - x[0]);
  return panel.clockwise ? -1.0 * normal : normal;
}

/// Where an edge of a panel stands, as the pattern has it.
std::vector<Vec3d> edge_in_space(const MeshedPattern& meshed, PanelSide side) {
  const PanelMesh& mesh = meshed.panels[at(side.panel)];
  std::vector<Vec2d> points;
  for (Index p : mesh.edge_points[at(side.edge)]) points.push_back(mesh.points[at(p)]);
  return place_points(points, meshed.pattern.panels[at(side.panel)].placement);
}

}  // namespace

PanelStands::PanelStands(const MeshedPattern& meshed) : panels_(meshed.pattern.panels) {
  // A panel is turned about the end of it that is nearer to the middle plane …
  for (const Panel& panel : panels_) {
    const Box box = box_of(panel);
    const int side = box.low.x > kMiddle ? 1 : box.high.x < -kMiddle ? -1 : 0;
    side_.push_back(side);
    joint_.push_back({side > 0 ? box.low.x : box.high.x, 0.5 * (box.low.y + box.high.y), 0});
  }

  // … unless the limb is sewn to the trunk: then all of its panels turn about that seam, the middle
  // of an armhole say.
  for (const int side : {1, -1}) {
    Vec3d sum;
    double points = 0;
    for (const Stitch& stitch : meshed.pattern.stitches)
      for (const auto& [limb, trunk] : {std::pair{stitch.sides[0], stitch.sides[1]},
                                        std::pair{stitch.sides[1], stitch.sides[0]}})
        if (side_[at(limb.panel)] == side && side_[at(trunk.panel)] == 0)
          for (Vec3d p : edge_in_space(meshed, trunk)) {
            sum += p;
            ++points;
          }
    if (points > 0)
      for (std::size_t p = 0; p < size(); ++p)
        if (side_[p] == side) joint_[p] = (1 / points) * sum;
  }
}

bool PanelStands::has_limbs() const {
  return std::ranges::any_of(side_, [](int side) { return side != 0; });
}

std::vector<PanelGroup> PanelStands::groups() const {
  std::vector<Box> boxes;
  for (const Panel& panel : panels_) boxes.push_back(box_of(panel));
  const auto is_mirror = [&](const Box& a, const Box& b) {
    const Vec3d low{-b.high.x, b.low.y, b.low.z}, high{-b.low.x, b.high.y, b.high.z};
    return norm(a.low - low) < kMirror && norm(a.high - high) < kMirror;
  };

  std::vector<PanelGroup> groups;
  std::vector<bool> taken(size());
  for (std::size_t p = 0; p < size(); ++p) {
    if (taken[p]) continue;
    PanelGroup group{{p}, is_limb(p)};
    for (std::size_t q = p + 1; q < size() && group.panels.size() == 1; ++q)
      if (!taken[q] && is_mirror(boxes[p], boxes[q])) group.panels.push_back(q);
    for (std::size_t q : group.panels) taken[q] = true;
    groups.push_back(std::move(group));
  }

  // What goes round the trunk moves together as well, and so do the sleeves or legs beside it.
  PanelGroup trunk, limbs;
  limbs.limb = true;
  for (std::size_t p = 0; p < size(); ++p) (is_limb(p) ? limbs : trunk).panels.push_back(p);
  for (PanelGroup* group : {&trunk, &limbs})
    if (group->panels.size() > 1 && group->panels.size() < size())
      groups.push_back(std::move(*group));
  return groups;
}

PanelPlacement PanelStands::placed(std::size_t p, const Stand& stand) const {
  const Panel& panel = panels_[p];
  PanelPlacement place = panel.placement;
  place.translation += stand.distance * outside_of(panel);
  if (stand.tilt > 0) {
    // Seen from the front, what is left of the wearer's middle turns clockwise.
    const double turn = -side_[p] * stand.tilt;
    const double c = std::cos(turn * kRadians), s = std::sin(turn * kRadians);
    const Vec3d t = place.translation - joint_[p];
    place.translation = joint_[p] + Vec3d{c * t.x - s * t.y, s * t.x + c * t.y, t.z};
    place.rotation.z += turn;  // the last of the turns about the axes
  }
  place.translation += {side_[p] * stand.spread, stand.lift, 0};
  if (stand.radius) place.bend_radius = (panel.clockwise ? -1 : 1) * *stand.radius;
  return place;
}

std::vector<PanelPlacement> PanelStands::placed(std::span<const Stand> stands) const {
  std::vector<PanelPlacement> result;
  for (std::size_t p = 0; p < size(); ++p) result.push_back(placed(p, stands[p]));
  return result;
}

std::vector<std::string> PanelStands::in_words(std::span<const Stand> stands) const {
  std::vector<std::string> moved;
  for (std::size_t p = 0; p < stands.size(); ++p) {
    const Stand& stand = stands[p];
    std::vector<std::string> parts;

    // What differs from the pattern, each in words.
    if (stand.distance > 0) parts.push_back(rounded_text(100 * stand.distance) + " cm further out");
    if (stand.lift != 0)
      parts.push_back(rounded_text(100 * std::fabs(stand.lift)) + " cm " +
                      (stand.lift > 0 ? "higher" : "lower"));
    if (stand.spread > 0) parts.push_back(rounded_text(100 * stand.spread) + " cm further apart");
    if (stand.tilt > 0) parts.push_back("tilted by " + rounded_text(stand.tilt) + "°");
    if (stand.radius)
      parts.push_back(*stand.radius == 0 ? "flat"
                                         : "bent to " + rounded_text(100 * *stand.radius) + " cm");
    if (parts.empty()) continue;

    // The parts become one clause about the panel.
    std::string clause = "panel " + in_quotes(panels_[p].name) + " is ";
    for (std::size_t i = 0; i < parts.size(); ++i)
      clause += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
    moved.push_back(clause);
  }
  return moved;
}

}  // namespace icloth
