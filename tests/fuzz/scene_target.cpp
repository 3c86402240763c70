#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "tests/fuzz/targets.h"
#include "tests/scenes/same_scene.h"

namespace pneuma::fuzz {
namespace {

constexpr const char* file_name = "fuzzed.toml";

void check_complaint(const scenes::Diagnostic& complaint, std::string_view text) {
  const std::string whole = scenes::to_string(complaint);
  if (complaint.message.empty()) throw std::logic_error("a complaint without words: " + whole);
  const auto strange = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (std::any_of(complaint.message.begin(), complaint.message.end(), strange)) {
    throw std::logic_error("a message with control characters: " + whole);
  }
  if (complaint.file != file_name || complaint.line == 0) return;
  const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
  const bool in_file = complaint.line >= 1 && complaint.line <= lines && complaint.column >= 1;
  if (!in_file) throw std::logic_error("a place outside of the file: " + whole);
}

void check_round_trip(const scenes::Scene& scene) {
  const std::string printed = scenes::print_scene(scene);
  const scenes::Scene again = [&] {
    try {
      return scenes::parse_scene(printed, file_name);
    } catch (const scenes::SceneError& error) {
      throw std::logic_error(fmt::format("printed, but refused: {}\n{}", error.what(), printed));
    }
  }();
  const std::string differs = scenes::difference(scene, again);
  if (!differs.empty()) throw std::logic_error(fmt::format("{} differs:\n{}", differs, printed));
  if (scenes::print_scene(again) != printed)
    throw std::logic_error("printed otherwise: " + printed);
}

}  // namespace

void try_scene(std::string_view bytes) {
  std::vector<std::string> pieces;
  for (std::size_t start = 0; start <= bytes.size();) {
    const std::size_t end = std::min(bytes.find('\0', start), bytes.size());
    pieces.emplace_back(bytes.substr(start, end - start));
    start = end + 1;
  }
  const std::string text = pieces.front();
  pieces.erase(pieces.begin());
  try {
    check_round_trip(scenes::parse_scene(text, file_name, pieces));
  } catch (const scenes::SceneError& error) {
    if (error.diagnostics().empty()) throw std::logic_error("refused without a reason");
    for (const scenes::Diagnostic& complaint : error.diagnostics())
      check_complaint(complaint, text);
  }
}

}  // namespace pneuma::fuzz
