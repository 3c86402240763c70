// Whatever is done to a file, reading it ends in a mesh or in a ModelError.
#include <gtest/gtest.h>

#include <functional>

#include "assets/load_model.h"
#include "tests/assets/model_writers.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::assets {
namespace {

struct Outcome {
  int accepted = 0;
  int refused = 0;
};

class Damage {
 public:
  explicit Damage(const std::string& file) : path_(folder_ / file) {
    write_text(folder_ / "it.bin", gltf_buffer(crooked_box()));
  }

  void load(const std::string& content) {
    write_text(path_, content);
    try {
      load_model(path_);
      ++outcome_.accepted;
    } catch (const ModelError& error) {
      const std::string message = error.what();
      EXPECT_GT(message.size(), path_.string().size() + 10);
      EXPECT_EQ(message.find("bad_alloc"), message.npos) << message;
      ++outcome_.refused;
    }
  }

  const Outcome& outcome() const { return outcome_; }

 private:
  TemporaryFolder folder_;
  std::filesystem::path path_;
  Outcome outcome_;
};

/// Cuts and flips spread over the file, the same ones each time.
void damage(const std::string& file, const std::string& content) {
  constexpr std::size_t cuts = 12, flips = 24;
  Damage damage(file);
  for (std::size_t i = 1; i < cuts; ++i) damage.load(content.substr(0, content.size() * i / cuts));
  std::uint32_t random = 12345;
  for (std::size_t i = 0; i < flips; ++i) {
    std::string damaged = content;
    for (int k = 0; k < 3; ++k) {
      random = random * 1664525u + 1013904223u;
      const std::size_t place = (i * content.size() / flips + (random >> 8) % 50) % content.size();
      damaged[place] = static_cast<char>(random >> 24);
    }
    damage.load(damaged);
  }
  EXPECT_GT(damage.outcome().refused, 5) << file;
}

TEST(DamagedFiles, Obj) { damage("it.obj", obj_text(crooked_box())); }
TEST(DamagedFiles, PlyText) { damage("it.ply", ply_text(crooked_box())); }
TEST(DamagedFiles, PlyBinary) { damage("it.ply", ply_bytes(crooked_box())); }
TEST(DamagedFiles, StlText) { damage("it.stl", stl_text(crooked_box())); }
TEST(DamagedFiles, StlBinary) { damage("it.stl", stl_bytes(crooked_box())); }
TEST(DamagedFiles, Off) { damage("it.off", off_text(crooked_box())); }
TEST(DamagedFiles, Gltf) { damage("it.gltf", gltf_text(crooked_box(), "it.bin")); }
TEST(DamagedFiles, Glb) { damage("it.glb", glb_bytes(crooked_box())); }
TEST(DamagedFiles, ThreeDs) { damage("it.3ds", a3ds_bytes(crooked_box())); }
TEST(DamagedFiles, Dae) { damage("it.dae", dae_text(crooked_box())); }
TEST(DamagedFiles, Fbx) { damage("it.fbx", fbx_text(crooked_box())); }

}  // namespace
}  // namespace pneuma::assets
