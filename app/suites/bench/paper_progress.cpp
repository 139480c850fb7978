#include "app/suites/bench/paper_progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "app/common/progress.h"

namespace icloth {

PaperProgress::PaperProgress(bool quiet)
    : quiet_(quiet), terminal_(!quiet && isatty(STDERR_FILENO)) {}

void PaperProgress::check() const {
  if (const char* signal = interrupts_.noted()) throw PaperInterrupted{signal};
}

void PaperProgress::advance(double seconds, const std::string& what) {
  done_ += seconds;
  check();

  // The line changes five times a second at most.
  const Clock::time_point now = Clock::now();
  if (!terminal_ || std::chrono::duration<double>(now - last_).count() < 0.2) return;
  last_ = now;
  shown_ = true;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double left = std::max(total_ - done_, 0.0) * elapsed / std::max(done_, 1e-9);
  std::fprintf(stderr, "\r\033[K%s, %.0f %% of all, %s left", what.c_str(),
               100 * std::min(done_ / std::max(total_, 1e-9), 1.0), duration_text(left).c_str());
  std::fflush(stderr);
}

void PaperProgress::print(const std::string& line) {
  clear();
  if (quiet_) return;
  std::printf("%s\n", line.c_str());
  std::fflush(stdout);
}

void PaperProgress::clear() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

}  // namespace icloth
