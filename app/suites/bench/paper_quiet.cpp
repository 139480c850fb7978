#include "app/suites/bench/paper_quiet.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace icloth {
namespace {

/// Processor time of this process [s].
double own_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Processor time of all processes [s], the time that a host takes away included; −1: unknown.
double all_seconds() {
  // The first line of the file: "cpu", then ticks as user, nice, system, idle, iowait, irq, softirq
  // and steal.
  std::ifstream file("/proc/stat");
  std::string name;
  double ticks[8] = {};
  if (!(file >> name) || name != "cpu") return -1;
  for (double& t : ticks)
    if (!(file >> t)) return -1;
  const double busy = ticks[0] + ticks[1] + ticks[2] + ticks[5] + ticks[6] + ticks[7];
  return busy / static_cast<double>(sysconf(_SC_CLK_TCK));
}

}  // namespace

ProcessorWatch::ProcessorWatch()
    : begin_(std::chrono::steady_clock::now()), own_(own_seconds()), all_(all_seconds()) {}

double ProcessorWatch::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

double ProcessorWatch::own_share(int threads) const {
  return (own_seconds() - own_) / (seconds() * threads);
}

double ProcessorWatch::others_share() const {
  const double now = all_seconds();
  if (now < 0 || all_ < 0) return -1;

  // Ticks are coarse, so that the difference may fall below 0.
  const double others = (now - all_) - (own_seconds() - own_);
  const auto cores = static_cast<double>(sysconf(_SC_NPROCESSORS_ONLN));
  return std::clamp(others / (seconds() * cores), 0.0, 1.0);
}

}  // namespace icloth
