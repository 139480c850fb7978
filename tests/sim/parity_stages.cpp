// Compiled once a build.
#include "tests/sim/parity_stages.h"

#include <algorithm>

#include "sim/collision/ccd.h"
#include "sim/collision/proximity.h"
#include "tests/support/stage_support.h"

namespace icloth::ICLOTH_BUILD {
namespace {

using testing::StageLists;

std::vector<Vec3r> to_real(const std::vector<Vec3f>& from) {
  std::vector<Vec3r> out;
  for (const Vec3f& p : from) out.push_back(convert<Real>(p));
  return out;
}

StageLists::Keys candidate_keys(const BroadPhase& broad_phase) {
  StageLists::Keys out;
  for (const Pair& p : broad_phase.vertex_faces().download()) out.push_back(pair_key(false, p));
  for (const Pair& p : broad_phase.edge_edges().download()) out.push_back(pair_key(true, p));
  std::sort(out.begin(), out.end());
  return out;
}

template <class Record>
StageLists::Keys keys_of(const std::vector<Record>& records) {
  StageLists::Keys out;
  for (const Record& record : records) out.push_back(record.key);
  return out;
}

/// Moves the cloth vertices of the impacts half the way back and marks them.
std::vector<std::uint8_t> move_back(const std::vector<Impact>& impacts, Index cloth_vertices,
                                    const std::vector<Vec3r>& x0, std::vector<Vec3r>& x1) {
  std::vector<std::uint8_t> dirty(static_cast<std::size_t>(cloth_vertices), 0);
  for (const Impact& impact : impacts)
    for (const Index v : impact.s.v)
      if (v < cloth_vertices) dirty[static_cast<std::size_t>(v)] = 1;
  for (std::size_t i = 0; i < dirty.size(); ++i)
    if (dirty[i]) x1[i] = x0[i] + Real(0.5) * (x1[i] - x0[i]);
  return dirty;
}

}  // namespace

StageLists run_stages(const testing::StageStart& start) {
  StageLists out;
  Stage stage(*start.scene);
  stage.start = to_real(start.x0);
  stage.state.x0.upload(stage.start);
  stage.set_velocity(to_real(start.velocity));
  std::vector<Vec3r> end = to_real(start.x1);
  stage.set_end(end);
  SubstepContext step = stage.context(static_cast<Real>(start.dt));

  BroadPhase broad_phase;
  broad_phase.prepare(step);
  out.candidates = candidate_keys(broad_phase);
  Proximity proximity;
  proximity.find(step, broad_phase);
  out.contacts = keys_of(proximity.contacts().download());

  Ccd ccd;
  broad_phase.cover_candidate(step);
  out.covered = candidate_keys(broad_phase);
  ccd.find(step, broad_phase, {}, false);
  const std::vector<Impact> impacts = ccd.impacts().download();
  out.impacts = keys_of(impacts);
  for (const Impact& impact : impacts) out.toi.push_back(static_cast<float>(impact.toi));

  Array<std::uint8_t> dirty;
  dirty.upload(move_back(impacts, stage.world.cloth_vertices, stage.start, end));
  stage.set_end(end);
  broad_phase.cover_dirty(step, dirty.view());
  ccd.find(step, broad_phase, dirty.view(), true);
  out.later = keys_of(ccd.impacts().download());
  return out;
}

}  // namespace icloth::ICLOTH_BUILD
