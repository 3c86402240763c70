#include "app/host/version.h"

#include <fmt/format.h>
#include <isa-l.h>
#include <libdeflate.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "app/host/build_info.h"
#include "render/context/context.h"
#include "render/context/load_gl.h"

namespace pneuma::app {

namespace {

/// "4.5 (Core Profile) Mesa 22.3.6". Mesa is a shared library: which it is, is known when it runs.
std::string gl_version() {
  try {
    return render::Context().report().version;
  } catch (const render::GlError& error) {
    return error.what();
  }
}

}  // namespace

Version version() {
  return {PNEUMA_VERSION, PNEUMA_COMMIT, PNEUMA_COMPILER, PNEUMA_BUILD_TYPE, PNEUMA_FLAGS};
}

bool is_debug_build() {
#ifdef __OPTIMIZE__
  return std::string(PNEUMA_FLAGS).find("-fsanitize") != std::string::npos;
#else
  return true;
#endif
}

std::vector<std::pair<std::string, std::string>> library_versions() {
  return {
      {"Eigen",
       fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"GLEW", render::glew_version()},
      {"fmt",
       fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
      {"nlohmann-json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                    NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
      {"CLI11", CLI11_VERSION},
      {"libdeflate", LIBDEFLATE_VERSION_STRING},
      {"ISA-L",
       fmt::format("{}.{}.{}", ISAL_MAJOR_VERSION, ISAL_MINOR_VERSION, ISAL_PATCH_VERSION)},
  };
}

std::string version_text() {
  const Version built = version();
  std::string text = fmt::format("pneuma {}\n", built.program);
  const auto add = [&](const std::string& name, const std::string& value) {
    text += fmt::format("  {:<14} {}\n", name, value.empty() ? "not known" : value);
  };
  add("commit", built.commit);
  add("compiler", built.compiler);
  add("build", built.build_type + (built.flags.empty() ? "" : " " + built.flags));
  add("OpenGL", gl_version());
  for (const auto& [name, number] : library_versions()) add(name, number);
  text.pop_back();  // the last line's end is printed with it
  return text;
}

}  // namespace pneuma::app
