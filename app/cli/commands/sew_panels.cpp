#include "app/cli/commands/sew_panels.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/common/element_names.h"
#include "app/common/headless.h"
#include "kernels/index.h"
#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/mesh_io.h"
#include "sim/files/text.h"
#include "sim/scene/intersections.h"
#include "sim/scene/panel_sewing.h"
#include "sim/scene/scene_json.h"
#include "sim/scene/seam_proposal.h"

namespace icloth {
namespace {

namespace fs = std::filesystem;

/// The scene file of the panels and the body, its files named as seen from `folder`.
nlohmann::json scene_file(const SewOptions& options, const std::string& folder) {
  const auto seen = [&](const std::string& path) {
    if (folder.empty()) return path;
    return fs::absolute(path).lexically_relative(fs::absolute(folder)).string();
  };

  // The cloth has the key "rest" where a second mesh is given.
  nlohmann::json cloth{{"name", "garment"}};
  cloth["mesh"] = seen(options.pattern);
  if (!options.rest.empty()) cloth["rest"] = seen(options.rest);
  if (options.material != "default") cloth["material"] = options.material;
  nlohmann::json scene{{"name", fs::path(options.pattern).stem().string()}};
  scene["cloths"] = nlohmann::json::array({cloth});

  // A body is an obstacle that does not move.
  if (!options.body.empty()) {
    nlohmann::json body{{"name", "body"}};
    body["mesh"] = seen(options.body);
    scene["obstacles"] = nlohmann::json::array({body});
  }
  return scene;
}

std::string panel_name(Index panel) { return "panel" + std::to_string(panel); }

/// "panel2:panel7", and a number behind it where these two have several seams.
std::vector<std::string> seam_names(const SeamProposal& proposal) {
  std::vector<std::string> names;
  std::map<std::array<Index, 2>, int> count;
  for (const ProposedSeam& seam : proposal.seams) {
    const int number = ++count[seam.panel];
    names.push_back(panel_name(seam.panel[0]) + ":" + panel_name(seam.panel[1]) +
                    (number > 1 ? "." + std::to_string(number) : ""));
  }
  return names;
}

void print_proposal(const SeamProposal& proposal) {
  const std::vector<std::string> names = seam_names(proposal);
  std::printf("%-24s %7s %9s %9s %9s %9s\n", "seam", "pairs", "gap [mm]", "at most", "angle [°]",
              "unpaired");
  for (std::size_t s = 0; s < names.size(); ++s) {
    const ProposedSeam& seam = proposal.seams[s];
    std::printf("%-24s %7zu %9.2f %9.2f %8.0f %9zu\n", names[s].c_str(), seam.pairs.size(),
                1000 * seam.mean_gap, 1000 * seam.largest_gap, 180 / std::numbers::pi * seam.angle,
                seam.unpaired);
  }
  std::printf(
      "%zu panels, %zu seams; %zu of %zu border vertices are sewn; left out: %zu pairs that do not "
      "stand in a row, %zu that would fold a face\n",
      proposal.panels, names.size(), proposal.sewn_vertices, proposal.border_vertices,
      proposal.scattered, proposal.crossing);
}

/// A scene file in which the seams are open and draw together.
void write_open_seams(const SewOptions& options, const SeamProposal& proposal,
                      const FileLayout& layout) {
  const std::vector<Index> numbers = file_numbers(layout);
  const auto in_file = [&](Index v) { return layout.is_identity() ? v : numbers[at(v)]; };
  const std::vector<std::string> names = seam_names(proposal);

  nlohmann::json seams = nlohmann::json::array();
  for (std::size_t s = 0; s < names.size(); ++s) {
    nlohmann::json pairs = nlohmann::json::array();
    for (const auto& [a, b] : proposal.seams[s].pairs)
      pairs.push_back(nlohmann::json::array({in_file(a), in_file(b)}));
    nlohmann::json seam{{"name", names[s]}};
    seam["pairs"] = std::move(pairs);
    seams.push_back(std::move(seam));
  }
  nlohmann::json scene = scene_file(options, fs::path(options.out).parent_path().string());
  scene["cloths"][0]["seams"] = std::move(seams);
  write_file(options.out, scene.dump(1) + "\n");
}

/// Says which faces intersect, by panel.
void print_conflicts(const SewOptions& options, const Scene& scene,
                     const std::vector<IntersectingFaces>& pairs, const std::vector<Index>& panel) {
  constexpr std::size_t kShown = 20;
  std::fprintf(stderr, "icloth: %s cannot be sewn: %zu pairs of faces intersect\n",
               shown_path(options.pattern).c_str(), pairs.size());
  const auto name = [&](Index face) {
    return at(face) < panel.size() ? panel_name(panel[at(face)]) + " face " + std::to_string(face)
                                   : ElementNames(scene).face(face);
  };
  for (std::size_t i = 0; i < std::min(pairs.size(), kShown); ++i)
    std::fprintf(stderr, "  %s and %s\n", name(pairs[i].a).c_str(), name(pairs[i].b).c_str());
  if (pairs.size() > kShown) std::fprintf(stderr, "  … and %zu more\n", pairs.size() - kShown);
}

}  // namespace

int sew_panels(const SewOptions& options) {
  set_thread_count(options.threads);
  SceneOrigin origin;
  SceneFolder folder;
  folder.files.anywhere = true;
  folder.notes = &origin.notes;
  Scene scene = parse_scene(scene_file(options, ""), shown_path(options.pattern), folder, origin);
  if (!options.quiet) print_notes(origin);

  // What lies side by side is proposed, and told before anything is changed.
  const SeamProposal proposal = propose_seams(scene.cloths[0].mesh, options.within);
  if (options.report) print_proposal(proposal);
  if (proposal.seams.empty())
    throw InputError(shown_path(options.pattern) + ": no borders within " +
                     rounded_text(1000 * options.within) +
                     " mm of each other, expected panels that lie side by side");
  if (lower_extension(options.out) == ".json") {
    write_open_seams(options, proposal, origin.layouts.at(0));
    return 0;
  }

  // The welded garment replaces the panels.
  const std::size_t before =
      options.report ? face_pairs(find_start_conflicts(scene, true)).size() : 0;
  const Seam seam = joint_seam(proposal);
  const SewnPanels sewn = sew_seam(scene, seam, shown_path(options.pattern));
  if (options.report) {
    std::printf(
        "%zu pairs of faces intersect as delivered, %zu when sewn, %zu after the repair, which "
        "moved %zu vertices by at most %.2f mm\n",
        before, sewn.pairs, sewn.left.size(), sewn.repair.moved, 1000 * sewn.repair.largest_move);
    if (sewn.open > 0)
      std::printf("%zu of %zu pairs stay open beside faces that could not be parted\n", sewn.open,
                  seam.pairs.size());
  }
  if (!sewn.left.empty()) {
    print_conflicts(options, sewn.scene, sewn.left, proposal.panel);
    return 1;
  }

  // The pattern of the garment is its rest shape.
  std::vector<std::string> names;
  for (std::size_t p = 0; p < proposal.panels; ++p)
    names.push_back(panel_name(static_cast<Index>(p)));
  if (!options.out.empty())
    write_cloth_obj(options.out, sewn.scene.cloths[0].mesh, proposal.panel, names,
                    "sewn by icloth, uv in metres");
  return 0;
}

}  // namespace icloth
