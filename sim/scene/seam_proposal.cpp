#include "sim/scene/seam_proposal.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "kernels/index.h"
#include "sim/files/disjoint_sets.h"
#include "sim/files/error.h"
#include "sim/files/text.h"
#include "sim/scene/box_tree.h"
#include "sim/scene/half_edges.h"

namespace icloth {
namespace {

constexpr std::size_t kShortestRow = 3;            ///< pairs; fewer are chance
constexpr Index kLongestStride = 3;                ///< vertices from one pair of a row to the next
constexpr std::size_t kMostMeetings = 50'000'000;  ///< vertices within reach of one, summed up

/// A vertex of the border of a mesh.
struct BorderVertex {
  Index vertex = 0;
  Index strand = 0;  ///< the run of the border that it lies on
  Index place = 0;   ///< number along the strand
  double way = 0;    ///< along the strand from its first vertex [m]
  Vec3d inward{};    ///< unit vector from the border into the surface
};

/// The border of a mesh in runs without branches.
struct Borders {
  std::vector<BorderVertex> vertices;  ///< strand by strand, in order
  std::vector<Index> first;            ///< of each strand, and the end of the last
  std::vector<double> closed_length;   ///< of a closed strand [m]; 0: it is open
};

Index strand_size(const Borders& borders, Index strand) {
  return borders.first[at(strand) + 1] - borders.first[at(strand)];
}

/// Border edges at each vertex, and the directions from them into their faces.
struct BorderGraph {
  std::map<Index, std::vector<Index>> neighbours;
  std::map<Index, Vec3d> inward;
};

BorderGraph border_graph(const TriangleMesh& mesh) {
  BorderGraph graph;
  for (const HalfEdge& side : border_sides(mesh.faces)) {
    const auto [a, b] = side.edge;
    graph.neighbours[a].push_back(b);
    graph.neighbours[b].push_back(a);

    // Inward is the direction of the third corner, across the edge.
    const Index third = mesh.faces[at(side.face)][at((side.corner + 2) % 3)];
    const Vec3d along = normalized(mesh.positions[at(b)] - mesh.positions[at(a)]);
    const Vec3d to_third = mesh.positions[at(third)] - mesh.positions[at(a)];
    const Vec3d across = normalized(to_third - dot(to_third, along) * along);
    for (const Index v : {a, b}) graph.inward[v] = graph.inward[v] + across;
  }
  return graph;
}

/// Follows the border from each vertex where it branches or ends, then around closed runs. These
/// start at a vertex that is not in `inner` where there is one.
Borders trace_borders(const TriangleMesh& mesh, const std::set<Index>& inner) {
  BorderGraph graph = border_graph(mesh);
  Borders borders;
  std::set<Index> passed;

  const auto follow = [&](Index start) {
    borders.first.push_back(static_cast<Index>(borders.vertices.size()));
    const auto strand = static_cast<Index>(borders.closed_length.size());
    double way = 0;
    Index place = 0, v = start, last = kNone;
    while (true) {
      passed.insert(v);
      borders.vertices.push_back({v, strand, place++, way, normalized(graph.inward[v])});

      // The next vertex is the first neighbour that was not passed.
      Index next = kNone;
      for (const Index w : graph.neighbours[v])
        if (w != last && !passed.contains(w) && next == kNone) next = w;
      const std::vector<Index>& around = graph.neighbours[v];
      const bool returns = place > 2 && std::ranges::find(around, start) != around.end();
      if (next == kNone || (place > 1 && around.size() != 2)) {
        const double closing = norm(mesh.positions[at(start)] - mesh.positions[at(v)]);
        borders.closed_length.push_back(returns ? way + closing : 0);
        return;
      }
      way += norm(mesh.positions[at(next)] - mesh.positions[at(v)]);
      last = v;
      v = next;
    }
  };

  // Vertices at branches start strands of their own, so that each other run is followed whole.
  for (const auto& [v, around] : graph.neighbours)
    if (around.size() != 2 && !passed.contains(v)) follow(v);
  for (const bool any : {false, true})
    for (const auto& [v, around] : graph.neighbours)
      if ((any || !inner.contains(v)) && !passed.contains(v)) follow(v);
  borders.first.push_back(static_cast<Index>(borders.vertices.size()));
  return borders;
}

/// Whether two border vertices may be sewn: they are not near each other along one border.
bool lie_apart(const Borders& borders, const BorderVertex& a, const BorderVertex& b,
               double within) {
  if (a.strand != b.strand) return true;
  const double length = borders.closed_length[at(a.strand)];
  const Index size = strand_size(borders, a.strand);
  double way = std::fabs(a.way - b.way);
  Index places = std::abs(a.place - b.place);

  // Round a closed border the shorter way counts.
  if (length > 0) way = std::min(way, length - way), places = std::min(places, size - places);
  return way > 3 * within && places > 2;
}

/// The nearest vertex of each strand within reach of each border vertex, by strand.
struct Nearest {
  Index strand = 0, other = 0;  ///< `other` is a number in Borders::vertices
  double distance = 0;
};
using NearestOnStrands = std::vector<std::vector<Nearest>>;

NearestOnStrands find_nearest(const Borders& borders, const TriangleMesh& mesh, double within) {
  // Each vertex is a box of no size, and reaches as far as `within` in a box around it.
  std::vector<Box> boxes(borders.vertices.size());
  const auto place = [&](std::size_t i) { return mesh.positions[at(borders.vertices[i].vertex)]; };
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].add(place(i));
  const BoxTree tree(boxes);

