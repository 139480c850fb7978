#include "sim/pattern/sewing.h"

#include <algorithm>
#include <cmath>

#include "kernels/index.h"
#include "sim/files/disjoint_sets.h"
#include "sim/files/text.h"
#include "sim/pattern/pattern_checks.h"

namespace icloth {
namespace {

/// Between the panels in material coordinates [m]; a multiple of the grid, so that nothing is
/// rounded.
constexpr double kUvGap = 1.0 / 64;

/// A seam whose edges would run alike within this share of what they do, with one of them turned
/// round, is reported as twisted.
constexpr double kTwisted = 0.5;
constexpr double kTooShort = 0.1;

std::string cm(double metres) { return rounded_text(100 * metres) + " cm"; }

/// Sewing of one garment.
class Sewing {
 public:
  Sewing(const MeshedPattern& meshed, std::span<const PanelPlacement> placements)
      : meshed_(meshed), pattern_(meshed.pattern) {
    for (std::size_t p = 0; p < meshed.panels.size(); ++p) {
      first_.push_back(static_cast<Index>(garment_.open_positions.size()));
      garment_.panel_names.push_back(pattern_.panels[p].name);
      const auto placed = place_points(meshed.panels[p].points, placements[p]);
      garment_.open_positions.insert(garment_.open_positions.end(), placed.begin(), placed.end());
    }
  }

  SewnGarment sew() {
    for (std::size_t s = 0; s < pattern_.stitches.size(); ++s) add_seam(s);
    merge_points();
    add_faces();
    note_branches();
    add_labels();
    return std::move(garment_);
  }

 private:
  void note(const std::string& text) { garment_.notes.push_back(pattern_.file + ": " + text); }

  struct Gap {
    double mean = 0, largest = 0;  ///< distance of the points of a pair [m]
    double uneven = 0;             ///< the same without the distance of the edges' middles [m]
  };

  void add_seam(std::size_t s);
  Gap gap_between(std::span<const Index> a, std::span<const Index> b) const;
  void merge_points();
  void add_faces();
  void note_branches();
  void add_labels();
  std::vector<Vec2d> material_coordinates(std::size_t p, double& right) const;
  std::vector<Index> points_of(PanelSide side) const;

