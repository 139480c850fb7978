// The panel of parameters. Its sliders are made from the table of parameters, which gives unit,
// range, scale and tooltips.
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>

#include "app/window/panels/hover.h"
#include "app/window/panels/panel.h"
#include "app/window/theme.h"
#include "sim/scene/presets.h"

namespace icloth {

namespace {

std::string group_of(const ParameterInfo& info) {
  return std::string(info.name.substr(0, info.name.find('.')));
}

/// The groups that people reach for first are open from the start.
bool open_at_first(const std::string& group) {
  return group == "step" || group == "gravity" || group == "wind" || group == "material" ||
         group == "impact_zones";
}

/// The group's name as a heading, in the words of who makes garments; one that has none there is
/// "impact_zones", as "Impact zones".
std::string heading(const std::string& group) {
  static const std::map<std::string_view, const char*> kHeadings = {
      {"step", "Time step"},
      {"material", "Fabric"},
      {"proximity", "Contact"},
      {"implicit", "Solver"},
      {"broad_phase", "Search for collisions"},
      {"impact_zones", "Impacts"},
      {"ccd", "Collision test"},
      {"grab", "Hands"},
  };
  if (const auto found = kHeadings.find(group); found != kHeadings.end()) return found->second;

  std::string text = group;
  for (char& c : text) {
    if (c == '_') c = ' ';
  }
  text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", value);
  return text;
}

/// Shows the tooltip of a parameter: its name, the effect of either direction, its range and
/// source.
void explain(const ParameterInfo& info, const ParameterEdits& edits) {
  over_item([&] {
    const std::string unit = info.unit.empty() ? "" : " " + std::string(info.unit);
    ImGui::TextUnformatted(shown(info.label).c_str());
    ImGui::TextDisabled("%s", std::string(info.name).c_str());
    ImGui::Text("%s", shown("lower: " + std::string(info.lower)).c_str());
    ImGui::Text("%s", shown("higher: " + std::string(info.higher)).c_str());

    // The tooltip gives the range and the scene's own value.
    ImGui::TextDisabled(
        "%s", shown("from " + number(info.minimum) + " to " + number(info.maximum) + unit +
                    ", in this scene " + number(edits.start_value(info)) + unit)
                  .c_str());

    // Some parameters act only together with another one.
    if (!info.only_with.empty())
      ImGui::TextDisabled("used only with %s", std::string(info.only_with).c_str());
    ImGui::TextDisabled("%s", shown("source: " + std::string(info.source)).c_str());
    ImGui::TextDisabled("right click: reset; Ctrl+click: type a value, Enter sets it");
  });
}

/// Offers reset and copying in the menu of a right click.
void offer_reset(const ParameterInfo& info, ParameterEdits& edits) {
  if (!ImGui::BeginPopupContextItem("##menu")) return;
  const std::string back = "Reset to " + number(edits.start_value(info));
  if (ImGui::MenuItem(back.c_str(), nullptr, false, edits.changed(info))) edits.reset(info);
  const std::string setting = std::string(info.name) + "=" + number(edits.value(info));
  if (ImGui::MenuItem(("Copy --set " + setting).c_str())) {
    ImGui::SetClipboardText(("--set " + setting).c_str());
  }
  ImGui::EndPopup();
}

/// Draws where the value of the last item lies in its range, as a line along the lower edge: a grip
/// would cover the number.
void draw_level(const ParameterInfo& info, double value) {
  const bool logarithmic = info.logarithmic && info.minimum > 0;
  const auto place = [&](double x) { return logarithmic ? std::log(x) : x; };
  const double low = place(info.minimum), high = place(info.maximum);
  const double share = std::clamp((place(value) - low) / (high - low), 0., 1.);
  const ImVec2 least = ImGui::GetItemRectMin(), most = ImGui::GetItemRectMax();
  const float rounding = ImGui::GetStyle().FrameRounding, height = 3;
  const float left = least.x + rounding, right = most.x - rounding;
  const ImU32 colour =
      ImGui::GetColorU32(ImGui::IsItemActive() ? ImGuiCol_SliderGrabActive : ImGuiCol_SliderGrab);
  ImGui::GetWindowDrawList()->AddRectFilled(
      {left, most.y - height},
      {left + std::max(2.f, static_cast<float>(share) * (right - left)), most.y}, colour);
}

/// A slider without a grip, or a field for a number that is typed (Ctrl+click).
template <class Slider>
bool with_level(const ParameterInfo& info, const double& value, const Slider& slider) {
  ImGui::PushStyleColor(ImGuiCol_SliderGrab, IM_COL32_BLACK_TRANS);
  ImGui::PushStyleColor(ImGuiCol_SliderGrabActive, IM_COL32_BLACK_TRANS);
  const bool moved = slider();
  ImGui::PopStyleColor(2);
  if (!ImGui::TempInputIsActive(ImGui::GetItemID())) draw_level(info, value);
  return moved;
}

/// A slider with the parameter's range, scale and unit. True when it moved.
bool edit_number(const ParameterInfo& info, double& value) {
  const ImGuiSliderFlags flags =
      ImGuiSliderFlags_AlwaysClamp | (info.logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  std::string format = info.unit.empty() ? "" : " " + shown(info.unit);

  // Whole numbers have a slider of their own.
  if (info.field.kind == ParameterInfo::Kind::whole) {
    format = "%d" + format;
    int whole = static_cast<int>(value);
    return with_level(info, value, [&] {
      const bool moved = ImGui::SliderInt("##value", &whole, static_cast<int>(info.minimum),
                                          static_cast<int>(info.maximum), format.c_str(), flags);
      value = whole;
      return moved;
    });
  }

  format = (info.maximum < 1 && !info.logarithmic ? "%.5f" : "%.4g") + format;
  return with_level(info, value, [&] {
    return ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &info.minimum,
                               &info.maximum, format.c_str(), flags);
  });
}

/// A list of names. True when another one was chosen.
bool edit_choice(std::span<const std::string_view> choices, double& value) {
  bool moved = false;
  if (!ImGui::BeginCombo("##value", std::string(choices[static_cast<std::size_t>(value)]).c_str()))
    return false;
  for (std::size_t k = 0; k < choices.size(); ++k) {
    if (!ImGui::Selectable(std::string(choices[k]).c_str(), static_cast<double>(k) == value))
      continue;
    value = static_cast<double>(k);
    moved = true;
  }
  ImGui::EndCombo();
  return moved;
}

/// Draws the name and the control of one parameter.
void draw_row(const ParameterInfo& info, ParameterEdits& edits, bool& held) {
  ImGui::PushID(info.name.data());
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();

  // The name is lit where the value is not the scene's.
  const bool changed = edits.changed(info);
  ImGui::TextColored(vec4(changed ? colour::kChanged : colour::kText), "%s",
                     shown(info.label).c_str());
  explain(info, edits);

  ImGui::TableNextColumn();
  ImGui::SetNextItemWidth(-1);

  // The control follows the kind of the parameter; one that has no effect now is disabled.
  double value = edits.value(info);
  bool moved = false;
  ImGui::BeginDisabled(!parameter_used(edits.values(), info));
  if (info.field.kind == ParameterInfo::Kind::boolean) {
    bool on = value != 0;
    moved = ImGui::Checkbox("##value", &on);
    value = on;
  } else if (const auto choices = info.field.choices; !choices.empty()) {
    moved = edit_choice(choices, value);
  } else {
    moved = edit_number(info, value);
  }
  ImGui::EndDisabled();

  // A slider that is held makes one change, however often it moves. A number that is being typed
  // passes through others: it counts when its field is left.
  if (ImGui::IsItemActivated()) held = false;
  if (moved && !ImGui::TempInputIsActive(ImGui::GetItemID())) {
    edits.set(info, value, held);
    held = true;
  }

  // The tooltip would cover a slider that is being dragged.
  if (!ImGui::IsItemActive()) explain(info, edits);
  offer_reset(info, edits);
  ImGui::PopID();
}

void explain_preset(const Preset& preset) {
  over_item([&] {
    ImGui::TextUnformatted(shown(std::string(preset.purpose)).c_str());
    // The file of results does not change while the program runs; it is read when first shown.
    static std::map<std::string_view, std::string> results;
    const auto [found, is_new] = results.try_emplace(preset.name);
    if (is_new) found->second = measured_results(preset);
    if (!found->second.empty()) ImGui::TextUnformatted(shown(found->second).c_str());
    for (const auto& [key, value] : preset.settings)
      ImGui::TextDisabled("%s = %s", std::string(key).c_str(), std::string(value).c_str());
  });
}

/// Draws buttons that set several parameters at once; the one in force is lit.
void draw_presets(ParameterEdits& edits) {
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const auto count = static_cast<float>(presets().size());
  const float width = (ImGui::GetContentRegionAvail().x - (count - 1) * gap) / count;

  // Buttons of equal width fill the row.
  for (const Preset& preset : presets()) {
    if (&preset != &presets().front()) ImGui::SameLine();

    const bool on = is_set(edits.values(), preset);
    if (on) ImGui::PushStyleColor(ImGuiCol_Button, colour::kLit);
    const bool pressed = ImGui::Button(std::string(preset.label).c_str(), {width, 0});
    if (on) ImGui::PopStyleColor();
    explain_preset(preset);

    // A preset is one change, which one undo takes back.
    if (!pressed) continue;
    Parameters wanted = edits.values();
    apply_preset(wanted, preset);
    edits.set_all(wanted);
  }
}

}  // namespace

void draw_parameters(PanelContext& context) {
  draw_presets(context.edits);
  const auto table = parameter_table();

  // Neighbours in the table with one group share a heading, which counts the changes below it.
  for (std::size_t k = 0; k < table.size();) {
    const std::string group = group_of(table[k]);
    std::size_t end = k;
    int changed = 0;
    for (; end < table.size() && group_of(table[end]) == group; ++end) {
      changed += context.edits.changed(table[end]);
    }

    const std::string text = heading(group) +
                             (changed ? "  (" + std::to_string(changed) + " changed)" : "") +
                             "###" + group;
    const ImGuiTreeNodeFlags flags =
        open_at_first(group) ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None;

    if (ImGui::CollapsingHeader(text.c_str(), flags) && ImGui::BeginTable("##rows", 2)) {
      ImGui::TableSetupColumn("label", ImGuiTableColumnFlags_WidthStretch, 0.54f);
      ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch, 0.46f);
      for (; k < end; ++k) draw_row(table[k], context.edits, context.ui.slider_held);
      ImGui::EndTable();
    }
    k = end;
  }
}

}  // namespace icloth
