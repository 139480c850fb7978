// The report of a step. Names are those of the statistics files and the panels.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kernels/parallel/platform.h"
#include "sim/state/limits.h"

namespace icloth {

/// Pair of elements that still collides. Vertices are global (cloths first, then obstacles).
struct OffendingPair {
  bool edge_edge = false;           ///< false: vertices[0] against the face of the other three
  std::array<Index, 4> vertices{};  ///< vf: vertex, face; ee: a0 a1 b0 b1
};

/// What a report says of the state at the end of a step. It follows from the state alone.
struct StateReport {
  /// Energies [J]; 0 where nobody asked for them (sim/simulator.h).
  double kinetic_energy = 0, elastic_energy = 0, gravity_energy = 0;
  double max_strain = 0;     ///< largest principal stretch − 1
  double max_speed = 0;      ///< [m/s]
  std::int64_t pinched = 0;  ///< cloth vertices that are let go from a body (collision/pinch.h)
  /// Stitched pairs of open seams that are not closed yet, and those among them that come no
  /// nearer.
  std::int64_t open_pairs = 0, stuck_pairs = 0;
  double seam_gap = 0;  ///< largest distance of a stitched pair [m]
  std::uint64_t state_hash = 0;
};

struct StepReport : StateReport {
  std::int64_t step = 0;
  double time = 0;  ///< at the end of the step [s]
  double dt = 0;    ///< [s]
  std::int64_t substeps = 1, retries = 0;
  double ms_total = 0, ms_proximity = 0, ms_implicit = 0, ms_broad_phase = 0, ms_ccd = 0,
         ms_impact_zones = 0, ms_other = 0;
  std::int64_t proximity_pairs = 0, candidate_pairs = 0, elementary_tests = 0, impacts_first = 0,
               impacts_left = 0;
  std::int64_t late_contacts = 0;  ///< impacts of candidates that joined the contacts
  std::int64_t box_tests = 0;      ///< boxes compared, where broad_phase.count_tests asks for it
  std::int64_t rounds = 0, zones = 0, largest_zone = 0, zone_iterations = 0;
  /// How far the worst zone was from an optimum (kernels/zones/zone_problem.h) [m], [m], relative.
  double zone_violation = 0, zone_complementarity = 0, zone_momentum_residual = 0;
  std::int64_t dynamic_faces = 0, static_faces = 0;  ///< T_d of the last round, and the other faces
  std::int64_t newton_iterations = 0;                ///< linearisations of the elastic forces
  std::int64_t linear_solves = 0;  ///< systems solved: contact passes of all linearisations
  std::int64_t cg_iterations = 0;  ///< of all linear solves together
  double cg_residual = 0;          ///< ‖b − AΔv‖₂ / ‖b‖₂, true
  double cg_bytes = 0;             ///< that the iterations had to move at least; no column
  double min_gap = 0;  ///< smallest proximity distance at the start of the step [m], h if none
  /// |Σ b − AΔv| / (dt Σ m) over the free vertices, of the last solve of a substep and the largest
  /// of all substeps: the force per mass that CG, where it stopped, makes or loses [m/s²].
  double momentum_error = 0;
  /// Kinetic, elastic, gravity and pressure energy after the step, less those before it, less the
  /// work done on the cloth in it by air, hands, open seams, contacts (repulsion and friction, as
  /// the linear terms applied them), yarn friction (what it gives back included) and impact zones
  /// (all that they changed in those energies) [J]. Negative: what damping, of the fabric and of
  /// the integrator, took away; positive: made from nothing, an error. The errors of CG and of the
  /// linearisation are in it, what the measured fabrics, whose stiffness follows the strain, give
  /// or take along a path, and what the weld of a seam changes. 0 of a refused step, and where
  /// nobody asked for energies.
  double energy_balance = 0;
  /// The limits that were reached in the step, in refused substeps too: a bit each, see limits.h.
  std::int64_t limits = 0;
  void reach(Limit limit) { limits |= bit_of(limit); }
  bool reached(Limit limit) const { return (limits & bit_of(limit)) != 0; }

  /// Impacts that were found in the step: before the first round of zones and after each round, for
  /// every attempt at a substep one after the other. Rounds of the last resort are left out.
  std::vector<std::int64_t> impacts_in_rounds;

  bool accepted = true;                  ///< false: the state before the step was kept
  bool finite = true;                    ///< false: NaN or infinity appeared and was thrown away
  std::vector<OffendingPair> offending;  ///< of a refused step, at most 100
  std::vector<std::string> notes;        ///< what users should read about the step, a line each
  bool no_room = false;  ///< refused, and every pair left is with an obstacle: it leaves no room
};

/// One column of the statistics table.
struct ReportColumn {
  using Member =
      std::variant<double StepReport::*, std::int64_t StepReport::*, std::uint64_t StepReport::*>;
  std::string_view name;
  Member member;
};

/// Columns in the order of the contract.
std::span<const ReportColumn> report_columns();

/// One value as text: integers exactly, doubles with 9 digits, the hash as 16 hex digits.
std::string report_value(const StepReport& report, const ReportColumn& column);

}  // namespace icloth
