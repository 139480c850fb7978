#include "app/suites/bench/scaling_report.h"

#include <algorithm>
#include <functional>

#include "app/suites/bench/power_fit.h"

namespace icloth {
namespace {

constexpr double kMillion = 1e6;

/// A quantity of a size.
struct Quantity {
  std::string name;
  std::function<double(const ScalingRow&)> value;
};

/// The median of a number of the steps of a size.
double median_of(const ScalingRow& row, const std::function<double(const StepReport&)>& value) {
  std::vector<double> values;
  for (const StepReport& report : row.steps.reports()) values.push_back(value(report));
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

double stage_ms(const ScalingRow& row, std::size_t stage) {
  return median_of(row, [&](const StepReport& report) { return report.*kStageTimes[stage]; });
}

double least(const ScalingRow& row, std::size_t stage) {
  return median_of(row,
                   [&](const StepReport& report) { return least_bytes(row.mesh, report)[stage]; });
}

double arrays(const ScalingRow& row, std::size_t stage) {
  return median_of(row,
                   [&](const StepReport& report) { return array_bytes(row.mesh, report)[stage]; });
}

std::string triangles(const ScalingRow& row) { return format_number(row.mesh.cloth_faces, 9); }

void add_sizes(const std::vector<ScalingRow>& rows, Report& report) {
  Table table("sizes", "The same moment at each size; medians of a step",
              {"triangles", "vertices", "thickness mm", "steps", "substeps", "pairs in proximity",
               "candidate pairs", "impacts (mean)", "linear solves", "CG iterations", "refused",
               "penetrations"});

  // What was simulated has to be the same at all sizes, for their times to be comparable.
  for (const ScalingRow& row : rows) {
    const auto median = [&](const char* column) {
      return format_number(row.steps.median(column), 9);
    };
    table.add({triangles(row), format_number(row.mesh.cloth_vertices, 9),
               format_number(1e3 * row.thickness, 3), std::to_string(row.steps.steps()),
               median("substeps"), median("proximity_pairs"), median("candidate_pairs"),
               format_number(row.steps.mean("impacts_first")), median("linear_solves"),
               median("cg_iterations"), std::to_string(row.refused),
               std::to_string(row.penetrations)});
  }
  report.add(table);
}

/// A table with a row for each size, and a plot of it over the triangles.
void add_by_size(const std::vector<ScalingRow>& rows, const std::vector<Quantity>& quantities,
                 const std::string& name, const std::string& title, const std::string& unit,
                 Report& report) {
  std::vector<std::string> columns = {"triangles"};
  for (const Quantity& quantity : quantities) columns.push_back(quantity.name);
  Table table(name, title, columns);
  for (const ScalingRow& row : rows) {
    std::vector<std::string> cells = {triangles(row)};
    for (const Quantity& quantity : quantities) cells.push_back(format_number(quantity.value(row)));
    table.add(cells);
  }
  report.add(table);

  Plot plot{.title = title,
            .x_label = "triangles",
            .y_label = unit,
            .log_x = true,
            .log_y = true,
            .markers = true,
            .series = {}};
  for (const Quantity& quantity : quantities) {
    Series series{quantity.name, {}};
    for (const ScalingRow& row : rows)
      series.points.emplace_back(row.mesh.cloth_faces, quantity.value(row));
    plot.series.push_back(series);
  }
  report.add(plot);
}

std::vector<Quantity> times() {
  std::vector<Quantity> quantities = {
      {"ms_total", [](const ScalingRow& row) { return row.steps.median("ms_total"); }}};
  for (std::size_t s = 0; s < kStages; ++s)
    quantities.push_back({std::string("ms_") + kStageNames[s],
                          [s](const ScalingRow& row) { return stage_ms(row, s); }});
  return quantities;
}

std::vector<Quantity> memory() {
  std::vector<Quantity> quantities = {
      {"peak MB", [](const ScalingRow& row) { return row.peak_memory / kMillion; }}};
  for (std::size_t s = 0; s < kStages; ++s)
    quantities.push_back({std::string(kStageNames[s]) + " MB",
                          [s](const ScalingRow& row) { return arrays(row, s) / kMillion; }});
  return quantities;
}

/// The exponents of all quantities, over all sizes and over the larger half.
void add_exponents(const std::vector<ScalingRow>& rows, Report& report) {
  std::vector<Quantity> quantities = times();
  quantities.push_back({"peak MB", [](const ScalingRow& row) { return row.peak_memory; }});
  for (const char* column : {"candidate_pairs", "proximity_pairs", "cg_iterations"})
    quantities.push_back(
        {column, [column](const ScalingRow& row) { return row.steps.median(column); }});

  Table table("exponents", "Fitted power laws: quantity = factor · triangles^exponent",
              {"quantity", "exponent", "from", "to", "largest deviation",
               "exponent of the larger half", "from (larger half)"});
  for (const Quantity& quantity : quantities) {
    std::vector<std::pair<double, double>> points;
    for (const ScalingRow& row : rows)
      points.emplace_back(row.mesh.cloth_faces, quantity.value(row));
    const PowerFit all = fit_power(points);
    const PowerFit half = fit_power(std::span(points).subspan(points.size() / 2));
    const auto cell = [](const PowerFit& fit, double value, int digits) {
      return fit.valid() ? format_number(value, digits) : std::string("-");
    };
    table.add({quantity.name, cell(all, all.exponent, 3), cell(all, all.first, 7),
               cell(all, all.last, 7), cell(all, all.worst, 3), cell(half, half.exponent, 3),
               cell(half, half.first, 7)});
  }
  report.add(table);
}

void add_floors(const std::vector<ScalingRow>& rows, Report& report) {
  Table table(
      "floors", "Each stage beside its floor; medians of a step",
      {"triangles", "stage", "MB at least", "GB/s", "floor ms", "measured ms", "measured / floor"});
  Plot plot{.title = "Measured time over the floor",
            .x_label = "triangles",
            .y_label = "measured / floor",
            .log_x = true,
            .log_y = true,
            .markers = true,
            .series = {}};
  for (const char* name : kStageNames) plot.series.push_back({name, {}});

  for (const ScalingRow& row : rows) {
    for (std::size_t s = 0; s < kStages; ++s) {
      const double bytes = least(row, s), ms = stage_ms(row, s);
      const double floor = row.bandwidth > 0 ? 1e3 * bytes / row.bandwidth : 0;
      const bool has_ratio = floor > 0 && ms > 0;
      table.add({triangles(row), kStageNames[s], format_number(bytes / kMillion),
                 format_number(row.bandwidth / 1e9, 3), format_number(floor), format_number(ms),
                 has_ratio ? format_number(ms / floor, 3) : "-"});
      if (has_ratio) plot.series[s].points.emplace_back(row.mesh.cloth_faces, ms / floor);
    }
  }
  report.add(table);
  report.add(plot);
}

}  // namespace

void report_scaling(const std::vector<ScalingRow>& rows, Report& report) {
  report.heading("Sizes");
  report.text(
      "The scene is Sphere: a ball pushes three sheets together, which hang by their corners. All "
      "sizes start where the ball is about to touch, take steps of 1/100 s, and are measured over "
      "the same simulated time after a short lead-in. Meshes and thickness are those that --set "
      "triangles gives, so the thickness is smaller where edges are shorter than 5 mm. Repulsion "
      "keeps the cloth apart in most of these steps; impact zones have work where impacts are "
      "left, and no exponent where the median step has none.");
  add_sizes(rows, report);

  report.heading("Time");
  add_by_size(rows, times(), "times", "Time of the stages; medians of a step", "ms", report);
  report.heading("Exponents");
  add_exponents(rows, report);

  // The model is stated where its numbers are.
  report.heading("Floors");
  for (const std::string& line : model_text()) report.text(line);
  report.text(
      "The bandwidth is that of icloth info, measured after the steps of each size, since other "
      "programs may share the machine.");
  add_floors(rows, report);

  report.heading("Memory");
  report.text(
      "The peak is that of the whole process, loading included. Those of the stages are the sizes "
      "of their largest arrays, counted from the numbers of elements, pairs and contacts.");
  add_by_size(rows, memory(), "memory", "Memory: measured peak, and arrays of the stages", "MB",
              report);
}

}  // namespace icloth
