// Meshes the panels of a pattern. Stitched edges are divided alike, so all panels are done
// together.
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "kernels/index.h"
#include "sim/files/error.h"
#include "sim/files/ring_crossings.h"
#include "sim/files/text.h"
#include "sim/pattern/outline.h"
#include "sim/pattern/panel_mesh.h"
#include "sim/pattern/sewing.h"

namespace icloth {
namespace {

constexpr int kMostDivisions = 12;  ///< rounds in which edges that are missing are divided
constexpr double kDense = 0.8;      ///< mean of the outline's edges, below which a panel is finer
constexpr double kDensest = 0.4;    ///< shortest edge length inside of such a panel
constexpr std::size_t kMostNotes = 5;     ///< of one kind
constexpr double kCountTolerance = 0.01;  ///< share by which the number of triangles may differ
constexpr int kMostCorrections = 3;       ///< of the edge length, to get a number of triangles

std::string cm(double metres) { return rounded_text(100 * metres) + " cm"; }

/// How one edge of a panel is divided.
struct DividedEdge {
  EdgePath path;
  std::vector<double> shares;        ///< of the length at which its points are, from 0 to 1
  std::optional<PanelSide> partner;  ///< the edge that it is sewn to
  bool reversed = true;              ///< the start of this edge meets the end of the partner
};

/// Meshing of one pattern.
class PatternMesher {
 public:
  PatternMesher(const Pattern& pattern, double edge_length) : edge_length_(edge_length) {
    meshed_.pattern = pattern;
    meshed_.edge_length = edge_length;
    make_edges();
    check_size();
    divide_edges();
  }

  MeshedPattern mesh() {
    meshed_.panels.resize(edges_.size());
    std::set<Index> todo;
    for (std::size_t p = 0; p < edges_.size(); ++p) todo.insert(static_cast<Index>(p));

    // A panel whose outline has gaps in its triangulation gets points between the ends of the gaps,
    // and so do the panels that are sewn there. Then these are meshed again.
    for (int round = 0; !todo.empty(); ++round) {
      std::set<std::pair<Index, Index>> gaps;
      for (const Index p : todo) mesh_panel(p, gaps);
      todo.clear();
      if (!gaps.empty() && round == kMostDivisions) refuse_gap(*gaps.begin());
      divide_gaps(gaps, todo);
    }
    return std::move(meshed_);
  }

 private:
  /// A segment of an edge, numbered over all edges of its panel.
  struct Segment {
    Index edge, segment;
  };

  const Panel& panel(Index p) const { return meshed_.pattern.panels[at(p)]; }
  std::string place(Index p) const {
    return meshed_.pattern.file + ": panel " + in_quotes(panel(p).name);
  }

  void check_size() const;
  void divide_edges();
  void note_short_edges();
  void make_edges();
  double segments_of(Index p, Index e) const;
  double segments_for(const DividedEdge& edge, bool is_straight) const;
  std::vector<GridPoint> loop_of(Index p) const;
  void check_ring(Index p, std::span<const GridPoint> ring) const;
  double spacing_of(Index p, double segments) const;
  void mesh_panel(Index p, std::set<std::pair<Index, Index>>& gaps);
  void store(Index p, const OutlineMesh& mesh, Index ring);
  Segment segment_of(Index p, Index number) const;
  void divide_gaps(const std::set<std::pair<Index, Index>>& gaps, std::set<Index>& todo);
  [[noreturn]] void refuse_gap(std::pair<Index, Index> gap) const;

