#include "sim/bodies/playback.h"

#include <algorithm>
#include <cmath>

namespace icloth {
namespace {

/// The moment within a clip: again from its beginning, or held at its ends.
double within(double time, double duration, bool loop) {
  if (!(duration > 0)) return 0;
  if (!loop) return std::clamp(time, 0.0, duration);
  const double rest = std::fmod(time, duration);
  return rest < 0 ? rest + duration : rest;
}

}  // namespace

PlayedMoment Playback::at(double time, double duration) const {
  // While the body is blended in, it goes to the first moment that is shown. It starts and ends at
  // rest, which a linear blend would not.
  const double passed = std::max(time, 0.0);
  if (passed < blend_in) {
    const double s = passed / blend_in;
    return {within(start, duration, loop), s * s * (3 - 2 * s)};
  }
  return {within(start + speed * (passed - blend_in), duration, loop), 1};
}

}  // namespace icloth
