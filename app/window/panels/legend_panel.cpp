// The legend of a coloured view, in the lower left corner of the picture.
#include "app/window/panels/panel.h"
#include "app/window/theme.h"
#include "render/legend.h"

namespace icloth {

void draw_legend(PanelContext& context, const Rect& view, double strain_range) {
  const std::optional<Legend> legend = legend_of(context.ui.view, strain_range);
  if (!legend) return;

  // A window of its own size over the picture.
  const float margin = 12 * context.scale;
  ImGui::SetNextWindowPos({view.x + margin, view.y + view.height - margin}, ImGuiCond_Always,
                          {0, 1});
  ImGui::SetNextWindowBgAlpha(0.75f);
  ImGui::Begin("##legend", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::TextUnformatted(shown(legend->title).c_str());

  // The scale is mixed between its stops, which differs by little from the mixture of light.
  const float width = 220 * context.scale, height = 10 * context.scale;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const auto stops = scale_stops();
  const auto tint = [&](std::size_t k) {
    return IM_COL32(stops[k][0], stops[k][1], stops[k][2], 255);
  };
  const float piece = width / static_cast<float>(stops.size() - 1);
  for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
    const float left = at.x + piece * static_cast<float>(k);
    ImGui::GetWindowDrawList()->AddRectFilledMultiColor({left, at.y}, {left + piece, at.y + height},
                                                        tint(k), tint(k + 1), tint(k + 1), tint(k));
  }
  ImGui::Dummy({width, height});

  // Marks are centred below their places, but for the outer ones.
  const std::size_t last = legend->marks.size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    const std::string mark = shown(legend->marks[k]);
    const float text = ImGui::CalcTextSize(mark.c_str()).x;
    const float place = width * static_cast<float>(k) / static_cast<float>(last);
    const float shift = k == 0 ? 0 : k == last ? text : 0.5f * text;
    if (k > 0) ImGui::SameLine();
    ImGui::SetCursorScreenPos({at.x + place - shift, ImGui::GetCursorScreenPos().y});
    ImGui::TextDisabled("%s", mark.c_str());
  }
  ImGui::End();
}

}  // namespace icloth