  double edge_length_;
  MeshedPattern meshed_;
  std::vector<std::vector<DividedEdge>> edges_;  ///< of each panel
};

/// Refuses an edge length with which the mesh would be too large. Segments are counted as numbers
/// before memory is taken for them.
void PatternMesher::check_size() const {
  if (!(edge_length_ >= 1e-4 && edge_length_ <= 1))
    throw InputError(meshed_.pattern.file + ": edge length " + number_text(edge_length_) +
                     " m, expected 0.0001 to 1 m");

  // The area inside, and a triangle for every segment of the outline.
  double triangles = 0;
  for (std::size_t p = 0; p < edges_.size(); ++p) {
    double segments = 0;
    for (std::size_t e = 0; e < edges_[p].size(); ++e)
      segments += segments_of(static_cast<Index>(p), static_cast<Index>(e));
    const double spacing = spacing_of(static_cast<Index>(p), segments);
    triangles += 2.31 * std::fabs(signed_area(panel(static_cast<Index>(p)))) / (spacing * spacing) +
                 segments;
  }
  if (triangles > kMostPatternTriangles)
    throw InputError(meshed_.pattern.file + ": edge length " + number_text(edge_length_) +
                     " m would give about " + rounded_text(triangles) +
                     " triangles, expected at most " + number_text(kMostPatternTriangles));
}

/// Segments of an edge by itself. An edge far below the edge length stays in one piece; others that
/// are curved or sewn get a point between their ends at least.
double PatternMesher::segments_for(const DividedEdge& edge, bool is_straight) const {
  const double count = edge.path.length() / edge_length_;
  if (count < 0.25) return 1;
  const double segments = std::max(1.0, std::ceil(count - 1e-6));
  return edge.partner || !is_straight ? std::max(segments, 2.0) : segments;
}

/// The edges with their partners, not divided yet.
void PatternMesher::make_edges() {
  for (const Panel& panel : meshed_.pattern.panels) {
    std::vector<DividedEdge> edges;
    for (const PanelEdge& edge : panel.edges)
      edges.push_back({EdgePath(panel, edge), {}, {}, true});
    edges_.push_back(std::move(edges));
  }
  for (const Stitch& stitch : meshed_.pattern.stitches)
    for (std::size_t k = 0; k < 2; ++k) {
      DividedEdge& edge = edges_[at(stitch.sides[k].panel)][at(stitch.sides[k].edge)];
      edge.partner = stitch.sides[1 - k];
      edge.reversed = !stitch.right_wrong;
    }
}

/// Segments of an edge: both edges of a stitch get as many as the longer one needs.
double PatternMesher::segments_of(Index p, Index e) const {
  const DividedEdge& edge = edges_[at(p)][at(e)];
  const double own = segments_for(edge, panel(p).edges[at(e)].curve == EdgeCurve::straight);
  if (!edge.partner) return own;
  const auto [other, number] = *edge.partner;
  const bool is_straight = panel(other).edges[at(number)].curve == EdgeCurve::straight;
  return std::max(own, segments_for(edges_[at(other)][at(number)], is_straight));
}

void PatternMesher::divide_edges() {
  for (std::size_t p = 0; p < edges_.size(); ++p)
    for (std::size_t e = 0; e < edges_[p].size(); ++e) {
      const double count = segments_of(static_cast<Index>(p), static_cast<Index>(e));
      for (double i = 0; i <= count; ++i) edges_[p][e].shares.push_back(i / count);
    }
  note_short_edges();
}

void PatternMesher::note_short_edges() {
  std::size_t count = 0;
  for (std::size_t p = 0; p < edges_.size(); ++p)
    for (std::size_t e = 0; e < edges_[p].size(); ++e) {
      const double length = edges_[p][e].path.length();
      if (length >= 0.25 * edge_length_ || ++count > kMostNotes) continue;
      meshed_.notes.push_back(place(static_cast<Index>(p)) + ": edge " + std::to_string(e) +
                              " is " + cm(length) + " long, less than a quarter of the edge " +
                              "length " + cm(edge_length_) + ": triangles beside it are worse");
    }
  if (count > kMostNotes)
    meshed_.notes.push_back(meshed_.pattern.file + ": " + std::to_string(count - kMostNotes) +
                            " more edges are as short");
}

/// The points of the outline in the order of the edges.
std::vector<GridPoint> PatternMesher::loop_of(Index p) const {
  std::vector<GridPoint> loop;
  for (const DividedEdge& edge : edges_[at(p)])
    for (std::size_t i = 0; i + 1 < edge.shares.size(); ++i)
      loop.push_back(to_grid(edge.path.at(edge.shares[i])));
  return loop;
}

/// Refuses an outline that is simple as a curve, but not with so few points.
void PatternMesher::check_ring(Index p, std::span<const GridPoint> ring) const {
  std::vector<GridPoint> sorted(ring.begin(), ring.end());
  std::ranges::sort(sorted);
  const bool touches = std::ranges::adjacent_find(sorted) != sorted.end();
  if (ring.size() >= 3 && !touches && !crosses_itself(ring)) return;
  throw InputError(place(p) + ": the outline touches or crosses itself when its edges are cut to " +
                   "edge length " + cm(edge_length_) + ", expected a simple loop: try a shorter " +
                   "edge length");
}

/// Edge length inside of a panel. A band that is sewn to a wider piece has more points on its
/// outline than by its size, and gets shorter edges inside as well.
double PatternMesher::spacing_of(Index p, double segments) const {
  double length = 0;
  for (const DividedEdge& edge : edges_[at(p)]) length += edge.path.length();
  const double mean = length / segments;
  return mean < kDense * edge_length_ ? std::max(mean, kDensest * edge_length_) : edge_length_;
}

void PatternMesher::mesh_panel(Index p, std::set<std::pair<Index, Index>>& gaps) {
  // The mesher wants the outline to turn counter-clockwise. Reversed, it begins with the same
  // point.
  std::vector<GridPoint> ring = loop_of(p);
  check_ring(p, ring);
  const auto count = static_cast<Index>(ring.size());
  if (panel(p).clockwise) std::reverse(ring.begin() + 1, ring.end());

  const OutlineMesh mesh = mesh_outline(ring, spacing_of(p, count) / kPanelGrid);
  for (const Index i : mesh.missing) gaps.insert({p, panel(p).clockwise ? count - 1 - i : i});
  if (!mesh.missing.empty()) return;
  if (mesh.faces.empty())
    throw InputError(place(p) + ": cannot be meshed with edge length " + cm(edge_length_) +
                     ", expected an outline whose parts do not touch each other");
  store(p, mesh, count);
}

/// Keeps a mesh, with the outline in the order of the edges again.
void PatternMesher::store(Index p, const OutlineMesh& mesh, Index ring) {
  const bool reversed = panel(p).clockwise;
  const auto place_of = [&](Index i) { return reversed && i < ring && i > 0 ? ring - i : i; };
  PanelMesh& result = meshed_.panels[at(p)];
  result.points.resize(mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    result.points[at(place_of(static_cast<Index>(i)))] = from_grid(mesh.points[i]);
  result.faces.clear();
  for (const Triangle& t : mesh.faces)
    result.faces.push_back({place_of(t[0]), place_of(t[1]), place_of(t[2])});

  result.edge_points.clear();
  Index first = 0;
  for (const DividedEdge& edge : edges_[at(p)]) {
    std::vector<Index> points;
    for (std::size_t i = 0; i < edge.shares.size(); ++i)
      points.push_back((first + static_cast<Index>(i)) % ring);
    first = points.back();
    result.edge_points.push_back(std::move(points));
  }
}

PatternMesher::Segment PatternMesher::segment_of(Index p, Index number) const {
  Index edge = 0;
  for (const DividedEdge& divided : edges_[at(p)]) {
    const auto count = static_cast<Index>(divided.shares.size()) - 1;
    if (number < count) break;
    number -= count;
    ++edge;
  }
  return {edge, number};
}

/// Halves segments of outlines and of what is sewn to them; adds the panels to `todo`.
void PatternMesher::divide_gaps(const std::set<std::pair<Index, Index>>& gaps,
                                std::set<Index>& todo) {
  // Panel, edge and segment, each once.
  std::set<std::array<Index, 3>> halved;
  for (const auto& [p, number] : gaps) {
    const Segment gap = segment_of(p, number);
    const DividedEdge& edge = edges_[at(p)][at(gap.edge)];
    halved.insert({p, gap.edge, gap.segment});
    if (!edge.partner) continue;
    const auto last = static_cast<Index>(edge.shares.size()) - 2;
    halved.insert({edge.partner->panel, edge.partner->edge,
                   edge.reversed ? last - gap.segment : gap.segment});
  }

  // From the last segment to the first, so that numbers stay valid.
  for (auto entry = halved.rbegin(); entry != halved.rend(); ++entry) {
    const auto& [p, e, segment] = *entry;
    std::vector<double>& shares = edges_[at(p)][at(e)].shares;
    const double middle = 0.5 * (shares[at(segment)] + shares[at(segment) + 1]);
    shares.insert(shares.begin() + segment + 1, middle);
    todo.insert(p);
  }
}

void PatternMesher::refuse_gap(std::pair<Index, Index> gap) const {
  const Index edge = segment_of(gap.first, gap.second).edge;
  throw InputError(place(gap.first) + ": edge " + std::to_string(edge) +
                   " is too near to another edge to be meshed with edge length " +
                   cm(edge_length_) + ", expected edges that are farther apart");
}

}  // namespace

MeshedPattern mesh_pattern(const Pattern& pattern, double edge_length) {
  return PatternMesher(pattern, edge_length).mesh();
}

double edge_length_for(const Pattern& pattern, Index triangles) {
  double area = 0;
  for (const Panel& panel : pattern.panels) area += std::fabs(signed_area(panel));
  return std::sqrt(2.31 * area / std::max<double>(triangles, 1));
}

Index triangle_count(const MeshedPattern& meshed) {
  std::size_t count = 0;
  for (const PanelMesh& panel : meshed.panels) count += panel.faces.size();
  return static_cast<Index>(count);
}

MeshedPattern mesh_with_count(const Pattern& pattern, Index triangles) {
  const auto ratio = [&](const MeshedPattern& meshed) {
    return triangle_count(meshed) / static_cast<double>(triangles);
  };
  const auto miss = [&](const MeshedPattern& meshed) { return std::fabs(ratio(meshed) - 1); };
  MeshedPattern best = mesh_pattern(pattern, edge_length_for(pattern, triangles));

  // Outlines are cut into whole numbers of edges, so that the estimate misses by some per cent. A
  // length that is corrected by what came out misses by less, except in the coarsest meshes. Where
  // it does not, half the correction may.
  double power = 0.5;
  for (int i = 0; i < kMostCorrections && miss(best) > kCountTolerance; ++i) {
    try {
      MeshedPattern next = mesh_pattern(pattern, best.edge_length * std::pow(ratio(best), power));
      if (miss(next) < miss(best))
        best = std::move(next);
      else
        power *= 0.5;
    } catch (const InputError&) {
      break;  // the pattern cannot be meshed with that length
    }
  }
  return best;
}

}  // namespace icloth
