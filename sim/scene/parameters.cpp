#include "sim/scene/parameters.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <vector>

#include "sim/files/error.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

// Names of the values of each choice, in the order of its enumeration.
constexpr std::string_view kZoneSolvers[] = {"augmented_lagrangian", "dual", "linear"};
constexpr std::string_view kPreconditioners[] = {"block_jacobi", "multilevel"};
constexpr std::string_view kBroadPhaseMethods[] = {"tree", "hash"};
constexpr std::string_view kIntegrators[] = {"backward_euler", "bdf2"};
constexpr std::string_view kBendingModels[] = {"hinge", "plate"};
constexpr std::string_view kMaterialEvaluations[] = {"direct", "table"};

using Names = std::span<const std::string_view>;
constexpr Names names_of(ZoneSolver) { return kZoneSolvers; }
constexpr Names names_of(Preconditioner) { return kPreconditioners; }
constexpr Names names_of(BroadPhaseMethod) { return kBroadPhaseMethods; }
constexpr Names names_of(Integrator) { return kIntegrators; }
constexpr Names names_of(BendingModel) { return kBendingModels; }
constexpr Names names_of(MaterialEvaluation) { return kMaterialEvaluations; }

// The member of Parameters that holds a group of settings.
constexpr auto group_of(StepParameters) { return &Parameters::step; }
constexpr auto group_of(GravityParameters) { return &Parameters::gravity; }
constexpr auto group_of(WindParameters) { return &Parameters::wind; }
constexpr auto group_of(MaterialParameters) { return &Parameters::material; }
constexpr auto group_of(ProximityParameters) { return &Parameters::proximity; }
constexpr auto group_of(ImplicitParameters) { return &Parameters::implicit; }
constexpr auto group_of(BroadPhaseParameters) { return &Parameters::broad_phase; }
constexpr auto group_of(CcdParameters) { return &Parameters::ccd; }
constexpr auto group_of(ImpactZoneParameters) { return &Parameters::impact_zones; }
constexpr auto group_of(GrabParameters) { return &Parameters::grab; }
constexpr auto group_of(SeamParameters) { return &Parameters::seams; }
constexpr auto group_of(BodyParameters) { return &Parameters::bodies; }

/// The group that a member belongs to; never called, its result type is what counts.
template <class Group, class Type>
Group owner_of(Type Group::*);

/// How the table reads and writes one member, such as &StepParameters::time_step.
template <auto Member>
constexpr ParameterField field() {
  constexpr auto Group = group_of(decltype(owner_of(Member)){});
  using Kind = ParameterField::Kind;
  using Type = std::remove_cvref_t<decltype(std::declval<Parameters>().*Group.*Member)>;

  // All values travel as doubles; a choice is the number of its name.
  ParameterField f{};
  f.get = [](const Parameters& p) { return static_cast<double>(p.*Group.*Member); };
  if constexpr (std::is_enum_v<Type>) {
    f.kind = Kind::choice;
    f.choices = names_of(Type{});
    f.set = [](Parameters& p, double value) {
      p.*Group.*Member = static_cast<Type>(static_cast<int>(value));
    };
  } else {
    f.kind = std::is_same_v<Type, double> ? Kind::number
             : std::is_same_v<Type, int>  ? Kind::whole
                                          : Kind::boolean;
    f.set = [](Parameters& p, double value) { p.*Group.*Member = static_cast<Type>(value); };
  }
  return f;
}

using Step = StepParameters;
using Gravity = GravityParameters;
using Wind = WindParameters;
using Fabric = MaterialParameters;
using Near = ProximityParameters;
using Solve = ImplicitParameters;
using Broad = BroadPhaseParameters;
using Zones = ImpactZoneParameters;
using Grab = GrabParameters;
using Stitch = SeamParameters;
using Bodies = BodyParameters;

constexpr std::string_view kOnlyPaper = "impact_zones.solver=augmented_lagrangian";

