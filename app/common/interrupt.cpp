#include "app/common/interrupt.h"

#include <csignal>
#include <iterator>

namespace icloth {
namespace {

struct NamedSignal {
  int number;
  const char* name;
};
constexpr NamedSignal kSignals[] = {{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}};

volatile std::sig_atomic_t noted_signal = 0;
struct sigaction earlier[std::size(kSignals)];

/// A handler may do little more than this. From then on the signals act as usual.
void note_signal(int number) {
  noted_signal = number;
  for (const NamedSignal& signal : kSignals) std::signal(signal.number, SIG_DFL);
}

}  // namespace

InterruptWatch::InterruptWatch() {
  noted_signal = 0;
  for (std::size_t i = 0; i < std::size(kSignals); ++i) {
    struct sigaction action {};
    action.sa_handler = note_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);

    // A signal that is ignored, SIGHUP under nohup say, stays so.
    sigaction(kSignals[i].number, nullptr, &earlier[i]);
    if (earlier[i].sa_handler != SIG_IGN) sigaction(kSignals[i].number, &action, nullptr);
  }
}

InterruptWatch::~InterruptWatch() {
  for (std::size_t i = 0; i < std::size(kSignals); ++i)
    sigaction(kSignals[i].number, &earlier[i], nullptr);
}

const char* InterruptWatch::noted() const {
  for (const NamedSignal& signal : kSignals)
    if (signal.number == noted_signal) return signal.name;
  return nullptr;
}

}  // namespace icloth
