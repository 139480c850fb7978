#include "app/suites/stability/case_run.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

#include "app/suites/suite_case.h"
#include "sim/files/error.h"
#include "sim/files/mesh_io.h"
#include "sim/scene/intersections.h"
#include "sim/scene/scene_meshes.h"

namespace icloth::stability {
namespace {

bool all_finite(const std::vector<Vec3d>& list) {
  return std::ranges::all_of(
      list, [](Vec3d p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); });
}

/// Number of states from one exported state to the next.
constexpr std::int64_t kExportEvery = 10;

std::string counted(std::int64_t number, const char* what) {
  return std::to_string(number) + " " + what;
}

}  // namespace

Simulator& CaseRun::start(std::shared_ptr<const Scene> scene) {
  // The start state must be valid, unless its refusal is the case.
  const auto pairs = find_start_intersections(*scene, settings_.build != Build::cpu64);
  require(pairs.empty(), "the start state of the case is free of intersections");

  // The faces of all objects are listed for the exact check of every state.
  SceneFaces soup = scene_faces(*scene);
  faces_ = std::move(soup.faces);
  group_ = std::move(soup.group);
  simulator_ = make_simulator(settings_.build, std::move(scene));
  return *simulator_;
}

void CaseRun::throw_cloth(std::size_t cloth, Vec3d velocity) {
  // The velocity belongs to the vertices of one cloth, and no older state counts.
  Snapshot state = simulator_->snapshot();
  const Scene& scene = simulator_->scene();
  std::size_t first = 0;
  for (std::size_t c = 0; c < cloth; ++c) first += scene.cloths[c].mesh.positions.size();
  const std::size_t end = first + scene.cloths[cloth].mesh.positions.size();
  for (std::size_t v = first; v < end; ++v) state.v[v] = velocity;
  state.past.forget();
  simulator_->restore(state);
}

void CaseRun::check_state() {
  const Snapshot state = simulator_->snapshot();
  result_.finite = result_.finite && all_finite(state.x1) && all_finite(state.v);
  if (!result_.finite) return;
  if (!settings_.frames.empty() && result_.states % kExportEvery == 0) write_state();
  ++result_.states;
  result_.penetrations +=
      static_cast<std::int64_t>(find_intersections(state.x1, faces_, group_).size());
}

/// Writes cloths and obstacles to one file each, so that other programs can tell them apart.
void CaseRun::write_state() const {
  std::vector<Vec3f> positions;
  simulator_->positions(positions);
  const SceneMeshes scene_meshes = named_meshes(simulator_->scene(), positions);
  const std::vector<NamedMesh>& meshes = scene_meshes.meshes;
  const std::size_t cloths = simulator_->scene().cloths.size();

  // The file's name is that of the case with the number of the state.
  std::string name = name_;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  char number[16];
  std::snprintf(number, sizeof number, "_%05ld", static_cast<long>(result_.states));
  const std::string path = settings_.frames + "/" + name + number;
  write_obj(path + "_cloth.obj", std::span(meshes).first(cloths));
  if (meshes.size() > cloths) write_obj(path + "_obstacles.obj", std::span(meshes).subspan(cloths));
}

void CaseRun::check_refusal(const Snapshot& before, const StepReport& report) {
  ++result_.refused;
  const Snapshot after = simulator_->snapshot();
  require(after.x1 == before.x1 && after.v == before.v && after.time == before.time,
          "a refused step keeps the state before it");
  if (report.finite) require(!report.offending.empty(), "a refused step names its pairs");
}

StepReport CaseRun::step(std::span<const InputEvent> events) {
  // The sums and extremes of the case go on from step to step.
  const Snapshot before = simulator_->snapshot();
  const StepReport report = simulator_->step(events);
  ++result_.steps;
  result_.substeps += report.substeps;
  result_.retries += report.retries;
  result_.rounds += report.rounds;
  result_.impacts += report.impacts_first;
  result_.violation = std::max(result_.violation, report.zone_violation);
  result_.max_strain = std::max(result_.max_strain, report.max_strain);
  result_.max_speed = std::max(result_.max_speed, report.max_speed);

  // A refused step must have left the state alone; an accepted one is checked exactly.
  if (!report.accepted)
    check_refusal(before, report);
  else if (result_.steps % check_every_ == 0)
    check_state();
  return report;
}

bool CaseRun::steps(int count) {
  for (int k = 0; k < count; ++k)
    if (!step().accepted) return false;
  return true;
}

bool CaseRun::run_for(double seconds) {
  return steps(static_cast<int>(std::lround(seconds / simulator_->parameters().step.time_step)));
}

void CaseRun::require(bool holds, const std::string& what) {
  note_failure(result_.failures, holds, what);
}

void CaseRun::require_input_error(const std::function<void()>& load,
                                  const std::vector<std::string>& words) {
  try {
    // The message must have every word.
    load();
  } catch (const InputError& error) {
    for (const std::string& word : words)
      require(std::string(error.what()).find(word) != std::string::npos,
              "'" + word + "' is in the message: " + error.what());
    return;
  }
  require(false, "an error about " + words.front());
}

void CaseRun::note(const std::string& text) {
  if (!result_.note.empty()) result_.note += "; ";
  result_.note += text;
}

CaseResult CaseRun::finish() {
  require(result_.penetrations == 0,
          "no intersections (" + counted(result_.penetrations, "pairs") + ")");
  require(result_.finite, "finite numbers");
  require(refusals_allowed_ || result_.refused == 0,
          "every step is accepted (" + counted(result_.refused, "refused") + ")");
  return result_;
}

CaseResult run_case(const Case& test, const Settings& settings) {
  CaseRun run(settings, test.name);
  return result_of(test, run);
}

}  // namespace icloth::stability
