#include "app/cli/commands/bench.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "sim/files/error.h"

namespace icloth {

namespace fs = std::filesystem;

int run_bench_program(const std::vector<std::string>& words) {
  // The program lies beside this one, whatever the working folder and PATH are.
  std::error_code error;
  const std::string program =
      (fs::read_symlink("/proc/self/exe", error).parent_path() / "icloth-bench").string();
  if (!fs::exists(program, error))
    throw InputError("bench: " + program +
                     " is not built; './run.sh bench' builds it, or 'cmake --build build --target "
                     "icloth-bench'");

  // execv takes pointers that may be written through, and never does so.
  std::vector<char*> arguments{const_cast<char*>(program.c_str())};
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execv(program.c_str(), arguments.data());
  throw InputError("bench: " + program + " cannot be started: " + std::strerror(errno));
}

}  // namespace icloth
