// The table of keys, which F1 shows.

#include "app/window/bindings.h"
#include "app/window/panels/panel.h"
#include "app/window/theme.h"

namespace icloth {

namespace {

/// Draws the rows of one group.
void draw_group(std::string_view group) {
  ImGui::TextColored(vec4(colour::kAccent), "%s", std::string(group).c_str());
  if (!ImGui::BeginTable(std::string(group).c_str(), 2, ImGuiTableFlags_RowBg)) return;
  ImGui::TableSetupColumn("input", ImGuiTableColumnFlags_WidthStretch, 0.44f);
  ImGui::TableSetupColumn("action", ImGuiTableColumnFlags_WidthStretch, 0.56f);

  // Rows without an input repeat the action above.
  for (const Binding& row : binding_table()) {
    if (row.group != group || row.input.empty()) continue;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(row.input.data(), row.input.data() + row.input.size());
    ImGui::TableNextColumn();
    ImGui::PushTextWrapPos();
    ImGui::TextDisabled("%s", std::string(row.text).c_str());
    ImGui::PopTextWrapPos();
  }

  ImGui::EndTable();
  ImGui::Spacing();
}

/// The names of the groups in the order of the table.
std::vector<std::string_view> group_names() {
  std::vector<std::string_view> names;
  for (const Binding& row : binding_table()) {
    if (names.empty() || names.back() != row.group) names.push_back(row.group);
  }
  return names;
}

}  // namespace

void draw_help(PanelContext& context, const Rect& view) {
  if (!context.ui.help) return;

  // The table lies over the middle of the view, as large as it fits.
  const float width = std::min(920 * context.scale, view.width - 24 * context.scale);
  const float height = std::min(570 * context.scale, view.height - 24 * context.scale);
  ImGui::SetNextWindowPos({view.x + (view.width - width) / 2, view.y + 12 * context.scale});
  ImGui::SetNextWindowSize({width, height});
  ImGui::SetNextWindowBgAlpha(0.95f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * context.scale);
  ImGui::Begin("##help", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings);

  if (ImGui::BeginTable("##columns", 2)) {
    ImGui::TableNextRow();

    // Groups fill the left column first, then the right one.
    const std::vector<std::string_view> groups = group_names();
    for (std::size_t k = 0; k < groups.size(); ++k) {
      if (k == 0 || k == (groups.size() + 1) / 2) ImGui::TableNextColumn();
      draw_group(groups[k]);
    }
    ImGui::EndTable();
  }

  // Clicks on it are not meant for the scene.
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  context.ui.overlays.push_back({at.x, at.y, size.x, size.y});
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace icloth
