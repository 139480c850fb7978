#include "app/window/imgui_gl.h"

#include <backends/imgui_impl_glfw.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <cstddef>

#include "app/window/theme.h"

namespace icloth {

static_assert(sizeof(UiVertex) == sizeof(ImDrawVert) && sizeof(ImDrawIdx) == 2);
static_assert(offsetof(UiVertex, x) == offsetof(ImDrawVert, pos));
static_assert(offsetof(UiVertex, u) == offsetof(ImDrawVert, uv));
static_assert(offsetof(UiVertex, rgba) == offsetof(ImDrawVert, col));

Ui::Ui(Window& window) : scale_(window.content_scale()) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();

  // The program keeps no files of the interface, and draws its triangles itself.
  ImGuiIO& io = ImGui::GetIO();

  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.BackendRendererName = "icloth";
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;

  // ImGui's callbacks call the window's own ones first.
  ImGui_ImplGlfw_InitForOpenGL(window.handle(), true);

  // The font becomes a texture of the painter.
  apply_theme(scale_);
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  painter_.set_font(pixels, width, height);
}

Ui::~Ui() {
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Ui::begin_frame() {
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void Ui::end_frame() { ImGui::Render(); }

void Ui::paint(int width, int height, unsigned framebuffer) {
  const ImDrawData* data = ImGui::GetDrawData();
  const ImVec2 scale = data->FramebufferScale;

  // Each list of ImGui becomes one drawing, whose batches have a clip rectangle in pixels.
  for (int n = 0; n < data->CmdListsCount; ++n) {
    const ImDrawList& list = *data->CmdLists[n];
    batches_.clear();
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback || command.ElemCount == 0) continue;

      // Rectangles are clipped to the framebuffer.
      const auto clip = [&](float value, float origin, float factor, int limit) {
        const float pixel = (value - origin) * factor;
        return pixel < 0                           ? 0.0f
               : pixel > static_cast<float>(limit) ? static_cast<float>(limit)
                                                   : pixel;
      };

      const ImVec4& r = command.ClipRect;
      batches_.push_back({{clip(r.x, data->DisplayPos.x, scale.x, width),
                           clip(r.y, data->DisplayPos.y, scale.y, height),
                           clip(r.z, data->DisplayPos.x, scale.x, width),
                           clip(r.w, data->DisplayPos.y, scale.y, height)},
                          command.IdxOffset,
                          command.ElemCount,
                          command.VtxOffset});
    }

    // ImGui's vertices have the painter's layout, which the assertions above check.
    const auto* vertices = reinterpret_cast<const UiVertex*>(list.VtxBuffer.Data);
    const UiDrawing drawing{
        .vertices = {vertices, static_cast<std::size_t>(list.VtxBuffer.Size)},
        .indices = {list.IdxBuffer.Data, static_cast<std::size_t>(list.IdxBuffer.Size)},
        .batches = batches_,
        .left = data->DisplayPos.x,
        .top = data->DisplayPos.y,
        .width = data->DisplaySize.x,
        .height = data->DisplaySize.y};
    painter_.paint(drawing, width, height, framebuffer);
  }
}

bool Ui::wants_text() const { return ImGui::GetIO().WantTextInput; }

bool Ui::popup_open() const {
  return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
}

void Ui::close_popups() {
  if (popup_open()) ImGui::ClosePopupToLevel(0, true);
}

}  // namespace icloth
