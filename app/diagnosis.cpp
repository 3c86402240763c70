#include "app/diagnosis.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "app/find_program.h"
#include "app/find_scene.h"
#include "app/machine.h"
#include "app/scene_catalogue.h"
#include "app/timing_conditions.h"
#include "app/version.h"
#include "render/context/context.h"
#include "render/image/file.h"
#include "render/image/png.h"
#include "render/renderer.h"
#include "scenes/load_scene.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;
using State = Finding::State;

std::string gl_remedy(render::GlFailure failure) {
  switch (failure) {
    case render::GlFailure::switched_off:
      return "unset PNEUMA_GL";
    case render::GlFailure::context_refused:
    case render::GlFailure::functions_missing:
    case render::GlFailure::version_too_old:
    case render::GlFailure::pixels_wrong:
    case render::GlFailure::shader_refused:
      break;
  }
  return "sudo apt-get install --reinstall libosmesa6, and unset MESA_* and GALLIUM_* variables";
}

/// A context, the shaders, and a picture, which the PNG check then writes.
Finding check_gl(render::Image& picture) {
  Finding finding{.subject = "OpenGL"};
  try {
    render::Renderer renderer({.width = 64, .height = 48});
    renderer.draw(render::Frame{}, picture);
    finding.detail = renderer.description();
  } catch (const render::GlError& error) {
    finding.state = State::broken;
    finding.detail = error.what();
    finding.remedy = gl_remedy(error.failure());
    finding.code = ExitCode::no_gl;
  }
  return finding;
}

/// Something to write where there is no GL to draw with.
render::Image plain_picture() {
  return {.width = 2, .height = 1, .pixels = {255, 0, 0, 0, 0, 255}};
}

Finding check_png(render::Image picture) {
  if (picture.pixels.empty()) picture = plain_picture();
  Finding finding{.subject = "PNG files"};
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  const std::string path = (folder / fmt::format("pneuma_doctor_{}.png", getpid())).string();
  try {
    if (error)
      throw render::IoError("the folder for temporary files, TMPDIR, cannot be used: " +
                            error.message());
    render::write_file_atomically(path, render::encode_png(picture));
    const bool same = render::read_png(path).pixels == picture.pixels;
    fs::remove(path, error);
    if (!same) throw render::IoError(path + " was read back with other pixels than were written");
    finding.detail = fmt::format("written to {} and read back", folder.string());
  } catch (const std::runtime_error& failure) {
    finding.state = State::broken;
    finding.detail = failure.what();
    finding.remedy = "export TMPDIR=FOLDER with one that you may write to and that has space";
    finding.code = ExitCode::input_output;
  }
  return finding;
}

Finding check_scenes() {
  Finding finding{.subject = "scenes"};
  try {
    const std::vector<CatalogueEntry> entries = scene_catalogue();
    const auto invalid =
        std::ranges::find_if(entries, [](const CatalogueEntry& e) { return !e.error.empty(); });
    std::string folders;
    for (const fs::path& folder : scene_folders()) {
      folders += (folders.empty() ? "" : " and ") + fs::absolute(folder).string();
    }
    finding.detail = fmt::format("{} in {}", entries.size(), folders);
    if (invalid != entries.end()) {
      finding.state = State::doubtful;
      finding.detail += fmt::format("; {} is not valid", invalid->name);
      finding.remedy = "pneuma check " + invalid->name;
    }
  } catch (const scenes::SceneError& error) {
    finding.state = State::missing;
    finding.detail = error.what();
    finding.remedy = "cd to the project's folder";
  }
  return finding;
}

Finding check_ffmpeg() {
  const auto path = find_program("ffmpeg");
  if (path) return {.subject = "ffmpeg", .detail = *path};
  return {.subject = "ffmpeg",
          .state = State::missing,
          .detail = "not found, so pneuma render --video prints the command instead of running it",
          .remedy = "sudo apt-get install ffmpeg"};
}