  NearestOnStrands nearest(boxes.size());
  std::size_t meetings = 0;
  const Vec3d reach{within, within, within};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    Box around;
    around.add(place(i) - reach);
    around.add(place(i) + reach);
    tree.visit(around, [&](Index j) {
      if (++meetings > kMostMeetings)
        throw InputError(
            "--within: " + rounded_text(1000 * within) +
            " mm reaches too many vertices of the borders, expected a smaller distance");
      const double distance = norm(place(at(j)) - place(i));
      if (distance > within ||
          !lie_apart(borders, borders.vertices[i], borders.vertices[at(j)], within))
        return;

      // The first of equally near ones stays, by its number.
      const Index strand = borders.vertices[at(j)].strand;
      auto known = std::ranges::find(nearest[i], strand, &Nearest::strand);
      if (known == nearest[i].end()) {
        nearest[i].push_back({strand, j, distance});
      } else if (distance < known->distance || (distance == known->distance && j < known->other)) {
        *known = {strand, j, distance};
      }
    });
  }
  return nearest;
}

/// Two border vertices, by their numbers in Borders::vertices, that are the nearest of each other.
struct Match {
  Index a = 0, b = 0;
  double gap = 0;
};

/// All matches, sorted by the two strands and then along the first of them.
std::vector<Match> match_borders(const Borders& borders, const NearestOnStrands& nearest) {
  std::vector<Match> matches;
  for (std::size_t i = 0; i < nearest.size(); ++i)
    for (const Nearest& n : nearest[i]) {
      // Each pair is looked at from its smaller number, and counts where the other one looks back.
      if (n.other < static_cast<Index>(i)) continue;
      const Index own = borders.vertices[i].strand;
      const auto back = std::ranges::find(nearest[at(n.other)], own, &Nearest::strand);
      if (back != nearest[at(n.other)].end() && back->other == static_cast<Index>(i))
        matches.push_back({static_cast<Index>(i), n.other, n.distance});
    }

  // Rows are found along sorted matches.
  std::ranges::sort(matches, {}, [&](const Match& m) {
    return std::array{borders.vertices[at(m.a)].strand, borders.vertices[at(m.b)].strand, m.a};
  });
  return matches;
}

