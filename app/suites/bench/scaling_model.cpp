#include "app/suites/bench/scaling_model.h"

#include <algorithm>

namespace icloth {
namespace {

using namespace array_entry;

// Nodes of all levels of a tree, eight children each, over its leaves.
constexpr double kTree = 8.0 / 7;

/// The blocks that are stored of the symmetric matrix: the diagonal, and for each edge the pair of
/// its ends and the pair of the corners across from it.
double stored_blocks(const MeshCounts& mesh) {
  return mesh.cloth_vertices + mesh.cloth_edges + mesh.hinges;
}

/// The edges of a mesh, and those of them that have two faces.
std::pair<double, double> count_edges(const TriangleMesh& mesh) {
  std::vector<std::array<Index, 2>> sides;
  sides.reserve(3 * mesh.faces.size());
  for (const Triangle& t : mesh.faces)
    for (std::size_t c = 0; c < 3; ++c)
      sides.push_back({std::min(t[c], t[(c + 1) % 3]), std::max(t[c], t[(c + 1) % 3])});
  std::ranges::sort(sides);

  // After sorting, the sides of one edge stand together.
  double edges = 0, inner = 0;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end] == sides[begin]) ++end;
    ++edges;
    if (end - begin == 2) ++inner;
  }
  return {edges, inner};
}

double number(std::int64_t value) { return static_cast<double>(value); }

double& at(PerStage& stages, Stage stage) { return stages[static_cast<std::size_t>(stage)]; }

}  // namespace

MeshCounts count_elements(const Scene& scene) {
  MeshCounts mesh;
  for (const Cloth& cloth : scene.cloths) {
    const auto [edges, inner] = count_edges(cloth.mesh);
    mesh.cloth_vertices += static_cast<double>(cloth.mesh.positions.size());
    mesh.cloth_faces += static_cast<double>(cloth.mesh.faces.size());
    mesh.cloth_edges += edges;
    mesh.hinges += inner;
  }

  // Collisions are looked for among all elements, those of bodies too.
  mesh.vertices = mesh.cloth_vertices;
  mesh.faces = mesh.cloth_faces;
  mesh.edges = mesh.cloth_edges;
  for (const Obstacle& obstacle : scene.obstacles) {
    mesh.vertices += static_cast<double>(obstacle.mesh.positions.size());
    mesh.faces += static_cast<double>(obstacle.mesh.faces.size());
    mesh.edges += count_edges(obstacle.mesh).first;
  }
  return mesh;
}

PerStage least_bytes(const MeshCounts& mesh, const StepReport& report) {
  PerStage bytes{};
  const double attempts = number(report.substeps + report.retries);
  const double pairs = number(report.candidate_pairs), contacts = number(report.proximity_pairs);
  const double n = mesh.cloth_vertices;

  // The candidates are read, and what is close is written.
  at(bytes, Stage::proximity) =
      attempts * (kPair * pairs + kPosition * mesh.vertices + kContact * contacts);

  // Shares of faces and hinges are written, and read into the matrix; CG says what it moves itself.
  const double assembly = mesh.cloth_faces * (kFaceRest + 2 * kFaceTerm) +
                          mesh.hinges * (kHingeRest + 2 * kHingeTerm) +
                          kBlock * stored_blocks(mesh) + 5 * kPosition * n;
  at(bytes, Stage::implicit) =
      report.cg_bytes + number(report.newton_iterations) * assembly +
      number(report.linear_solves) * (contacts * (kContact + kContactTerm) + 4 * kPosition * n);

  // Boxes of vertices, faces and edges, both trees, and the list of candidates; then whether the
  // boxes still hold the paths.
  const double elements = mesh.faces + mesh.edges;
  const double boxes = mesh.vertices * (2 * kPosition + kBox) + 3 * kIndex * mesh.faces +
                       2 * kIndex * mesh.edges + elements * 2 * (kBox + kTree * kBox);
  at(bytes, Stage::broad_phase) =
      attempts * (boxes + kPair * pairs + mesh.vertices * (kPosition + kBox));

  // Each test reads its pair; the places at both ends of the path are read once.
  at(bytes, Stage::ccd) =
      kPair * number(report.elementary_tests) + attempts * 2 * kPosition * mesh.vertices;

  // A round looks up the vertices of its zones, moves them and flags them.
  at(bytes, Stage::impact_zones) =
      number(report.rounds) * n * (kIndex + 1) + kConstraint * number(report.impacts_first);

  // The state is saved and put back into the history, hashed and measured.
  at(bytes, Stage::other) = 8 * kPosition * n + kFaceRest * mesh.cloth_faces +
                            kHingeRest * mesh.hinges + 2 * kPosition * mesh.vertices;
  return bytes;
}

PerStage array_bytes(const MeshCounts& mesh, const StepReport& report) {
  PerStage bytes{};
  const double pairs = number(report.candidate_pairs), contacts = number(report.proximity_pairs);
  const double n = mesh.cloth_vertices, blocks = stored_blocks(mesh);
  at(bytes, Stage::proximity) = 2 * kContact * contacts;

  // The lists of sources name nine blocks of each face and 16 of each hinge, of which one half is
  // stored: six and ten.
  at(bytes, Stage::implicit) =
      blocks * (kBlock + 3 * kIndex) + 2 * kIndex * (blocks - n) + mesh.cloth_faces * kFaceTerm +
      mesh.hinges * (kHingeTerm + kHingeRest) + kIndex * (6 * mesh.cloth_faces + 10 * mesh.hinges) +
      kContactTerm * contacts + n * (12 * kPosition + kBlock);

  const double elements = mesh.faces + mesh.edges;
  at(bytes, Stage::broad_phase) =
      2 * kBox * (mesh.vertices + elements + kTree * elements) + kIndex * elements + kPair * pairs;
  at(bytes, Stage::impact_zones) = kConstraint * number(report.impacts_first) + n * (kIndex + 1);
  at(bytes, Stage::other) = 6 * kPosition * mesh.vertices + kFaceRest * mesh.cloth_faces;
  return bytes;
}

std::vector<std::string> model_text() {
  return {
      "Floor of a stage: the bytes that it has to move at least, by the measured bandwidth. Every "
      "array counts once for each pass over it, in single precision. V, F, E: vertices, faces, "
      "edges of all objects; Vc, Fc: of the cloths; H: hinges; A: substeps and refused attempts.",
      "proximity: A (8 B a candidate pair + 12 B V + 88 B a pair in proximity).",
      "implicit: what the iterations of CG move (blocks of half the matrix, contacts, 15 vectors "
      "and a block a row, each once an iteration) + for each linearisation 540 B Fc + 156 B H + 36 "
      "B a block of the matrix (Vc + Ec + H) + 60 B Vc + for each solve 140 B a contact + 48 B Vc.",
      "broad_phase: A (boxes and trees: 48 B V + 87 B F + 83 B E, 8 B a candidate pair, 36 B V).",
      "ccd: 8 B an elementary test + A 24 B V.",
      "impact_zones: 5 B Vc a round + 136 B an impact.",
      "other: 96 B Vc + 36 B Fc + 44 B H + 24 B V, to save, hash and measure the state.",
      "Where a mesh fits into the caches, a stage may be faster than its floor."};
}

}  // namespace icloth
