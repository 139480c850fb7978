// Whether a measurement had the machine to itself.
#pragma once

#include <chrono>

namespace icloth {

/// A machine is quiet while others use at most this share of its cores.
inline constexpr double kMostOthers = 0.1;

/// Watches the processor from its construction on.
class ProcessorWatch {
 public:
  ProcessorWatch();

  /// Wall time since then [s].
  double seconds() const;
  /// Share of so many cores that this process has used.
  double own_share(int threads) const;
  /// Share of all cores that everything else has used; −1 where the system does not tell.
  double others_share() const;

 private:
  std::chrono::steady_clock::time_point begin_;
  double own_, all_;  ///< processor time of this process, and of all together [s]
};

}  // namespace icloth
