#include "app/doctor/diagnosis.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "app/files/find_scene.h"
#include "app/host/find_program.h"
#include "app/host/machine.h"
#include "app/host/timing_conditions.h"
#include "app/host/version.h"
#include "render/context/context.h"
#include "render/image/png.h"
#include "render/renderer.h"
#include "scenes/loader/load_scene.h"
#include "sim/base/enum_name.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;
using State = Finding::State;

std::string gl_remedy(render::GlFailure failure, std::optional<render::Backend> backend) {
  if (failure == render::GlFailure::switched_off) return "unset PNEUMA_GL";
  const bool egl = backend == render::Backend::egl;
  const char* packages = egl ? "libegl1 libgl1-mesa-dri" : "libosmesa6";
  if (failure == render::GlFailure::library_missing) {
    return fmt::format("sudo apt-get install {}", packages);
  }
  return fmt::format(
      "sudo apt-get install --reinstall {}, and unset MESA_* and GALLIUM_* variables", packages);
}

/// A context, the shaders, and a picture, which the PNG check then writes.
Finding check_gl(render::Image& picture, std::optional<render::Backend> backend) {
  Finding finding{.subject = "OpenGL"};
  try {
    render::Renderer renderer({.width = 64, .height = 48, .backend = backend});
    renderer.draw(render::Frame{}, picture);
    finding.detail = renderer.description();
  } catch (const render::GlError& error) {
    finding.state = State::broken;
    finding.detail = error.what();
    finding.remedy = gl_remedy(error.failure(), backend);
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
      throw base::IoError("the folder for temporary files, TMPDIR, cannot be used: " +
                          error.message());
    base::write_file_atomically(path, render::encode_png(picture));
    const bool same = render::read_png(path).pixels == picture.pixels;
    fs::remove(path, error);
    if (!same) throw base::IoError(path + " was read back with other pixels than were written");
    finding.detail = fmt::format("written to {} and read back", folder.string());
  } catch (const std::runtime_error& failure) {
    finding.state = State::broken;
    finding.detail = failure.what();
    finding.remedy = "export TMPDIR=FOLDER with one that you may write to and that has space";
    finding.code = ExitCode::input_output;
  }
  return finding;
}

Finding check_scenes() { return scenes_finding(scene_catalogue); }

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

/// Throws base::IoError unless a file can be made in the folder.
void try_to_write(const fs::path& folder) {
  const fs::path file = folder / fmt::format(".pneuma_doctor_{}", getpid());
  base::write_file_atomically(file.string(), {});
  std::error_code ignored;
  fs::remove(file, ignored);
}

/// Where `render` writes unless it is told otherwise: ./out, which it makes when it is not there.
Finding check_disk() {
  // A minute of 1280 x 720 frames takes about 0.4 GiB.
  constexpr double least_gib = 1.0;
  Finding finding{.subject = "disk"};
  std::error_code error;
  const fs::path folder = fs::exists("out", error) ? "out" : ".";
  const std::string elsewhere = "pneuma render SCENE --out FOLDER with one ";
  try {
    try_to_write(folder);
  } catch (const base::IoError& failure) {
    finding.state = State::broken;
    finding.detail = failure.what();
    finding.remedy = "cd to a folder that you may write to, or " + elsewhere + "of that kind";
    finding.code = ExitCode::input_output;
    return finding;
  }
  const fs::space_info space = fs::space(folder, error);
  if (error) {
    finding.state = State::doubtful;
    finding.detail = "free space in this folder is not known: " + error.message();
    finding.remedy = elsewhere + "on another disk";
    return finding;
  }
  const double gib = static_cast<double>(space.available) / (1024.0 * 1024.0 * 1024.0);
  finding.detail = fmt::format("{:.1f} GiB free in this folder", gib);
  if (gib < least_gib) {
    finding.state = State::doubtful;
    finding.remedy = elsewhere + "on a disk that has space";
  }
  return finding;
}

std::string_view word(State state) {
  static constexpr auto names =
      std::to_array<std::string_view>({"good", "doubtful", "missing", "BROKEN"});
  return base::enum_name(names, state);
}

}  // namespace

Finding scenes_finding(const std::function<std::vector<CatalogueEntry>()>& catalogue) {
  Finding finding{.subject = "scenes"};
  const auto none = [&](const std::string& why) {
    finding.state = State::broken;
    finding.detail = why;
    finding.remedy =
        "install pneuma again (cmake --install build), or name scene files by their paths";
    finding.code = ExitCode::invalid_scene;
    return finding;
  };
  std::vector<CatalogueEntry> entries;
  try {
    entries = catalogue();
  } catch (const scenes::SceneError& error) {
    return none(error.what());
  }
  std::string folders;
  for (const fs::path& folder : scene_folders()) {
    folders += (folders.empty() ? "" : " and ") + fs::absolute(folder).string();
  }
  if (entries.empty()) return none("none in " + folders);
  finding.detail = fmt::format("{} in {}", entries.size(), folders);
  const auto invalid =
      std::ranges::find_if(entries, [](const CatalogueEntry& e) { return !e.error.empty(); });
  if (invalid != entries.end()) {
    finding.state = State::doubtful;
    finding.detail += fmt::format("; {} is not valid", invalid->name);
    finding.remedy = "pneuma check " + invalid->name;
  }
  return finding;
}

std::vector<Finding> diagnose(std::optional<render::Backend> backend) {
  render::Image picture;
  std::vector<Finding> findings = {check_gl(picture, backend)};
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
