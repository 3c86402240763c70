#include "scenes/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace pneuma::scenes {
namespace {

constexpr std::size_t most_diagnostics = 100;

std::string joined(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) {
    if (!text.empty()) text += '\n';
    text += to_string(diagnostic);
  }
  return text;
}

}  // namespace

std::string to_string(const Diagnostic& diagnostic) {
  if (diagnostic.line == 0) return fmt::format("{}: {}", diagnostic.file, diagnostic.message);
  return fmt::format("{}:{}:{}: {}", diagnostic.file, diagnostic.line, diagnostic.column,
                     diagnostic.message);
}

SceneError::SceneError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(joined(diagnostics)), diagnostics_(std::move(diagnostics)) {}

Report::Report(std::string file, std::span<const std::string> overrides)
    : file_(std::move(file)), overrides_(overrides) {}

void Report::add(Origin origin, std::string message) {
  entries_.push_back({origin, std::move(message)});
}

bool Report::blames_override(int override_index) const {
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.origin.override_index == override_index;
  });
}

void Report::throw_errors() {
  if (entries_.empty()) return;
  const auto rank = [](const Entry& entry) {
    const Origin& at = entry.origin;
    return std::tie(at.override_index, at.line, at.column);
  };
  std::stable_sort(entries_.begin(), entries_.end(),
                   [&](const Entry& a, const Entry& b) { return rank(a) < rank(b); });

  // An override of every body can be wrong for each of them; its first error says enough.
  const auto last =
      std::unique(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        const bool same_override = a.origin.override_index == b.origin.override_index;
        return same_override && a.origin.override_index >= 0;
      });
  entries_.erase(last, entries_.end());

  std::vector<Diagnostic> diagnostics;
  for (const Entry& entry : entries_) {
    if (diagnostics.size() == most_diagnostics) {
      const std::size_t more = entries_.size() - most_diagnostics;
      diagnostics.push_back({file_, 0, 0, fmt::format("{} more errors are not shown", more)});
      break;
    }
    diagnostics.push_back(diagnostic(entry));
  }
  throw SceneError(std::move(diagnostics));
}

Diagnostic Report::diagnostic(const Entry& entry) const {
  const Origin& at = entry.origin;
  if (at.override_index < 0) return {file_, at.line, at.column, entry.message};
  const std::string& text = overrides_[static_cast<std::size_t>(at.override_index)];
  return {"--set " + text, 0, 0, entry.message};
}

}  // namespace pneuma::scenes