// Units: k is a repulsion stiffness per area, hence N/m³. "paper" is Tang et al. 2018, "ARCSim" the
// defaults that Narain, Samii and O'Brien 2012 published with theirs, "measured" our own runs.
constexpr ParameterInfo kTable[] = {
    {"step.time_step", "time step dt", "s", field<&Step::time_step>(), 1e-4, 0.1, true,
     "smoother contacts, less numerical damping, more steps for a second of motion",
     "fewer steps for a second of motion, more damping, deeper penetrations to resolve",
     "paper, Fig. 8 (1/200 to 1/100 s)"},
    {"step.max_substep_levels", "substep levels", "", field<&Step::max_substep_levels>(), 0, 10,
     false, "a step that cannot be made free of penetrations is refused sooner",
     "such a step is halved more often before it is refused", "own choice: dt/64"},
    {"step.max_travel", "travel in a substep", "edges", field<&Step::max_travel>(), 0.1, 100, true,
     "fast motion is cut into more substeps: fewer, shallower impacts",
     "fewer substeps; more contacts are found late, and impacts are deeper", "measured on Funnel"},
    {"step.sleep", "sleep at rest", "", field<&Step::sleep>(), 0, 1, false,
     "off: every step is computed",
     "on: cloth that was still for 3 s is left alone until something touches or changes it",
     "own choice; on in the window"},

    {"gravity.x", "gravity x", "m/s²", field<&Gravity::x>(), -100, 100, false, "pull towards −x",
     "pull towards +x", "Y is up"},
    {"gravity.y", "gravity y", "m/s²", field<&Gravity::y>(), -100, 100, false, "stronger pull down",
     "weaker pull down, above 0: up", "standard gravity"},
    {"gravity.z", "gravity z", "m/s²", field<&Gravity::z>(), -100, 100, false, "pull towards −z",
     "pull towards +z", "Y is up"},

    {"wind.x", "wind x", "m/s", field<&Wind::x>(), -50, 50, false, "air moves towards −x",
     "air moves towards +x", "still air"},
    {"wind.y", "wind y", "m/s", field<&Wind::y>(), -50, 50, false, "air moves down", "air moves up",
     "still air"},
    {"wind.z", "wind z", "m/s", field<&Wind::z>(), -50, 50, false, "air moves towards −z",
     "air moves towards +z", "still air"},
    {"wind.air_density", "air density", "kg/m³", field<&Wind::air_density>(), 0, 10, false,
     "less pressure across the cloth; 0 together with air_drag 0: no air at all",
     "wind pushes and still air brakes more", "ARCSim; air is 1.2"},
    {"wind.air_drag", "air drag along the cloth", "N·s/m³", field<&Wind::air_drag>(), 0, 10, false,
     "air slips along the cloth; pressure still brakes it as long as air_density is above 0",
     "air drags the cloth along", "ARCSim"},

    {"material.stretch_scale", "stretching ×", "", field<&Fabric::stretch_scale>(), 1e-3, 1e3, true,
     "softer in the plane, fewer iterations", "stiffer in the plane, more iterations",
     "as measured"},
    {"material.bend_scale", "bending ×", "", field<&Fabric::bend_scale>(), 0, 1e3, false,
     "finer, softer folds", "wider, stiffer folds", "as measured"},
    {"material.yarn_friction", "friction of yarns ×", "", field<&Fabric::yarn_friction>(), 0, 100,
     false, "springs back from folds; 0: elastic",
     "stands up by itself and keeps folds, hangs stiffer", "as its fabric says, mostly none"},
    {"material.density_scale", "density ×", "", field<&Fabric::density_scale>(), 1e-2, 1e2, true,
     "lighter cloth: moved more by wind and hands", "heavier cloth: sags and stretches more",
     "as measured"},
    {"material.damping", "added damping", "s", field<&Fabric::damping>(), 0, 0.1, false,
     "ripples live longer", "ripples and motion die out, rotations are braked too",
     "none beyond the fabric's own"},
    {"material.strain_limit", "strain limit", "", field<&Fabric::strain_limit>(), 0, 10, false,
     "cloth hardens at less stretch, more iterations; 0: as its fabric says, mostly never",
     "cloth stretches further before it hardens", "own choice; 0.1: a tenth longer"},
    {"material.pressure", "pressure inside", "Pa", field<&Fabric::pressure>(), -1e5, 1e5, false,
     "blows up closed cloth less; negative: sucks it in", "blows up closed cloth more",
     "none; open cloth is left alone"},
    {"material.bending", "bending", "", field<&Fabric::bending>(), 0, 1, false,
     "hinge: each edge for itself; how stiff depends on the layout of the mesh",
     "plate: from the curvature of each face; as stiff on every mesh", "measured"},
    {"material.evaluation", "stiffness", "", field<&Fabric::evaluation>(), 0, 1, false,
     "direct: the measured law at each strain",
     "table: sampled at 30 strains in three axes and interpolated, as ARCSim does",
     "for comparisons"},

    {"proximity.enabled", "repulsion and friction", "", field<&Near::enabled>(), 0, 1, false,
     "off: impact zones alone keep layers apart, no friction", "on", "paper, Section 2.5"},
    {"proximity.thickness", "thickness h", "m", field<&Near::thickness>(), 1e-5, 0.05, true,
     "layers lie closer, more impacts are left to the impact zones",
     "layers stay further apart; above a third of an edge length neighbours repel", "ARCSim"},
    {"proximity.stiffness", "repulsion stiffness k", "N/m³", field<&Near::stiffness>(), 1e2, 1e10,
     true, "layers press into the thickness, more impacts",
     "contacts hold heavier loads and faster approaches, more iterations",
     "stops 3 m/s within 1 mm; ARCSim's sphere scene"},
    {"proximity.friction_cloth", "friction cloth–cloth", "", field<&Near::friction_cloth>(), 0, 2,
     false, "layers slide on each other", "layers and knots hold", "ARCSim"},
    {"proximity.friction_obstacle", "friction cloth–obstacle", "",
     field<&Near::friction_obstacle>(), 0, 2, false, "cloth slides off bodies",
     "cloth is carried along by bodies", "ARCSim"},
    {"proximity.late_rounds", "rounds of late contacts", "", field<&Near::late_rounds>(), 0, 10,
     false, "0: all impacts are left to the impact zones, which know no stiffness and no friction",
     "where many impacts are left, they are solved as contacts first", "measured"},

    {"implicit.integrator", "integrator", "", field<&Solve::integrator>(), 0, 1, false,
     "backward_euler: first order, damps ripples more the larger the step",
     "bdf2: second order where nothing touches, motion lives longer", "measured"},
    {"implicit.preconditioner", "preconditioner", "", field<&Solve::preconditioner>(), 0, 1, false,
     "block_jacobi: cheap iterations, several times as many",
     "multilevel: groups of vertices are corrected together, on several levels", "measured"},
    {"implicit.cg_tolerance", "CG tolerance", "", field<&Solve::cg_tolerance>(), 1e-10, 0.5, true,
     "solves the linear system better, slower", "faster, loses momentum, may look damped",
     "measured; the paper's family uses 1e-2"},
    {"implicit.cg_max_iterations", "CG iterations", "", field<&Solve::cg_max_iterations>(), 1,
     20000, true, "bounds the time of a step, stiff cloth looks stretchy",
     "reaches the tolerance more often", "P-Cloth (Li et al. 2020)"},
    {"implicit.contact_passes", "contact passes", "", field<&Solve::contact_passes>(), 1, 100,
     false, "contacts are guessed from the velocities once; more impacts are left",
     "contacts that close, open, stick or slide during the solve are found and solved again",
     "measured"},
    {"implicit.contact_tolerance", "contact tolerance", "", field<&Solve::contact_tolerance>(), 0,
     1, false, "contact forces of the right kind and size, more passes; 0: always all passes",
     "contacts may pull, and friction be wrong, by this share of the load", "measured"},
    {"implicit.newton_iterations", "Newton iterations", "", field<&Solve::newton_iterations>(), 1,
     20, false, "1: one linearisation as in the paper; stiff or fast turning cloth gains strain",
     "elastic forces are those of the end of the step; slower", "measured"},
    {"implicit.newton_tolerance", "Newton tolerance", "N/m", field<&Solve::newton_tolerance>(),
     1e-6, 1e6, true, "iterates until the linearisation is wrong by less tension",
     "stops iterating sooner", "measured: bench accuracy"},
    {"implicit.max_linearization_error", "largest linearisation error", "N/m",
     field<&Solve::max_linearization_error>(), 1, 1e9, true,
     "halves the step sooner, calmer stiff fabrics",
     "stiff fabrics that are hit gain energy from what one solve does not see", "measured"},

    {"broad_phase.method", "broad phase", "", field<&Broad::method>(), 0, 1, false,
     "tree: bounding volumes, refitted and rebuilt now and then",
     "hash: a grid of sorted cells, as in the paper's family", "measured"},
    {"broad_phase.rebuild_interval", "tree rebuilt every", "steps",
     field<&Broad::rebuild_interval>(), 1, 1000, true, "tighter boxes, more time spent building",
     "looser boxes, more candidate pairs", "measured", "broad_phase.method=tree"},
    {"broad_phase.count_tests", "count box tests", "", field<&Broad::count_tests>(), 0, 1, false,
     "off", "on: fills the column box_tests, searches twice", "own choice"},

    {"ccd.incremental", "incremental rounds", "", field<&CcdParameters::incremental>(), 0, 1, false,
     "off: every round makes the lists anew and tests all pairs; same impacts, slower",
     "on: later rounds look at pairs with a dirty vertex", "paper, Section 3"},

    {"impact_zones.enabled", "impact zones", "", field<&Zones::enabled>(), 0, 1, false,
     "off: a step with impacts is refused, nothing is resolved", "on", "paper, Section 4"},
    {"impact_zones.solver", "zone solver", "", field<&Zones::solver>(), 0, 2, false,
     "augmented_lagrangian: the paper's; dual: projected gradient on the impulses",
     "linear: inelastic projection (Harmon et al. 2008), layers stick", "measured"},
    {"impact_zones.offset", "impact offset δ", "m", field<&Zones::offset>(), 1e-6, 0.01, true,
     "resolved layers end closer to each other, more of them collide again",
     "resolved layers end further apart, visible jumps", "ARCSim; 0.1 × thickness"},
    {"impact_zones.penalty", "penalty μ", "", field<&Zones::penalty>(), 1, 1e6, true,
     "constraints are approached slowly; rho must be lowered with it",
     "constraints dominate, ill-conditioned", "paper, Eq. 6", kOnlyPaper},
    {"impact_zones.rho", "Chebyshev ρ", "", field<&Zones::rho>(), 0, 0.99999, false,
     "slower convergence, more robust", "faster convergence, diverges when penalty is small",
     "paper, Eq. 8", kOnlyPaper},
    {"impact_zones.iterations", "iterations of a zone", "", field<&Zones::iterations>(), 1, 10000,
     true, "faster rounds, more rounds needed", "each round resolves more", "paper, Section 4.1"},
    {"impact_zones.step_threshold", "smallest step length", "", field<&Zones::step_threshold>(), 0,
     1e-2, false, "iterates until nothing moves any more", "stops early", "paper, Section 4.1",
     kOnlyPaper},
    {"impact_zones.chebyshev", "Chebyshev acceleration", "", field<&Zones::chebyshev>(), 0, 1,
     false, "off: plain descent, slower", "on", "paper, Eq. 8", kOnlyPaper},
    {"impact_zones.max_rounds", "rounds", "", field<&Zones::max_rounds>(), 1, 1000, true,
     "gives up sooner and halves the step", "tries longer before the step is halved",
     "own choice; the paper shows up to 200"},
    {"impact_zones.max_correction", "largest correction", "edges", field<&Zones::max_correction>(),
     0.1, 100, true, "halves the step sooner, keeps the fabric from being torn by an impact",
     "accepts corrections that stretch the fabric wildly", "measured on the scarf"},

    {"grab.stiffness", "grab stiffness", "N/m", field<&Grab::stiffness>(), 1, 1e5, true,
     "cloth follows the hand softly", "cloth follows the hand closely, stretches more",
     "own choice"},
    {"grab.radius", "grab radius", "m", field<&Grab::radius>(), 1e-3, 0.5, true,
     "holds a small spot, pulls a tip", "holds a wide patch", "own choice: a fingertip"},
    {"grab.max_speed", "fastest hand", "m/s", field<&Grab::max_speed>(), 0.1, 20, true,
     "cloth lags behind a fast cursor, calmer", "cloth keeps up, larger impacts in a step",
     "own choice"},
    {"grab.max_force", "strongest hand", "N", field<&Grab::max_force>(), 1e-2, 1e3, true,
     "a stuck cloth is let go of sooner", "pulls heavier cloth, stretches the grabbed patch",
     "own choice: ten times the weight of a scarf"},

    {"seams.slowest", "closing time τ, first", "s", field<&Stitch::slowest>(), 1e-3, 10, true,
     "open seams jerk together", "open seams begin to close more gently", "own choice"},
    {"seams.fastest", "closing time τ, after the ramp", "s", field<&Stitch::fastest>(), 1e-4, 10,
     true, "seams reach their whole pull sooner", "seams reach their whole pull later",
     "own choice"},
    {"seams.ramp", "ramp of τ", "s", field<&Stitch::ramp>(), 1e-3, 10, true,
     "seams pull with their whole strength sooner", "seams take longer to pull", "own choice"},
    {"seams.max_pull", "pull of a seam per length", "N/m", field<&Stitch::max_pull>(), 1e-2, 1e4,
     true, "seams give way to what is between them",
     "seams close against heavier loads, and stretch the cloth where something is between",
     "measured: a belt that is far too small stretches by 11 %"},
    {"seams.reach", "reach of a stitch", "m", field<&Stitch::reach>(), 0, 1, false,
     "seams that wait for a hand have to be brought nearer",
     "seams that wait for a hand catch from farther away", "own choice"},

    {"bodies.speed", "speed of the bodies", "", field<&Bodies::speed>(), 0, 4, false,
     "clips and keyframes run slower; 0 holds the bodies where they are",
     "bodies move faster, and cloth has less time to get out of their way", "own choice"},
};

