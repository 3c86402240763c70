#include "app/render/log/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>

#include "sim/base/file.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, int error) {
  const char* advice = error == ENOSPC || error == EFBIG || error == EDQUOT
                           ? "free some space and continue with --resume"
                           : "choose a folder you may write to with --out";
  throw base::IoError(
      fmt::format("cannot write {}: {}; {}", path.string(), std::strerror(error), advice));
}

}  // namespace

std::optional<JournalContents> read_journal(const fs::path& path) {
  if (!fs::exists(path)) return std::nullopt;
  const auto bytes = base::read_file(path.string());
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());

  std::optional<JournalContents> contents;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string_view::npos) break;
    Json line = Json::parse(text.substr(begin, end - begin), nullptr, false);
    if (!line.is_object()) break;
    begin = end + 1;
    if (!contents) {
      contents = JournalContents{std::move(line), {}, {}, begin};
    } else {
      contents->lines.push_back(std::move(line));
      contents->ends.push_back(begin);
    }
  }
  return contents;
}

Journal::Journal(const fs::path& path, std::uint64_t keep) : path_(path) {
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(path_, errno);
  // Some file systems have no locks (ENOLCK): there nothing watches over this.
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(descriptor_);
    throw base::IoError(fmt::format(
        "{} is being written by another run; wait for it or choose another folder with --out",
        path_.string()));
  }
  if (ftruncate(descriptor_, static_cast<off_t>(keep)) != 0) {
    const int error = errno;
    close(descriptor_);
    fail(path_, error);
  }
}

Journal::~Journal() { close(descriptor_); }

void Journal::append(const Json& line) {
  const std::string text = line.dump() + "\n";
  std::string_view rest = text;
  while (!rest.empty()) {
    const ssize_t written = write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path_, errno);
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
}

bool is_in_use(const fs::path& journal) {
  const int descriptor = open(journal.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool locked = flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  return locked;
}

}  // namespace pneuma::app
