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

TEST_F(ReplacedFiles, DoesNotReplaceASceneBesideAModelUnasked) {
  const fs::path model = folder_ / "tetrahedron.obj", kept = folder_ / "tetrahedron.toml";
  write_text(model, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const auto render_model = [&](const std::string& options) {
    return run_pneuma("render '" + model.string() + "' --out '" + folder_.path().string() +
                      "' --frames 1 --size 64x48 " + options + " 2>&1");
  };
  write_text(kept, "mine");
  ProgramResult result = render_model("");
  EXPECT_EQ(result.exit_code, 6);
  for (const char* word : {"tetrahedron.toml is there already", "--overwrite", "--out"}) {
    EXPECT_NE(result.output.find(word), std::string::npos) << result.output;
  }
  EXPECT_EQ(read_text(kept), "mine");
  EXPECT_FALSE(fs::exists(folder_ / "run.json")) << "before the run";

  EXPECT_EQ(render_model("--overwrite").exit_code, 0);
  const std::string chosen = read_text(kept);
  EXPECT_NE(chosen.find("shape = \"model\""), std::string::npos) << chosen;
  EXPECT_EQ(render_model("--resume").exit_code, 0) << "the same file is in nobody's way";
  write_text(kept, chosen + "# edited\n");
  EXPECT_EQ(render_model("--resume").exit_code, 6);
  EXPECT_EQ(read_text(kept), chosen + "# edited\n");
}

TEST_F(ReplacedFiles, KeepsASceneThatMovesWithItsModel) {
  const fs::path project = folder_ / "project", moved = folder_ / "moved";
  fs::create_directories(project / "models");
  write_text(project / "models" / "tetrahedron.obj",
             "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const auto render_in = [](const fs::path& folder, const std::string& arguments) {
    return run_pneuma("render " + arguments + " --frames 1 --size 64x48 2>&1",
                      "cd '" + folder.string() + "' &&");
  };
  EXPECT_EQ(render_in(project, "models/tetrahedron.obj").exit_code, 0);
  const std::string kept = "out/tetrahedron/tetrahedron.toml";
  EXPECT_NE(read_text(project / kept).find("\"../../models/tetrahedron.obj\""), std::string::npos)
      << read_text(project / kept);
  fs::rename(project, moved);
  const ProgramResult again = render_in(moved, kept + " --resume");
  EXPECT_EQ(again.exit_code, 0) << "and it is the scene of the run: " << again.output;
  EXPECT_EQ(render_in(moved, "models/tetrahedron.obj --resume").exit_code, 0);
  EXPECT_EQ(render_in(moved, "models/tetrahedron.obj --out beside").exit_code, 0);
}

TEST_F(ReplacedFiles, DoesNotReplaceAVideoUnasked) {
  const fs::path film = folder_ / "film.apng";
  write_text(film, "mine");
  const std::string video = "--frames 2 --video '" + film.string() + "'";
  for (const char* way : {"", " --resume"}) {
    const ProgramResult refused = render(video + way);
    EXPECT_EQ(refused.exit_code, 6);
    EXPECT_NE(refused.output.find("film.apng is there already; replace it with --overwrite"),
              std::string::npos)
        << refused.output;
    EXPECT_EQ(read_text(film), "mine");
    EXPECT_FALSE(fs::exists(out())) << "before the run";
  }
  EXPECT_EQ(render(video + " --overwrite").exit_code, 0);
  EXPECT_NE(read_text(film), "mine");
}

TEST_F(ReplacedFiles, ReplacesTheVideoOfARunThatGoesOn) {
  const fs::path film = folder_ / "film.apng", other = folder_ / "other.apng";
  write_text(other, "mine");
  ASSERT_EQ(render("--frames 2 --video '" + film.string() + "'").exit_code, 0);
  const std::string before = read_text(film);
  EXPECT_EQ(render("--frames 3 --resume --video '" + other.string() + "'").exit_code, 6);
  EXPECT_EQ(read_text(other), "mine");
  for (const char* frames : {"--frames 3", "--frames 4"}) {
    const ProgramResult longer =
        render(std::string(frames) + " --resume --video='" + film.string() + "'");
    EXPECT_EQ(longer.exit_code, 0) << longer.output;
  }
  EXPECT_GT(read_text(film).size(), before.size());
}

/// As other folders have files of its name.
TEST_F(ReplacedFiles, KnowsTheVideoOfARunByItsWholePath) {
  const fs::path here = folder_ / "here", there = folder_ / "there";
  fs::create_directories(here);
  fs::create_directories(there);
  const auto render_in = [&](const fs::path& folder, const std::string& video,
                             const std::string& options) {
    return run_pneuma("render '" + scene().string() + "' --out '" + out().string() +
                          "' --size 64x48 --video " + video + " " + options + " 2>&1",
                      "cd '" + folder.string() + "' &&");
  };
  ASSERT_EQ(render_in(here, "film.apng", "--frames 2").exit_code, 0);
  write_text(there / "film.apng", "mine");
  EXPECT_EQ(render_in(there, "film.apng", "--frames 3 --resume").exit_code, 6);
  EXPECT_EQ(read_text(there / "film.apng"), "mine");
  EXPECT_EQ(render_in(here, "./film.apng", "--frames 3 --resume").exit_code, 0);
  EXPECT_EQ(render_in(there, "../here/film.apng", "--frames 4 --resume").exit_code, 0);
}

}  // namespace
}  // namespace pneuma
