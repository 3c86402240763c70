// A run of `pneuma render` in a folder of its own, in tiny pictures.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "render/image/png.h"
#include "tests/support/run_pneuma.h"
#include "tests/support/temporary_folder.h"

namespace pneuma {

/// A ball that falls on the ground, 21 frames of two steps each.
inline constexpr const char* falling_ball = R"(
title = "A ball"
duration = 0.7
[picture]
width = 64
height = 48
samples = 1
[[body]]
name = "ball"
kind = "soft"
shape = "sphere"
radius = 1.0
position = [0.0, 0.0, 1.2]
)";

class RenderTest : public testing::Test {
 protected:
  RenderTest() { write_text(scene(), falling_ball); }

  std::filesystem::path scene() const { return folder_ / "fall.toml"; }
  std::filesystem::path out(const std::string& name = "out") const { return folder_ / name; }

  /// Messages are part of the output, unless the options send standard error elsewhere.
  ProgramResult render(const std::string& options, const std::string& environment = "") const {
    return render_into("out", options, environment);
  }
  ProgramResult render_into(const std::string& name, const std::string& options,
                            const std::string& environment = "") const {
    const std::string arguments = fmt::format("render 2>&1 '{}' --out '{}' {}", scene().string(),
                                              out(name).string(), options);
    return run_pneuma(arguments, environment);
  }

  nlohmann::json record(const std::string& name = "out") const {
    return nlohmann::json::parse(read_text(out(name) / "run.json"));
  }

  /// The bytes of every picture, by its file's name.
  std::map<std::string, std::string> pictures(const std::string& name = "out") const {
    std::map<std::string, std::string> bytes;
    if (!std::filesystem::exists(out(name))) return bytes;
    for (const auto& entry : std::filesystem::directory_iterator(out(name))) {
      if (entry.path().extension() != ".png") continue;
      bytes[entry.path().filename().string()] = read_text(entry.path());
    }
    return bytes;
  }

  TemporaryFolder folder_;
};

/// Every picture can be decoded to the end and has its size.
inline void expect_whole(const std::map<std::string, std::string>& pictures) {
  for (const auto& [name, bytes] : pictures) {
    try {
      const render::Image image =
          render::decode_png({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
      EXPECT_EQ(image.width, 64) << name;
      EXPECT_EQ(image.height, 48) << name;
    } catch (const std::exception& error) {
      ADD_FAILURE() << name << ": " << error.what();
    }
  }
}

}  // namespace pneuma
