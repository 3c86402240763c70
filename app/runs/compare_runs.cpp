#include "app/runs/compare_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string_view>

#include "app/host/errors.h"
#include "app/host/standard_streams.h"
#include "app/terminal/table.h"
#include "render/image/compare.h"
#include "render/image/contact_sheet.h"
#include "render/image/png.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;
constexpr int visible_difference = 24;  // of 255: what a rounding of colours never makes

/// By their number.
std::map<std::int64_t, const Json*> frames_by_number(const RecordedRun& run) {
  std::map<std::int64_t, const Json*> frames;
  for (const Json& frame : run.frames()) frames[frame["frame"].get<std::int64_t>()] = &frame;
  return frames;
}

/// Also when neither run has it.
bool same_picture(const fs::path& first, const fs::path& second) {
  if (!fs::exists(first) || !fs::exists(second)) return fs::exists(first) == fs::exists(second);
  return base::read_file(first.string()) == base::read_file(second.string());
}

/// "key = value" without its comment; the printer puts one behind every key.
std::string without_comment(const std::string& line) {
  const std::string text = line.substr(0, line.rfind(" # "));
  const std::size_t end = text.find_last_not_of(' ');
  return end == std::string::npos ? "" : text.substr(0, end + 1);
}

/// The effective scene as "section, key = value" and where its camera was in a frame; bodies,
/// springs and valves are numbered.
std::vector<std::string> settings_of(const Json& record, const Json& frame) {
  std::vector<std::string> settings;
  std::istringstream text(record["scene_toml"].get<std::string>());
  std::string section;
  std::map<std::string, int> counts;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("[[")) {
      const std::string kind = line.substr(2, line.find(']') - 2);
      section = fmt::format("{} {}, ", kind, ++counts[kind]);
    } else if (line.starts_with('[')) {
      section = line.substr(1, line.find(']') - 1) + ", ";
    } else if (line.find(" = ") != std::string::npos) {
      settings.push_back(section + without_comment(line));
    }
  }
  const auto camera = frame.find("camera");
  if (camera != frame.end()) settings.push_back("camera as placed: " + camera->dump());
  return settings;
}

/// Both scenes are printed by one printer, key by key: what only one of them has.
std::vector<std::string> different_settings(const RecordedRun& first, const RecordedRun& second,
                                            std::int64_t frame) {
  const std::array scenes = {settings_of(first.record, *frames_by_number(first).at(frame)),
                             settings_of(second.record, *frames_by_number(second).at(frame))};
  std::vector<std::string> result;
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    for (const std::string& setting : scenes[side]) {
      const auto& other = scenes[1 - side];
      if (std::ranges::find(other, setting) != other.end()) continue;
      result.push_back((side == 0 ? "A: " : "B: ") + setting);
    }
  }
  return result;
}

