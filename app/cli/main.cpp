#include "app/cli/commands.h"

int main(int argc, char** argv) { return icloth::run_command_line(argc, argv); }
