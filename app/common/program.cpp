#include "app/common/program.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include "sim/files/error.h"

namespace icloth {
namespace {

int fail(int code, const std::string& what) {
  std::fflush(stdout);
  std::fprintf(stderr, "icloth: %s\n", first_line(what).c_str());
  return code;
}

/// Output that was printed may still wait in a buffer for a disk that is full.
void check_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout))
    throw InputError(std::string("standard output: cannot be written (") + std::strerror(errno) +
                     ")");
}

}  // namespace

std::string first_line(const std::string& text) {
  return text.substr(0, text.find_first_of("\r\n"));
}

int run_program(const std::function<int()>& work) {
  // A file that may not grow is reported as a full disk is, and does not end the program at once.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    const int code = work();
    check_output();
    return code;
  } catch (const InputError& error) {
    return fail(2, error.what());
  } catch (const DeviceError& error) {
    return fail(3, error.what());
  } catch (const std::bad_alloc&) {
    return fail(2, "there is not enough memory for this input");
  } catch (const std::exception& error) {
    return fail(1, std::string("internal error: ") + error.what());
  }
}

}  // namespace icloth
