#include "sim/collision/detect.h"

#include <chrono>

#include "sim/collision/ccd.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// The key of a half-edge: its larger vertex, then its smaller one.
struct HalfEdgeKeys {
  View<const Int3> face;
  View<std::uint64_t> key;
  View<Index> value;
  ICLOTH_HD void operator()(Index i) const {
    const Index a = face[i / 3].v[i % 3], b = face[i / 3].v[(i + 1) % 3];
    key[i] = (static_cast<std::uint64_t>(a < b ? b : a) << 31) |
             static_cast<std::uint64_t>(a < b ? a : b);
    value[i] = i;
  }
};

/// Keeps the first one of equal keys, and no edge from a vertex to itself.
struct IsNewEdge {
  View<const std::uint64_t> key;
  ICLOTH_HD bool operator()(Index i) const {
    return (i == 0 || key[i] != key[i - 1]) && !(key_pair(key[i]).a == key_pair(key[i]).b);
  }
};

/// Turns the picked keys into edges.
struct TakeEdges {
  View<const std::uint64_t> key;
  View<const Index> picked;
  View<Int2> edge;
  ICLOTH_HD void operator()(Index i) const {
    const Pair ends = key_pair(key[picked[i]]);
    edge[i] = {{ends.b, ends.a}};
  }
};

/// Finds the distinct edges of the faces, numbered by their larger vertex, then by the smaller.
void find_edges(const Array<Int3>& face, Array<Int2>& edge) {
  const Index corners = 3 * face.size();
  Array<std::uint64_t> key(corners);
  Array<Index> value(corners), picked;
  for_each("detect.edges", corners, HalfEdgeKeys{face.view(), key.view(), value.view()});
  sort_by_key("detect.edges", key.view(), value.view(), 62);
  edge.resize(compact("detect.edges", corners, IsNewEdge{key.view()}, picked));
  for_each("detect.edges", edge.size(), TakeEdges{key.view(), picked.view(), edge.view()});
}

/// The faces and edges of one mesh, all of it cloth.
Topology make_topology(std::span<const Triangle> faces, Index vertices) {
  Topology mesh;
  std::vector<Int3> face;
  face.reserve(faces.size());
  for (const Triangle& t : faces) face.push_back({{t[0], t[1], t[2]}});
  mesh.face.upload(face);
  find_edges(mesh.face, mesh.edge);

  // All elements are cloth, so that every pair without a common vertex is tested.
  mesh.vertices = mesh.cloth_vertices = vertices;
  mesh.faces = mesh.cloth_faces = mesh.face.size();
  mesh.edges = mesh.cloth_edges = mesh.edge.size();
  return mesh;
}

void upload(Array<Vec3r>& to, std::span<const Vec3d> from) {
  std::vector<Vec3r> list;
  list.reserve(from.size());
  for (const Vec3d& p : from) list.push_back(convert<Real>(p));
  to.upload(list);
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

}  // namespace

Collisions detect_collisions(std::span<const Vec3d> start, std::span<const Vec3d> end,
                             std::span<const Triangle> faces) {
  Collisions collisions;

  // The mesh and its two frames become the state of a step without padding of the boxes, so that
  // only pairs that touch are found.
  auto clock = std::chrono::steady_clock::now();
  const auto vertices = static_cast<Index>(start.size());
  const Topology mesh = make_topology(faces, vertices);
  Parameters parameters;
  parameters.proximity.thickness = parameters.impact_zones.offset = 0;
  State state;
  upload(state.x0, start);
  upload(state.x1, end);
  state.inverse_mass.resize(vertices);
  state.inverse_mass.fill(Real(1));

  // The broad phase covers the straight paths from start to end.
  StepReport report;
  SubstepContext step{mesh, parameters, state, report, Real(1), 0.0};
  BroadPhase broad_phase;
  broad_phase.cover_candidate(step);
  collisions.ms_broad_phase = milliseconds_since(clock);

  // The elementary tests decide. The caller knows no edge numbers, so vertices name an edge pair.
  clock = std::chrono::steady_clock::now();
  Ccd ccd;
  ccd.find(step, broad_phase, {}, false);
  for (const Impact& impact : ccd.impacts().download()) {
    const Index* v = impact.s.v;
    if (key_is_edge_edge(impact.key))
      collisions.edge_edge.push_back({v[0], v[1], v[2], v[3]});
    else
      collisions.vertex_face.push_back({v[0], key_pair(impact.key).b});
  }
  collisions.candidates = broad_phase.candidate_count();
  collisions.ms_ccd = milliseconds_since(clock);
  return collisions;
}

}  // namespace icloth::ICLOTH_BUILD
