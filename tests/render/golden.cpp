#include "tests/render/golden.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "render/image/compare.h"
#include "render/image/png.h"
#include "sim/base/file.h"
#include "tests/support/paths.h"

namespace pneuma::render {
namespace {

// llvmpipe compiles its code for the CPU it finds. Between SSE2 and AVX2
// (GALLIUM_OVERRIDE_CPU_CAPS=sse2 against none) 2 % of the pixels differ, by 2 at most, but for 1
// in 10000 at the edges of triangles, where another sample falls inside; the mean is 0.014. Vectors
// of 128 or 256 bits and the number of threads change nothing. The limits are about twice that.
constexpr int threshold = 4;
constexpr double allowed_share = 0.0005;
constexpr double allowed_mean = 0.03;

void save(const std::filesystem::path& path, const Image& image) {
  base::write_file_atomically(path.string(), encode_png(image));
}

bool updating() {
  const char* wish = std::getenv("PNEUMA_UPDATE_GOLDEN");
  return wish != nullptr && std::string_view(wish) == "1";
}

}  // namespace

void expect_golden(const std::string& name, const Image& image) {
  const auto golden = project_folder() / "tests/golden" / (name + ".png");
  if (updating()) {
    save(golden, image);
    return;
  }
  ASSERT_TRUE(std::filesystem::exists(golden))
      << golden << " is missing; make it with PNEUMA_UPDATE_GOLDEN=1 and look at it";
  const Image expected = read_png(golden.string());
  ASSERT_EQ(expected.width, image.width);
  ASSERT_EQ(expected.height, image.height);
  const ImageDifference difference = compare_images(image, expected, threshold);
  if (difference.fraction_beyond <= allowed_share && difference.mean <= allowed_mean) return;

  const std::filesystem::path folder = build_folder() / "tests/render/golden_failures";
  std::filesystem::create_directories(folder);
  save(folder / (name + ".actual.png"), image);
  save(folder / (name + ".expected.png"), expected);
  save(folder / (name + ".difference.png"), difference_picture(image, expected));
  ADD_FAILURE() << name << " looks different: max. difference " << difference.max << ", "
                << 100.0 * difference.fraction_beyond << " % of pixels beyond " << threshold
                << " (allowed " << 100.0 * allowed_share << " %), mean " << difference.mean
                << " (allowed " << allowed_mean << "). Look at " << folder
                << "; if it is meant, replace the picture with PNEUMA_UPDATE_GOLDEN=1";
}

}  // namespace pneuma::render
