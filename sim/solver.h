// The solver of one build: the stages, the state and what connects them. The order of things is in
// sim/step.cpp, which is the file to read first.
#pragma once

#include <memory>
#include <optional>

#include "sim/bodies/skinning.h"
#include "sim/collision/broad_phase.h"
#include "sim/collision/ccd.h"
#include "sim/collision/impact_zones.h"
#include "sim/collision/pinch.h"
#include "sim/collision/proximity.h"
#include "sim/hands.h"
#include "sim/mechanics/implicit.h"
#include "sim/simulator.h"

namespace icloth::ICLOTH_BUILD {

class Solver final : public Simulator {
 public:
  /// `device`: of the CUDA build, already selected for the calling thread.
  Solver(std::shared_ptr<const Scene> scene, World world, int device);

  // sim/step.cpp
  StepReport step(std::span<const InputEvent> events) override;
  void pass_over() override;
  std::vector<OffendingPair> contacts_at_rest() override;

  // sim/solver.cpp
  icloth::Build build() const override;
  const Scene& scene() const override { return *scene_; }
  const Parameters& parameters() const override { return parameters_; }
  void set_parameters(const Parameters& parameters) override;
  double time() const override { return state_.time; }
  std::int64_t step_index() const override { return state_.step; }
  std::uint64_t state_hash() const override;
  void positions(std::vector<Vec3f>& out) const override;
  void positions_on_device(std::unique_ptr<DevicePositions>& slot) const override;
  double measure(StateReport& report) override;
  void report_energies(bool on) override;
  Snapshot snapshot() const override;
  void restore(const Snapshot& snapshot) override;
  std::vector<HandleState> handles() const override;

 private:
  // sim/step.cpp
  void begin_step(std::span<const InputEvent> events, StepReport& report);
  bool sleeps(std::span<const InputEvent> events, StepReport& report);
  bool run_substeps(StepReport& report);
  void finish_step(StepReport& report);
  void report_end_state(StepReport& report);
  void close_report(StepReport& report) const;
  /// One attempt at a substep; false when impacts are left or numbers are not finite.
  bool try_substep(StepReport& report, double start, double dt, bool last_resort);
  SubstepContext substep(StepReport& report, double start, double dt);
  void find_contacts(SubstepContext& step);
  bool check_candidate(StepReport& report, bool last_resort);
  bool resolve_by_contacts(SubstepContext& step, std::int64_t fewest, bool last_resort);
  bool zones_stretch_cloth(const SubstepContext& step) const;
  bool resolve_by_zones(SubstepContext& step);
  bool resolve_by_rollback(SubstepContext& step);
  void find_impacts(SubstepContext& step, bool first_round);
  bool let_go_of_bodies(StepReport& report, double start, double dt);

  // sim/solver.cpp
  void upload_skins();
  void begin_substep(double start, double dt);
  double body_time(double time) const;
  void advance_clocks(double dt);
  void upload_pose(const Obstacle& obstacle, double time, Index first_vertex);
  void accept_substep(StepReport& report, double dt);
  double zone_work(double dt);
  void report_offending(StepReport& report) const;

  /// Calls come from any thread, and a CUDA device is selected for each thread by itself.
  void use_device() const;
  void use_hands(std::span<const InputEvent> events, StepReport& report);
  double largest_speed() const;  ///< of a vertex [m/s]
  /// Halvings after which no vertex is expected to travel further than allowed in a substep. Notes
  /// the speed of the fastest one.
  int travel_level(StepReport& report);
  void back_to_substep_start();
  void rest_cloth();
  void save_start();
  void back_to_start();
  void forget_measures();
  void reserve_memory();
  void grow_reserve();
  std::vector<Vec3d> cloth_positions() const;
  std::vector<Vec3d> watched_positions() const;  ///< of the vertices that hands_ watches

  int device_ = 0;
  std::shared_ptr<const Scene> scene_;
  World world_;
  Parameters parameters_;
  Topology mesh_;
  State state_;
  Memory start_;                           ///< before the whole step, save_start
  Hands hands_;                            ///< work on state_.hands
  Array<Spring> springs_;                  ///< of the hands, use_hands
  mutable Array<Index> watched_;           ///< vertices that hands_ watches, watched_positions
  mutable Array<Vec3r> watched_position_;  ///< their positions [m], watched_positions
  /// Device memory that the pool had when it was last looked at [bytes], grow_reserve.
  std::uint64_t reserved_ = 0;
  double fastest_ = 0;    ///< largest speed of a vertex at the start of the substep [m/s]
  double free_mass_ = 0;  ///< of the vertices that are not pinned [kg], set_parameters
  bool reports_energies_ = true;
  /// Energy of the state where it is known [J], step. It follows from memory and parameters.
  std::optional<double> energy_;
  std::optional<StateReport> measured_;  ///< of the state where it is known, report_end_state
  double work_ = 0;                      ///< on the cloth in the step so far [J], accept_substep
  Array<Vec3r> candidate_v_;             ///< velocity without impacts (cloth_vertices), zone_work

  BroadPhase broad_phase_;
  Proximity proximity_;
  Implicit implicit_;
  Ccd ccd_;
  ImpactZones impact_zones_;
  Pinch pinch_{world_};
  std::vector<std::unique_ptr<Skinning>> skins_;  ///< of the objects, null where no bones move it
};

}  // namespace icloth::ICLOTH_BUILD
