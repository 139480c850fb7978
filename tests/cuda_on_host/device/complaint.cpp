#include "tests/cuda_on_host/device/complaint.h"

#include <execinfo.h>
#include <unistd.h>

#include <cstdarg>
#include <cstdio>

namespace cuda_on_host {

const char* running_operation = nullptr;

void complain(const char* format, ...) {
  std::fflush(stdout);
  std::fprintf(stderr, "cuda_on_host: %s: ", running_operation ? running_operation : "host");
  va_list arguments;
  va_start(arguments, format);
  std::vfprintf(stderr, format, arguments);
  va_end(arguments);
  std::fprintf(stderr, "\n");
  print_calls();
  _exit(kComplaint);
}

void print_calls() {
  void* calls[60];
  backtrace_symbols_fd(calls, backtrace(calls, 60), STDERR_FILENO);
}

}  // namespace cuda_on_host
