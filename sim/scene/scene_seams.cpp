// Open seams of a scene file: pairs of vertices, or runs along two borders.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <set>

#include "kernels/index.h"
#include "sim/files/text.h"
#include "sim/scene/half_edges.h"
#include "sim/scene/scene_json.h"

namespace icloth {
namespace {

constexpr std::size_t kMostSeams = 1000;

/// The border of a cloth as a graph of vertices.
using Border = std::map<Index, std::vector<Index>>;

Border border_of(const TriangleMesh& mesh) {
  Border border;
  for (const HalfEdge& side : border_sides(mesh.faces)) {
    border[side.edge[0]].push_back(side.edge[1]);
    border[side.edge[1]].push_back(side.edge[0]);
  }
  return border;
}

/// Vertices along a border, with the way from the first one [m].
struct Run {
  std::vector<Index> vertices;
  std::vector<double> way;
};

/// The shortest way along the border from one vertex to another; empty where there is none.
std::vector<Index> border_path(const Border& border, const std::vector<Vec3d>& x, Index start,
                               Index end) {
  std::map<Index, double> distance{{start, 0.0}};
  std::map<Index, Index> before;
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  queue.push({0.0, start});

  // Dijkstra's algorithm; equal ways are settled by the numbers of the vertices.
  while (!queue.empty()) {
    const auto [way, v] = queue.top();
    queue.pop();
    if (way > distance[v]) continue;
    if (v == end) break;
    for (const Index w : border.at(v)) {
      const double next = way + norm(x[at(w)] - x[at(v)]);
      const auto known = distance.find(w);
      if (known != distance.end() && known->second <= next) continue;
      distance[w] = next;
      before[w] = v;
      queue.push({next, w});
    }
  }

  // The way is followed back from its end.
  if (start != end && !before.contains(end)) return {};
  std::vector<Index> path{end};
  while (path.back() != start) path.push_back(before[path.back()]);
  std::ranges::reverse(path);
  return path;
}

/// Reads a run: two or more vertices of the border, and the shortest way along it over all of them.
Run parse_run(const JsonValue& value, const LoadedCloth& cloth) {
  const Border border = border_of(cloth.cloth.mesh);
  const std::vector<JsonValue> stops = value.items();
  if (stops.size() < 2) value.refuse("a list of two or more vertices of the border");

  const std::vector<Vec3d>& x = cloth.cloth.mesh.positions;
  Run run;
  for (const JsonValue& stop : stops) {
    const Index v = parse_vertex(stop, cloth);
    if (v == kNone || !border.contains(v)) stop.refuse("a vertex on the border of the cloth");
    if (run.vertices.empty()) {
      run = {{v}, {0.0}};
      continue;
    }

    // Each stop is reached along the border.
    const std::vector<Index> path = border_path(border, x, run.vertices.back(), v);
    if (path.size() < 2) stop.refuse("another vertex on the same border as the one before");
    for (std::size_t i = 1; i < path.size(); ++i) {
      run.way.push_back(run.way.back() + norm(x[at(path[i])] - x[at(path[i - 1])]));
      run.vertices.push_back(path[i]);
    }
  }

  // Every vertex of a run is stitched once.
  std::set<Index> once(run.vertices.begin(), run.vertices.end());
  if (once.size() != run.vertices.size()) value.refuse("a run that comes to no vertex twice");
  return run;
}

/// For each vertex of the run with fewer vertices, the one of the other run that is nearest to the
/// same share of its way, ascending and none twice.
std::vector<std::size_t> match_runs(const Run& few, const Run& many) {
  const std::size_t n = few.vertices.size(), m = many.vertices.size();
  std::vector<std::size_t> matched;
  for (std::size_t i = 0; i < n; ++i) {
    const double share = few.way[i] / few.way.back();
    const std::size_t first = i == 0 ? 0 : matched.back() + 1, last = m - (n - i);
    std::size_t best = first;
    for (std::size_t j = first; j <= last; ++j)
      if (std::fabs(many.way[j] / many.way.back() - share) <
          std::fabs(many.way[best] / many.way.back() - share))
        best = j;
    matched.push_back(i + 1 == n ? m - 1 : best);
  }
  return matched;
}

/// Pairs two runs, from their first vertices to their last.
std::vector<std::array<Index, 2>> pair_runs(const Run& from, const Run& to) {
  const bool swapped = from.vertices.size() > to.vertices.size();
  const Run &few = swapped ? to : from, &many = swapped ? from : to;
  const std::vector<std::size_t> matched = match_runs(few, many);

  std::vector<std::array<Index, 2>> pairs;
  for (std::size_t i = 0; i < matched.size(); ++i) {
    const Index a = few.vertices[i], b = many.vertices[matched[i]];
    pairs.push_back(swapped ? std::array{b, a} : std::array{a, b});
  }
  return pairs;
}

std::vector<std::array<Index, 2>> parse_pairs(const JsonValue& value, const LoadedCloth& from,
                                              const LoadedCloth& to) {
  std::vector<std::array<Index, 2>> pairs;
  for (const JsonValue& item : value.items()) {
    const std::vector<JsonValue> ends = item.items();
    if (ends.size() != 2) item.refuse("[a, b], a vertex of each side");
    pairs.push_back({parse_vertex(ends[0], from), parse_vertex(ends[1], to)});
    for (std::size_t k = 0; k < 2; ++k)
      if (pairs.back()[k] == kNone) ends[k].refuse("a vertex that a face uses");
  }
  if (pairs.empty()) value.refuse("at least one pair [a, b]");
  return pairs;
}

/// Refuses pairs that cannot become one vertex: those of one vertex, or of two that share an edge.
/// Where two runs of a cloth meet, their common vertex is left out.
void check_pairs(const JsonValue& where, Seam& seam, const LoadedCloth& cloth, bool runs) {
  const bool one_cloth = seam.from == seam.to;
  if (runs && one_cloth) std::erase_if(seam.pairs, [](const auto& p) { return p[0] == p[1]; });
  if (seam.pairs.empty()) where.refuse("two different runs");

  // No vertex may be in two pairs, neither on one side nor on both.
  std::set<std::array<Index, 2>> seen;
  for (const auto& [a, b] : seam.pairs) {
    const bool first = seen.insert({seam.from, a}).second,
               second = seen.insert({seam.to, b}).second;
    if (!first || !second)
      where.refuse("every vertex in one pair of the seam only, not vertex " +
                   std::to_string(first ? b : a) + " in two");
  }

  // Vertices of one edge would leave a face without area.
  if (!one_cloth) return;
  std::set<std::array<Index, 2>> edges;
  for (const Triangle& t : cloth.cloth.mesh.faces)
    for (std::size_t c = 0; c < 3; ++c) edges.insert({t[c], t[(c + 1) % 3]});
  for (const auto& [a, b] : seam.pairs)
    if (edges.contains({a, b}) || edges.contains({b, a}))
      where.refuse("pairs of vertices without an edge between them, unlike " + std::to_string(a) +
                   " and " + std::to_string(b));
}

Seam parse_seam(const JsonValue& value, Index own, const std::vector<LoadedCloth>& cloths,
                const SceneFolder& folder, std::size_t number) {
  if (value.is_string())
    value.refuse(
        "an object with \"from\" and \"to\", or \"pairs\": names of edges are those of a "
        "pattern, which has its own stitches");

  // The cloth of the other side is this one unless the seam says so.
  JsonObject object(value);
  Seam seam;
  seam.name = object.text("name", "seam" + std::to_string(number));
  if (seam.name.empty() || seam.name.size() > 100) object["name"].refuse("1 to 100 bytes");
  seam.from = seam.to = own;
  if (object.has("cloth")) seam.to = find_cloth(object["cloth"], cloths);
  seam.pulls = object.boolean("pull", true);

  // Pairs are given one by one, or follow from two runs along borders.
  const LoadedCloth &from = cloths[at(seam.from)], &to = cloths[at(seam.to)];
  if (to.garment) object["cloth"].refuse("a cloth with a mesh: a pattern has its own stitches");
  const bool runs = !object.has("pairs");
  if (!runs) {
    for (const char* key : {"from", "to"})
      if (object.has(key)) object[key].refuse("either \"pairs\", or \"from\" and \"to\"");
    seam.pairs = parse_pairs(object["pairs"], from, to);
  } else {
    const Run a = parse_run(object.required("from"), from),
              b = parse_run(object.required("to"), to);
    seam.pairs = pair_runs(a, b);
    if (a.vertices.size() != b.vertices.size())
      folder.note("seam " + in_quotes(seam.name) + ": " + std::to_string(a.vertices.size()) +
                  " vertices on one side and " + std::to_string(b.vertices.size()) +
                  " on the other: " + std::to_string(seam.pairs.size()) +
                  " pairs are stitched, and small holes stay between them");
  }
  object.finish();
  check_pairs(value, seam, from, runs);
  return seam;
}

}  // namespace

std::vector<Seam> parse_seams(const JsonValue& list, const std::vector<LoadedCloth>& cloths,
                              const SceneFolder& folder) {
  std::vector<Seam> seams;
  const std::vector<JsonValue> items = list.items();
  for (std::size_t c = 0; c < items.size(); ++c) {
    JsonObject cloth(items[c]);
    if (!cloth.has("seams")) continue;
    const JsonValue own = cloth["seams"];
    const std::vector<JsonValue> entries = own.items();
    if (entries.empty()) own.refuse("at least one seam");
    if (seams.size() + entries.size() > kMostSeams)
      own.refuse("at most " + std::to_string(kMostSeams) + " seams in a scene");
    for (const JsonValue& entry : entries)
      seams.push_back(parse_seam(entry, static_cast<Index>(c), cloths, folder, seams.size()));
  }

  // Messages and statistics tell seams apart by name.
  std::set<std::string> names;
  for (const Seam& seam : seams)
    if (!names.insert(seam.name).second)
      list.refuse("a name of its own for every seam, not " + in_quotes(seam.name) + " twice");
  return seams;
}

}  // namespace icloth
