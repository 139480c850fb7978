#include "sim/files/frame_export.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "sim/files/error.h"
#include "sim/files/frame_list.h"
#include "sim/files/text.h"

namespace icloth {

FrameExport::FrameExport(std::string folder, long every, std::span<const FrameFormat> formats,
                         std::int64_t steps)
    : folder_(std::move(folder)),
      every_(every),
      formats_(formats.begin(), formats.end()),
      caches_(folder_) {
  if (!folder_.empty() && steps > 0 && std::filesystem::exists(frame_list(folder_)))
    keep_frames(steps);
}

bool FrameExport::has(FrameFormat format) const {
  return std::ranges::find(formats_, format) != formats_.end();
}

void FrameExport::keep_frames(std::int64_t steps) {
  // Frames after the state that the run goes on from are made again, and that of the state itself
  // where it was written as the last one only.
  std::vector<ListedFrame> frames = read_frame_list(folder_);
  const auto rest = std::ranges::find_if(frames, [&](const ListedFrame& frame) {
    return frame.step > steps || (frame.step == steps && frame.step % every_ != 0);
  });
  frames.erase(rest, frames.end());
  write_frame_list(folder_, frames);

  frames_ = frames.size();
  if (!frames.empty()) last_step_ = frames.back().step;
  for (const ListedFrame& frame : frames)
    if (frame.step % every_ == 0) even_times_.push_back(frame.time);
  kept_ = static_cast<std::int64_t>(even_times_.size());
}

void FrameExport::begin(std::span<const NamedMesh> meshes) {
  begun_ = true;
  if (frames_ == 0) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error)
      throw InputError("--out " + shown_path(folder_) + ": cannot be made a folder (" +
                       error.message() + ")");

    // Frames of an earlier run in the same folder are no longer listed.
    begin_frame_list(folder_);
  }
  if (has_caches()) caches_.begin(meshes, kept_);
}

void FrameExport::write(std::span<const NamedMesh> meshes, std::int64_t step, double time,
                        bool last) {
  const std::string comment = frame_comment({step, time});
  if (!begun_) begin(meshes);
  if (step != last_step_) write_frame(meshes, step, time, comment);
  if (!last) return;

  // MDD and USDA have all times before the places, so they are made of the PC2 files at the end.
  if (has(FrameFormat::obj)) write_obj(folder_ + "/last.obj", meshes, comment);
  if (has(FrameFormat::mdd)) write_mdd(folder_, caches_.caches(), even_times_);
  if (has(FrameFormat::usda)) write_usda_scene(folder_, caches_.caches(), even_times_);
}

void FrameExport::write_frame(std::span<const NamedMesh> meshes, std::int64_t step, double time,
                              const std::string& comment) {
  const std::string name = numbered_frame(folder_, frames_);
  if (has(FrameFormat::obj)) write_obj(name + ".obj", meshes, comment);
  if (has(FrameFormat::ply)) write_ply(name + ".ply", meshes, comment);
  if (step % every_ == 0) {
    if (has_caches()) caches_.append(meshes);
    even_times_.push_back(listed_time(time));
  }

  // The list names a frame only when its file is complete.
  add_to_frame_list(folder_, frames_, {step, time});
  last_step_ = step;
  ++frames_;
}

}  // namespace icloth