double value_of(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

/// Names and numbers of a frame's record.
std::vector<std::pair<std::string, double>> numbers_in(const Json& frame) {
  std::vector<std::pair<std::string, double>> numbers;
  for (const auto& [name, value] : frame["energy"].items()) {
    numbers.emplace_back("energy, " + name + ", J", value_of(value));
  }
  for (const auto& [name, value] : frame["volumes"].items()) {
    numbers.emplace_back("volume, " + name + ", m^3", value_of(value));
  }
  numbers.emplace_back("max. penetration, m", value_of(frame["greatest_penetration"]));
  numbers.emplace_back("contacts", value_of(frame["contacts"]["count"]));
  return numbers;
}

std::string frame_text(const std::optional<std::int64_t>& frame) {
  return frame ? fmt::format("frame {}", *frame) : std::string("none");
}

void print_comparison(const RunComparison& comparison, const RecordedRun& first,
                      const RecordedRun& second) {
  fmt::print("A: {}\nB: {}\n", first.folder.path().string(), second.folder.path().string());
  fmt::print("frames in both: {}; only in A: {}; only in B: {}\n", comparison.common_frames,
             comparison.only_first, comparison.only_second);
  fmt::print("first frame with another state: {}\n", frame_text(comparison.state_differs));
  fmt::print("first frame with another picture: {}\n", frame_text(comparison.picture_differs));
  if (comparison.settings.empty()) return;
  fmt::print("settings that differ:\n");
  for (const std::string& line : comparison.settings) fmt::print("  {}\n", line);
}

void print_numbers(const std::vector<ComparedNumber>& numbers, std::int64_t frame) {
  Table table({{.heading = fmt::format("frame {}", frame), .align = Table::Align::left},
               {.heading = "A"},
               {.heading = "B"},
               {.heading = "B - A"}});
  for (const ComparedNumber& number : numbers) {
    table.add_row({number.name, fmt::format("{:.9g}", number.first),
                   fmt::format("{:.9g}", number.second),
                   fmt::format("{:.3g}", number.second - number.first)});
  }
  fmt::print("\n{}", table.text());
}

/// Nothing where a picture is not there.
std::optional<std::array<render::Image, 2>> pictures_of(const RecordedRun& first,
                                                        const RecordedRun& second,
                                                        std::int64_t frame) {
  const std::array files = {first.folder.frame(frame), second.folder.frame(frame)};
  for (const fs::path& file : files) {
    if (fs::exists(file)) continue;
    print_message("{} is not there: no pictures are compared\n", file.string());
    return std::nullopt;
  }
  return std::array{render::read_png(files[0].string()), render::read_png(files[1].string())};
}

/// A, B and their difference beside each other; without the difference when their sizes differ.
void write_pictures(const std::array<render::Image, 2>& pictures, const std::string& file) {
  std::vector<render::Image> shown(pictures.begin(), pictures.end());
  const bool comparable =
      pictures[0].width == pictures[1].width && pictures[0].height == pictures[1].height;
  if (comparable) {
    const render::ImageDifference difference =
        render::compare_images(pictures[0], pictures[1], visible_difference);
    fmt::print("pictures: mean difference {:.3g} of 255, {:.3g} % of the pixels by more than {}\n",
               difference.mean, 100.0 * difference.fraction_beyond, visible_difference);
    shown.push_back(render::difference_picture(pictures[0], pictures[1]));
  } else {
    print_message("the pictures are {} x {} and {} x {}: no difference is drawn\n",
                  pictures[0].width, pictures[0].height, pictures[1].width, pictures[1].height);
  }
  const int columns = static_cast<int>(shown.size());
  const render::Image page =
      render::contact_sheet(shown, columns, 1, columns * (pictures[0].width + 16));
  base::write_file_atomically(file, render::encode_png(page));
  fmt::print("{}\n", file);
}

void check_frame_number(const RecordedRun& first, const RecordedRun& second, std::int64_t frame) {
  const auto firsts = frames_by_number(first);
  const auto seconds = frames_by_number(second);
  if (firsts.contains(frame) && seconds.contains(frame)) return;
  throw UsageError(
      fmt::format("--frame: not both runs have frame {}; A has {} to {}, B has {} to {}", frame,
                  firsts.begin()->first, firsts.rbegin()->first, seconds.begin()->first,
                  seconds.rbegin()->first));
}

bool is_png(const fs::path& file) {
  constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
  std::string begin(signature.size(), ' ');
  std::ifstream(file, std::ios::binary).read(begin.data(), std::ssize(begin));
  return begin == signature;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw base::IoError(fmt::format("{}: {}", folder.string(), error.message()));
}

/// The last part of a folder's path.
std::string name_of(const RecordedRun& run) {
  std::error_code unreadable;
  return fs::weakly_canonical(run.folder.path(), unreadable).filename().string();
}

/// Where nothing is lost by it but another picture of this kind.
fs::path checked_output(const CompareRequest& request, const RecordedRun& first,
                        const RecordedRun& second) {
  const fs::path out =
      request.out.empty()
          ? fs::path("out") / "compare" / fmt::format("{}_{}.png", name_of(first), name_of(second))
          : fs::path(request.out);
  std::error_code unreadable;
  if (!fs::exists(out, unreadable)) return out;
  const fs::path place = fs::weakly_canonical(out, unreadable).parent_path();
  for (const RecordedRun* run : {&first, &second}) {
    if (place != fs::weakly_canonical(run->folder.path(), unreadable)) continue;
    throw UsageError(fmt::format("--out {}: the file is part of a run; write into another folder",
                                 out.string()));
  }
  if (is_png(out)) return out;
  throw base::IoError(
      fmt::format("{}: this is no picture, and would be lost; remove it, or give "
                  "another file by --out",
                  out.string()));
}

}  // namespace

RunComparison compare_runs(const RecordedRun& first, const RecordedRun& second) {
  const auto firsts = frames_by_number(first);
  const auto seconds = frames_by_number(second);
  RunComparison comparison;
  for (const auto& [number, frame] : firsts) {
    const auto found = seconds.find(number);
    if (found == seconds.end()) continue;
    if (comparison.common_frames++ == 0) comparison.first_common = number;
    comparison.last_common = number;
    if (!comparison.state_differs && (*frame)["state_hash"] != (*found->second)["state_hash"]) {
      comparison.state_differs = number;
    }
    if (!comparison.picture_differs &&
        !same_picture(first.folder.frame(number), second.folder.frame(number))) {
      comparison.picture_differs = number;
    }
  }
  if (comparison.common_frames == 0) {
    throw base::IoError(fmt::format("{} and {} have no frame in common",
                                    first.folder.path().string(), second.folder.path().string()));
  }
  comparison.only_first = static_cast<std::int64_t>(firsts.size()) - comparison.common_frames;
  comparison.only_second = static_cast<std::int64_t>(seconds.size()) - comparison.common_frames;
  comparison.settings = different_settings(first, second, comparison.first_common);
  return comparison;
}

std::vector<ComparedNumber> numbers_of(const RecordedRun& first, const RecordedRun& second,
                                       std::int64_t frame) {
  const auto others = numbers_in(*frames_by_number(second).at(frame));
  std::vector<ComparedNumber> result;
  for (const auto& [name, value] : numbers_in(*frames_by_number(first).at(frame))) {
    const auto other = std::ranges::find(others, name, &std::pair<std::string, double>::first);
    if (other != others.end()) result.push_back({name, value, other->second});
  }
  return result;
}

ExitCode compare_run_folders(const CompareRequest& request) {
  const RecordedRun first = read_run(request.first);
  const RecordedRun second = read_run(request.second);
  const fs::path out = checked_output(request, first, second);
  const RunComparison comparison = compare_runs(first, second);
  if (request.frame) check_frame_number(first, second, *request.frame);
  const std::int64_t frame = request.frame.value_or(comparison.state_differs.value_or(
      comparison.picture_differs.value_or(comparison.last_common)));
  print_comparison(comparison, first, second);
  print_numbers(numbers_of(first, second, frame), frame);
  if (const auto pictures = pictures_of(first, second, frame)) {
    if (request.out.empty()) make_folder(out.parent_path());
    write_pictures(*pictures, out.string());
  }
  return request.expect_equal && !comparison.equal() ? ExitCode::check_failed : ExitCode::done;
}

}  // namespace pneuma::app