/// Other names that are read: the paper's symbols, and names of earlier versions.
constexpr std::pair<std::string_view, std::string_view> kAliases[] = {
    {"time_step", "step.time_step"},
    {"mu", "impact_zones.penalty"},
    {"rho", "impact_zones.rho"},
    {"implicit.max_missed_tension", "implicit.max_linearization_error"},
};

std::string_view without_alias(std::string_view key) {
  for (const auto& [alias, name] : kAliases)
    if (alias == key) return name;
  return key;
}

std::string expected_range(const ParameterInfo& info) {
  if (const auto choices = info.field.choices; !choices.empty()) {
    std::string text = "one of";
    for (const std::string_view choice : choices) text += " " + std::string(choice);
    return text;
  }

  if (info.field.kind == ParameterInfo::Kind::boolean) return "true or false";
  const char* kind = info.field.kind == ParameterInfo::Kind::whole ? "a whole number" : "a number";
  std::string text =
      std::string(kind) + " from " + number_text(info.minimum) + " to " + number_text(info.maximum);
  if (!info.unit.empty()) text += " " + std::string(info.unit);
  return text;
}

[[noreturn]] void refuse(const ParameterInfo& info, std::string_view value) {
  throw InputError("parameter " + std::string(info.name) + ": value " + in_quotes(value) +
                   ", expected " + expected_range(info));
}

