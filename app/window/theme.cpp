#include "app/window/theme.h"

#include <cmath>
#include <filesystem>
#include <utility>

namespace icloth {

namespace {

constexpr const char* kFontFiles[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
};
constexpr float kFontSize = 14, kBitmapFontSize = 13;

/// True when the font has Greek letters and typographic signs; set once with the font.
bool g_font_is_complete = false;

/// Loads the first font that is there.
void load_font(float scale) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;

  // The ranges hold the Latin, Greek and mathematical signs that the panels use.
  static const ImWchar kRanges[] = {0x20,   0xFF,   0x370,  0x3FF,  0x2010, 0x2026, 0x2070,
                                    0x208E, 0x2190, 0x2193, 0x2212, 0x2212, 0x221A, 0x221A,
                                    0x2248, 0x2265, 0x25A0, 0x25FF, 0};

  for (const char* file : kFontFiles) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) continue;
    ImFontConfig config;
    config.OversampleH = 2;
    config.PixelSnapH = true;
    if (atlas.AddFontFromFileTTF(file, std::round(kFontSize * scale), &config, kRanges)) {
      g_font_is_complete = true;
      return;
    }
  }

  // ImGui's own bitmap font remains, which has ASCII only.
  ImFontConfig config;
  config.SizePixels = kBitmapFontSize * std::max(1.0f, std::round(scale));
  atlas.AddFontDefault(&config);
}

void set_colours(ImGuiStyle& style) {
  const auto set = [&style](ImGuiCol index, ImU32 value) { style.Colors[index] = vec4(value); };

  set(ImGuiCol_Text, colour::kText);
  set(ImGuiCol_TextDisabled, colour::kDim);
  set(ImGuiCol_WindowBg, colour::kPanel);
  set(ImGuiCol_ChildBg, IM_COL32(0, 0, 0, 0));
  set(ImGuiCol_PopupBg, IM_COL32(30, 34, 41, 250));
  set(ImGuiCol_Border, IM_COL32(52, 58, 69, 255));

  // Frames, sliders and buttons get lighter from rest to hovering to pressing.
  set(ImGuiCol_FrameBg, IM_COL32(38, 43, 52, 255));
  set(ImGuiCol_FrameBgHovered, IM_COL32(48, 54, 65, 255));
  set(ImGuiCol_FrameBgActive, IM_COL32(56, 63, 76, 255));
  set(ImGuiCol_SliderGrab, IM_COL32(94, 176, 239, 130));
  set(ImGuiCol_SliderGrabActive, IM_COL32(94, 176, 239, 200));
  set(ImGuiCol_CheckMark, colour::kAccent);
  set(ImGuiCol_Button, IM_COL32(44, 50, 61, 255));
  set(ImGuiCol_ButtonHovered, IM_COL32(58, 66, 80, 255));
  set(ImGuiCol_ButtonActive, IM_COL32(70, 80, 97, 255));

  // Headers and tabs share their colours, of which the chosen tab has the accent.
  set(ImGuiCol_Header, IM_COL32(33, 37, 45, 255));
  set(ImGuiCol_HeaderHovered, IM_COL32(43, 48, 58, 255));
  set(ImGuiCol_HeaderActive, IM_COL32(50, 56, 68, 255));
  set(ImGuiCol_Tab, IM_COL32(33, 37, 45, 255));
  set(ImGuiCol_TabHovered, IM_COL32(58, 66, 80, 255));
  set(ImGuiCol_TabActive, IM_COL32(48, 84, 118, 255));
  set(ImGuiCol_TabUnfocused, IM_COL32(33, 37, 45, 255));
  set(ImGuiCol_TabUnfocusedActive, IM_COL32(48, 84, 118, 255));

  // Lines, scrollbars and rows of tables stay in the background.
  set(ImGuiCol_Separator, IM_COL32(44, 49, 59, 255));
  set(ImGuiCol_ScrollbarBg, IM_COL32(0, 0, 0, 0));
  set(ImGuiCol_ScrollbarGrab, IM_COL32(60, 67, 80, 255));
  set(ImGuiCol_TableRowBgAlt, IM_COL32(255, 255, 255, 6));
}

}  // namespace

void apply_theme(float scale) {
  load_font(scale);
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  ImGui::StyleColorsDark(&style);

  // Sizes are those at scale 1.
  style.WindowPadding = {12, 10};
  style.FramePadding = {8, 4};
  style.ItemSpacing = {8, 6};
  style.ItemInnerSpacing = {6, 4};

  style.ScrollbarSize = 10;
  style.GrabMinSize = 7;
  style.WindowBorderSize = 0;
  style.PopupBorderSize = 1;
  style.WindowRounding = 0;

  style.PopupRounding = style.FrameRounding = style.GrabRounding = 4;
  style.ScrollbarRounding = 6;

  style.ScaleAllSizes(scale);
  set_colours(style);
}

std::string shown(std::string_view text) {
  std::string out(text);
  if (g_font_is_complete) return out;

  // Symbols that the bitmap font lacks are spelled out.
  constexpr std::pair<std::string_view, std::string_view> kSpelled[] = {
      {"μ", "mu"}, {"ρ", "rho"}, {"δ", "delta"}, {"−", "-"}, {"–", "-"}, {"…", "..."},
      {"≥", ">="}, {"≤", "<="},  {"₂", "2"},     {"₀", "0"}, {"Δ", "d"}, {"→", "->"}};

  for (const auto& [symbol, word] : kSpelled) {
    for (std::size_t at = out.find(symbol); at != std::string::npos; at = out.find(symbol, at)) {
      out.replace(at, symbol.size(), word);
    }
  }
  return out;
}

}  // namespace icloth
