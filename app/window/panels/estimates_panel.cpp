// The panel of the errors that the newest steps estimate of themselves.
#include "app/window/estimates.h"
#include "app/window/panels/hover.h"
#include "app/window/panels/panel.h"
#include "app/window/theme.h"

namespace icloth {

namespace {

void tooltip(const std::string& text) {
  over_item([&] { ImGui::TextUnformatted(shown(text).c_str()); });
}

}  // namespace

void draw_estimates_line(const PanelContext& context) {
  const StepReport* report = context.stages.newest();
  if (!report) return;
  const Parameters& parameters = context.state.parameters;
  const std::string text = estimates_in_short(*report, parameters);
  ImGui::TextDisabled("%s", text.empty() ? "step refused" : shown(text).c_str());

  // The tooltip has all estimates with their units.
  std::string all;
  for (const Estimate& e : estimates(*report, parameters))
    all += (all.empty() ? "" : "\n") + std::string(e.name) + ": " + e.value;
  if (!all.empty()) tooltip(all);
}

void draw_estimates(const StepReport& report, const Parameters& parameters) {
  for (const Estimate& e : estimates(report, parameters)) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", e.name);
    tooltip(e.meaning);
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(shown(e.value).c_str());
    tooltip(e.meaning);
  }
}

}  // namespace icloth
