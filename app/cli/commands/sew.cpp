#include "app/cli/commands/sew.h"

#include <chrono>
#include <cstdio>
#include <filesystem>

#include "app/cli/commands/sew_panels.h"
#include "app/common/dressing_progress.h"
#include "app/common/headless.h"
#include "kernels/index.h"
#include "sim/files/body_io.h"
#include "sim/files/error.h"
#include "sim/files/mesh_io.h"
#include "sim/files/text.h"
#include "sim/garment/open_scene.h"
#include "sim/scene/intersections.h"
#include "sim/scene/material_io.h"

namespace icloth {
namespace {

using Clock = std::chrono::steady_clock;

/// A scene with the garment, as it is sewn, and the body.
Scene make_scene(const SewOptions& options, std::vector<std::string>& notes) {
  Scene scene;
  scene.name = std::filesystem::path(options.pattern).stem().string();

  Cloth cloth;
  cloth.name = "garment";
  cloth.material = load_material(options.material, "");
  Garment garment = read_garment(options.pattern, options.triangles, notes);
  garment.plan.on = options.dress;
  garment.plan.hold = options.hold;
  garment.plan.settling = options.settling;
  sew_garment(garment, cloth);
  notes.insert(notes.end(), garment.sewn.notes.begin(), garment.sewn.notes.end());
  scene.cloths.push_back(std::move(cloth));
  scene.garments.push_back(std::move(garment));

  if (!options.body.empty()) {
    Obstacle body;
    body.name = "body";
    body.mesh = read_body(options.body).mesh;
    scene.obstacles.push_back(std::move(body));
  }
  fit_thickness(scene);
  return scene;
}

/// Panels and stitches as they are sewn.
void print_pattern(const Garment& garment, const TriangleMesh& mesh) {
  const SewnGarment& sewn = garment.sewn;
  std::vector<std::size_t> faces(sewn.panel_names.size());
  for (Index panel : sewn.panel) ++faces[at(panel)];
  std::printf("%-24s %10s %10s\n", "panel", "corners", "triangles");
  for (std::size_t p = 0; p < faces.size(); ++p)
    std::printf("%-24s %10zu %10zu\n", excerpt(sewn.panel_names[p]).c_str(),
                garment.meshed->pattern.panels[p].corners.size(), faces[p]);

  std::printf("%-24s %-24s %8s %8s %7s %7s %9s\n", "edge", "sewn to", "cm", "cm", "ratio", "points",
              "gap [cm]");
  for (const SewnSeam& seam : sewn.seams) {
    const auto side = [&](Index panel, Index edge) {
      return excerpt(sewn.panel_names[at(panel)]) + ":" + std::to_string(edge);
    };
    std::printf("%-24s %-24s %8.1f %8.1f %7.3f %7zu %9.1f%s\n",
                side(seam.panel_a, seam.edge_a).c_str(), side(seam.panel_b, seam.edge_b).c_str(),
                100 * seam.length_a, 100 * seam.length_b, gather_ratio(seam), seam.points.size(),
                100 * seam.mean_gap, gather_ratio(seam) > kGatherRatio ? "  gather" : "");
  }
  std::printf("%zu vertices, %zu triangles, %zu panels, %zu stitches\n", mesh.positions.size(),
              mesh.faces.size(), faces.size(), sewn.seams.size());
}

/// How the garment got onto the body.
void print_report(const GarmentReport& report, std::size_t intersections, double seconds) {
  const Arrangement& start = report.arrangement;
  std::printf(
      "start: %zu pairs of faces intersect, %zu after moving panels, %zu with bodies "
      "contracted over %.0f mm (%d checks)\n",
      start.pairs_before, start.pairs_moved, start.pairs_left, 1000 * start.contraction,
      start.checks);
  if (start.repaired > 0)
    std::printf("  %zu vertices were moved to part the faces that were left\n", start.repaired);
  for (const std::string& moved : start.moved) std::printf("  %s\n", moved.c_str());
  for (const std::string& left : start.left)
    if (start.pairs_left > 0) std::printf("  %s\n", left.c_str());

  if (report.dressing) {
    const DressingReport& worn = *report.dressing;
    std::printf("dressing: %d steps while seams close, %d to settle, %d refused, %lld impacts\n",
                worn.closing_steps, worn.settling_steps, worn.refused_steps,
                static_cast<long long>(worn.impacts));
    if (worn.refined_steps > 0)
      std::printf("refined: %d steps to settle after the triangles were divided\n",
                  worn.refined_steps);
    std::printf(
        "strain: 95 %% of the faces below %.3f, largest %.3f; at seams 95 %% below %.3f; "
        "gathers, %.1f %% of the faces, left out\n",
        worn.strain_p95, worn.largest_strain, worn.seam_strain_p95, 100 * worn.gathered_share);
  }
  std::printf("end: %zu pairs of faces intersect; %.1f s\n", intersections, seconds);
}

}  // namespace

int run_sew(const SewOptions& options) {
  if (options.within > 0) return sew_panels(options);
  const Clock::time_point begin = Clock::now();
  set_thread_count(options.threads);
  SceneOrigin read, dressed;
  Scene scene = make_scene(options, read.notes);
  if (!options.quiet) print_notes(read);
  const std::vector<GarmentReport> reports =
      put_garments_on(scene, dressed.notes, show_dressing(options.quiet));
  if (!options.quiet) print_notes(dressed);

  // The file is written when the exact test finds nothing, so that every program can wear it.
  const std::size_t intersections = face_pairs(find_start_conflicts(scene, true)).size();
  const std::chrono::duration<double> time = Clock::now() - begin;
  if (options.report) {
    print_pattern(scene.garments[0], scene.cloths[0].mesh);
    print_report(reports.at(0), intersections, time.count());
  }
  if (intersections > 0) {
    std::fprintf(stderr, "icloth: %s cannot be worn: %zu pairs of faces intersect\n",
                 shown_path(options.pattern).c_str(), intersections);
    return 1;
  }
  if (!options.out.empty())
    write_cloth_obj(options.out, scene.cloths[0].mesh, scene.garments[0].sewn.panel,
                    scene.garments[0].sewn.panel_names, "sewn by icloth, uv in metres");
  return 0;
}

}  // namespace icloth
