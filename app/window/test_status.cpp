#include "app/window/test_status.h"

#include <cstdio>
#include <cstdlib>

namespace icloth {

TestStatusFile::TestStatusFile() {
  if (const char* path = std::getenv("ICLOTH_TEST_STATUS")) path_ = path;
}

void TestStatusFile::write(const TestStatus& s) const {
  // A file of another name is written and then renamed, so that a reader never sees half a line.
  const std::string part = path_ + ".part";
  std::FILE* file = std::fopen(part.c_str(), "w");
  if (!file) return;

  // The line is JSON, written by hand as its values need no escaping.
  std::fprintf(file,
               "{\"phase\": \"%s\", \"clock\": %.3f, \"dressing_step\": %d, \"body_speed\": %.9g, ",
               s.phase.c_str(), s.clock, s.dressing_step, s.body_speed);
  std::fprintf(file, "\"garments\": \"%s\", ", s.garments.c_str());
  const auto word = [](bool b) { return b ? "true" : "false"; };
  std::fprintf(
      file,
      "\"step\": %lld, \"time\": %.9g, \"penetrations\": %lld, \"max_speed\": %.9g, "
      "\"fps\": %.3f, \"steps_per_second\": %.3f, \"handles\": %d, \"parked\": %d, \"notes\": %d, "
      "\"playing\": %s, \"failed\": %s, \"panels\": %s, ",
      s.step, s.time, s.penetrations, s.max_speed, s.ui_fps, s.steps_per_second, s.handles,
      s.parked, s.notes, word(s.playing), word(s.failed), word(s.panels));
  std::fprintf(file, "\"eye\": [%.9g, %.9g, %.9g], ", s.eye.x, s.eye.y, s.eye.z);
  std::fprintf(file,
               "\"view\": [%.0f, %.0f, %.0f, %.0f], \"mean\": [%.9g, %.9g, %.9g], "
               "\"cloth_visible\": %s, \"cloth_pixel\": [%.0f, %.0f]}\n",
               static_cast<double>(s.view[0]), static_cast<double>(s.view[1]),
               static_cast<double>(s.view[2]), static_cast<double>(s.view[3]), s.mean.x, s.mean.y,
               s.mean.z, word(s.cloth_visible), s.cloth_x, s.cloth_y);

  const bool written = std::fclose(file) == 0;
  if (written) std::rename(part.c_str(), path_.c_str());
}

}  // namespace icloth
