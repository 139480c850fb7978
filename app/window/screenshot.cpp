#include "app/window/screenshot.h"

#include <cstdio>
#include <filesystem>

#include "render/ui_painter.h"
#include "sim/files/error.h"
#include "sim/files/text.h"

namespace icloth {

std::string free_name(const std::string& folder, const char* stem, const char* extension) {
  std::error_code failed;
  if (!folder.empty()) std::filesystem::create_directories(folder, failed);
  if (failed)
    throw InputError(shown_path(folder) + ": the folder cannot be made (" + failed.message() + ")");
  for (int k = 1;; ++k) {
    char number[24];
    std::snprintf(number, sizeof number, "_%04d", k);
    const std::filesystem::path place = folder.empty() ? "." : folder;
    const std::filesystem::path path = place / (stem + std::string(number) + extension);
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return path.lexically_normal().string();
  }
}

SaveResult save_screenshot(const Window& window, Ui& ui, const Target* picture, float left,
                           float high, const std::string& folder) {
  const int width = window.framebuffer_width(), height = window.framebuffer_height();
  Target target(Target::Kind::bytes);
  target.resize(width, height);

  clear_picture(target.framebuffer(), 0.09f, 0.1f, 0.12f);
  const float factor = static_cast<float>(width) / static_cast<float>(window.width());
  const int start = static_cast<int>(left * factor);
  if (picture)
    show_picture(*picture, target.framebuffer(), height, start, 0, width - start,
                 static_cast<int>(high * factor));
  ui.paint(width, height, target.framebuffer());

  try {
    const std::string path = free_name(folder, "icloth", ".png");
    write_png(path, read_picture(target));
    return {"Picture saved to " + path, false};
  } catch (const InputError& error) {
    return {std::string("The picture was not saved: ") + error.what(), true};
  }
}

}  // namespace icloth
