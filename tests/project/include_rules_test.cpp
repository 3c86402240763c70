// The order of the tree: which folder may include which, and the one file that may include a
// library. `rules` and `only_here` below are these rules, written once; the README's table of
// folders says the same in words.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "tests/project/include_graph.h"
#include "tests/support/paths.h"

namespace pneuma {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> program_folders = {"sim", "render", "scenes", "assets", "app"};
constexpr int most_files = 40;

/// A folder may include itself, and of the program only these; what stands for a folder stands for
/// all below it. Of several rules the one of the innermost folder holds.
struct Rule {
  std::string_view folder;
  std::vector<std::string_view> may_include;
};

const std::vector<Rule> rules = {
    // Files, hashes, text, exact predicates, which everything may include.
    {"sim/base", {}},
    // Plain data of meshes, then of the world, without the code that steps it.
    {"sim/mesh", {"sim/base"}},
    {"sim/world", {"sim/base", "sim/mesh"}},
    // The simulation never draws, reads no scene and no model, and knows nothing of the program.
    {"sim", {}},
    // The renderer draws a frame, its own plain data, and knows nothing of the simulation.
    {"render", {"sim/base"}},
    // A scene is plain data, and its settings are those of the world.
    {"scenes", {"sim/base", "sim/world"}},
    // A model becomes a mesh.
    {"assets", {"sim/base", "sim/mesh"}},
    // The program puts them together.
    {"app", {"sim", "render", "scenes", "assets"}},
};

/// Headers of libraries that a single file includes, so that the library can be replaced there.
struct OnlyHere {
  std::string_view header;  // or the folder of headers
  std::string_view file;
};

constexpr OnlyHere only_here[] = {
    {"GL/osmesa.h", "render/context/osmesa.cpp"}, {"EGL", "render/context/egl.cpp"},
    {"GL/glew.h", "render/context/gl.h"},         {"stb/stb_image_write.h", "render/image/png.cpp"},
    {"assimp", "assets/import_model.cpp"},        {"pybind11", "app/python/module.cpp"},
};

const Rule& rule_of(std::string_view folder) {
  const Rule* innermost = nullptr;
  for (const Rule& rule : rules) {
    if (!lies_in(folder, rule.folder)) continue;
    if (innermost == nullptr || rule.folder.size() > innermost->folder.size()) innermost = &rule;
  }
  if (innermost == nullptr) throw std::logic_error("no rule for folder " + std::string(folder));
  return *innermost;
}

/// What is wrong with an include of ours, if anything.
std::optional<std::string> broken_folder_rule(const Include& include) {
  const Rule& rule = rule_of(folder_of(include.file));
  const std::string target = folder_of(include.included);
  if (lies_in(target, rule.folder)) return std::nullopt;
  std::string allowed(rule.folder);
  for (const std::string_view folder : rule.may_include) {
    if (lies_in(target, folder)) return std::nullopt;
    allowed.append(", ").append(folder);
  }
  return std::string(rule.folder) + " may include only " + allowed;
}

/// What is wrong with an include of a library, if anything.
std::optional<std::string> broken_library_rule(const Include& include) {
  for (const auto& [header, file] : only_here) {
    if (lies_in(include.included, header) && include.file != file) {
      return "only " + std::string(file) + " may include " + std::string(header);
    }
  }
  return std::nullopt;
}

std::string where(const Include& include) {
  return include.file + ":" + std::to_string(include.line) + " includes " + include.included;
}

const std::vector<Include>& program_includes() {
  static const std::vector<Include> includes = includes_of_tree(project_folder(), program_folders);
  return includes;
}

TEST(IncludeRules, EveryFolderIncludesOnlyWhatItMay) {
  EXPECT_GT(program_includes().size(), 1000u) << "the search for #include lines finds too few";
  for (const Include& include : program_includes()) {
    if (!include.ours) continue;
    const auto broken = broken_folder_rule(include);
    EXPECT_FALSE(broken) << where(include) << "; " << *broken;
  }
}

TEST(IncludeRules, ALibraryBehindOneFileIsIncludedThereOnly) {
  for (const Include& include : program_includes()) {
    const auto broken = broken_library_rule(include);
    EXPECT_FALSE(broken) << where(include) << "; " << *broken;
  }
  for (const auto& rule : only_here) {
    const auto is_it = [&](const Include& include) {
      return include.file == rule.file && lies_in(include.included, rule.header);
    };
    EXPECT_TRUE(std::ranges::any_of(program_includes(), is_it))
        << rule.file << " does not include " << rule.header << ": the rule names the wrong file";
  }
}

// A path from the project's folder says where the file lies, and the rules above see all of it.
TEST(IncludeRules, EveryIncludeNamesItsFileFromTheProjectsFolder) {
  for (const Include& include : program_includes()) {
    if (!include.ours) continue;
    const bool made_by_cmake = fs::exists(project_folder() / (include.included + ".in"));
    EXPECT_TRUE(made_by_cmake || fs::exists(project_folder() / include.included)) << where(include);
  }
}

TEST(IncludeRules, NoFoldersIncludeEachOtherInACycle) {
  std::string cycle;
  for (const std::string& folder : find_cycle(folder_graph(program_includes()))) {
    cycle += (cycle.empty() ? "" : " -> ") + folder;
  }
  EXPECT_EQ(cycle, "");
}

// In a folder of more a file is not found at a glance. Scene files are left out: there is one for
// each scene, and no reader goes through them to find his way.
TEST(Folders, HaveAtMostFortyFilesOfTheirOwn) {
  std::map<std::string, int> files;
  for (const char* top : {"sim", "render", "scenes", "assets", "app", "tests", "scripts"}) {
    for (const auto& entry : fs::recursive_directory_iterator(project_folder() / top)) {
      if (!entry.is_regular_file() || entry.path().extension() == ".toml") continue;
      ++files[entry.path().parent_path().lexically_relative(project_folder()).generic_string()];
    }
  }
  EXPECT_GT(files.size(), 40u) << "the search for folders finds too few";
  for (const auto& [folder, count] : files) EXPECT_LE(count, most_files) << folder;
}

// The tests above say nothing while all is well: these show that they would.

TEST(ReadIncludes, FindsQuotesAndBracketsWithTheirLines) {
  const auto includes = read_includes("a/b.cpp",
                                      "#include \"a/b.h\"\n\n#include <vector>\n"
                                      "  # include \"c.h\"  // why\n// #include \"d.h\"\n");
  ASSERT_EQ(includes.size(), 3u);
  EXPECT_EQ(where(includes[0]), "a/b.cpp:1 includes a/b.h");
  EXPECT_TRUE(includes[0].ours);
  EXPECT_EQ(where(includes[1]), "a/b.cpp:3 includes vector");
  EXPECT_FALSE(includes[1].ours);
  EXPECT_EQ(where(includes[2]), "a/b.cpp:4 includes c.h");
}

TEST(BrokenFolderRule, IsSaidOfEachWayUpTheTree) {
  const auto breaks = [](const std::string& file, const std::string& included) {
    return broken_folder_rule({file, 1, included, true}).has_value();
  };
  EXPECT_TRUE(breaks("sim/base/file.cpp", "sim/mesh/measure.h"));
  EXPECT_TRUE(breaks("sim/world/world.h", "sim/soft/damping.h"));
  EXPECT_TRUE(breaks("sim/step/stages/plan.cpp", "scenes/loader/scene.h"));
  EXPECT_TRUE(breaks("sim/step/stages/plan.cpp", "tests/support/json.h"));
  EXPECT_TRUE(breaks("render/passes/bodies.cpp", "sim/mesh/measure.h"));
  EXPECT_TRUE(breaks("render/passes/bodies.cpp", "simulation/base/file.h"));
  EXPECT_TRUE(breaks("scenes/loader/scene.h", "sim/step/stepper.h"));
  EXPECT_TRUE(breaks("assets/cat/cat.cpp", "scenes/loader/scene.h"));
  EXPECT_FALSE(breaks("sim/base/file.cpp", "sim/base/file.h"));
  EXPECT_FALSE(breaks("sim/step/stages/plan.cpp", "sim/world/world.h"));
  EXPECT_FALSE(breaks("render/image/png.cpp", "sim/base/file.h"));
  EXPECT_FALSE(breaks("scenes/loader/scene.h", "sim/world/settings.h"));
  EXPECT_FALSE(breaks("app/study/csv.cpp", "app/host/version.h"));
  EXPECT_EQ(broken_folder_rule({"render/a.cpp", 1, "sim/mesh/b.h", true}),
            "render may include only render, sim/base");
}

TEST(BrokenLibraryRule, IsSaidOfAllButTheOneFile) {
  const auto breaks = [](const std::string& file, const std::string& included) {
    return broken_library_rule({file, 1, included, false}).has_value();
  };
  EXPECT_TRUE(breaks("app/check/check_model.cpp", "assimp/scene.h"));
  EXPECT_TRUE(breaks("render/renderer.cpp", "GL/osmesa.h"));
  EXPECT_FALSE(breaks("render/context/osmesa.cpp", "GL/osmesa.h"));
  EXPECT_FALSE(breaks("render/renderer.cpp", "vector"));
}

TEST(FindCycle, NamesItsFoldersOnly) {
  EXPECT_EQ(find_cycle({{"a", {"b", "c"}}, {"b", {"c"}}, {"c", {"c"}}}),
            std::vector<std::string>());
  EXPECT_EQ(find_cycle({{"a", {"b"}}, {"b", {"c"}}, {"c", {"d", "b"}}}),
            (std::vector<std::string>{"b", "c", "b"}));
}

}  // namespace
}  // namespace pneuma
