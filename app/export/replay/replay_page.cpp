#include "app/export/replay/replay_page.h"

#include <fmt/format.h>

#include <map>
#include <stdexcept>
#include <utility>

#include "app/export/replay/page_files.h"
#include "app/export/replay/quantise.h"
#include "app/export/replay/replay_data.h"
#include "app/export/sink/bytes.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

std::string html_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '<') {
      escaped += "&lt;";
    } else if (c == '&') {
      escaped += "&amp;";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

/// For a script element, which the text "</script" would end.
std::string script_json(const Json& json) {
  std::string escaped;
  for (const char c : json.dump(-1, ' ', true, Json::error_handler_t::replace)) {
    if (c == '<') {
      escaped += "\\u003c";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

/// The template with each {{NAME}} replaced, once: a value may hold braces.
std::string fill(std::string_view text, const std::map<std::string, std::string>& values) {
  std::string filled;
  for (;;) {
    const std::size_t begin = text.find("{{");
    filled += text.substr(0, begin);
    if (begin == std::string_view::npos) return filled;
    const std::size_t end = text.find("}}", begin);
    filled += values.at(std::string(text.substr(begin + 2, end - begin - 2)));
    text.remove_prefix(end + 2);
  }
}

}  // namespace

std::string replay_page(const Recording& recording) {
  const ReplayData data = replay_data(recording);
  std::string script;
  for (const std::string_view part : page_scripts) script += part;
  return fill(page_template, {{"title", html_text(recording.title)},
                              {"style", std::string(page_style)},
                              {"header", script_json(data.header)},
                              {"data", base64(deflate(data.bytes))},
                              {"script", script}});
}

ReplaySink::ReplaySink(const scenes::Scene& scene, const sim::World& start, int threads,
                       CameraEvents events, std::filesystem::path file)
    : recorder_(scene, start, threads, std::move(events)), file_(std::move(file)) {}

std::filesystem::path ReplaySink::finish() {
  const std::string page = replay_page(recorder_.recording());
  base::write_file_atomically(file_.string(),
                              {reinterpret_cast<const std::uint8_t*>(page.data()), page.size()});
  return file_;
}

}  // namespace pneuma::app
