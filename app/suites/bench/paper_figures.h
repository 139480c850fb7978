// The report of `icloth bench paper`, made from what was measured: a section for each figure of
// Tang et al. 2018. A section is left out where its scene was not measured.
#pragma once

#include "app/suites/bench/paper_run.h"
#include "app/suites/report/report.h"

namespace icloth {

/// The scenes that were measured, and where their results are.
struct PaperResults {
  const PaperContext& context;
  std::vector<PaperScene> scenes;

  /// A result; null where there is none.
  const PaperStore::Json* find(const PaperScene& scene, const Stretch& stretch,
                               const std::string& mode) const;
  /// All steps of the run to a stretch.
  const PaperStore::Json* find_run(const PaperScene& scene, const Stretch& stretch) const;
  /// The scene of that name; null where it was not measured.
  const PaperScene* scene(std::string_view name) const;
};

/// Collision handling of the first `count` steps [ms].
double collision_ms(const PaperStore::Json& rows, std::size_t count = ~std::size_t{0});

/// Fig. 8 with its companions: speed, collision handling, every stretch, where the machine was not
/// quiet.
void show_speed(const PaperResults& results, Report& report);
/// Section 4.3: one attempt with each solver of impact zones.
void show_single_attempts(const PaperResults& results, Report& report);
/// Fig. 5, 6, 7, 9, 10, 11 and 12.
void show_figures(const PaperResults& results, Report& report);
/// Which steps stand for which frames of the paper.
void show_frames(const PaperResults& results, Report& report);

/// Whether all states of our own way are free of penetrations, and no step was refused.
bool is_clean(const PaperResults& results);

}  // namespace icloth
