// The panel of a failure: it is explained in a sentence, shown on the mesh, and comes with
// remedies.
#include "app/common/element_names.h"
#include "app/window/panels/panel.h"
#include "app/window/theme.h"

namespace icloth {

namespace {

constexpr std::size_t kMaxListed = 50;

/// Draws one list of names that scrolls beyond six rows and ends after fifty.
template <class Places, class Name>
void draw_list(const char* what, const Places& places, const Name& name) {
  if (places.empty()) return;
  if (!ImGui::TreeNode(what, "%zu %s", places.size(), what)) return;
  const float line = ImGui::GetTextLineHeightWithSpacing();
  ImGui::BeginChild("##list",
                    {0, line * static_cast<float>(std::min<std::size_t>(places.size(), 6))});
  for (std::size_t k = 0; k < std::min(places.size(), kMaxListed); ++k)
    ImGui::BulletText("%s", shown(name(places[k])).c_str());
  if (places.size() > kMaxListed) ImGui::TextDisabled("and %zu more", places.size() - kMaxListed);
  ImGui::EndChild();
  ImGui::TreePop();
}

/// Lists the pairs behind the failure, those of the start or those of the step, by the names that
/// the terminal uses.
void draw_pairs(const PanelContext& context) {
  const ElementNames names(context.scene, context.origin.layouts);
  const StartConflicts& start = context.start_conflicts;
  draw_list("pairs of faces", start.pairs,
            [&](const IntersectingFaces& pair) { return names.pair(pair); });
  draw_list("places where neighbouring faces touch", start.touches,
            [&](const Touch& touch) { return names.touch(touch); });
  if (context.start_intersections.empty())
    draw_list("pairs", context.state.report.offending,
              [&](const OffendingPair& pair) { return names.pair(pair); });
}

/// Draws the remedies, of which an invalid start has none but looking at it.
void draw_buttons(PanelContext& context) {
  if (ImGui::Button("Show")) context.ui.show_failure = true;
  if (!context.start_intersections.empty()) return;
  ImGui::SameLine();

  // Half the time step, applied at once, and the session goes on.
  if (ImGui::Button("Smaller step and go on")) {
    const ParameterInfo& step = *find_parameter("step.time_step");
    context.edits.set(step, context.edits.value(step) / 2);
    for (const auto& [name, value] : context.edits.take_changes()) context.session.set(name, value);
    context.session.play();
  }
  ImGui::SameLine();
  if (ImGui::Button("One step back")) context.session.step_back();

  // The clock goes on over the step, as with --on-failure continue, and so does the session.
  if (context.state.may_pass_over) {
    ImGui::SameLine();
    if (ImGui::Button("Pass over")) {
      context.session.pass_over();
      context.session.play();
    }
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip(
          "The clock goes on over this step: bodies move, the cloth rests where it is.\n"
          "Cloth that bodies go through is let go from them until it is outside again.");
  }
  ImGui::SameLine();
  if (ImGui::Button("Save session")) context.ui.save_session = true;
}

}  // namespace

void draw_failure(PanelContext& context, const Rect& view) {
  if (!context.state.failed) return;
  const float width = std::min(560 * context.scale, view.width - 32 * context.scale);

  // The panel stands at the top of the view, in the middle.
  ImGui::SetNextWindowPos({view.x + (view.width - width) / 2, view.y + 16 * context.scale});
  ImGui::SetNextWindowSize({width, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * context.scale);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1.5f * context.scale);
  ImGui::PushStyleColor(ImGuiCol_Border, colour::kBad);
  ImGui::Begin("##failure", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize);

  // It says what is wrong, and why.
  ImGui::TextColored(vec4(colour::kBad), "%s",
                     context.start_intersections.empty() ? "The step was not accepted"
                                                         : "The start state is not valid");
  ImGui::PushTextWrapPos();
  ImGui::TextUnformatted(shown(context.state.failure).c_str());
  ImGui::PopTextWrapPos();

  draw_pairs(context);
  draw_buttons(context);

  // Clicks on it are not meant for the scene.
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  context.ui.overlays.push_back({at.x, at.y, size.x, size.y});
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(2);
}

}  // namespace icloth
