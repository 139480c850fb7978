#include "app/cli/commands/detect.h"

#include <chrono>
#include <cstdio>

#include "sim/collision/detect.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/mesh_io.h"
#include "sim/files/text.h"
#include "sim/simulator.h"

namespace icloth {
namespace {

/// Refuses frames of different meshes, and names the first difference.
void check_same_topology(const DetectOptions& options, const TriangleMesh& a,
                         const TriangleMesh& b) {
  if (a.positions.size() != b.positions.size())
    throw InputError(shown_path(options.end) + ": " + std::to_string(b.positions.size()) +
                     " vertices, expected " + std::to_string(a.positions.size()) + " as in " +
                     shown_path(options.start));
  if (a.faces.size() != b.faces.size())
    throw InputError(shown_path(options.end) + ": " + std::to_string(b.faces.size()) +
                     " faces, expected " + std::to_string(a.faces.size()) + " as in " +
                     shown_path(options.start));
  for (std::size_t f = 0; f < a.faces.size(); ++f)
    if (a.faces[f] != b.faces[f])
      throw InputError(shown_path(options.end) + ": face " + std::to_string(f) +
                       " has other vertices, expected those of " + shown_path(options.start));
}

/// Adds a line of comma-separated numbers.
void append(std::string& text, std::initializer_list<Index> numbers) {
  char separator = 0;
  for (const Index n : numbers) {
    if (separator != 0) text += separator;
    text += std::to_string(n);
    separator = ',';
  }
  text += '\n';
}

/// Writes the two lists of pairs.
void write_csv(const std::string& prefix, const Collisions& found,
               std::span<const Triangle> faces) {
  std::string text = "vertex,face,f0,f1,f2\n";

  for (const auto& [v, f] : found.vertex_face) {
    const Triangle& t = faces[static_cast<std::size_t>(f)];
    append(text, {v, f, t[0], t[1], t[2]});
  }
  write_file(prefix + "_vf.csv", text);
  text = "a0,a1,b0,b1\n";
  for (const auto& e : found.edge_edge) append(text, {e[0], e[1], e[2], e[3]});
  write_file(prefix + "_ee.csv", text);
}

}  // namespace

int run_detect(const DetectOptions& options) {
  // Reading counts apart from the detection, as files may take longer.
  const auto clock = std::chrono::steady_clock::now();
  set_thread_count(options.threads);
  const MeshFile start = read_mesh(options.start), end = read_mesh(options.end);
  check_same_topology(options, start.mesh, end.mesh);
  const double ms_read =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - clock).count();

  // The detection measures its two stages by itself.
  const Collisions found =
      cpu64::detect_collisions(start.mesh.positions, end.mesh.positions, start.mesh.faces);
  if (!options.csv.empty()) write_csv(options.csv, found, start.mesh.faces);
  std::printf("vertices %zu, faces %zu, candidate pairs %lld\n", start.mesh.positions.size(),
              start.mesh.faces.size(), static_cast<long long>(found.candidates));
  std::printf("vertex-face %zu, edge-edge %zu\n", found.vertex_face.size(), found.edge_edge.size());
  std::printf("ms read %.1f, broad_phase %.1f, ccd %.1f\n", ms_read, found.ms_broad_phase,
              found.ms_ccd);
  return 0;
}

}  // namespace icloth
