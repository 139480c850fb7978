#include "sim/state/stillness.h"

#include "kernels/parallel/parallel.h"

namespace icloth::ICLOTH_BUILD {
namespace {

/// Square of the distance between two places of a vertex [m²].
struct Distance2 {
  View<const Vec3r> a, b;
  ICLOTH_HD Real operator()(Index i) const { return norm2(a[i] - b[i]); }
};

struct CopyPlaces {
  View<const Vec3r> from;
  View<Vec3r> to;
  ICLOTH_HD void operator()(Index i) const { to[i] = from[i]; }
};

Real largest_distance2(View<const Vec3r> a, View<const Vec3r> b) {
  return reduce("step.stillness", a.size(), Real(0), Distance2{a, b}, Max{});
}

}  // namespace

void watch_stillness(const Topology& mesh, State& state) {
  const Index vertices = mesh.cloth_vertices;
  const View<const Vec3r> now = std::as_const(state.x1).view().sub(0, vertices);
  constexpr auto most = static_cast<Real>(kStillDistance * kStillDistance);
  if (state.still_x.size() == vertices &&
      !(largest_distance2(now, std::as_const(state.still_x).view()) > most))
    return;
  state.still_x.resize(vertices);
  for_each("step.stillness", vertices, CopyPlaces{now, state.still_x.view()});
  state.still_since = state.time;
}

void disturb(Memory& memory) {
  memory.still_x.resize(0);
  memory.still_since = 0;
}

bool is_still(const Memory& memory) {
  return !memory.still_x.empty() && memory.time - memory.still_since >= kStillTime;
}

bool bodies_move(const Topology& mesh, const State& state) {
  const Index first = mesh.cloth_vertices, count = mesh.vertices - first;
  return largest_distance2(state.x0.view().sub(first, count), state.x1.view().sub(first, count)) >
         0;
}

}  // namespace icloth::ICLOTH_BUILD
