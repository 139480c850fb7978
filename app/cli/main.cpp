#include "app/cli/commands.h"
#include "sim/files/body_io.h"

int main(int argc, char** argv) {
  // This program runs itself again to read bodies.
  if (const auto code = icloth::serve_body_reader(argc, argv)) return *code;
  return icloth::run_command_line(argc, argv);
}
