// The main function of the tests. Reading a body runs the program again, hence this one and not
// that of GoogleTest.
#include <gtest/gtest.h>

#include "sim/files/body_io.h"

int main(int argc, char** argv) {
  if (const auto code = icloth::serve_body_reader(argc, argv)) return *code;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