/// Steps along the strand of the second side from one match to the next, the short way round.
Index stride(const Borders& borders, const Match& from, const Match& to) {
  const BorderVertex &b = borders.vertices[at(from.b)], &next = borders.vertices[at(to.b)];
  const Index size = strand_size(borders, b.strand);
  Index steps = next.place - b.place;
  if (borders.closed_length[at(b.strand)] > 0) {
    if (steps > size / 2) steps -= size;
    if (steps < -size / 2) steps += size;
  }
  return steps;
}

/// Cuts sorted matches into rows that go on along both borders, the second in one direction.
std::vector<std::vector<Match>> rows_of(const Borders& borders, const std::vector<Match>& matches) {
  std::vector<std::vector<Match>> rows;
  Index direction = 0;
  for (const Match& m : matches) {
    // A match goes on with the last row where both of its vertices are the next ones, or almost.
    bool goes_on = false;
    if (!rows.empty()) {
      const Match& last = rows.back().back();
      const BorderVertex &a = borders.vertices[at(m.a)], &b = borders.vertices[at(m.b)];
      const bool same = a.strand == borders.vertices[at(last.a)].strand &&
                        b.strand == borders.vertices[at(last.b)].strand;
      const Index steps = same ? stride(borders, last, m) : 0;
      const Index way = steps > 0 ? 1 : -1;
      goes_on = same && m.a - last.a <= kLongestStride && steps != 0 &&
                std::abs(steps) <= kLongestStride && (direction == 0 || direction == way);
      if (goes_on) direction = way;
    }

    // Any other begins a row, in a direction that its second match decides.
    if (!goes_on) rows.emplace_back(), direction = 0;
    rows.back().push_back(m);
  }
  return rows;
}

/// Refuses matches that would take a corner from a face, the nearest matches first: two vertices of
/// one edge may not become one, not even by way of others.
class Unions {
 public:
  explicit Unions(const TriangleMesh& mesh) : sets_(mesh.positions.size()) {
    for (const Triangle& t : mesh.faces)
      for (std::size_t c = 0; c < 3; ++c)
        edges_.push_back({std::min(t[c], t[(c + 1) % 3]), std::max(t[c], t[(c + 1) % 3])});
    std::ranges::sort(edges_);
  }

  /// Whether the sets of the two vertices are one from now on.
  bool unite(Index a, Index b) {
    // No member of one set may share an edge with one of the other.
    const std::vector<Index> own = members(a), other = members(b);
    for (const Index v : own)
      for (const Index w : other)
        if (std::ranges::binary_search(edges_, std::array{std::min(v, w), std::max(v, w)}))
          return false;

    // Sets are small, therefore their members are copied together.
    if (sets_.find(at(a)) == sets_.find(at(b))) return true;
    std::vector<Index> all = own;
    all.insert(all.end(), other.begin(), other.end());
    sets_.unite(at(a), at(b));
    members_[static_cast<Index>(sets_.find(at(a)))] = std::move(all);
    return true;
  }

 private:
  std::vector<Index> members(Index v) {
    const auto set = static_cast<Index>(sets_.find(at(v)));
    const auto known = members_.find(set);
    return known == members_.end() ? std::vector<Index>{set} : known->second;
  }

  DisjointSets sets_;
  std::vector<std::array<Index, 2>> edges_;
  std::map<Index, std::vector<Index>> members_;  ///< of sets of two and more
};

/// Vertices of a strand between two places of it that are no further apart than a stride.
std::size_t between(Index steps) { return static_cast<std::size_t>(std::abs(steps) - 1); }

