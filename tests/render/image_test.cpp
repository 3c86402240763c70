#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <thread>

#include "render/image/compare.h"
#include "render/image/contact_sheet.h"
#include "render/image/png.h"
#include "tests/render/probe.h"

namespace pneuma::render {
namespace {

Image noise(int width, int height, std::uint32_t seed) {
  Image image{width, height, {}};
  std::mt19937 random(seed);
  for (int i = 0; i < 3 * width * height; ++i) {
    image.pixels.push_back(static_cast<std::uint8_t>(random()));
  }
  return image;
}

Image plain(int width, int height, const Pixel& colour) {
  Image image{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    for (const int channel : colour) image.pixels.push_back(static_cast<std::uint8_t>(channel));
  }
  return image;
}

TEST(Png, ComesBackAsItWent) {
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {64, 64}, {641, 479}}) {
    const Image image = noise(width, height, static_cast<std::uint32_t>(width));
    const Image back = decode_png(encode_png(image));
    EXPECT_EQ(back.width, width);
    EXPECT_EQ(back.height, height);
    EXPECT_EQ(back.pixels, image.pixels);
  }
}

TEST(Png, HasSignatureAndRightChecksums) {
  const std::vector<std::uint8_t> bytes = encode_png(noise(20, 10, 3));
  const std::vector<std::uint8_t> signature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  ASSERT_TRUE(std::equal(signature.begin(), signature.end(), bytes.begin()));
  const auto number_at = [&bytes](std::size_t i) {
    return static_cast<std::uint32_t>(bytes[i] << 24 | bytes[i + 1] << 16 | bytes[i + 2] << 8 |
                                      bytes[i + 3]);
  };
  // Bit by bit, as the PNG specification's annex D defines it.
  const auto checksum = [&bytes](std::size_t begin, std::size_t end) {
    std::uint32_t crc = 0xffffffffu;
    for (std::size_t i = begin; i < end; ++i) {
      crc ^= bytes[i];
      for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
    }
    return ~crc;
  };
  int chunks = 0;
  for (std::size_t at = 8; at < bytes.size(); ++chunks) {
    const std::size_t end = at + 8 + number_at(at);
    EXPECT_EQ(number_at(end), checksum(at + 4, end)) << "chunk " << chunks;
    at = end + 4;
  }
  EXPECT_EQ(chunks, 3) << "IHDR, IDAT, IEND";
}

TEST(Png, IsTheSameFromEachThread) {
  const Image image = noise(100, 80, 5);
  const auto expected = encode_png(image);
  std::vector<std::vector<std::uint8_t>> made(4);
  {
    std::vector<std::jthread> threads;
    for (auto& bytes : made) threads.emplace_back([&] { bytes = encode_png(image); });
  }
  for (const auto& bytes : made) EXPECT_EQ(bytes, expected);
}

TEST(Png, RefusesWhatIsNotAPicture) {
  EXPECT_THROW(encode_png(Image{}), std::invalid_argument);
  EXPECT_THROW(encode_png(Image{4, 4, std::vector<std::uint8_t>(47)}), std::invalid_argument);
  EXPECT_THROW(decode_png(std::vector<std::uint8_t>{1, 2, 3}), std::invalid_argument);
  std::vector<std::uint8_t> cut = encode_png(noise(20, 20, 1));
  cut.resize(cut.size() / 2);
  EXPECT_THROW(decode_png(cut), std::invalid_argument);
}

TEST(CompareImages, CountsPixelsAndChannels) {
  const Image a = plain(10, 10, {100, 100, 100});
  Image b = a;
  b.pixels[0] = 110;  // one pixel, two of its channels
  b.pixels[1] = 80;
  b.pixels[3] = 103;  // another, within the threshold
  const ImageDifference difference = compare_images(a, b, 5);
  EXPECT_EQ(difference.max, 20);
  EXPECT_DOUBLE_EQ(difference.fraction_beyond, 0.01);
  EXPECT_DOUBLE_EQ(difference.mean, (10.0 + 20.0 + 3.0) / 300.0);
  EXPECT_EQ(compare_images(a, a, 0).max, 0);
  EXPECT_THROW(compare_images(a, plain(10, 9, {0, 0, 0}), 0), std::invalid_argument);
}

TEST(DifferencePicture, IsGreyWhereNothingDiffers) {
  const Image a = plain(2, 1, {100, 100, 100});
  Image b = a;
  b.pixels[0] = 90;
  b.pixels[5] = 255;
  const Image difference = difference_picture(a, b);
  EXPECT_EQ(pixel_at(difference, 0, 0), (Pixel{208, 128, 128}));
  EXPECT_EQ(pixel_at(difference, 1, 0), (Pixel{128, 128, 0}));
}

TEST(Downscale, AveragesBlocks) {
  const Image image = noise(12, 8, 2);
  const Image small = downscale(image, 4, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        int sum = 0;
        for (int j = 0; j < 2; ++j) {
          for (int i = 0; i < 3; ++i) sum += pixel_at(image, 3 * x + i, 2 * y + j)[c];
        }
        // Rounded to whole numbers.
        EXPECT_NEAR(pixel_at(small, x, y)[c], sum / 6.0, 0.501);
      }
    }
  }
}

