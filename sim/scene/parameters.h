// The one table of settings: panels, JSON, --set, --dump-config and the docs come from it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>

namespace icloth {

/// Settings of a running simulation. Every member has one row in parameter_table(), which holds
/// its public name, unit, range and meaning; all of them may change between two steps.
enum class ZoneSolver { augmented_lagrangian, dual, linear };
enum class Preconditioner { block_jacobi, multilevel };
enum class BroadPhaseMethod { tree, hash };
enum class MaterialEvaluation { direct, table };
enum class BendingModel { hinge, plate };
enum class Integrator { backward_euler, bdf2 };

struct Parameters {
  // step
  double time_step = 0.01;
  int max_substep_levels = 6;
  double max_travel = 2.0;
  // forces
  double gravity_x = 0.0, gravity_y = -9.81, gravity_z = 0.0;
  double wind_x = 0.0, wind_y = 0.0, wind_z = 0.0;
  double air_density = 1.0;
  double air_drag = 0.0;
  // material
  double stretch_scale = 1.0;
  double bend_scale = 1.0;
  double yarn_friction = 1.0;
  double density_scale = 1.0;
  double damping_extra = 0.0;
  double strain_limit = 0.0;
  MaterialEvaluation material_evaluation = MaterialEvaluation::direct;
  BendingModel bending_model = BendingModel::plate;
  // proximity
  bool proximity_enabled = true;
  double thickness = 1e-3;
  double repulsion_stiffness = 1e6;
  double friction_cloth = 0.6;
  double friction_obstacle = 0.3;
  // implicit
  Integrator integrator = Integrator::backward_euler;
  Preconditioner preconditioner = Preconditioner::multilevel;
  double cg_tolerance = 1e-3;
  int cg_max_iterations = 500;
  int contact_passes = 6;
  double contact_tolerance = 1e-3;
  int newton_iterations = 5;
  double newton_tolerance = 5;
  double max_missed_tension = 1e3;
  // broad phase
  BroadPhaseMethod broad_phase_method = BroadPhaseMethod::tree;
  int rebuild_interval = 16;
  bool count_box_tests = false;
  // ccd
  bool ccd_incremental = true;
  // impact zones
  bool impact_zones_enabled = true;
  ZoneSolver zone_solver = ZoneSolver::dual;
  double offset = 1e-4;
  double penalty = 1e3;
  double rho = 0.9992;
  int zone_iterations = 100;
  double step_threshold = 1e-12;
  bool chebyshev = true;
  int max_rounds = 30;
  double max_correction = 1.0;
  // hands
  double grab_stiffness = 400.0;
  double grab_radius = 0.02;
  double grab_max_speed = 3.0;
  double grab_max_force = 10.0;
};

struct ParameterInfo {
  using Member = std::variant<double Parameters::*, int Parameters::*, bool Parameters::*,
                              ZoneSolver Parameters::*, BroadPhaseMethod Parameters::*,
                              MaterialEvaluation Parameters::*, Preconditioner Parameters::*,
                              BendingModel Parameters::*, Integrator Parameters::*>;

  std::string_view name;   ///< dotted public name, e.g. "impact_zones.penalty"
  std::string_view label;  ///< short text of the panel, with the paper's symbol
  std::string_view unit;   ///< SI unit, "" for none
  Member member;
  double minimum, maximum;  ///< valid range (inclusive); sliders use it, out-of-range is an error
  bool logarithmic;         ///< slider scale
  std::string_view lower, higher;  ///< what smaller and larger values do
  std::string_view source;         ///< where the default comes from
  /// "PARAMETER=CHOICE" when the value matters with that choice only; else empty.
  std::string_view only_with = "";
};

/// Names of the values 0, 1, … of a parameter that is chosen by name; empty for numbers.
std::span<const std::string_view> parameter_choices(const ParameterInfo& info);

/// Whether the value matters with the present choices (see only_with).
bool parameter_used(const Parameters& parameters, const ParameterInfo& info);

std::span<const ParameterInfo> parameter_table();

/// Row by its public name, or nullptr.
const ParameterInfo* find_parameter(std::string_view name);

/// Value as a number (bools are 0 or 1, choices their place).
double get_parameter(const Parameters& parameters, const ParameterInfo& info);

/// Sets one value. Throws InputError naming the key, the value and the valid range.
void set_parameter(Parameters& parameters, const ParameterInfo& info, double value);

/// Sets "KEY" to "VALUE" as --set does. Throws InputError; an unknown key names the nearest one.
void set_parameter(Parameters& parameters, std::string_view key, std::string_view value);

/// All effective values as a JSON object keyed by public name.
std::string dump_parameters(const Parameters& parameters);

}  // namespace icloth
