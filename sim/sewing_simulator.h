// A simulator of a scene with open seams. The solver never changes its topology: when all pairs of
// a seam are closed, the cloth is stopped, its two sides are welded in the scene, and a new solver
// goes on from the same state.
#pragma once

#include "sim/scene/seam_weld.h"
#include "sim/simulator.h"

namespace icloth {

/// Makes the solver of a scene; seams are springs to it.
using MakeSolver = std::unique_ptr<Simulator> (*)(Build build, std::shared_ptr<const Scene> scene);

class SewingSimulator final : public Simulator {
 public:
  SewingSimulator(Build build, std::shared_ptr<const Scene> scene, MakeSolver make);

  Build build() const override { return build_; }
  const Scene& scene() const override { return *scene_; }
  const Scene& sewn_scene() const override { return *sewn_; }

  StepReport step(std::span<const InputEvent> events) override;
  void pass_over() override { solver_->pass_over(); }
  std::vector<OffendingPair> contacts_at_rest() override;

  const Parameters& parameters() const override { return solver_->parameters(); }
  void set_parameters(const Parameters& parameters) override {
    solver_->set_parameters(parameters);
  }
  double time() const override { return solver_->time(); }
  std::int64_t step_index() const override { return solver_->step_index(); }
  std::uint64_t state_hash() const override { return solver_->state_hash(); }
  void positions(std::vector<Vec3f>& out) const override;
  void positions_on_device(std::unique_ptr<DevicePositions>& slot) const override;
  double measure(StateReport& report) override { return solver_->measure(report); }
  void report_energies(bool on) override;
  Snapshot snapshot() const override;
  void restore(const Snapshot& snapshot) override;
  std::vector<HandleState> handles() const override { return solver_->handles(); }

 private:
  bool is_closed(const Seam& seam) const;
  void close_seam(std::size_t seam, StepReport& report);
  bool weld(std::size_t seam, StepReport& report);
  void take(WeldedScene welded, std::unique_ptr<Simulator> solver, World world);
  void start_again();
  bool sew_as(const std::vector<SeamProgress>& progress);
  void note_stuck(StepReport& report);
  void name_originally(std::vector<OffendingPair>& pairs) const;

  Build build_;
  MakeSolver make_;
  std::shared_ptr<const Scene> scene_;  ///< as it was given
  std::shared_ptr<const Scene> sewn_;   ///< as it is now
  World world_;                         ///< of sewn_
  std::unique_ptr<Simulator> solver_;   ///< of sewn_
  std::vector<Index> vertex_;           ///< number in sewn_ of each vertex of scene_
  std::vector<Index> original_;         ///< first vertex of scene_ of each vertex of sewn_
  bool reports_energies_ = true;
  std::vector<SeamProgress> progress_;  ///< of each seam
  std::vector<bool> told_closed_;       ///< seams whose closing was noted
  std::vector<bool> told_stuck_;        ///< seams that were named as stuck
};

}  // namespace icloth
