// The panel of statistics: the time of each stage, and the counts of the step.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/window/panels/panel.h"
#include "app/window/theme.h"

namespace icloth {

namespace {

/// The report that the numbers are about: the clicked one while it is in the history.
const StepReport* chosen(const PanelContext& context) {
  if (const StepReport* report = context.stages.find(context.ui.chosen_step)) return report;
  return context.stages.newest();
}

/// Draws the stages of one step as a stacked bar, cut off at the top.
void draw_bar(ImDrawList& list, const StepReport& report, ImVec2 foot, float width, float height,
              double scale) {
  float y = foot.y;
  for (const Stage& stage : stages()) {
    const float part = static_cast<float>(report.*stage.ms / scale) * height;
    const float top = std::max(y - part, foot.y - height);
    if (y - top > 0.1f) list.AddRectFilled({foot.x, top}, {foot.x + width, y}, stage.colour);
    y = top;
  }
}

void bar_tooltip(const StepReport& report) {
  ImGui::BeginTooltip();
  ImGui::Text("step %lld: %.2f ms", static_cast<long long>(report.step), report.ms_total);
  for (const Stage& stage : stages()) {
    ImGui::TextColored(vec4(stage.colour), "%-14s %.2f ms", std::string(stage.name).c_str(),
                       report.*stage.ms);
  }
  ImGui::TextDisabled("click: its counts in Statistics");
  ImGui::EndTooltip();
}

/// Draws the colours and names of the stages in two columns, with their mean times.
void draw_stage_legend(PanelContext& context) {
  const float column = ImGui::GetContentRegionAvail().x / 2;
  const float left = ImGui::GetCursorPosX();
  int k = 0;
  for (const Stage& stage : stages()) {
    if (k % 2 == 1) ImGui::SameLine(left + column);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float size = ImGui::GetFontSize();

    // A small square shows the stage's colour.
    ImGui::GetWindowDrawList()->AddRectFilled(
        {at.x, at.y + size * 0.25f}, {at.x + size * 0.6f, at.y + size * 0.85f}, stage.colour, 2);
    ImGui::Dummy({size * 0.6f, size});
    ImGui::SameLine();
    ImGui::TextDisabled("%s %.2f", std::string(stage.name).c_str(), context.stages.mean(stage.ms));
    ++k;
  }
}

/// Draws one row of a table.
void row(const char* name, const char* format, auto... values) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", name);
  ImGui::TableNextColumn();
  char text[96];
  std::snprintf(text, sizeof text, format, values...);
  ImGui::TextUnformatted(text);
}

using Count = long long;

void draw_counts(const StepReport& r) {
  // These counts explain the times of the stages, from the first pairs to the linear solves.
  row("proximity pairs", "%lld", static_cast<Count>(r.proximity_pairs));
  row("candidate pairs", "%lld", static_cast<Count>(r.candidate_pairs));
  row("elementary tests", "%lld", static_cast<Count>(r.elementary_tests));
  row("late contacts", "%lld", static_cast<Count>(r.late_contacts));
  row("impacts found, left", "%lld, %lld", static_cast<Count>(r.impacts_first),
      static_cast<Count>(r.impacts_left));
  if (r.pinched > 0) row("pinched vertices", "%lld", static_cast<Count>(r.pinched));
  row("rounds", "%lld", static_cast<Count>(r.rounds));
  row("zones, largest", "%lld, %lld", static_cast<Count>(r.zones),
      static_cast<Count>(r.largest_zone));
  row("zone iterations", "%lld", static_cast<Count>(r.zone_iterations));
  row("faces moved again T_d", "%lld", static_cast<Count>(r.dynamic_faces));
  row("substeps, retries", "%lld, %lld", static_cast<Count>(r.substeps),
      static_cast<Count>(r.retries));
  row("CG iterations", "%lld", static_cast<Count>(r.cg_iterations));

  // A limit is named by the parameter that raises it.
  for (const std::string_view name : names_of_limits(r.limits))
    row("limit reached", "%.*s", static_cast<int>(name.size()), name.data());
}

void draw_quantities(const StepReport& r) {
  row("kinetic energy", "%.3e J", r.kinetic_energy);
  row("elastic energy", "%.3e J", r.elastic_energy);
  row("gravity energy", "%.4g J", r.gravity_energy);
  row("largest strain", "%.1f %%", 100 * r.max_strain);
  row("largest speed", "%.3f m/s", r.max_speed);
  row("smallest gap", "%.3f mm", 1000 * r.min_gap);
}

/// Draws the slowest steps of the run and what they had more of than others; a click goes to the
/// state before a step, from where it can be made again and watched.
void draw_slowest(PanelContext& context) {
  ImGui::TextUnformatted("Slowest steps");
  if (!ImGui::BeginTable("##slowest", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit))
    return;

  // A run in which a step was refused has recorded more steps than it has made.
  const bool are_places = static_cast<Count>(context.state.history) == context.state.step;
  for (const StepReport& report : context.stages.slowest()) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const std::string step = std::to_string(report.step);
    const ImGuiSelectableFlags flags =
        ImGuiSelectableFlags_SpanAllColumns | (are_places ? 0 : ImGuiSelectableFlags_Disabled);
    if (ImGui::Selectable(step.c_str(), false, flags))
      context.session.go(static_cast<std::size_t>(std::max<Count>(0, report.step - 1)));
    if (are_places && ImGui::IsItemHovered())
      ImGui::SetTooltip("click: go to the state before this step");

    // What it took, and why, follows its number.
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%.3g ms", report.ms_total);
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(why_slow(report, context.stages).c_str());
  }
  ImGui::EndTable();
}

