#include "scenes/loader/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "sim/base/nearest.h"

namespace pneuma::scenes {
namespace {

constexpr std::size_t most_diagnostics = 100;
constexpr std::size_t longest_shown_line = 100;
constexpr std::string_view file_mark = "\xef\xbb\xbf";

Diagnostic more_errors(std::string file, std::size_t count) {
  return {std::move(file), 0, 0, fmt::format("{} more errors are not shown", count)};
}

std::string joined(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) {
    if (!text.empty()) text += '\n';
    text += with_source_line(diagnostic);
  }
  return text;
}

/// Line `number` of a text, counted from 1, without its end.
std::string line_of(std::string_view text, int number) {
  if (text.starts_with(file_mark)) text.remove_prefix(file_mark.size());
  for (; number > 1; --number) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  text = text.substr(0, text.find('\n'));
  if (text.ends_with('\r')) text.remove_suffix(1);
  return std::string(text);
}

bool continues_letter(char c) { return (static_cast<unsigned char>(c) & 0xc0u) == 0x80u; }

/// The part of a line that is shown, and blanks up to the column: `column` counts from 1.
struct MarkedLine {
  std::string text;
  std::string blanks;
};

MarkedLine marked_line(std::string_view line, int column) {
  const std::size_t at = std::min(static_cast<std::size_t>(std::max(column, 1)) - 1, line.size());
  std::size_t begin = at < longest_shown_line ? 0 : at - longest_shown_line / 2;
  while (begin < at && continues_letter(line[begin])) ++begin;
  const std::size_t end = std::min(begin + longest_shown_line, line.size());
  MarkedLine marked;
  if (begin > 0) marked = {"...", "   "};
  std::size_t i = begin;
  while (i < end) {
    const bool is_tab = line[i] == '\t';
    const std::size_t size = base::letter_size(line.substr(i));
    marked.text += is_tab ? "\t" : size > 0 ? line.substr(i, size) : "?";
    // A tab is as wide below as above.
    if (i < at) marked.blanks += is_tab ? '\t' : ' ';
    i += std::max<std::size_t>(size, 1);
  }
  if (i < line.size()) marked.text += "...";
  return marked;
}

}  // namespace

std::string with_source_line(const Diagnostic& diagnostic) {
  const std::string text = to_string(diagnostic);
  if (diagnostic.source_line.empty()) return text;
  const MarkedLine marked = marked_line(diagnostic.source_line, diagnostic.column);
  const std::string number = fmt::format("{:>5}", diagnostic.line);
  return fmt::format("{}\n{} | {}\n{:{}} | {}^", text, number, marked.text, "", number.size(),
                     marked.blanks);
}

std::string to_string(const Diagnostic& diagnostic) {
  if (diagnostic.line == 0) return fmt::format("{}: {}", diagnostic.file, diagnostic.message);
  return fmt::format("{}:{}:{}: {}", diagnostic.file, diagnostic.line, diagnostic.column,
                     diagnostic.message);
}

Diagnostic diagnostic_at(const Place& place, std::string message) {
  return {place.file, place.line, place.column, std::move(message), place.source_line};
}

Diagnostic diagnostic_at(const Scene& scene, Place place, std::string message) {
  if (place.file.empty()) place.file = (scene.folder / (scene.name + ".toml")).string();
  return diagnostic_at(place, std::move(message));
}

SceneError::SceneError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(joined(diagnostics)), diagnostics_(std::move(diagnostics)) {}

Report::Report(std::string file, std::string_view text, std::span<const std::string> overrides)
    : file_(std::move(file)), text_(text), overrides_(overrides) {}

void Report::add(Origin origin, std::string message) {
  entries_.push_back({origin, std::move(message)});
}

void Report::warn(const Origin& origin, std::string message) {
  warnings_.push_back(to_string(diagnostic_at(place(origin), "warning: " + message)));
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
      diagnostics.push_back(more_errors(file_, entries_.size() - most_diagnostics));
      break;
    }
    diagnostics.push_back(diagnostic_at(place(entry.origin), entry.message));
  }
  throw SceneError(std::move(diagnostics));
}

Place Report::place(const Origin& at) const {
  if (at.override_index < 0) {
    return {file_, at.line, at.column, at.of_whole_file ? "" : line_of(text_, at.line)};
  }
  return {"--set " + overrides_[static_cast<std::size_t>(at.override_index)], 0, 0, ""};
}

void Refusals::add(const SceneError& error) {
  diagnostics_.insert(diagnostics_.end(), error.diagnostics().begin(), error.diagnostics().end());
}

void Refusals::throw_errors() {
  if (diagnostics_.empty()) return;
  std::ranges::stable_sort(diagnostics_, {}, [](const Diagnostic& at) {
    return std::tuple(at.line == 0, at.line, at.column);  // those of overrides last
  });
  if (diagnostics_.size() > most_diagnostics) {
    const std::size_t more = diagnostics_.size() - most_diagnostics;
    diagnostics_.resize(most_diagnostics);
    diagnostics_.push_back(more_errors(diagnostics_.front().file, more));
  }
  throw SceneError(std::move(diagnostics_));
}

}  // namespace pneuma::scenes
