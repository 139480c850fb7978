// Puts garments on before time 0: their seams are drawn together round the body, at first without
// weight and then with a part of it, and the garments settle under the whole of it. Nothing goes
// through anything meanwhile, as in every other step.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/scene/scene.h"
#include "sim/simulator.h"

namespace icloth {

/// How dressing a garment went.
struct DressingReport {
  std::string garment;         ///< name of its cloth
  int closing_steps = 0;       ///< without their weight, or with a part of it
  int settling_steps = 0;      ///< with all of it
  int refined_steps = 0;       ///< after its triangles were divided
  int refused_steps = 0;       ///< steps that were taken back; the garment went on from rest
  std::int64_t impacts = 0;    ///< that collision handling resolved
  double gathered_share = 0;   ///< of the faces, left out of the strains below
  double strain_p95 = 0;       ///< of the faces at the end
  double largest_strain = 0;   ///< of the faces at the end
  double seam_strain_p95 = 0;  ///< of the faces at stitches, at the end
};

/// Where dressing is, for a progress line or a picture.
struct DressingStatus {
  const std::string& garment;
  bool settling = false;
  int step = 0, most_steps = 0;  ///< of this garment
  double largest_strain = 0;     ///< outside gathers, when it was last measured
};

/// Is called after every step; false ends the dressing: DressingCancelled is thrown.
using DressingWatch = std::function<bool(const Simulator&, const DressingStatus&)>;

struct DressingCancelled {};

/// Numbers of the garments in the order in which they are put on: lower layers first.
std::vector<std::size_t> dressing_order(const Scene& scene);

/// Puts one garment on, among the garments `on`, numbers in scene.garments, that are on already. It
/// is done on the processor in single precision, so that every device starts from the same state.
/// Bodies stand where they are at time 0; they grow to that from a slender copy, contracted over
/// `contraction` [m]. Cloths that are no garments stay where they are. What hangs on the body then
/// becomes the start of the garments in the scene. Throws InputError where the garment cannot be
/// put on.
DressingReport dress_garment(Scene& scene, std::size_t garment, std::span<const std::size_t> on,
                             double contraction, const DressingWatch& watch = {});

/// Lets the garments `on`, which were refined where they hang, settle together. Their reports, in
/// the same order, get the strains that they have then.
void settle_refined(Scene& scene, std::span<const std::size_t> on,
                    std::span<DressingReport* const> reports, const DressingWatch& watch = {});

}  // namespace icloth
