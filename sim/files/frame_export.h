// States of a run as numbered mesh files.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/files/cache_export.h"
#include "sim/files/mesh_io.h"

namespace icloth {

/// Formats of exported frames: a file for each frame, or one of each object for all of them.
enum class FrameFormat { obj, ply, pc2, mdd, usda };

/// Writes every K-th state of a run and the last one as frame_00000.obj, frame_00001.obj and so on
/// (or .ply) into a folder. The frames are numbered consecutively; frames.csv beside them says step
/// and time of each, as does a comment in every file. The last state is also written as last.obj.
/// Point caches (sim/files/cache_export.h) hold every K-th state alone, so that their frames are
/// even. A frame is listed when it is whole in all formats, so a crash loses nothing before it.
class FrameExport {
 public:
  /// `folder` is made when the first frame is written; empty: nothing is written. A run that goes
  /// on after `steps` steps keeps the frames of these that frames.csv lists, and numbers its own
  /// after them. Throws InputError where the list is not one.
  FrameExport(std::string folder, long every, std::span<const FrameFormat> formats = kObj,
              std::int64_t steps = 0);

  /// Whether the state after that many steps is written; `last`: it is that at the end of the run.
  bool wants(std::int64_t step, bool last) const {
    return !folder_.empty() && (last || step % every_ == 0);
  }
  /// Writes a state that is wanted, `time` [s] after the start. Throws InputError where the folder
  /// cannot be made or a file cannot be written.
  void write(std::span<const NamedMesh> meshes, std::int64_t step, double time, bool last);

 private:
  static constexpr FrameFormat kObj[] = {FrameFormat::obj};

  bool has(FrameFormat format) const;
  bool has_caches() const {
    return has(FrameFormat::pc2) || has(FrameFormat::mdd) || has(FrameFormat::usda);
  }
  void begin(std::span<const NamedMesh> meshes);
  void write_frame(std::span<const NamedMesh> meshes, std::int64_t step, double time,
                   const std::string& comment);
  void keep_frames(std::int64_t steps);

  std::string folder_;
  std::int64_t every_;
  std::vector<FrameFormat> formats_;
  CacheExport caches_;
  bool begun_ = false;
  std::int64_t last_step_ = -1;  ///< of the frame written last; −1: none yet
  std::size_t frames_ = 0;
  std::vector<double> even_times_;  ///< of the frames in caches [s]
  std::int64_t kept_ = 0;           ///< of them, those that were there before
};

}  // namespace icloth