/// Draws one line over the history on a logarithmic axis; zeros are left out.
void draw_log_line(const PanelContext& context, const char* name,
                   double (*value)(const StepReport&), ImU32 tint) {
  // The axis covers whole powers of ten, at least one.
  double low = 1e300, high = 0;
  for (const StepReport& report : context.stages.reports()) {
    const double v = value(report);
    if (!(v > 0)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  if (high <= 0) return;
  low = std::pow(10, std::floor(std::log10(low)));
  high = std::max(std::pow(10, std::ceil(std::log10(high))), 10 * low);

  // The name and the range stand above the plot.
  ImGui::TextDisabled("%s  %.0e to %.0e", name, low, high);
  const ImVec2 size{ImGui::GetContentRegionAvail().x, 44 * context.scale};
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::Dummy(size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, colour::kWell, 3);

  // The newest step is at the right end. A zero interrupts the line.
  const float step = size.x / static_cast<float>(StageHistory::kLength);
  float x = at.x + size.x - step * static_cast<float>(context.stages.reports().size());
  ImVec2 last{};
  bool has_last = false;
  for (const StepReport& report : context.stages.reports()) {
    const double v = value(report);
    if (v > 0) {
      const double height = std::log(v / low) / std::log(high / low);
      const ImVec2 point{x, at.y + size.y * (1 - static_cast<float>(height))};
      if (has_last) list.AddLine(last, point, tint, 1.5f);
      last = point;
    }
    has_last = v > 0;
    x += step;
  }
}

}  // namespace

void draw_stage_plot(PanelContext& context) {
  const StageHistory& history = context.stages;
  const double scale = history.scale_ms();

  // The speed is above the plot, and the error estimates follow.
  ImGui::Text("%.1f steps/s", context.state.steps_per_second);
  char text[48];
  std::snprintf(text, sizeof text, "%.2f ms a step", history.mean(&StepReport::ms_total));
  ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::CalcTextSize(text).x -
                  ImGui::GetStyle().WindowPadding.x);
  ImGui::TextDisabled("%s", text);
  draw_estimates_line(context);

  // The plot itself is one button, so that a click can choose a bar.
  const ImVec2 size{ImGui::GetContentRegionAvail().x, 84 * context.scale};
  const float bars = size.y - ImGui::GetTextLineHeight() - 4;  // under the label
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool clicked = ImGui::InvisibleButton("##stages", size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, colour::kWell, 3);

  // Each bar is a step, the newest at the right end. The hovered and the chosen one are lit.
  const float width = size.x / static_cast<float>(StageHistory::kLength);
  float x = at.x + size.x - width * static_cast<float>(history.reports().size());
  const float mouse = ImGui::GetIO().MousePos.x;
  for (const StepReport& report : history.reports()) {
    const bool hovered = ImGui::IsItemHovered() && mouse >= x && mouse < x + width;
    if (hovered || report.step == context.ui.chosen_step) {
      list.AddRectFilled({x, at.y}, {x + width, at.y + size.y}, IM_COL32(255, 255, 255, 40));
    }
    draw_bar(list, report, {x, at.y + size.y}, std::max(1.0f, width - 0.5f), bars, scale);
    if (hovered) bar_tooltip(report);

    // A second click on the chosen bar goes back to the newest step.
    if (hovered && clicked) {
      context.ui.chosen_step = context.ui.chosen_step == report.step ? -1 : report.step;
    }
    x += width;
  }

  // The plot needs its scale and a legend.
  std::snprintf(text, sizeof text, "%.3g ms", scale);
  list.AddText({at.x + 5, at.y + 2}, colour::kDim, text);
  draw_stage_legend(context);
}

void draw_statistics(PanelContext& context) {
  const StepReport* report = chosen(context);
  if (!report) return ImGui::TextDisabled("No step was made yet.");

  // A chosen step is named, with the way back to the newest one.
  if (report->step == context.ui.chosen_step) {
    ImGui::TextColored(vec4(colour::kAccent), "step %lld", static_cast<Count>(report->step));
    ImGui::SameLine();
    if (ImGui::SmallButton("newest")) context.ui.chosen_step = -1;
  }

  const ImGuiTableFlags flags = ImGuiTableFlags_RowBg;
  ImGui::TextUnformatted("Error estimates");
  if (ImGui::BeginTable("##estimates", 2, flags)) {
    draw_estimates(*report, context.state.parameters);
    ImGui::EndTable();
  }

  ImGui::TextUnformatted("Counts and quantities");
  if (ImGui::BeginTable("##counts", 2, flags)) {
    draw_counts(*report);
    draw_quantities(*report);
    ImGui::EndTable();
  }

  draw_slowest(context);

  // The history of four numbers tells how the run goes.
  ImGui::Spacing();
  draw_log_line(
      context, "CG residual", [](const StepReport& r) { return r.cg_residual; }, colour::kAccent);
  draw_log_line(
      context, "momentum error [m/s²]", [](const StepReport& r) { return r.momentum_error; },
      colour::kBad);
  draw_log_line(
      context, "zone iterations",
      [](const StepReport& r) { return static_cast<double>(r.zone_iterations); }, colour::kChanged);
  draw_log_line(
      context, "kinetic energy [J]", [](const StepReport& r) { return r.kinetic_energy; },
      colour::kGood);
}

}  // namespace icloth
