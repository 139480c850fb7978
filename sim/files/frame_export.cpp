#include "sim/files/frame_export.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr const char* kList = "/frames.csv";
constexpr const char* kHead = "frame,step,time\n";

}  // namespace

FrameExport::FrameExport(std::string folder, long every, std::span<const FrameFormat> formats,
                         std::int64_t steps)
    : folder_(std::move(folder)),
      every_(every),
      formats_(formats.begin(), formats.end()),
      caches_(folder_) {
  if (!folder_.empty() && steps > 0 && std::filesystem::exists(folder_ + kList)) keep_frames(steps);
}

bool FrameExport::has(FrameFormat format) const {
  return std::ranges::find(formats_, format) != formats_.end();
}

void FrameExport::keep_frames(std::int64_t steps) {
  const std::string path = folder_ + kList, text = read_file(path);
  const auto refuse = [&] {
    throw InputError(shown_path(path) + ": row " + std::to_string(frames_) +
                     ": expected frame, step and time of an export");
  };
  if (!text.starts_with(kHead)) refuse();

  // Frames after the state that the run goes on from are made again, and that of the state itself
  // where it was written as the last one only.
  std::size_t begin = std::string(kHead).size();
  for (std::size_t end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    long frame = 0;
    long long step = 0;
    double time = 0;
    const std::string row = text.substr(begin, end - begin);
    if (std::sscanf(row.c_str(), "%ld,%lld,%lf", &frame, &step, &time) != 3 || frame != frames_)
      refuse();
    if (step > steps || (step == steps && step % every_ != 0)) break;
    last_step_ = step;
    ++frames_;
    if (step % every_ == 0) even_times_.push_back(time);
  }
  kept_ = static_cast<std::int64_t>(even_times_.size());
  write_file(path, text.substr(0, begin));
}

void FrameExport::write(std::span<const NamedMesh> meshes, std::int64_t step, double time,
                        bool last) {
  char comment[80];
  std::snprintf(comment, sizeof comment, "step %lld, time %.9g s", static_cast<long long>(step),
                time);
  if (step != last_step_) write_frame(meshes, step, time, comment);
  if (!last) return;

  // MDD and USDA have all times before the places, so they are made of the PC2 files at the end.
  if (has(FrameFormat::obj)) write_obj(folder_ + "/last.obj", meshes, comment);
  if (has(FrameFormat::mdd)) caches_.write_mdd(even_times_);
  if (has(FrameFormat::usda)) caches_.write_usda(even_times_);
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
  std::snprintf(name, sizeof name, "/frame_%05ld", frames_);
  if (has(FrameFormat::obj)) write_obj(folder_ + name + ".obj", meshes, comment);
  if (has(FrameFormat::ply)) write_ply(folder_ + name + ".ply", meshes, comment);
  if (step % every_ == 0) {
    const bool cached = has(FrameFormat::pc2) || has(FrameFormat::mdd) || has(FrameFormat::usda);
    if (cached) caches_.append(meshes, kept_);
    even_times_.push_back(time);
  }

  // The list names a frame only when its file is complete.
  char row[80];
  std::snprintf(row, sizeof row, "%ld,%lld,%.9g\n", frames_, static_cast<long long>(step), time);
  if (frames_ == 0) {
    write_file(folder_ + kList, std::string(kHead) + row);
  } else {
    append_file(folder_ + kList, row);
  }
  last_step_ = step;
  ++frames_;
}

}  // namespace icloth
