// The panels of what a figure is made of: bodies that move, and the garments on them.
#include <algorithm>
#include <cstdio>

#include "app/window/panels/hover.h"
#include "app/window/panels/panel.h"
#include "app/window/theme.h"

namespace icloth {
namespace {

const ParameterInfo& body_speed() { return *find_parameter("bodies.speed"); }

/// What a body plays: "dance, 6.4 s".
std::string motion_of(const Obstacle& body) {
  if (const SkinnedPoses* skin = body.skinned()) {
    char length[32];
    std::snprintf(length, sizeof length, ", %.1f s", skin->clip().duration);
    return "clip " + (skin->clip().name.empty() ? "without a name" : skin->clip().name) + length;
  }
  return body.poses ? "point cache" : "keyframes";
}

}  // namespace

void draw_bodies(PanelContext& context) {
  const auto moves = [](const Obstacle& body) { return body.moves(); };
  if (std::ranges::none_of(context.scene.obstacles, moves)) return;
  if (!ImGui::CollapsingHeader("Bodies", ImGuiTreeNodeFlags_DefaultOpen)) return;
  for (const Obstacle& body : context.scene.obstacles)
    if (body.moves()) ImGui::TextUnformatted(shown(body.name + ": " + motion_of(body)).c_str());

  // The speed is a parameter, so it is recorded, and undone, like the others.
  const ParameterInfo& info = body_speed();
  double speed = context.edits.value(info);
  bool plays = speed > 0;
  if (ImGui::Checkbox("Play", &plays)) context.edits.set(info, plays ? 1 : 0);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("B: off holds the bodies where they are, and the cloth goes on");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  auto value = static_cast<float>(speed);
  if (ImGui::SliderFloat("##body_speed", &value, static_cast<float>(info.minimum),
                         static_cast<float>(info.maximum), "speed %.2f"))
    context.edits.set(info, static_cast<double>(value), !ImGui::IsItemActivated());
}

void draw_garments(const PanelContext& context) {
  if (context.garments.empty()) return;
  if (!ImGui::CollapsingHeader("Garments", ImGuiTreeNodeFlags_DefaultOpen)) return;
  for (const GarmentState& garment : context.garments) {
    ImGui::TextDisabled("%s", shown(garment.name).c_str());
    ImGui::TextColored(vec4(garment.open_pairs > 0 ? colour::kChanged : colour::kText), "%s",
                       garment_text(garment).c_str());
  }
}

}  // namespace icloth
