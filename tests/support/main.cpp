// The main function of the tests. Reading a body runs the program again, hence this one and not
// that of GoogleTest.
#include <gtest/gtest.h>

#include <cstring>
#include <new>
#include <string>
#include <vector>

#include "sim/files/body_io.h"
#include "sim/files/body_process.h"

namespace {

/// In a child of a test that takes the limits of body readers upon itself: works without an end, or
/// takes memory until it gets no more and tells how much it got. Anything else: −1.
int misbehave(const std::string& verb) {
  constexpr std::size_t kMegabyte = std::size_t{1} << 20;
  icloth::enter_limits({.memory = 100 * kMegabyte, .result = kMegabyte, .seconds = 1});
  if (verb == "--icloth-test-spin") {
    volatile bool never = false;  // so that no compiler takes the loop away
    while (!never) {
    }
  }
  if (verb != "--icloth-test-grow") return -1;
  std::vector<std::vector<char>> taken;
  try {
    for (;;) taken.emplace_back(kMegabyte, '\1');
  } catch (const std::bad_alloc&) {
    const std::string count = std::to_string(taken.size());
    taken.clear();
    return icloth::send_result(count) ? 0 : 1;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::strncmp(argv[1], "--icloth-test-", 14) == 0) return misbehave(argv[1]);
  if (const auto code = icloth::serve_body_reader(argc, argv)) return *code;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
