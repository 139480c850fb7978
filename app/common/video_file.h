// Videos, made by the program ffmpeg from one picture after another.
#pragma once

#include <sys/types.h>

#include <string>

#include "render/image.h"

namespace icloth {

/// An MP4 file (H.264). It is written to a file with `.part` at the end of its name, which becomes
/// `path` when it is whole. ffmpeg has a process group of its own: Ctrl-C leaves it alone, and it
/// finishes what it got when this program dies.
class VideoFile {
 public:
  /// Starts ffmpeg for pictures of this size. Throws InputError where it is not installed, a side
  /// has an odd number of pixels, or the file cannot be written.
  VideoFile(std::string path, int width, int height, int frames_per_second);
  /// Drops a video that was not finished.
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  /// Appends a frame, so many times. Throws InputError when ffmpeg has ended, for example since the
  /// disk is full.
  void add(const Image& picture, int times = 1);

  /// Ends the video. Throws InputError when ffmpeg failed.
  void finish();

 private:
  void start();
  void close_input();
  int wait();
  [[noreturn]] void fail();

  std::string path_, part_;
  int width_ = 0, height_ = 0, frames_per_second_ = 0;
  int input_ = -1;     ///< our end of what ffmpeg reads
  int messages_ = -1;  ///< file in memory with what ffmpeg printed
  pid_t child_ = -1;
};

}  // namespace icloth
