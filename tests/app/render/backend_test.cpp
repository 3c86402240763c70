// The libraries that make OpenGL contexts: chosen, named, missing.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/support/run_pneuma.h"
#include "tests/support/temporary_folder.h"

namespace pneuma {
namespace {

namespace fs = std::filesystem;

constexpr const char* all_passes =
    "render sphere_in_torus --frames 0-2 --size 160x120 --show particles,wireframe --quiet ";

std::string rendered_by(const std::string& backend, const TemporaryFolder& folder) {
  const fs::path out = folder / backend;
  const ProgramResult result =
      run_pneuma(all_passes + ("--backend " + backend + " --out '" + out.string() + "' 2>&1"));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  return nlohmann::json::parse(read_text(out / "run.json"))["run"]["gl"];
}

TEST(Backend, DrawsTheSamePixelsAndIsNamed) {
  const TemporaryFolder folder;
  EXPECT_TRUE(rendered_by("osmesa", folder).ends_with(", by osmesa"));
  EXPECT_TRUE(rendered_by("egl", folder).ends_with(", by egl"));
  for (const char* name : {"sphere_in_torus_00000.png", "sphere_in_torus_00002.png"}) {
    const std::string picture = read_text(folder / "osmesa" / name);
    EXPECT_GT(picture.size(), 1000u);
    EXPECT_EQ(picture, read_text(folder / "egl" / name)) << name;
  }
  EXPECT_NE(run_pneuma("doctor --backend egl").output.find(", by egl\n"), std::string::npos);
}

TEST(Backend, ThatIsNotKnownIsAUsageError) {
  EXPECT_EQ(run_pneuma("doctor --backend glx 2>/dev/null").exit_code, 2);
}

/// An environment in which these libraries cannot be opened.
std::string without(const std::vector<std::string>& libraries, const TemporaryFolder& folder) {
  for (const std::string& library : libraries) write_text(folder / library, "no library");
  return "LD_LIBRARY_PATH='" + folder.path().string() + "'";
}

TEST(Backend, IsEglWithoutOsmesa) {
  const TemporaryFolder folder;
  const ProgramResult result = run_pneuma("doctor", without({"libOSMesa.so.8"}, folder));
  EXPECT_NE(result.output.find(", by egl\n"), std::string::npos) << result.output;
}

TEST(Backend, ThatIsMissingIsAnErrorThatNamesThePackage) {
  const TemporaryFolder folder;
  const std::string environment = without({"libOSMesa.so.8", "libEGL.so.1"}, folder);
  const ProgramResult neither = run_pneuma("render one_sphere --frames 1 2>&1", environment);
  EXPECT_EQ(neither.exit_code, 4);
  EXPECT_NE(neither.output.find("apt-get install libosmesa6"), std::string::npos) << neither.output;
  EXPECT_NE(neither.output.find("apt-get install libegl1"), std::string::npos) << neither.output;
  EXPECT_EQ(run_pneuma("check one_sphere 2>&1", environment).exit_code, 0);
  const ProgramResult doctor = run_pneuma("doctor --backend egl", environment);
  EXPECT_EQ(doctor.exit_code, 4);
  EXPECT_NE(doctor.output.find("to mend it: sudo apt-get install libegl1 libgl1-mesa-dri\n"),
            std::string::npos)
      << doctor.output;
}

TEST(Backend, IsNotLoadedByACommandThatDrawsNothing) {
  const std::string loaded = run_pneuma("check one_sphere 2>&1", "LD_DEBUG=files").output;
  EXPECT_NE(loaded.find("libstdc++"), std::string::npos) << "the linker says what it loads";
  for (const char* library : {"libOSMesa", "libEGL", "libGL", "libLLVM"}) {
    EXPECT_EQ(loaded.find(library), std::string::npos) << library;
  }
}

}  // namespace
}  // namespace pneuma
