#include "app/common/progress.h"

#include <unistd.h>

#include <cstdio>

namespace icloth {
std::string duration_text(double seconds) {
  char text[32];
  const long s = static_cast<long>(seconds + 0.5);
  if (s < 60)
    std::snprintf(text, sizeof text, "%ld s", s);
  else if (s < 3600)
    std::snprintf(text, sizeof text, "%ld:%02ld min", s / 60, s % 60);
  else
    std::snprintf(text, sizeof text, "%ld:%02ld h", s / 3600, s / 60 % 60);
  return text;
}

Progress::Progress(std::string what, long total, bool quiet)
    : what_(std::move(what)), total_(total), enabled_(!quiet && isatty(STDERR_FILENO)) {}

void Progress::update(long done) {
  if (!enabled_ || done <= 0 || done >= total_) return;

  // Short runs show nothing, and the line changes five times a second at most.
  const Clock::time_point now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double total = elapsed * static_cast<double>(total_) / static_cast<double>(done);

  if (total < 2.0 || std::chrono::duration<double>(now - last_).count() < 0.2) return;
  last_ = now;
  shown_ = true;
  std::fprintf(stderr, "\r\033[K%s: step %ld of %ld, %.1f steps/s, %s left", what_.c_str(), done,
               total_, static_cast<double>(done) / elapsed, duration_text(total - elapsed).c_str());
  std::fflush(stderr);
}

void Progress::finish() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

}  // namespace icloth