TEST(Downscale, KeepsTheMeanAtSizesThatDoNotDivide) {
  const Image image = noise(101, 67, 9);
  const Image small = downscale(image, 37, 29);
  const auto mean = [](const Image& i) {
    return std::accumulate(i.pixels.begin(), i.pixels.end(), 0.0) /
           static_cast<double>(i.pixels.size());
  };
  // Every pixel counts by its area, so that only the rounding of 3219 channels is left.
  EXPECT_NEAR(mean(small), mean(image), 0.03);
  EXPECT_EQ(downscale(image, 101, 67).pixels, image.pixels);
  EXPECT_THROW(downscale(image, 102, 67), std::invalid_argument);
  EXPECT_THROW(downscale(image, 10, 0), std::invalid_argument);
}

TEST(ContactSheet, PutsPicturesRowByRow) {
  const std::vector<Image> images = {plain(200, 100, {255, 0, 0}), plain(200, 100, {0, 255, 0}),
                                     plain(200, 100, {0, 0, 255})};
  const Image sheet = contact_sheet(images, 2, 2, 202);
  // Margins of 2, so two cells of 98 by 49 across.
  ASSERT_EQ(sheet.width, 202);
  ASSERT_EQ(sheet.height, 2 + 2 * (49 + 2));
  EXPECT_EQ(pixel_at(sheet, 2, 2), (Pixel{255, 0, 0}));
  EXPECT_EQ(pixel_at(sheet, 99, 50), (Pixel{255, 0, 0}));
  EXPECT_EQ(pixel_at(sheet, 102, 2), (Pixel{0, 255, 0}));
  EXPECT_EQ(pixel_at(sheet, 2, 53), (Pixel{0, 0, 255}));
  const Pixel paper = {250, 250, 250};
  EXPECT_EQ(pixel_at(sheet, 0, 0), paper);
  EXPECT_EQ(pixel_at(sheet, 100, 20), paper);
  EXPECT_EQ(pixel_at(sheet, 150, 80), paper) << "no fourth picture";
}

TEST(ContactSheet, CentresWhatDoesNotFillItsCell) {
  const std::vector<Image> images = {plain(100, 100, {0, 0, 0}), plain(10, 10, {255, 0, 0})};
  const Image sheet = contact_sheet(images, 2, 1, 206);
  ASSERT_EQ(sheet.height, 104);
  EXPECT_EQ(pixel_at(sheet, 154, 52), (Pixel{255, 0, 0}));
  EXPECT_EQ(pixel_at(sheet, 140, 52), (Pixel{250, 250, 250})) << "not enlarged";
}

TEST(ContactSheet, IsNoWiderThanItsPicturesFill) {
  const std::vector<Image> images(5, plain(64, 48, {255, 0, 0}));
  const Image sheet = contact_sheet(images, 4, 3, 1920);
  // Margins of 1920 / 320 = 6 about cells of 64 x 48.
  EXPECT_EQ(sheet.width, 6 + 4 * (64 + 6));
  EXPECT_EQ(sheet.height, 6 + 3 * (48 + 6));
  EXPECT_EQ(pixel_at(sheet, 6, 6), (Pixel{255, 0, 0}));
  EXPECT_EQ(pixel_at(sheet, 6 + 63, 6 + 47), (Pixel{255, 0, 0}));
  EXPECT_EQ(pixel_at(sheet, 6 + 64, 6), (Pixel{250, 250, 250}));
}

TEST(ContactSheet, HasACaptionBelowEachPicture) {
  const std::vector<Image> images(3, plain(64, 48, {255, 0, 0}));
  const Image bare = contact_sheet(images, 2, 2, 640);
  const std::vector<std::string> captions = {"k = 50", "", "k = 80, and more than fits in a line"};
  const Image sheet = contact_sheet(images, 2, 2, 640, captions);
  EXPECT_EQ(sheet.width, bare.width);
  EXPECT_GT(sheet.height, bare.height + 2 * 9);
  const int row = (sheet.height - 2) / 2;
  const auto is_written_in = [&](int left, int top) {
    for (int y = top; y < top + row - 48 - 2; ++y) {
      for (int x = left; x < left + 64; ++x) {
        if (pixel_at(sheet, x, y)[0] < 100) return true;
      }
    }
    return false;
  };
  EXPECT_TRUE(is_written_in(2, 2 + 48));
  EXPECT_FALSE(is_written_in(2 + 64 + 2, 2 + 48));
  EXPECT_TRUE(is_written_in(2, 2 + row + 48));
  EXPECT_EQ(pixel_at(sheet, 2, 2 + row), (Pixel{255, 0, 0})) << "the second row begins below";
}

TEST(ContactSheet, RefusesTooManyOrTooFew) {
  const std::vector<Image> images(5, plain(10, 10, {0, 0, 0}));
  EXPECT_THROW(contact_sheet(images, 2, 2), std::invalid_argument);
  EXPECT_THROW(contact_sheet({}, 2, 2), std::invalid_argument);
  EXPECT_THROW(contact_sheet(images, 5, 1, 12), std::invalid_argument);
}

}  // namespace
}  // namespace pneuma::render
