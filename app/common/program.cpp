#include "app/common/program.h"

#include <cstdio>
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

}  // namespace

std::string first_line(const std::string& text) {
  return text.substr(0, text.find_first_of("\r\n"));
}

int run_program(const std::function<int()>& work) {
  try {
    return work();
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
