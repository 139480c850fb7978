// The public face of the solver: one interface, three builds behind it.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kernels/device_positions.h"
#include "sim/scene/input.h"
#include "sim/scene/parameters.h"
#include "sim/scene/scene.h"
#include "sim/state/memory.h"
#include "sim/state/report.h"

namespace icloth {

enum class Build { cpu32, cpu64, cuda32 };

std::string_view build_name(Build build);

class Simulator {
 public:
  virtual ~Simulator() = default;

  virtual Build build() const = 0;
  virtual const Scene& scene() const = 0;
  /// The scene with the meshes that are simulated now: where a seam was welded, its two sides share
  /// vertices. snapshot() is one of this scene; everything else counts elements as scene() does.
  virtual const Scene& sewn_scene() const { return scene(); }

  /// One step of parameters().step.time_step. Never throws for numerical reasons: a refused step
  /// keeps the state before it and says so in the report.
  virtual StepReport step(std::span<const InputEvent> events) = 0;

  /// Moves the clock over a step that was refused: bodies go to where they are after it, the cloth
  /// stays where it is and comes to rest. Vertices that bodies go through are let go from these
  /// until they are outside again; penetrations are left to be counted.
  virtual void pass_over() = 0;

  /// Pairs, at most 100, that the collision test of this build does not see apart although nothing
  /// moves: a step from here will hardly be accepted. They are apart in the scene where the start
  /// check accepts it, but closer than the numbers of the build resolve. Changes nothing.
  virtual std::vector<OffendingPair> contacts_at_rest() { return {}; }

  /// Writes what a report says about the present state: energies, strain, speed, seams, hash.
  /// Returns the energy of which StepReport::energy_balance counts the change [J], 0 where energies
  /// are not reported.
  virtual double measure(StateReport&) { return 0; }

  /// Whether reports have energies and their balance, which takes a few per cent of a step; on at
  /// first. They are 0 while it is off. The motion does not depend on it.
  virtual void report_energies(bool) {}

  virtual const Parameters& parameters() const = 0;
  virtual void set_parameters(const Parameters& parameters) = 0;

  virtual double time() const = 0;
  virtual std::int64_t step_index() const = 0;
  virtual std::uint64_t state_hash() const = 0;

  /// Positions of all vertices in single precision, for drawing; resized to (V).
  virtual void positions(std::vector<Vec3f>& out) const = 0;
  /// The same on the device that computes them, for a reader there: `slot` becomes a copy of its
  /// own (kernels/device_positions.h), empty where the solver runs on the CPU. Does not wait.
  virtual void positions_on_device(std::unique_ptr<DevicePositions>& slot) const { slot.reset(); }
  /// All that the next step goes on from, apart from the parameters.
  virtual Snapshot snapshot() const = 0;
  /// Replaces the state, held handles included, by one of this scene: the next steps are those
  /// that followed the snapshot, bit for bit. Throws std::invalid_argument for another scene's.
  virtual void restore(const Snapshot& snapshot) = 0;
  virtual std::vector<HandleState> handles() const = 0;
};

/// True when this program holds the build and, for cuda32, the device chosen in sim/cuda_devices.h
/// can be used. `reason` (optional) says in one line why not.
bool build_available(Build build, std::string* reason = nullptr);

/// The scene must outlive nothing: the simulator keeps its share. Throws DeviceError when the build
/// is not available, InputError when the scene cannot be simulated (massless vertices, coordinates
/// that single precision does not resolve …).
/// Start intersections are not checked here, see sim/scene/intersections.h.
/// A cuda32 simulator stays on the device that is chosen now, whichever thread calls it.
std::unique_ptr<Simulator> make_simulator(Build build, std::shared_ptr<const Scene> scene);

/// Largest number of threads the CPU builds use from now on; 0: all.
void set_thread_count(int threads);

}  // namespace icloth
