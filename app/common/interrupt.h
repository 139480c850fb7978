// Ctrl-C and its kin end a run in order.
#pragma once

namespace icloth {

/// While one lives, the first SIGINT, SIGTERM or SIGHUP is noted, and the second ends the program
/// as usual. One at a time.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  /// "SIGINT", "SIGTERM" or "SIGHUP"; null: none came yet.
  const char* noted() const;
};

}  // namespace icloth
