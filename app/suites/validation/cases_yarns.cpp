// The fold and the shear that the friction between yarns keeps.
#include <cmath>
#include <functional>
#include <vector>

#include "app/suites/validation/case_run.h"
#include "app/suites/validation/cases.h"
#include "app/suites/validation/strips.h"

namespace icloth::validation {
namespace {

constexpr double kModulus = 1.6e-5, kTensile = 400, kShear = kTensile / 2;

/// The positions at rest after a strip was let go, without gravity, in the shape `place`, in which
/// no friction acts.
std::vector<Vec3d> left_at_rest(CaseRun& run, const Strip& strip, const Material& material,
                                const std::function<Vec3d(double, double)>& place) {
  auto scene = exact_scene("friction of yarns");
  scene->parameters.gravity.y = 0;
  scene->cloths = {strip_cloth(strip, place, material)};
  run.start(scene);
  run.relax(2e-3, 1, 1e-9, 2000);
  return run.positions();
}

}  // namespace

/// A strip let go as an arc stays curved, and a sheared one stays sheared. Source: a slider beside
/// a spring (Grosberg 1966; the Kawabata tests are read in this way) comes to rest where the
/// elastic moment is that of the friction, at the curvature HB/D, and at the shear angle HG/G.
/// Protocol: D = 16 µN·m, HB = 0.5 mN, from 60/m; G = 200 N/m, HG = 3 N/m, from an angle of 0.06;
/// equilateral triangles, curvature from the directions at a quarter and three quarters of the
/// length.
void friction_of_yarns(CaseRun& run) {
  Strip strip;
  strip.length = 0.04;
  strip.rows = run.brief() ? 20 : 40;
  strip.columns = strip.rows / 5;
  Material material = plain_fabric(kTensile, 0, 0.2, kModulus);

  // The strip is let go as an arc.
  material.bending_friction = 5e-4;
  const double start = 60;
  const std::vector<Vec3d> bent = left_at_rest(run, strip, material, [&](double u, double v) {
    return Vec3d{std::sin(start * v) / start, (1 - std::cos(start * v)) / start, u};
  });

  // Its curvature is the change of direction between two rows.
  const auto slope = [&](Index row) {
    const Vec3d d = row_mean(strip, bent, row + 1) - row_mean(strip, bent, row);
    return std::atan2(d.y, d.x);
  };
  const Index first = strip.rows / 4, last = strip.rows - 1 - first;
  const double curvature = (slope(last) - slope(first)) / ((last - first) * strip.row_height());
  run.compare("curvature that is left, HB/D", material.bending_friction / kModulus,
              std::fabs(curvature), 0.01);

  // The strip is let go sheared, with the other friction.
  material.bending_friction = 0;
  material.shear_friction = 3;
  const double angle = 0.06;
  const std::vector<Vec3d> sheared = left_at_rest(run, strip, material, [&](double u, double v) {
    return Vec3d{v * std::cos(angle), 0, u + v * std::sin(angle)};
  });

  // Its shear is the angle between a row and the middle line.
  const std::vector<Index> row = strip.row(0);
  const auto at = [&](Index v) { return sheared[static_cast<std::size_t>(v)]; };
  const Vec3d across = at(row.back()) - at(row.front());
  const Vec3d along = row_mean(strip, sheared, strip.rows) - row_mean(strip, sheared, 0);
  run.compare("shear angle that is left, HG/G", material.shear_friction / kShear,
              std::asin(dot(across, along) / (norm(across) * norm(along))), 0.01);
}

}  // namespace icloth::validation
