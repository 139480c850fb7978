// A box of text beside the mouse.
#pragma once

#include <imgui.h>

namespace icloth {

/// While the mouse is over the item drawn last, disabled or not, shows a box with what `draw`
/// draws, its lines as wide as reads well.
template <class Draw>
void over_item(const Draw& draw) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
  draw();
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

}  // namespace icloth