Finding check_gnuplot() {
  const auto path = find_program("gnuplot");
  if (path) return {.subject = "gnuplot", .detail = *path};
  return {.subject = "gnuplot",
          .state = State::missing,
          .detail = "not found, so pneuma study writes its diagrams as scripts only",
          .remedy = "sudo apt-get install gnuplot-nox"};
}

/// Those of the instruction sets that matter here.
Finding check_processor() {
  const Machine here = machine();
  std::string sets;
  const auto add = [&](bool there, const char* name) {
    if (there) sets += std::string(sets.empty() ? "" : " ") + name;
  };
#if defined(__x86_64__)
  add(__builtin_cpu_supports("sse4.2"), "SSE4.2");
  add(__builtin_cpu_supports("avx"), "AVX");
  add(__builtin_cpu_supports("avx2"), "AVX2");
  add(__builtin_cpu_supports("fma"), "FMA");
  add(__builtin_cpu_supports("avx512f"), "AVX-512");
#endif
  return {.subject = "processor",
          .detail = fmt::format("{}, {} core{}{}{}", here.cpu, here.cores,
                                here.cores == 1 ? "" : "s", sets.empty() ? "" : ", ", sets)};
}

Finding check_build() {
  const Version built = version();
  const TimingConditions conditions = timing_conditions();
  Finding finding{.subject = "build"};
  finding.detail = fmt::format("pneuma {}{}, {}, {}", built.program,
                               built.commit.empty() ? "" : " (" + built.commit + ")",
                               built.compiler, conditions.build);
  if (conditions.debug_build) {
    finding.state = State::doubtful;
    finding.detail += ": slow, its times say nothing";
    finding.remedy =
        "cmake -B build -DCMAKE_BUILD_TYPE=Release -DPNEUMA_SANITIZE= && cmake --build build";
  }
  return finding;
}

Finding check_disk() {
  // A minute of 1280 x 720 frames takes about 0.4 GiB.
  constexpr double least_gib = 1.0;
  Finding finding{.subject = "disk"};
  std::error_code error;
  const fs::space_info space = fs::space(".", error);
  if (error) {
    finding.state = State::doubtful;
    finding.detail = "free space in this folder is not known: " + error.message();
    return finding;
  }
  const double gib = static_cast<double>(space.available) / (1024.0 * 1024.0 * 1024.0);
  finding.detail = fmt::format("{:.1f} GiB free in this folder", gib);
  if (gib < least_gib) {
    finding.state = State::doubtful;
    finding.remedy = "pneuma render SCENE --out FOLDER with one on a disk that has space";
  }
  return finding;
}

std::string_view word(State state) {
  switch (state) {
    case State::good:
      return "good";
    case State::doubtful:
      return "doubtful";
    case State::missing:
      return "missing";
    case State::broken:
      break;
  }
  return "BROKEN";
}

}  // namespace

std::vector<Finding> diagnose() {
  render::Image picture;
  std::vector<Finding> findings = {check_gl(picture)};
  findings.push_back(check_png(std::move(picture)));
  for (auto* check :
       {check_scenes, check_ffmpeg, check_gnuplot, check_processor, check_build, check_disk}) {
    findings.push_back(check());
  }
  return findings;
}

ExitCode exit_code(const std::vector<Finding>& findings) {
  const auto broken = std::ranges::find(findings, State::broken, &Finding::state);
  return broken == findings.end() ? ExitCode::done : broken->code;
}

std::string diagnosis_text(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    text += fmt::format("{:<8}  {:<9}  {}\n", word(finding.state), finding.subject, finding.detail);
    if (!finding.remedy.empty()) text += fmt::format("{:21}to mend it: {}\n", "", finding.remedy);
  }
  const auto broken = std::ranges::count(findings, State::broken, &Finding::state);
  text += broken == 0 ? "\nAll that is required works.\n" : "\nNot all that is required works.\n";
  return text;
}

}  // namespace pneuma::app
