#include "app/doctor/diagnosis.h"

#include <gtest/gtest.h>

#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

using State = Finding::State;

const Finding good = {.subject = "OpenGL", .detail = "4.5"};
const Finding missing = {.subject = "ffmpeg",
                         .state = State::missing,
                         .detail = "not found",
                         .remedy = "sudo apt-get install ffmpeg"};
const Finding no_gl = {.subject = "OpenGL",
                       .state = State::broken,
                       .detail = "no context",
                       .remedy = "unset PNEUMA_GL",
                       .code = ExitCode::no_gl};
const Finding no_disk = {.subject = "PNG files",
                         .state = State::broken,
                         .detail = "disk full",
                         .code = ExitCode::input_output};

TEST(Diagnosis, IsDoneWhenAllThatIsRequiredWorks) {
  EXPECT_EQ(exit_code({}), ExitCode::done);
  EXPECT_EQ(exit_code({good, missing}), ExitCode::done);
}

TEST(Diagnosis, EndsWithTheCodeOfTheFirstThatIsBroken) {
  EXPECT_EQ(exit_code({good, no_gl, no_disk}), ExitCode::no_gl);
  EXPECT_EQ(exit_code({good, no_disk, no_gl}), ExitCode::input_output);
}

TEST(Diagnosis, HasACommandBelowEachProblem) {
  EXPECT_EQ(diagnosis_text({good, missing}),
            "good      OpenGL     4.5\n"
            "missing   ffmpeg     not found\n"
            "                     to mend it: sudo apt-get install ffmpeg\n"
            "\n"
            "All that is required works.\n");
  EXPECT_NE(diagnosis_text({no_gl}).find("Not all that is required works."), std::string::npos);
}

TEST(ScenesFinding, IsBrokenWithoutScenes) {
  const Finding none = scenes_finding([] { return std::vector<CatalogueEntry>(); });
  EXPECT_EQ(exit_code({none}), ExitCode::invalid_scene);
  EXPECT_NE(none.remedy, "");
  const Finding no_folder = scenes_finding([]() -> std::vector<CatalogueEntry> {
    throw scenes::SceneError({{"scenes", 0, 0, "there is no such folder"}});
  });
  EXPECT_EQ(exit_code({no_folder}), ExitCode::invalid_scene);
  EXPECT_NE(no_folder.detail.find("no such folder"), std::string::npos);
}

TEST(Diagnosis, OfThisMachineKnowsARemedyForWhateverItFinds) {
  for (const Finding& finding : diagnose()) {
    EXPECT_NE(finding.detail, "") << finding.subject;
    if (finding.state != State::good) {
      EXPECT_NE(finding.remedy, "") << finding.subject;
    }
  }
}

}  // namespace
}  // namespace pneuma::app
