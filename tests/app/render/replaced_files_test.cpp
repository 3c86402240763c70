// What `pneuma render` finds in its folder: what it replaces, and what it leaves alone.
#include <set>

#include "tests/app/render/rendered_run.h"

namespace pneuma {
namespace {

namespace fs = std::filesystem;

std::set<std::string> names_of(const std::map<std::string, std::string>& pictures) {
  std::set<std::string> names;
  for (const auto& [name, bytes] : pictures) names.insert(name);
  return names;
}

class ReplacedFiles : public RenderTest {};

TEST_F(ReplacedFiles, DoesNotReplaceARunUnasked) {
  render("--frames 2");
  const auto before = pictures();
  const std::string record_before = read_text(out() / "run.json");
  const ProgramResult result = render("--frames 3");
  EXPECT_EQ(result.exit_code, 6);
  for (const char* way_out : {"--overwrite", "--resume", "--out"}) {
    EXPECT_NE(result.output.find(way_out), std::string::npos) << result.output;
  }
  EXPECT_EQ(pictures(), before);
  EXPECT_EQ(read_text(out() / "run.json"), record_before);
}

TEST_F(ReplacedFiles, ReplacesARunWhenAskedButNothingElse) {
  render("--frames 5 --sheet 2x2");
  write_text(out() / "notes.txt", "mine");
  write_text(out() / "photo.png", "mine");
  EXPECT_EQ(render("--frames 2 --overwrite").exit_code, 0);
  EXPECT_EQ(names_of(pictures()),
            (std::set<std::string>{"fall_00000.png", "fall_00001.png", "photo.png"}));
  EXPECT_EQ(read_text(out() / "notes.txt"), "mine");
  EXPECT_EQ(read_text(out() / "photo.png"), "mine");
  EXPECT_EQ(record()["frames"].size(), 2u);
}

TEST_F(ReplacedFiles, SaysWhichPicturesOfNoRunAreInItsWay) {
  fs::create_directory(out());
  write_text(out() / "fall_00001.png", "mine");
  write_text(out() / "fall_99999.png", "mine");
  for (const char* way : {"", " --resume"}) {
    const ProgramResult result = render(std::string("--frames 2") + way);
    EXPECT_EQ(result.exit_code, 6);
    EXPECT_NE(result.output.find("holds fall_00001.png, ..., fall_99999.png, but no record"),
              std::string::npos)
        << result.output;
  }
  EXPECT_EQ(read_text(out() / "fall_00001.png"), "mine");
  EXPECT_EQ(render("--frames 2 --overwrite").exit_code, 0);
  EXPECT_EQ(render("--frames 1 --overwrite").exit_code, 0);
  EXPECT_EQ(names_of(pictures()), (std::set<std::string>{"fall_00000.png", "fall_99999.png"}));
  EXPECT_EQ(read_text(out() / "fall_99999.png"), "mine");
}

}  // namespace
}  // namespace pneuma
