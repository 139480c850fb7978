// The file of `run --garments`: how the garments of a scene are worn after every step.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/session/garment_fit.h"
#include "sim/simulator.h"

namespace icloth {

class GarmentFile {
 public:
  /// Opens the CSV file and writes its head; an empty path: nothing is measured or written. Throws
  /// InputError, also where no cloth of the scene is a garment.
  GarmentFile(std::string path, const Scene& scene);

  /// Adds a row for each garment of the present state.
  void add(const Simulator& simulator, std::int64_t step);

  /// A line for each garment: its largest values, and the steps that have them.
  std::string summary() const;

 private:
  /// A largest value and its step.
  struct Peak {
    double value = -1;
    std::int64_t step = 0;
    void take(double candidate, std::int64_t at_step);
  };
  struct Peaks {
    std::string name, panel;
    Peak strain, waist, collar;
  };

  std::string path_;
  std::unique_ptr<GarmentFitGauge> gauge_;
  std::vector<Peaks> peaks_;
  std::vector<Vec3f> positions_;
};

}  // namespace icloth
