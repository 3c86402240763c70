// Every scene under every integrator comes to the state that is on record. A change that is meant
// is recorded by scripts/golden-hashes, which shows what it does to energy, volume and penetration.
#include "tests/app/world/golden_states.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "app/record/world_json.h"
#include "scenes/loader/integrator_names.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

const std::vector<GoldenSection>& golden_states() {
  static const auto sections =
      read_golden_states(project_folder() / "tests/golden/state_hashes.txt");
  return sections;
}

const std::vector<GoldenSection>& golden_paper_states() {
  static const auto sections =
      read_golden_states(project_folder() / "tests/golden/paper_hashes.txt");
  return sections;
}

void expect_recorded(const std::vector<GoldenState>& states,
                     const std::vector<GoldenSection>& sections) {
  const GoldenSection* golden = section_of(sections, this_system());
  if (golden == nullptr) {
    GTEST_SKIP() << "no states on record for " << this_system() << ": scripts/golden-hashes";
  }
  for (const GoldenState& now : states) {
    const auto same_run = [&](const GoldenState& state) {
      return state.scene == now.scene && state.integrator == now.integrator;
    };
    const auto before = std::ranges::find_if(golden->states, same_run);
    ASSERT_NE(before, golden->states.end())
        << now.scene << " under " << now.integrator << " is not on record: scripts/golden-hashes";
    EXPECT_EQ(now.steps, before->steps) << now.integrator;
    EXPECT_EQ(hex(now.hash), hex(before->hash))
        << now.integrator << ": energy " << now.energy << " J after " << before->energy
        << ", volume " << now.volume << " m^3 after " << before->volume << ", penetration "
        << now.penetration << " m after " << before->penetration
        << ". If this is meant: scripts/golden-hashes";
  }
}

class GoldenStates : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Scenes, GoldenStates, testing::ValuesIn(all_scenes()),
                         [](const auto& scene) { return scene.param; });

TEST_P(GoldenStates, AreWhatTheyWere) {
  const bool is_known = section_of(golden_states(), this_system()) != nullptr;
  expect_recorded(is_known ? measure_states(GetParam()) : std::vector<GoldenState>(),
                  golden_states());
}

class GoldenPaperStates : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Scenes, GoldenPaperStates, testing::ValuesIn(paper_method_scenes()),
                         [](const auto& scene) { return scene.param; });

TEST_P(GoldenPaperStates, AreWhatTheyWere) {
  expect_recorded(measure_paper_state(GetParam()), golden_paper_states());
}

TEST(GoldenPaperStates, AreOnRecordForNoSceneThatIsGone) {
  EXPECT_FALSE(golden_paper_states().empty());
  for (const GoldenSection& section : golden_paper_states()) {
    EXPECT_EQ(section.states.size(), paper_method_scenes().size()) << section.systems.front();
  }
}

TEST(GoldenStates, AreOnRecordForNoSceneThatIsGone) {
  const std::size_t runs = all_scenes().size() * scenes::integrator_names().size();
  EXPECT_FALSE(golden_states().empty());
  for (const GoldenSection& section : golden_states()) {
    EXPECT_EQ(section.states.size(), runs) << section.systems.front();
  }
}

GoldenState some_state(std::uint64_t hash) {
  return {.scene = "one_sphere",
          .integrator = "rk4",
          .steps = 180,
          .hash = hash,
          .energy = -70290.5,
          .volume = 1545.0,
          .penetration = 0.25};
}

TEST(GoldenStatesFile, IsReadAsItIsWritten) {
  const TemporaryFolder folder;
  const std::vector<GoldenSection> sections = {
      {{"g++ 12, glibc 2.36", "clang++ 14, glibc 2.36"}, {some_state(0xfedcba9876543210)}},
      {{"g++ 14, glibc 2.40"}, {some_state(1)}}};
  std::ostringstream text;
  write_golden_states(sections, text);
  write_text(folder / "states.txt", text.str());
  const auto read = read_golden_states(folder / "states.txt");
  ASSERT_EQ(read.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].systems, sections[i].systems);
    EXPECT_EQ(read[i].states, sections[i].states);
  }
  EXPECT_EQ(section_of(read, "clang++ 14, glibc 2.36"), &read[0]);
  EXPECT_EQ(section_of(read, "clang++ 15, glibc 2.36"), nullptr);
}

TEST(GoldenStatesFile, SaysWhichLineIsWrong) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& text) -> std::string {
    write_text(folder / "states.txt", text);
    try {
      read_golden_states(folder / "states.txt");
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_TRUE(error_of("# a word\nsystem a\n").empty());
  const std::string state = "one_sphere rk4 180 0x1 0.5 2 0";
  EXPECT_TRUE(error_of("system a\n" + state).empty());
  EXPECT_TRUE(error_of(state).ends_with("states.txt:1: expected: system COMPILER, C LIBRARY"));
  for (const char* wrong :
       {"one_sphere rk4 180 0x1 0.5 2", "one_sphere rk4 180 1 0.5 2 0",
        "one_sphere rk4 180 0x1z 0.5 2 0", "one_sphere rk4 180 0x1 0.5 2 0 1"}) {
    EXPECT_NE(error_of(std::string("system a\n") + wrong).find("states.txt:2: expected: scene"),
              std::string::npos)
        << wrong;
  }
}

TEST(RecordStates, SystemsThatComeToTheSameShareASection) {
  std::vector<GoldenSection> sections;
  record_states("a", {some_state(1)}, sections);
  record_states("b", {some_state(1)}, sections);
  ASSERT_EQ(sections.size(), 1u);
  EXPECT_EQ(sections[0].systems, (std::vector<std::string>{"a", "b"}));
  record_states("a", {some_state(2)}, sections);
  ASSERT_EQ(sections.size(), 2u);
  EXPECT_EQ(sections[0].systems, std::vector<std::string>{"b"});
  EXPECT_EQ(sections[1].states, std::vector<GoldenState>{some_state(2)});
  record_states("b", {some_state(2)}, sections);
  ASSERT_EQ(sections.size(), 1u);
  EXPECT_EQ(sections[0].systems, (std::vector<std::string>{"a", "b"}));
}

}  // namespace
}  // namespace pneuma::app