/// Number behind the text of --set; false when it is not one.
bool parse_value(std::string_view text, const ParameterInfo& info, double& value) {
  const bool words = info.field.kind == ParameterInfo::Kind::boolean;

  // A choice is given by its name, and its value is the number of that name.
  const auto choices = info.field.choices;
  if (!choices.empty()) {
    const auto found = std::ranges::find(choices, text);
    value = static_cast<double>(found - choices.begin());
    return found != choices.end();
  }

  // Switches also take words, besides 0 and 1.
  if (words && (text == "true" || text == "on")) return value = 1, true;
  if (words && (text == "false" || text == "off")) return value = 0, true;

  // Everything else has to be a number up to its last character.
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && rest == end;
}

/// Nearest by the whole name or by its last word, so that "thicknes" finds its group.
std::string_view nearest_parameter(std::string_view key) {
  std::vector<std::string_view> words, names;
  for (const ParameterInfo& info : kTable) {
    for (std::string_view word : {info.name, info.name.substr(info.name.find('.') + 1)}) {
      words.push_back(word);
      names.push_back(info.name);
    }
  }
  const std::string_view found = nearest_name(key, words);
  return names[static_cast<std::size_t>(std::ranges::find(words, found) - words.begin())];
}

}  // namespace

std::span<const ParameterInfo> parameter_table() { return kTable; }

