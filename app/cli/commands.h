// The command line: commands, options, exit codes.
#pragma once

namespace icloth {

/// Runs one command. Exit codes: 0 done, 1 the run or check found what it must not, 2 bad usage or
/// input, 3 device or display missing. Errors are one line on stderr.
int run_command_line(int argc, const char* const* argv);

}  // namespace icloth
