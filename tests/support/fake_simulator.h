// A simulator that takes no time to understand: vertices swing, handles pull them, steps can be
// made slow or be refused. Its state is a function of its inputs, so that replays can be compared.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "sim/simulator.h"
#include "tests/support/fake_device.h"

namespace icloth::testing {

struct FakeOptions {
  int vertices = 12;
  int step_ms = 0;            ///< how long a step takes
  std::int64_t refuse = -1;   ///< calls of step() from this one on are refused …
  double refuse_above = 0;    ///< … while the time step is above this [s]
  std::int64_t note = -1;     ///< the report of this call of step() has two notes
  std::int64_t explode = -1;  ///< this call of step() throws
  std::int64_t lose = -1;     ///< from this call of step() on the device is lost: it and all
                              ///< questions about the state throw
  bool on_device = false;     ///< hand positions out as a solver on a device does
};

class FakeSimulator : public Simulator {
 public:
  explicit FakeSimulator(FakeOptions options = {}) : options_(options) {
    scene_.name = "fake";
    const auto count = static_cast<std::size_t>(options.vertices);
    positions_.resize(count);
    velocities_.assign(count, Vec3d{0, 0, 0.1});
    for (std::size_t v = 0; v < count; ++v) positions_[v] = {0.1 * static_cast<double>(v), 1, 0};
    scene_.cloths.emplace_back();
    scene_.cloths[0].mesh.positions = positions_;
    scene_.cloths[0].mesh.faces = {{0, 1, 2}};
    parameters_ = scene_.parameters;
  }

  Scene& scene_for_setup() { return scene_; }

  Build build() const override { return Build::cpu32; }
  const Scene& scene() const override { return scene_; }

  StepReport step(std::span<const InputEvent> events) override {
    if (options_.step_ms > 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(options_.step_ms));
    }
    const std::int64_t call = calls_++;
    if (options_.lose >= 0 && call >= options_.lose) lost_ = true;
    check_device();
    if (call == options_.explode) throw std::runtime_error("out of order");
    for (const InputEvent& event : events) apply(event);
    StepReport report;
    report.dt = parameters_.step.time_step;
    if (call == options_.note) report.notes = {"seam 'a': welded", "seam 'b': stuck"};
    report.accepted =
        options_.refuse < 0 || call < options_.refuse || report.dt <= options_.refuse_above;
    if (report.accepted) advance();
    report.step = step_;
    report.time = time_;
    report.impacts_left = report.accepted ? 0 : 3;
    if (!report.accepted) report.offending = {{false, {0, 1, 2, 3}}};
    report.state_hash = state_hash();
    return report;
  }

  void pass_over() override { advance(); }

  const Parameters& parameters() const override { return parameters_; }
  void set_parameters(const Parameters& parameters) override { parameters_ = parameters; }
  double time() const override { return time_; }
  std::int64_t step_index() const override { return step_; }

  std::uint64_t state_hash() const override {
    std::uint64_t hash = 1469598103934665603u;
    const auto mix = [&hash](double value) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      hash = (hash ^ bits) * 1099511628211u;
    };
    for (const auto* list : {&positions_, &velocities_}) {
      for (const Vec3d& v : *list) mix(v.x), mix(v.y), mix(v.z);
    }
    return hash;
  }

  void positions_on_device(std::unique_ptr<DevicePositions>& slot) const override {
    std::vector<Vec3f> now;
    positions(now);
    if (options_.on_device) return fake_copy_to_device(now, slot);
    slot.reset();
  }
  void positions(std::vector<Vec3f>& out) const override {
    check_device();
    out.resize(positions_.size());
    std::ranges::transform(positions_, out.begin(), [](Vec3d p) { return convert<float>(p); });
  }
  Snapshot snapshot() const override {
    check_device();
    Snapshot snapshot;
    snapshot.step = step_;
    snapshot.time = time_;
    snapshot.x1 = positions_;
    snapshot.v = velocities_;
    snapshot.hands = held_;
    return snapshot;
  }
  void restore(const Snapshot& snapshot) override {
    check_device();
    step_ = snapshot.step;
    time_ = snapshot.time;
    positions_ = snapshot.x1;
    velocities_ = snapshot.v;
    held_ = snapshot.hands;
  }
  std::vector<HandleState> handles() const override {
    std::vector<HandleState> list;
    for (const HeldPatch& held : held_) list.push_back({held, positions_[0], 0.5});
    return list;
  }

 private:
  void check_device() const {
    if (lost_) throw std::runtime_error("device lost");
  }

  void apply(const InputEvent& event) {
    apply_event(held_, event, [](const InputEvent& grab) { return HeldPatch{handle_of(grab)}; });
  }

  void advance() {
    const double dt = parameters_.step.time_step;
    for (std::size_t v = 0; v < positions_.size(); ++v) {
      Vec3d force = -9.0 * (positions_[v] - Vec3d{0, 1, 0});
      for (const HeldPatch& held : held_) force += 20.0 * (held.target - positions_[v]);
      velocities_[v] += dt * force;
      positions_[v] += dt * velocities_[v];
    }
    time_ += dt;
    ++step_;
  }

  FakeOptions options_;
  Scene scene_;
  Parameters parameters_;
  std::vector<Vec3d> positions_, velocities_;
  std::vector<HeldPatch> held_;
  std::int64_t step_ = 0, calls_ = 0;
  double time_ = 0;
  bool lost_ = false;
};

}  // namespace icloth::testing
