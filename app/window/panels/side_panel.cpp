// The column on the left, with its transport buttons and tabs.
#include <algorithm>
#include <cstdio>

#include "app/window/panels/panel.h"
#include "app/window/scene_list.h"
#include "app/window/theme.h"

namespace icloth {

namespace {

bool wide_button(const char* label, float width, ImU32 tint = 0) {
  if (tint) ImGui::PushStyleColor(ImGuiCol_Button, tint);
  const bool pressed = ImGui::Button(label, {width, 0});
  if (tint) ImGui::PopStyleColor();
  return pressed;
}

void tooltip(const char* text) {
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

/// Draws the slider of the steps that were made: the picture follows it, and letting go goes there.
void draw_history(PanelContext& context) {
  const PublishedState& state = context.state;
  const int made = static_cast<int>(state.history), all = made + static_cast<int>(state.ahead);
  int& at = context.ui.history_at;
  char label[96];
  if (at >= 0)
    std::snprintf(label, sizeof label, "to step %d of %d", at, all);
  else if (all > made)
    std::snprintf(label, sizeof label, "step %d of %d", made, all);
  else
    std::snprintf(label, sizeof label, "history: %d steps", made);

  ImGui::SetNextItemWidth(-1);
  ImGui::BeginDisabled(all == 0);
  int position = at >= 0 ? at : made;
  if (ImGui::SliderInt("##history", &position, 0, std::max(all, 1), label)) {
    at = position;
    context.session.preview(static_cast<std::size_t>(at));
  }
  if (!ImGui::IsItemActive())
    tooltip("Drag to look at earlier states; let go to go there. Shift+Right goes forward again.");

  if (ImGui::IsItemDeactivated() && at >= 0) {
    context.session.go(static_cast<std::size_t>(at));
    at = -1;
  }
  ImGui::EndDisabled();

  // What was left by going on from an earlier state is not lost.
  if (state.left == 0) return;
  std::snprintf(label, sizeof label, "Other run (%d steps)###left", static_cast<int>(state.left));
  if (ImGui::SmallButton(label)) context.session.return_to_left_run();
  tooltip("Shift+Left: back to the run that was left, made again step by step");
}

/// The name of the scene, which opens the list of the others.
void draw_scene_menu(PanelContext& context) {
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.5f);
  if (!ImGui::BeginCombo("##scene", shown(context.scene.name).c_str())) {
    tooltip("Open another scene");
    return;
  }
  for (const std::string& name : suggested_scenes())
    if (ImGui::Selectable(name.c_str(), name == context.scene.source)) context.ui.open_scene = name;
  ImGui::EndCombo();
}

}  // namespace

void draw_transport(PanelContext& context) {
  const PublishedState& state = context.state;

  // Four buttons share the width.
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float width = (ImGui::GetContentRegionAvail().x - 3 * gap) / 4;
  if (wide_button(state.playing ? "Pause" : "Play", width, state.playing ? 0 : colour::kLit)) {
    state.playing ? context.session.pause() : context.session.play();
  }
  tooltip("Space");
  ImGui::SameLine();
  if (wide_button("Back", width)) context.session.step_back();
  tooltip("Left: one step back");
  ImGui::SameLine();
  if (wide_button("Step", width)) context.session.step_once();
  tooltip("Right: one step");
  ImGui::SameLine();
  if (wide_button("Reset", width)) context.session.reset();
  tooltip("R: to the start state, parameters stay");

  draw_history(context);

  // The options of the run; a script is offered only where the scene has one.
  bool real_time = state.real_time, scripted = state.scripted;
  if (ImGui::Checkbox("Real time", &real_time)) context.session.set_real_time(real_time);
  tooltip("On: never faster than the clock. Off: as fast as the solver goes.");
  if (context.scene.input.empty()) return;
  ImGui::SameLine();
  if (ImGui::Checkbox("Play scripted input", &scripted)) context.session.set_scripted(scripted);
  tooltip("Apply the grabs that are written in the scene file.");
}

void draw_notes(const PanelContext& context) {
  constexpr std::size_t kFew = 3;  // so many are open from the start
  const std::vector<std::string>& notes = context.origin.notes;
  if (notes.empty()) return;
  const std::string title = "Notes (" + std::to_string(notes.size()) + ")###notes";
  const ImGuiTreeNodeFlags open = notes.size() <= kFew ? ImGuiTreeNodeFlags_DefaultOpen : 0;
  if (!ImGui::CollapsingHeader(title.c_str(), open)) return;

  // Many notes scroll, so that they leave room for the rest of the column.
  std::string text;
  for (const std::string& note : notes) text += (text.empty() ? "" : "\n") + shown(note);
  const float width = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize;
  const float most = 10 * ImGui::GetTextLineHeight();
  const float high = ImGui::CalcTextSize(text.c_str(), nullptr, false, width).y;
  ImGui::BeginChild("##notes", {0, std::min(high, most) + ImGui::GetStyle().ItemSpacing.y});
  ImGui::PushTextWrapPos(width);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndChild();
}

void draw_side_panel(PanelContext& context, const Rect& place) {
  // The column has no decoration of its own.
  ImGui::SetNextWindowPos({place.x, place.y});
  ImGui::SetNextWindowSize({place.width, place.height});
  ImGui::Begin("##side", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoSavedSettings);

  // The scene's name is on the left, the clock on the right.
  draw_scene_menu(context);
  char clock[64];
  std::snprintf(clock, sizeof clock, "%.2f s   step %lld", context.state.time,
                static_cast<long long>(context.state.step));
  ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::CalcTextSize(clock).x -
                  ImGui::GetStyle().WindowPadding.x);
  ImGui::TextDisabled("%s", clock);

  // The parts follow from top to bottom, and the tabs take the rest.
  draw_transport(context);
  draw_bodies(context);
  draw_garments(context);
  draw_notes(context);
  ImGui::Spacing();
  draw_stage_plot(context);
  ImGui::Spacing();

  if (ImGui::BeginTabBar("##tabs")) {
    if (ImGui::BeginTabItem("Parameters")) {
      ImGui::BeginChild("##parameters");
      draw_parameters(context);
      ImGui::EndChild();
      ImGui::EndTabItem();
    }
    if (ImGui::BeginTabItem("Statistics")) {
      ImGui::BeginChild("##statistics");
      draw_statistics(context);
      ImGui::EndChild();
      ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
  }

  ImGui::End();
}

}  // namespace icloth
