// The two lines along the bottom: hints for the present actions, and the state of the run.
#include <cstdio>

#include "app/window/bindings.h"
#include "app/window/panels/panel.h"
#include "app/window/theme.h"

namespace icloth {

namespace {

constexpr double kLongStep = 1.5;  ///< [s]

/// Draws a text behind the one before it.
void item(const char* text, ImU32 tint = colour::kText) {
  ImGui::SameLine(0, ImGui::GetFontSize() * 1.3f);
  ImGui::TextColored(vec4(tint), "%s", text);
}

/// Draws the number of penetrations. It is always visible, also when the panels are hidden.
void draw_penetrations(const PanelContext& context) {
  char text[48];
  const long long left = penetrations(context);
  std::snprintf(text, sizeof text, "penetrations %lld", left);

  // A round light shows at a glance whether there are any.
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float radius = ImGui::GetFontSize() * 0.3f;
  const ImU32 tint = left == 0 ? colour::kGood : colour::kBad;
  ImGui::GetWindowDrawList()->AddCircleFilled({at.x + radius, at.y + ImGui::GetFontSize() * 0.55f},
                                              radius, tint);
  ImGui::Dummy({2 * radius, 0});
  ImGui::SameLine();
  ImGui::TextColored(vec4(tint), "%s", text);
}

std::string thousands(long long count) {
  char text[32];
  if (count < 10'000) {
    std::snprintf(text, sizeof text, "%lld", count);
  } else {
    std::snprintf(text, sizeof text, "%.1fK", static_cast<double>(count) / 1000);
  }
  return text;
}

}  // namespace

long long penetrations(const PanelContext& context) {
  return static_cast<long long>(context.start_intersections.size()) +
         static_cast<long long>(context.state.report.impacts_left);
}

void draw_status_bar(PanelContext& context, const StatusTexts& texts, const Rect& place) {
  // The bar has its own colour and no decoration.
  ImGui::SetNextWindowPos({place.x, place.y});
  ImGui::SetNextWindowSize({place.width, place.height});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, colour::kBar);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {12 * context.scale, 7 * context.scale});
  ImGui::Begin("##status", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();

  // The first line tells what can be done, or the last message.
  if (!texts.pointer.empty()) {
    ImGui::TextUnformatted(shown(texts.pointer).c_str());
    ImGui::SameLine(0, ImGui::GetFontSize() * 1.3f);
  }
  if (texts.note.empty()) {
    ImGui::TextDisabled("%s", hint_line(context.drag.grabbing()).c_str());
  } else {
    const ImU32 tint = texts.note_is_bad ? colour::kBad : colour::kAccent;
    ImGui::TextColored(vec4(tint), "%s", texts.note.c_str());
  }

  // The second line begins with the most important number.
  draw_penetrations(context);
  char text[64];

  // Squeezed cloth is mentioned for as long as there is any.
  if (context.state.report.pinched > 0) {
    std::snprintf(text, sizeof text, "pinched %lld",
                  static_cast<long long>(context.state.report.pinched));
    item(text, colour::kChanged);
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip(
          "Bodies overlap and squeeze this many cloth vertices:\n"
          "they are let go from one body until the bodies part.");
  }
  item(texts.device.c_str());

  // A step that takes long is announced, so that the window does not seem to hang.
  const double busy = context.session.step_seconds();
  if (busy > kLongStep) {
    std::snprintf(text, sizeof text, "in a step for %.0f s", busy);
    item(text, colour::kChanged);
  } else {
    const double speed = context.state.steps_per_second;
    std::snprintf(text, sizeof text, "%.1f steps/s, %.2g x real time", speed,
                  speed * context.state.parameters.step.time_step);
    item(context.state.playing ? text : "paused",
         context.state.playing ? colour::kText : colour::kChanged);
  }

  if (!context.garments.empty()) {
    const GarmentState all = total(context.garments);
    item(garment_text(all).c_str(), all.open_pairs > 0 ? colour::kChanged : colour::kText);
  }

  // The rest describes the drawing.
  std::snprintf(text, sizeof text, "window %.0f fps", texts.ui_fps);
  item(text);
  item((thousands(context.world.cloth_faces) + " triangles").c_str());
  const std::string vertices = "vertices by " + texts.upload_path;
  item(vertices.c_str(), colour::kDim);

  // The last item may be cut off, so its text is also a tooltip.
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", vertices.c_str());
  ImGui::End();
}

}  // namespace icloth