const ParameterInfo* find_parameter(std::string_view name) {
  const std::string_view full_name = without_alias(name);
  for (const ParameterInfo& info : kTable)
    if (info.name == full_name) return &info;
  return nullptr;
}

bool parameter_used(const Parameters& parameters, const ParameterInfo& info) {
  if (info.only_with.empty()) return true;
  const std::size_t split = info.only_with.find('=');
  const ParameterInfo& other = *find_parameter(info.only_with.substr(0, split));
  const auto place = static_cast<std::size_t>(get_parameter(parameters, other));
  return other.field.choices[place] == info.only_with.substr(split + 1);
}

double get_parameter(const Parameters& parameters, const ParameterInfo& info) {
  return info.field.get(parameters);
}

void set_parameter(Parameters& parameters, const ParameterInfo& info, double value) {
  const bool whole = info.field.kind != ParameterInfo::Kind::number;
  if (!(value >= info.minimum && value <= info.maximum) || (whole && value != std::floor(value)))
    refuse(info, number_text(value));
  info.field.set(parameters, value);
}

void set_parameter(Parameters& parameters, std::string_view key, std::string_view value) {
  const ParameterInfo* info = find_parameter(key);
  if (!info)
    throw InputError("parameter " + in_quotes(key) + " is not known, the nearest is " +
                     in_quotes(nearest_parameter(key)));
  double number = 0;
  if (!parse_value(value, *info, number)) refuse(*info, value);
  set_parameter(parameters, *info, number);
}

std::string dump_parameters(const Parameters& parameters) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();

  // Values are written with their own types, so that the dump reads as a scene file would have
  // them.
  for (const ParameterInfo& info : kTable) {
    auto& value = json[std::string(info.name)];
    if (const auto choices = info.field.choices; !choices.empty())
      value = choices[static_cast<std::size_t>(get_parameter(parameters, info))];
    else if (info.field.kind == ParameterInfo::Kind::boolean)
      value = get_parameter(parameters, info) != 0;
    else if (info.field.kind == ParameterInfo::Kind::whole)
      value = static_cast<int>(get_parameter(parameters, info));
    else
      value = get_parameter(parameters, info);
  }
  return json.dump(2);
}

}  // namespace icloth