ProposedSeam make_seam(const Borders& borders, const std::vector<Match>& row) {
  ProposedSeam seam;
  for (std::size_t i = 0; i < row.size(); ++i) {
    // Gaps and angles are means over the pairs.
    const BorderVertex &a = borders.vertices[at(row[i].a)], &b = borders.vertices[at(row[i].b)];
    seam.pairs.push_back({a.vertex, b.vertex});
    seam.mean_gap += row[i].gap / static_cast<double>(row.size());
    seam.largest_gap = std::max(seam.largest_gap, row[i].gap);
    seam.angle +=
        std::acos(std::clamp(dot(a.inward, b.inward), -1.0, 1.0)) / static_cast<double>(row.size());

    // Vertices that were passed over on either side leave holes.
    if (i > 0)
      seam.unpaired +=
          between(row[i].a - row[i - 1].a) + between(stride(borders, row[i - 1], row[i]));
  }
  return seam;
}

/// Panel of every vertex, numbered by their first vertices.
std::vector<Index> number_panels(const TriangleMesh& mesh, std::size_t& count) {
  DisjointSets sets(mesh.positions.size());
  for (const Triangle& t : mesh.faces)
    sets.unite(at(t[0]), at(t[1])), sets.unite(at(t[0]), at(t[2]));
  std::vector<Index> panel(mesh.positions.size());
  count = 0;
  for (std::size_t v = 0; v < panel.size(); ++v) {
    const std::size_t first = sets.find(v);
    panel[v] = first == v ? static_cast<Index>(count++) : panel[first];
  }
  return panel;
}

}  // namespace

SeamProposal propose_seams(const TriangleMesh& mesh, double within) {
  SeamProposal proposal;
  const std::vector<Index> panel = number_panels(mesh, proposal.panels);
  for (const Triangle& t : mesh.faces) proposal.panel.push_back(panel[at(t[0])]);

  // A closed border is followed again from a vertex without a partner, so that no row is cut there.
  Borders borders = trace_borders(mesh, {});
  std::vector<Match> matches = match_borders(borders, find_nearest(borders, mesh, within));
  std::set<Index> paired;
  for (const Match& m : matches)
    paired.insert({borders.vertices[at(m.a)].vertex, borders.vertices[at(m.b)].vertex});
  borders = trace_borders(mesh, paired);
  matches = match_borders(borders, find_nearest(borders, mesh, within));
  proposal.border_vertices = borders.vertices.size();

  // Pairs that do not stand in a row are chance, as where borders cross.
  std::vector<std::vector<Match>> rows = rows_of(borders, matches);
  std::erase_if(rows, [&](const std::vector<Match>& row) {
    if (row.size() >= kShortestRow) return false;
    proposal.scattered += row.size();
    return true;
  });

  // The nearest pairs have the first choice of what becomes one vertex.
  struct Entry {
    double gap;
    std::size_t row, match;
  };
  std::vector<Entry> entries;
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t m = 0; m < rows[r].size(); ++m) entries.push_back({rows[r][m].gap, r, m});
  std::ranges::stable_sort(entries, {}, &Entry::gap);
  Unions unions(mesh);
  for (const Entry& e : entries) {
    Match& m = rows[e.row][e.match];
    if (unions.unite(borders.vertices[at(m.a)].vertex, borders.vertices[at(m.b)].vertex)) continue;
    m.a = kNone;
    ++proposal.crossing;
  }

  // What is left of the rows are the seams.
  std::set<Index> sewn;
  for (std::vector<Match>& row : rows) {
    std::erase_if(row, [](const Match& m) { return m.a == kNone; });
    if (row.empty()) continue;
    ProposedSeam seam = make_seam(borders, row);
    for (const auto& [a, b] : seam.pairs) sewn.insert({a, b});
    seam.panel = {panel[at(seam.pairs[0][0])], panel[at(seam.pairs[0][1])]};
    proposal.seams.push_back(std::move(seam));
  }
  proposal.sewn_vertices = sewn.size();
  return proposal;
}

Seam joint_seam(const SeamProposal& proposal) {
  Seam seam;
  for (const ProposedSeam& s : proposal.seams)
    seam.pairs.insert(seam.pairs.end(), s.pairs.begin(), s.pairs.end());
  return seam;
}

}  // namespace icloth
