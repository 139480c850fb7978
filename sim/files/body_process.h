// A child process with limits that reads one untrusted file for this program.
#pragma once

#include <cstdint>
#include <string>

namespace icloth {

/// Limits on the reading of one file.
struct ProcessLimits {
  std::uint64_t memory = 0;   ///< address space beyond what the program itself maps [bytes]
  std::uint64_t result = 0;   ///< [bytes] sent back
  std::uint64_t seconds = 0;  ///< of processor time; twice as many by the clock
};

/// Limits for a file of so many bytes: a constant that small files never need, and a share that
/// grows with the file.
ProcessLimits limits_for(std::uint64_t file_bytes);

/// False in builds with sanitizers, which reserve terabytes of address space: there a child may
/// take any amount of memory.
bool limits_memory();

/// How the child ended, and what it sent.
struct ProcessResult {
  std::string bytes;    ///< all that it sent; meaningful where `failure` is empty
  std::string failure;  ///< why there is no result, a clause for a message: "crashed while …"
};

/// Runs this program again as `PROGRAM verb path`, waits for it, and returns what it wrote to
/// kResultFile. Throws InputError when no process can be started.
ProcessResult run_own_program(const char* verb, const std::string& path,
                              const ProcessLimits& limits);

/// Descriptor that the child writes its result to.
inline constexpr int kResultFile = 3;

/// In the child, before the file is touched: the limits take effect for the rest of its life.
void enter_limits(const ProcessLimits& limits);

/// In the child: writes everything to kResultFile; false when nobody reads it any more.
bool send_result(std::string_view bytes);

}  // namespace icloth
