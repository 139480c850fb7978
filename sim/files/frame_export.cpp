#include "sim/files/frame_export.h"

#include <cstdio>
#include <filesystem>
#include <utility>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"

namespace icloth {

FrameExport::FrameExport(std::string folder, long every)
    : folder_(std::move(folder)), every_(every) {}

void FrameExport::write(std::span<const NamedMesh> meshes, std::int64_t step, double time,
                        bool last) {
  char comment[80];
  std::snprintf(comment, sizeof comment, "step %lld, time %.9g s", static_cast<long long>(step),
                time);
  if (step != last_step_) write_frame(meshes, step, time, comment);
  if (last) write_obj(folder_ + "/last.obj", meshes, comment);
}

void FrameExport::write_frame(std::span<const NamedMesh> meshes, std::int64_t step, double time,
                              const std::string& comment) {
  if (frames_ == 0) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error)
      throw InputError("--out " + shown_path(folder_) + ": cannot be made a folder (" +
                       error.message() + ")");
  }
  char name[32];
  std::snprintf(name, sizeof name, "/frame_%05ld.obj", frames_);
  write_obj(folder_ + name, meshes, comment);

  // The list names a frame only when its file is complete.
  char row[80];
  std::snprintf(row, sizeof row, "%ld,%lld,%.9g\n", frames_, static_cast<long long>(step), time);
  if (frames_ == 0) {
    write_file(folder_ + "/frames.csv", std::string("frame,step,time\n") + row);
  } else {
    append_file(folder_ + "/frames.csv", row);
  }
  last_step_ = step;
  ++frames_;
}

}  // namespace icloth
