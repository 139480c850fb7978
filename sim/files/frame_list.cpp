#include "sim/files/frame_list.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr std::string_view kHead = "frame,step,time\n";
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;
constexpr const char* kTimeFormat = "%.9g";

std::string row(std::size_t number, const ListedFrame& frame) {
  char time[32];
  std::snprintf(time, sizeof time, kTimeFormat, frame.time);
  return std::to_string(number) + "," + std::to_string(frame.step) + "," + time + "\n";
}

}  // namespace

std::string frame_list(const std::string& folder) { return folder + "/frames.csv"; }

double listed_time(double time) {
  char text[32];
  std::snprintf(text, sizeof text, kTimeFormat, time);
  return std::strtod(text, nullptr);
}

std::string numbered_frame(const std::string& folder, std::size_t number) {
  char name[40];
  std::snprintf(name, sizeof name, "/frame_%05zu", number);
  return folder + name;
}

std::string frame_comment(const ListedFrame& frame) {
  char comment[80];
  std::snprintf(comment, sizeof comment, "step %lld, time %.9g s",
                static_cast<long long>(frame.step), frame.time);
  return comment;
}

void begin_frame_list(const std::string& folder) { write_file(frame_list(folder), kHead); }

void add_to_frame_list(const std::string& folder, std::size_t number, const ListedFrame& frame) {
  append_file(frame_list(folder), row(number, frame));
}

void write_frame_list(const std::string& folder, const std::vector<ListedFrame>& frames) {
  std::string text(kHead);
  for (std::size_t f = 0; f < frames.size(); ++f) text += row(f, frames[f]);
  write_file(frame_list(folder), text);
}

std::vector<ListedFrame> read_frame_list(const std::string& folder) {
  const std::string path = frame_list(folder), text = read_file(path, kMostBytes);
  std::vector<ListedFrame> frames;
  const auto refuse = [&](const std::string& value) {
    throw InputError(shown_path(path) + ": row " + std::to_string(frames.size()) + ": value " +
                     in_quotes(value) + ", expected frame, step and time of an export");
  };
  if (!text.starts_with(kHead)) refuse(text.substr(0, text.find('\n')));

  // Frames are counted from 0, and both step and time grow.
  std::size_t begin = kHead.size();
  for (std::size_t end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string line = text.substr(begin, end - begin);
    unsigned long long number = 0;
    long long step = 0;
    double time = 0;
    int read = 0;
    const int found = std::sscanf(line.c_str(), "%llu,%lld,%lf%n", &number, &step, &time, &read);
    const bool whole = found == 3 && static_cast<std::size_t>(read) == line.size();
    if (!whole || number != frames.size() || step < 0 || !std::isfinite(time)) refuse(line);
    if (!frames.empty() && (step <= frames.back().step || time <= frames.back().time)) refuse(line);
    frames.push_back({step, time});
  }
  return frames;
}

}  // namespace icloth
