#include "assets/sandbox.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>
#include <optional>
#include <system_error>

#include "assets/model.h"

namespace pneuma::assets {
namespace {

// How the copy ends.
constexpr int answered = 0;
constexpr int refused = 101;  // the answer is an error's text; sanitizers end with 1
constexpr int out_of_memory = 102;

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

/// Bytes of address space in use, as Linux counts them: with a sanitizer they are many terabytes.
std::optional<rlim_t> address_space() {
  std::ifstream statm("/proc/self/statm");
  rlim_t pages = 0;
  if (!(statm >> pages)) return std::nullopt;
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

void limit(__rlimit_resource resource, rlim_t most) {
  // One above, so that the processor's limit ends in a signal of its own.
  const rlimit both{most, most + 1};
  // A limit that is lower already stays.
  setrlimit(resource, &both);
}

void become_harmless(const ApartLimits& limits) {
  // It does not outlive the program that wants its answer.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE}) ::signal(signal, SIG_DFL);
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, stream);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);  // it writes no files
  limit(RLIMIT_CPU, static_cast<rlim_t>(limits.seconds));
  if (const auto now = address_space()) limit(RLIMIT_AS, *now + limits.memory);
}

void write_all(int to, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(to, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;  // nobody listens any more
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// Ends without what a program does at its end: buffers and objects belong to the original.
[[noreturn]] void work_and_end(const std::function<std::string()>& work, const ApartLimits& limits,
                               int to) {
  int result = answered;
  try {
    become_harmless(limits);
    write_all(to, work());
  } catch (const std::bad_alloc&) {
    result = out_of_memory;
  } catch (const std::exception& error) {
    write_all(to, error.what());
    result = refused;
  } catch (...) {
    write_all(to, "an error without a name");
    result = refused;
  }
  _exit(result);
}

/// Up to one byte more than `most`.
std::string read_all(int from, std::size_t most) {
  std::string text;
  std::array<char, 64 * 1024> buffer;
  while (text.size() <= most) {
    const ssize_t count = ::read(from, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  return text;
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) fail("cannot wait for the importer");
  }
  return status;
}

[[noreturn]] void refuse_end(int status, const ApartLimits& limits) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == out_of_memory) {
    throw ModelError(
        fmt::format("the importer asked for more than {} MiB of memory; the file is damaged, or "
                    "the model far too large",
                    limits.memory >> 20));
  }
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
    throw ModelError(
        fmt::format("the importer did not come to an end within {} seconds; the file is damaged",
                    limits.seconds));
  }
  throw ModelError(fmt::format(
      "the importer broke down over the file ({}); it is damaged, or needs what the importer "
      "cannot do. Save the model again, best as PLY or OBJ",
      WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : "no answer"));
}

}  // namespace

std::string run_in_sandbox(const std::function<std::string()>& work, const ApartLimits& limits) {
  std::array<int, 2> ends = {};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) fail("cannot make a pipe to the importer");
  Descriptor from(ends[0]), to(ends[1]);
  const pid_t child = fork();
  if (child < 0) fail("cannot start the importer");
  if (child == 0) {
    from.close();
    work_and_end(work, limits, to.number());
  }
  to.close();
  std::string answer = read_all(from.number(), limits.answer);
  from.close();  // ends a copy that still writes
  const int status = wait_for(child);
  if (answer.size() > limits.answer) throw ModelError("the model is too large; simplify it");
  if (!WIFEXITED(status)) refuse_end(status, limits);
  if (WEXITSTATUS(status) == answered) return answer;
  if (WEXITSTATUS(status) == refused) throw ModelError(answer);
  refuse_end(status, limits);
}

}  // namespace pneuma::assets
