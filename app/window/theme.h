// The look of the panels: calm and dark, one accent colour, the same colours in all panels.
#pragma once

#include <imgui.h>

#include <string>
#include <string_view>

namespace icloth {

/// Colours of the panels.
namespace colour {
inline constexpr ImU32 kText = IM_COL32(222, 226, 233, 255), kDim = IM_COL32(138, 146, 160, 255),
                       kAccent = IM_COL32(94, 176, 239, 255), kGood = IM_COL32(104, 200, 140, 255),
                       kBad = IM_COL32(240, 92, 84, 255), kChanged = IM_COL32(240, 186, 92, 255),
                       kPanel = IM_COL32(24, 27, 33, 255), kBar = IM_COL32(18, 20, 25, 255),
                       kWell = IM_COL32(16, 18, 22, 255),
                       kLit = IM_COL32(38, 92, 136, 255);  ///< a button that is in force
}  // namespace colour

/// Sets style and font of the current ImGui context for a content scale. The font is DejaVu Sans
/// where the system has it, else ImGui's own bitmap font.
void apply_theme(float scale);

/// The text with the symbols that the font lacks spelled out (ρ → rho).
std::string shown(std::string_view text);

inline ImVec4 vec4(ImU32 c) { return ImGui::ColorConvertU32ToFloat4(c); }

}  // namespace icloth
