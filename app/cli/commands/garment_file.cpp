#include "app/cli/commands/garment_file.h"

#include <cstdio>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

/// A distance in metres for the file; empty where there is none.
std::string distance_text(const std::optional<double>& distance) {
  if (!distance) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.5f", *distance);
  return text;
}

/// The name of a garment or a panel, from a file that may hold anything, as a field of a CSV file.
std::string field(std::string name) {
  for (char& c : name)
    if (c == ',' || c == '"' || static_cast<unsigned char>(c) < ' ') c = '_';
  return name;
}

}  // namespace

void GarmentFile::Peak::take(double candidate, std::int64_t at_step) {
  if (candidate <= value) return;
  value = candidate;
  step = at_step;
}

GarmentFile::GarmentFile(std::string path, const Scene& scene) : path_(std::move(path)) {
  if (path_.empty()) return;
  if (scene.garments.empty())
    throw InputError("--garments " + shown_path(path_) + ": no cloth of the scene " +
                     in_quotes(scene.name) + " is sewn from a pattern");
  require_folder("--garments", path_);
  gauge_ = std::make_unique<GarmentFitGauge>(scene);
  write_file(path_, "step,time,garment,strain_p95,largest_strain,panel,waist,collar\n");
}

void GarmentFile::add(const Simulator& simulator, std::int64_t step) {
  if (!gauge_) return;
  simulator.positions(positions_);
  const std::vector<GarmentFit> fits = gauge_->measure(positions_, simulator.time());
  peaks_.resize(fits.size());

  // The rows of a step reach the file together; the largest values are kept for the summary.
  std::string rows;
  for (std::size_t g = 0; g < fits.size(); ++g) {
    const GarmentFit& fit = fits[g];
    char numbers[64];
    std::snprintf(numbers, sizeof numbers, "%lld,%.6g,", static_cast<long long>(step),
                  simulator.time());
    rows += numbers + field(fit.name);
    std::snprintf(numbers, sizeof numbers, ",%.4f,%.4f,", fit.strain_p95, fit.largest_strain);
    rows += numbers + field(fit.panel) + "," + distance_text(fit.waist) + "," +
            distance_text(fit.collar) + "\n";

    Peaks& peaks = peaks_[g];
    peaks.name = fit.name;
    if (fit.largest_strain > peaks.strain.value) peaks.panel = field(fit.panel);
    peaks.strain.take(fit.largest_strain, step);
    if (fit.waist) peaks.waist.take(*fit.waist, step);
    if (fit.collar) peaks.collar.take(*fit.collar, step);
  }
  append_file(path_, rows);
}

std::string GarmentFile::summary() const {
  std::string text;
  for (const Peaks& peaks : peaks_) {
    char part[200];
    std::snprintf(part, sizeof part,
                  "garment %s: largest strain outside gathers %.3f (%s, step %lld)",
                  peaks.name.c_str(), peaks.strain.value, peaks.panel.c_str(),
                  static_cast<long long>(peaks.strain.step));
    text += part;

    // A border that the pattern does not have is left out.
    for (const auto& [what, peak] : {std::pair("waist", peaks.waist), {"collar", peaks.collar}}) {
      if (peak.value < 0) continue;
      std::snprintf(part, sizeof part, ", %s within %.1f cm (step %lld)", what, 100 * peak.value,
                    static_cast<long long>(peak.step));
      text += part;
    }
    text += "\n";
  }
  return text;
}

}  // namespace icloth
