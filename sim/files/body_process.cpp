// Why a new program and not a fork of this one: when a body is read, oneTBB's threads, the window
// and a GPU may exist, and a forked child of such a process may only call async-signal-safe
// functions; assimp allocates memory in its first line. posix_spawn of /proc/self/exe starts from a
// clean image, in which the limits are set before anything is read, and costs a few milliseconds.
#include "sim/files/body_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>

#include "sim/files/error.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kMegabyte = std::uint64_t{1} << 20;
constexpr std::uint64_t kStack = 8 * kMegabyte;

// Sanitizers reserve terabytes of address space and slow everything down.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
#else
constexpr bool kSanitized = false;
#endif

void lower_limit(int resource, rlim_t value) {
  rlimit limit{};
  getrlimit(static_cast<__rlimit_resource>(resource), &limit);
  limit.rlim_cur = std::min(limit.rlim_cur, value);
  limit.rlim_max = std::min(limit.rlim_max, value);
  setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

/// Address space of this process [bytes].
std::uint64_t mapped_bytes() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

/// The pipe between both processes; what is still open is closed at the end.
struct Pipe {
  int ends[2] = {-1, -1};  // read, write

  Pipe() {
    if (pipe2(ends, O_CLOEXEC) != 0)
      throw InputError(std::string("no pipe to the reader of bodies (") + std::strerror(errno) +
                       ")");
  }
  ~Pipe() {
    for (int k : {0, 1}) close_end(k);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  void close_end(int k) {
    if (ends[k] >= 0) close(ends[k]);
    ends[k] = -1;
  }
};

/// Starts `PROGRAM verb path` with the write end as kResultFile and no other file of ours.
pid_t spawn(const char* verb, const std::string& path, const Pipe& pipe) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);

  // The result may land on 0, 1 or 2 in a program that closed those: it moves first.
  posix_spawn_file_actions_adddup2(&actions, pipe.ends[1], kResultFile);
  for (int k : {0, 1, 2})
    posix_spawn_file_actions_addopen(&actions, k, "/dev/null", k == 0 ? O_RDONLY : O_WRONLY, 0);
  posix_spawn_file_actions_addclosefrom_np(&actions, kResultFile + 1);

  // posix_spawn takes its words as char*, though it does not change them.
  std::string words[] = {"icloth", verb, path};
  char* const arguments[] = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  pid_t child = -1;
  const int error = posix_spawn(&child, "/proc/self/exe", &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    throw InputError(shown_path(path) + ": the reader of bodies cannot be started (" +
                     std::strerror(error) + ")");
  return child;
}

/// Reads to the end of the pipe; returns why it stopped before, or "".
std::string receive(int file, const ProcessLimits& limits, std::string& bytes) {
  const auto deadline = Clock::now() + std::chrono::seconds(2 * limits.seconds);
  char piece[1 << 16];
  for (;;) {
    // Wait for more, but no longer than the time that is left.
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0)
      return "was not read within " + std::to_string(2 * limits.seconds) + " s";
    pollfd wait{file, POLLIN, 0};
    const int ready = poll(&wait, 1, static_cast<int>(std::min<long>(left.count(), 60'000)));
    if (ready <= 0) continue;

    // Nothing is kept beyond the limit, however much the child sends.
    const ssize_t count = read(file, piece, sizeof piece);
    if (count == 0) return "";
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return std::string("was not read (") + std::strerror(errno) + ")";
    if (bytes.size() + static_cast<std::size_t>(count) > limits.result)
      return "holds more than " + std::to_string(limits.result / kMegabyte) +
             " MB of triangles, too many for its size";
    bytes.append(piece, static_cast<std::size_t>(count));
  }
}

/// Why a child that ended by itself has no result, "" where it has one.
std::string reason_of(int status, const ProcessLimits& limits) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGXCPU || signal == SIGKILL)
    return "was not read within " + std::to_string(limits.seconds) + " s of processor time";
  return "cannot be read: its reader crashed, the file is broken or nested too deeply";
}

}  // namespace

bool limits_memory() { return !kSanitized; }

ProcessLimits limits_for(std::uint64_t file_bytes) {
  const std::uint64_t slow = kSanitized ? 10 : 1;
  return {.memory = 640 * kMegabyte + 40 * file_bytes,
          .result = 64 * kMegabyte + 40 * file_bytes,
          .seconds = slow * (4 + file_bytes / (4 * kMegabyte))};
}

ProcessResult run_own_program(const char* verb, const std::string& path,
                              const ProcessLimits& limits) {
  Pipe pipe;
  const pid_t child = spawn(verb, path, pipe);
  pipe.close_end(1);  // so that the end of the child is the end of the data

  // A child that is too slow or sends too much is ended; one that has ended is not there to kill,
  // but keeps its number until it is waited for.
  ProcessResult result;
  result.failure = receive(pipe.ends[0], limits, result.bytes);
  if (!result.failure.empty()) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (result.failure.empty()) result.failure = reason_of(status, limits);
  return result;
}

void enter_limits(const ProcessLimits& limits) {
  // A parent that is killed takes the child with it.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  lower_limit(RLIMIT_CORE, 0);
  lower_limit(RLIMIT_FSIZE, 0);  // it writes to the pipe alone
  lower_limit(RLIMIT_STACK, kStack);
  lower_limit(RLIMIT_CPU, limits.seconds);
  if (limits_memory()) lower_limit(RLIMIT_AS, mapped_bytes() + limits.memory);
}

bool send_result(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(kResultFile, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace icloth
