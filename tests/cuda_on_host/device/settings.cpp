#include "tests/cuda_on_host/device/settings.h"

#include <cstdlib>
#include <string>

#include "tests/cuda_on_host/device/complaint.h"

namespace cuda_on_host {
namespace {

unsigned long number(const char* name, unsigned long otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr && *text != '\0' ? std::strtoul(text, nullptr, 0) : otherwise;
}

Order order_from_environment() {
  const char* text = std::getenv("CUDA_ON_HOST_ORDER");
  const std::string order = text != nullptr ? text : "forward";
  if (order == "forward") return Order::forward;
  if (order == "backward") return Order::backward;
  if (order == "random") return Order::random;
  complain("CUDA_ON_HOST_ORDER is '%s', expected forward, backward or random", text);
}

Settings from_environment() {
  Settings s;
  s.order = order_from_environment();
  s.seed = number("CUDA_ON_HOST_SEED", s.seed);
  s.turns = static_cast<unsigned>(number("CUDA_ON_HOST_TURNS", s.turns));
  s.devices = static_cast<unsigned>(number("CUDA_ON_HOST_DEVICES", s.devices));
  s.processors = static_cast<unsigned>(number("CUDA_ON_HOST_PROCESSORS", s.processors));
  s.resident = static_cast<unsigned>(number("CUDA_ON_HOST_RESIDENT", s.resident));
  s.poison = static_cast<unsigned char>(number("CUDA_ON_HOST_POISON", s.poison));
  s.deferred = number("CUDA_ON_HOST_DEFERRED", 0) != 0;
  s.guarded = number("CUDA_ON_HOST_GUARDED", 0) != 0;
  if (s.devices > 1) complain("CUDA_ON_HOST_DEVICES is %u, expected 0 or 1", s.devices);
  if (s.turns == 0 || s.processors == 0 || s.resident == 0)
    complain("CUDA_ON_HOST_TURNS, _PROCESSORS and _RESIDENT must be at least 1");
  return s;
}

}  // namespace

Settings& settings() {
  static Settings all = from_environment();
  return all;
}

std::uint64_t random_number() {
  // SplitMix64: a counter whose bits are mixed.
  static std::uint64_t counter = 0;
  std::uint64_t z = settings().seed * 0xd1342543de82ef95ull + ++counter * 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

std::int64_t nth(std::int64_t n, std::int64_t i, std::int64_t start) {
  switch (settings().order) {
    case Order::backward:
      return n - 1 - i;
    case Order::random:
      return (i + start % n) % n;
    case Order::forward:
      break;
  }
  return i;
}

}  // namespace cuda_on_host
