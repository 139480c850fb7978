// The one table of settings: panels, JSON, --set, --dump-config and the docs come from it.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace icloth {

enum class ZoneSolver { augmented_lagrangian, dual, linear };
enum class Preconditioner { block_jacobi, multilevel };
enum class BroadPhaseMethod { tree, hash };
enum class MaterialEvaluation { direct, table };
enum class BendingModel { hinge, plate };
enum class Integrator { backward_euler, bdf2 };

// The groups of settings. A member has the name that it has in JSON and on the command line; its
// unit, range and meaning stand in its row of parameter_table().

struct StepParameters {
  double time_step = 0.01;
  int max_substep_levels = 6;
  double max_travel = 10.0;
  bool sleep = false;
};

struct GravityParameters {
  double x = 0.0, y = -9.81, z = 0.0;
};

struct WindParameters {
  double x = 0.0, y = 0.0, z = 0.0;
  double air_density = 1.0;
  double air_drag = 0.0;
};

struct MaterialParameters {
  double stretch_scale = 1.0;
  double bend_scale = 1.0;
  double yarn_friction = 1.0;
  double density_scale = 1.0;
  double damping = 0.0;
  double strain_limit = 0.0;
  double pressure = 0.0;
  BendingModel bending = BendingModel::plate;
  MaterialEvaluation evaluation = MaterialEvaluation::direct;
};

struct ProximityParameters {
  bool enabled = true;
  double thickness = 1e-3;
  double stiffness = 1e6;
  double friction_cloth = 0.6;
  double friction_obstacle = 0.3;
  int late_rounds = 2;
};

struct ImplicitParameters {
  Integrator integrator = Integrator::backward_euler;
  Preconditioner preconditioner = Preconditioner::multilevel;
  double cg_tolerance = 1e-3;
  int cg_max_iterations = 500;
  int contact_passes = 30;
  double contact_tolerance = 1e-2;
  int newton_iterations = 5;
  double newton_tolerance = 5;
  double max_linearization_error = 1e3;
};

struct BroadPhaseParameters {
  BroadPhaseMethod method = BroadPhaseMethod::tree;
  int rebuild_interval = 16;
  bool count_tests = false;
};

struct CcdParameters {
  bool incremental = true;
};

struct ImpactZoneParameters {
  bool enabled = true;
  ZoneSolver solver = ZoneSolver::dual;
  double offset = 1e-4;
  double penalty = 1e3;
  double rho = 0.9992;
  int iterations = 100;
  double step_threshold = 1e-12;
  bool chebyshev = true;
  int max_rounds = 30;
  double max_correction = 1.0;
};

struct GrabParameters {
  double stiffness = 400.0;
  double radius = 0.02;
  double max_speed = 3.0;
  double max_force = 10.0;
};

struct SeamParameters {
  double slowest = 0.3;
  double fastest = 0.02;
  double ramp = 0.5;
  double max_pull = 10.0;
  double reach = 0.02;
};

struct BodyParameters {
  double speed = 1.0;
};

/// Settings of a running simulation; all of them may change between two steps.
struct Parameters {
  StepParameters step;
  GravityParameters gravity;
  WindParameters wind;
  MaterialParameters material;
  ProximityParameters proximity;
  ImplicitParameters implicit;
  BroadPhaseParameters broad_phase;
  CcdParameters ccd;
  ImpactZoneParameters impact_zones;
  GrabParameters grab;
  SeamParameters seams;
  BodyParameters bodies;
};

/// How the member behind a row is read, written and offered. Made by field() in parameters.cpp,
/// which derives all of it from the type of the member.
struct ParameterField {
  enum class Kind { number, whole, boolean, choice };

  Kind kind;
  double (*get)(const Parameters&);
  void (*set)(Parameters&, double);           ///< expects a value that is valid for the kind
  std::span<const std::string_view> choices;  ///< names of the values 0, 1, … of a choice
};

struct ParameterInfo {
  using Kind = ParameterField::Kind;

  std::string_view name;   ///< dotted public name, e.g. "impact_zones.penalty"
  std::string_view label;  ///< short text of the panel, with the paper's symbol
  std::string_view unit;   ///< SI unit, "" for none
  ParameterField field;
  double minimum, maximum;  ///< valid range (inclusive); sliders use it, out-of-range is an error
  bool logarithmic;         ///< slider scale
  std::string_view lower, higher;  ///< what smaller and larger values do
  std::string_view source;         ///< where the default comes from
  /// "PARAMETER=CHOICE" when the value matters with that choice only; else empty.
  std::string_view only_with = "";
};

/// Whether the value matters with the present choices (see only_with).
bool parameter_used(const Parameters& parameters, const ParameterInfo& info);

std::span<const ParameterInfo> parameter_table();

/// Row by its public name or an alias of it, or nullptr.
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
