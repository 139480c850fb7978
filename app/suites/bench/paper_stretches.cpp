#include "app/suites/bench/paper_stretches.h"

#include <algorithm>
#include <cmath>

#include "sim/files/text.h"

namespace icloth {

std::string steps_text(const Stretch& stretch) {
  return std::to_string(stretch.first) + "–" + std::to_string(stretch.end());
}

std::string stretch_text(const Stretch& stretch) {
  if (stretch.clip_start < 0) return steps_text(stretch);
  return steps_text(stretch) + ", clip from " + rounded_text(stretch.clip_start, 4) + " s";
}

const std::vector<PaperScene>& paper_scenes() {
  static const std::vector<PaperScene> scenes = {
      // Cloths that are run from their start.
      {"sphere",
       "Sphere",
       200000,
       200,
       {0.35, 1.06, 1.95, 0.790, 0.285},
       {{100, 40, "the ball pushes into the sheets"}, {380, 40, "the ball is deep in the sheets"}},
       1.2},
      {"twisting",
       "Twisting",
       200000,
       200,
       {0.34, 1.03, 5.08, 0.660, 0.164},
       {{60, 50, "the sheets drape over the ball"},
        {250, 35, "the ball begins to turn"},
        {600, 35, "the sheets are wrung"}},
       1.6},
      {"funnel",
       "Funnel",
       200000,
       100,
       {0.60, 2.33, 8.47, 0.353, 0.066},
       {{60, 20, "the sheets fold into the cone"},
        {150, 20, "the sheets fill the cone"},
        {300, 20, "the sheets sink into the pipe"}},
       4.5},

      // The clip of a garment starts so that the moment comes after 0.5 s of blend and 0.3 s.
      {"andy",
       "Andy",
       127000,
       200,
       {0.27, 1.19, 3.73, 0.689, 0.177},
       {{160, 20, "fastest moment of the kung fu", 2.45},
        {160, 20, "second fastest moment", 0.9},
        {160, 20, "third fastest moment", 5.85}},
       1.2},
      {"dress",
       "Dress",
       90000,
       100,
       {0.28, 0.92, 6.06, 0.774, 0.073},
       {{80, 20, "fastest moment of the dance", 3.55},
        {80, 20, "second fastest moment", 2.55},
        {80, 20, "third fastest moment", 4.55}},
       0.7},
      {"tiered",
       "Tiered",
       215000,
       200,
       {0.16, 0.64, 1.23, 1.310, 0.654},
       {{160, 20, "fastest moment of the dance", 3.65},
        {160, 20, "second fastest moment", 2.65},
        {160, 20, "third fastest moment", 4.65}},
       2},
      {"bishop",
       "Bishop",
       124000,
       100,
       {0.31, 1.06, 4.46, 0.743, 0.148},
       {{80, 20, "fastest moment of the swing", 4.6},
        {80, 20, "second fastest moment", 5.1},
        {80, 20, "third fastest moment", 4.1}},
       1.5},
  };
  return scenes;
}

std::vector<PaperScene> scenes_at(double scale) {
  std::vector<PaperScene> scenes = paper_scenes();
  if (scale >= kQuickLook) return scenes;
  for (PaperScene& scene : scenes)
    scene.stretches.resize(
        std::min<std::size_t>(scene.stretches.size(), scene.is_garment() ? 1 : 2));
  return scenes;
}

std::vector<FastMoment> fastest_moments(const Obstacle& obstacle, double blend_in, double duration,
                                        double window, std::size_t count) {
  constexpr double kSample = 0.01, kApart = 0.5;
  constexpr long kStride = 5;  // samples between the beginnings of windows
  const long samples = std::lround(duration / kSample), width = std::lround(window / kSample);

  // The mean speed of the vertices between two samples.
  std::vector<double> speed;
  std::vector<Vec3d> before, after;
  obstacle.pose(blend_in, before);
  for (long k = 0; k < samples; ++k) {
    obstacle.pose(blend_in + kSample * static_cast<double>(k + 1), after);
    double sum = 0;
    for (std::size_t v = 0; v < before.size(); ++v) sum += norm(after[v] - before[v]);
    speed.push_back(sum / kSample / static_cast<double>(before.size()));
    before.swap(after);
  }

  // Every window in which the clip can have played long enough before.
  std::vector<FastMoment> windows;
  for (long k = kStride * std::lround(kFollowing / kSample / kStride); k + width <= samples;
       k += kStride) {
    double sum = 0;
    for (long i = k; i < k + width; ++i) sum += speed[static_cast<std::size_t>(i)];
    windows.push_back({kSample * static_cast<double>(k), sum / static_cast<double>(width)});
  }

  // The fastest ones that are apart from those before.
  std::ranges::stable_sort(windows, std::greater{}, &FastMoment::speed);
  std::vector<FastMoment> chosen;
  for (const FastMoment& candidate : windows) {
    const auto is_near = [&](const FastMoment& other) {
      return std::fabs(other.begin - candidate.begin) < kApart;
    };
    if (chosen.size() < count && std::ranges::none_of(chosen, is_near)) chosen.push_back(candidate);
  }
  return chosen;
}

}  // namespace icloth
