#include "app/common/video_file.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <utility>
#include <vector>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

/// The words of the command: pictures come in as they lie in memory, and the head of the file is
/// moved to its front at the end, so that players can start before they have all of it.
std::vector<std::string> command(const std::string& out, int width, int height, int rate) {
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  std::istringstream options("-nostdin -y -loglevel error -f rawvideo -pix_fmt rgba -s:v " + size +
                             " -r " + std::to_string(rate) +
                             " -i pipe:0 -an -c:v libx264 -crf 18 -pix_fmt yuv420p"
                             " -movflags +faststart -f mp4");

  // A path may have blanks of its own, and a colon.
  std::vector<std::string> words{"ffmpeg"};
  for (std::string word; options >> word;) words.push_back(word);
  words.push_back("file:" + out);
  return words;
}

void close_file(int& file) {
  if (file >= 0) close(file);
  file = -1;
}

}  // namespace

VideoFile::VideoFile(std::string path, int width, int height, int frames_per_second)
    : path_(std::move(path)),
      part_(path_ + ".part"),
      width_(width),
      height_(height),
      frames_per_second_(frames_per_second) {
  if (width % 2 != 0 || height % 2 != 0)
    throw InputError(shown_path(path_) + ": " + std::to_string(width) + "x" +
                     std::to_string(height) + " pixels, expected even numbers for a video");
  write_file(part_, "");
  try {
    start();
  } catch (...) {
    close_input();
    close_file(messages_);
    std::filesystem::remove(part_);
    throw;
  }
}

void VideoFile::start() {
  const auto refuse = [&](const std::string& what) {
    throw InputError(shown_path(path_) + ": " + what);
  };

  // A socket, unlike a pipe, can be written to without a signal when ffmpeg has ended.
  int ends[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    refuse(std::string("no socket to ffmpeg (") + std::strerror(errno) + ")");
  input_ = ends[0];
  messages_ = memfd_create("ffmpeg", MFD_CLOEXEC);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, messages_, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);

  // posix_spawn takes its words as char*, though it does not change them.
  std::vector<std::string> words = command(part_, width_, height_, frames_per_second_);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int error =
      posix_spawnp(&child_, "ffmpeg", &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  close_file(ends[1]);
  if (error == 0) return;

  child_ = -1;
  if (error == ENOENT)
    refuse(
        "a video needs ffmpeg, which is not installed; expected the package 'ffmpeg', or "
        "FILE.png");
  refuse(std::string("ffmpeg cannot be started (") + std::strerror(error) + ")");
}

VideoFile::~VideoFile() {
  close_input();
  if (child_ > 0) wait();
  close_file(messages_);
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void VideoFile::add(const Image& picture, int times) {
  if (picture.width != width_ || picture.height != height_)
    throw InputError(shown_path(path_) + ": a picture of another size than the video's");
  for (int k = 0; k < times; ++k) {
    std::size_t sent = 0;
    while (sent < picture.pixels.size()) {
      const ssize_t count =
          send(input_, picture.pixels.data() + sent, picture.pixels.size() - sent, MSG_NOSIGNAL);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail();
      sent += static_cast<std::size_t>(count);
    }
  }
}

void VideoFile::finish() {
  close_input();
  if (wait() != 0) fail();
  std::error_code error;
  std::filesystem::rename(part_, path_, error);
  if (error) throw InputError(shown_path(path_) + ": cannot be written (" + error.message() + ")");
}

/// Without more input ffmpeg ends the file.
void VideoFile::close_input() { close_file(input_); }

/// Waits for ffmpeg; its exit status.
int VideoFile::wait() {
  int status = 0;
  while (waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  return status;
}

/// Says what ffmpeg had to say.
void VideoFile::fail() {
  close_input();
  if (child_ > 0) wait();
  char text[400] = "";
  const ssize_t count = pread(messages_, text, sizeof text - 1, 0);
  std::string said(text, count > 0 ? static_cast<std::size_t>(count) : 0);
  said = said.substr(0, said.find('\n'));
  throw InputError(shown_path(path_) + ": ffmpeg made no video" +
                   (said.empty() ? "" : " (" + excerpt(said) + ")"));
}

}  // namespace icloth