  const MeshedPattern& meshed_;
  const Pattern& pattern_;
  std::vector<Index> first_;  ///< vertex of the open mesh of each panel
  SewnGarment garment_;
};

/// Points of an edge, as vertices of the open mesh.
std::vector<Index> Sewing::points_of(PanelSide side) const {
  std::vector<Index> points = meshed_.panels[at(side.panel)].edge_points[at(side.edge)];
  for (Index& v : points) v += first_[at(side.panel)];
  return points;
}

void Sewing::add_seam(std::size_t s) {
  const auto [a, b] = pattern_.stitches[s].sides;
  const std::vector<Index> side_a = points_of(a);
  std::vector<Index> side_b = points_of(b);
  if (!pattern_.stitches[s].right_wrong) std::ranges::reverse(side_b);

  SewnSeam seam{a.panel, a.edge, b.panel, b.edge, 0, 0, {}, 0, 0};
  seam.length_a = stitched_length(pattern_, s, 0);
  seam.length_b = stitched_length(pattern_, s, 1);
  const Gap gap = gap_between(side_a, side_b);
  seam.mean_gap = gap.mean;
  seam.largest_gap = gap.largest;
  for (std::size_t i = 0; i < side_a.size(); ++i) seam.points.push_back({side_a[i], side_b[i]});
  garment_.seams.push_back(std::move(seam));

  // Two edges of one panel may point anywhere before the panel is bent, but a right side that is
  // sewn to a wrong side makes a Möbius strip of it.
  if (a.panel == b.panel) {
    if (pattern_.stitches[s].right_wrong)
      note(stitch_name(pattern_, s) +
           " looks twisted: it sews the right side of a panel to its own " +
           "wrong side; is \"right_wrong\" right?");
    return;
  }

  // Panels may be far apart, so the distance between their middles does not count. An edge that is
  // short beside that distance may run around the body, and its direction tells nothing.
  std::ranges::reverse(side_b);
  const Gap turned = gap_between(side_a, side_b);
  if (gap.uneven > kTooShort * gap.mean && turned.uneven < kTwisted * gap.uneven)
    note(stitch_name(pattern_, s) + " looks twisted: its points are " + cm(gap.mean) +
         " apart, and " + cm(turned.mean) +
         " with one edge turned round; is \"right_wrong\" right?");
}

/// Distances between the points of two edges, pair by pair.
Sewing::Gap Sewing::gap_between(std::span<const Index> a, std::span<const Index> b) const {
  const auto difference = [&](std::size_t i) {
    return garment_.open_positions[at(a[i])] - garment_.open_positions[at(b[i])];
  };
  const double share = 1 / static_cast<double>(a.size());
  Gap gap;
  Vec3d middle;
  for (std::size_t i = 0; i < a.size(); ++i) {
    middle += share * difference(i);
    gap.mean += share * norm(difference(i));
    gap.largest = std::max(gap.largest, norm(difference(i)));
  }
  for (std::size_t i = 0; i < a.size(); ++i) gap.uneven += share * norm(difference(i) - middle);
  return gap;
}

/// Makes one vertex of the points that are sewn together, directly or by way of others, at the mean
/// of their places.
void Sewing::merge_points() {
  const std::size_t count = garment_.open_positions.size();
  DisjointSets groups(count);
  for (const SewnSeam& seam : garment_.seams)
    for (const auto& [a, b] : seam.points) groups.unite(at(a), at(b));

  // Groups are numbered in the order of their first points, which stand for them.
  std::vector<Vec3d>& positions = garment_.mesh.positions;
  std::vector<double> members;
  garment_.merged.resize(count);
  for (std::size_t v = 0; v < count; ++v) {
    const std::size_t first = groups.find(v);
    if (first == v) {
      garment_.merged[v] = static_cast<Index>(positions.size());
      positions.push_back({});
      members.push_back(0);
    } else {
      garment_.merged[v] = garment_.merged[first];
    }
    positions[at(garment_.merged[v])] += garment_.open_positions[v];
    ++members[at(garment_.merged[v])];
  }
  for (std::size_t v = 0; v < positions.size(); ++v) positions[v] = (1 / members[v]) * positions[v];
}

/// Material coordinates of a panel, with its left border at `right`, which moves to where the next
/// panel begins.
std::vector<Vec2d> Sewing::material_coordinates(std::size_t p, double& right) const {
  std::vector<Vec2d> uv = meshed_.panels[p].points;
  if (pattern_.panels[p].clockwise)
    for (Vec2d& c : uv) c.x = -c.x;
  const auto [low, high] = std::ranges::minmax(uv, {}, &Vec2d::x);
  for (Vec2d& c : uv) c.x += right - low.x;
  right += std::ceil((high.x - low.x) / kUvGap + 1) * kUvGap;
  return uv;
}

void Sewing::add_faces() {
  double right = 0;
  std::size_t dropped = 0;
  for (std::size_t p = 0; p < meshed_.panels.size(); ++p) {
    const std::vector<Vec2d> uv = material_coordinates(p, right);
    for (Triangle t : meshed_.panels[p].faces) {
      if (pattern_.panels[p].clockwise) std::swap(t[1], t[2]);
      Triangle merged;
      for (std::size_t k = 0; k < 3; ++k) merged[k] = garment_.merged[at(first_[p] + t[k])];

      // Two corners in one vertex leave nothing of a triangle.
      if (merged[0] == merged[1] || merged[1] == merged[2] || merged[2] == merged[0]) {
        ++dropped;
        continue;
      }
      garment_.mesh.faces.push_back(merged);
      garment_.mesh.uv.push_back({uv[at(t[0])], uv[at(t[1])], uv[at(t[2])]});
      garment_.panel.push_back(static_cast<Index>(p));
    }
  }
  if (dropped > 0)
    note(std::to_string(dropped) +
         " triangles have two corners that are sewn together and are left out");
}

/// Notes edges at which more than two faces meet.
void Sewing::note_branches() {
  std::vector<std::array<Index, 2>> edges;
  for (const Triangle& t : garment_.mesh.faces)
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  std::ranges::sort(edges);
  std::size_t branches = 0;
  for (std::size_t i = 0; i < edges.size();) {
    const std::size_t first = i;
    while (i < edges.size() && edges[i] == edges[first]) ++i;
    branches += i - first > 2;
  }
  if (branches > 0)
    note(std::to_string(branches) + " edges of the sewn mesh have more than two faces");
}

void Sewing::add_labels() {
  for (std::size_t p = 0; p < pattern_.panels.size(); ++p)
    for (std::size_t e = 0; e < pattern_.panels[p].edges.size(); ++e) {
      const std::string& label = pattern_.panels[p].edges[e].label;
      if (label.empty()) continue;
      const PanelSide side{static_cast<Index>(p), static_cast<Index>(e)};
      std::vector<Index> vertices = points_of(side);
      for (Index& v : vertices) v = garment_.merged[at(v)];
      garment_.labelled.push_back({label, side.panel, side.edge, std::move(vertices)});
    }
}

}  // namespace

SewnGarment sew_panels(const MeshedPattern& meshed, std::span<const PanelPlacement> placements) {
  return Sewing(meshed, placements).sew();
}

SewnGarment sew_pattern(const Pattern& pattern, double edge_length) {
  const MeshedPattern meshed = mesh_pattern(pattern, edge_length);
  SewnGarment garment = sew_panels(meshed, placements_of(pattern));
  std::vector<std::string> notes = pattern.notes;
  notes.insert(notes.end(), meshed.notes.begin(), meshed.notes.end());
  notes.insert(notes.end(), garment.notes.begin(), garment.notes.end());
  garment.notes = std::move(notes);
  return garment;
}

}  // namespace icloth
