#include "render/passes/ground_shadow.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "render/passes/look.h"

namespace pneuma::render {
namespace {

constexpr int size = 160;  // texels on a side; blurred, so that more would not show
static_assert(size % GroundShadow::cells == 0);
constexpr std::size_t texels = static_cast<std::size_t>(size) * size;

/// Depth of the ground z = 0 over the map's coordinates: dot(result, (u, v, 1)). In those
/// coordinates q = A p + b the plane reads n.(q - b) = 0 with n = A^-T e_z, so that its depth is
/// (n.b - n_x u - n_y v) / n_z.
Vec3f ground_depth(const ShadowMap& map) {
  const Eigen::Matrix3f to_map = map.world_to_map().topLeftCorner<3, 3>();
  const Vec3f offset = map.world_to_map().topRightCorner<3, 1>();
  const Vec3f normal = to_map.inverse().transpose() * Vec3f::UnitZ();
  return {-normal.x() / normal.z(), -normal.y() / normal.z(), normal.dot(offset) / normal.z()};
}

/// Weights at -radius..radius texels of nine binomial weights, 1 8 28 56 70 56 28 8 1 over 256
/// (close to a Gaussian), that lie `step` texels apart: each is shared between its two neighbours.
void make_kernel(float step, std::vector<float>& kernel) {
  constexpr std::array<float, 5> weights = {70, 56, 28, 8, 1};
  const auto radius = static_cast<std::size_t>(4.0f * step) + 1;
  kernel.assign(2 * radius + 1, 0.0f);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const float away = static_cast<float>(i) * step;
    const auto whole = static_cast<std::size_t>(away);
    const float rest = away - static_cast<float>(whole);
    const float weight = weights[i] / 256.0f;
    for (const bool left : {true, false}) {
      if (i == 0 && left) continue;
      const auto at = [&](std::size_t d) -> float& {
        return kernel[left ? radius - d : radius + d];
      };
      at(whole) += weight * (1.0f - rest);
      if (rest > 0.0f) at(whole + 1) += weight * rest;
    }
  }
}

using Bytes = std::array<std::uint8_t, 4>;

/// What is left of the ground's colour when 0..255 of 255 parts of the light are blocked. sRGB is
/// close to linear to the power of 1 / 2.2, and so are products.
std::array<Bytes, 256> colours_left(const Vec3f& to_light) {
  std::array<Bytes, 256> colours;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float direct = sun[c] * to_light.z();
      const float left = 1.0f - static_cast<float>(i) / 255.0f * direct / (sky[c] + direct);
      colours[i][c] = static_cast<std::uint8_t>(255.0f * std::pow(left, 1.0f / 2.2f) + 0.5f);
    }
    colours[i][3] = 255;
  }
  return colours;
}

void add_weighted(float weight, const float* from, float* to, int count) {
  for (int i = 0; i < count; ++i) to[i] += weight * from[i];
}

}  // namespace

GroundShadow::GroundShadow()
    : cover_(texels), soft_cover_(texels), narrow_(texels), scratch_(texels), bytes_(texels) {
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size, size, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  // The map's margin is free of casters, so that its edge says: no shadow. Four bytes a texel that
  // are clamped to the edge are what llvmpipe reads fastest.
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void GroundShadow::draw(const ShadowMap& map, const Vec3f& to_light) {
  map.read(depths_);
  measure_cover(map);
  // Nine weights spread over two and a half steps to each side, to the eye.
  const float wide_step = 0.4f * map.edge() * size;
  const float narrow_step = std::min(0.5f * wide_step, 1.0f);
  blur(cover_, narrow_step);
  blur(soft_cover_, narrow_step);
  narrow_ = cover_;
  blur(cover_, wide_step);
  blur(soft_cover_, wide_step);
  upload(to_light);
  find_dark_cells();
}

void GroundShadow::measure_cover(const ShadowMap& map) {
  const Vec3f ground = ground_depth(map);
  // A shadow is at its softest a third of the scene's size below its caster.
  const float softness = map.depth_range() / (0.35f * map.extent());
  const int map_size = map.size();
  const auto first = [map_size](int texel) { return texel * map_size / size; };
  std::vector<float> nearest(static_cast<std::size_t>(map_size));
  std::vector<float> covered(static_cast<std::size_t>(map_size));
  for (int y = 0; y < size; ++y) {
    std::ranges::fill(nearest, 1.0f);
    std::ranges::fill(covered, 0.0f);
    for (int row = first(y); row < first(y + 1); ++row) {
      const float* depths = depths_.data() + static_cast<std::ptrdiff_t>(row) * map_size;
      for (std::size_t i = 0; i < nearest.size(); ++i) {
        nearest[i] = std::min(nearest[i], depths[i]);
        covered[i] += depths[i] < 1.0f ? 1.0f : 0.0f;
      }
    }
    for (int x = 0; x < size; ++x) {
      float depth = 1.0f;
      float sum = 0.0f;
      for (int column = first(x); column < first(x + 1); ++column) {
        depth = std::min(depth, nearest[static_cast<std::size_t>(column)]);
        sum += covered[static_cast<std::size_t>(column)];
      }
      const int count = (first(x + 1) - first(x)) * (first(y + 1) - first(y));
      const float fraction = sum / static_cast<float>(count);
      const Vec3f at = {(static_cast<float>(x) + 0.5f) / size,
                        (static_cast<float>(y) + 0.5f) / size, 1.0f};
      const auto texel = static_cast<std::size_t>(y * size + x);
      cover_[texel] = fraction;
      soft_cover_[texel] = fraction * std::clamp((ground.dot(at) - depth) * softness, 0.0f, 1.0f);
    }
  }
}

void GroundShadow::blur(Picture& picture, float step) {
  make_kernel(step, kernel_);
  const int radius = static_cast<int>(kernel_.size() / 2);
  // Beyond the edges there is nothing: the map's margin is free of casters.
  std::ranges::fill(scratch_, 0.0f);
  for (int d = -radius; d <= radius; ++d) {
    const float weight = kernel_[static_cast<std::size_t>(d + radius)];
    for (int y = std::max(0, -d); y < std::min(size, size - d); ++y) {
      add_weighted(weight, picture.data() + (y + d) * size, scratch_.data() + y * size, size);
    }
  }
  std::ranges::fill(picture, 0.0f);
  for (int y = 0; y < size; ++y) {
    for (int d = -radius; d <= radius; ++d) {
      const int begin = std::max(0, -d);
      const int end = std::min(size, size - d);
      add_weighted(kernel_[static_cast<std::size_t>(d + radius)],
                   scratch_.data() + y * size + begin + d, picture.data() + y * size + begin,
                   end - begin);
    }
  }
}

void GroundShadow::upload(const Vec3f& to_light) {
  const auto colours = colours_left(to_light);
  for (std::size_t i = 0; i < texels; ++i) {
    const float softness = soft_cover_[i] / std::max(cover_[i], 0.004f);
    const float blocked = narrow_[i] + (cover_[i] - narrow_[i]) * softness;
    bytes_[i] = colours[static_cast<std::size_t>(255.0f * std::clamp(blocked, 0.0f, 1.0f) + 0.5f)];
  }
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size, size, GL_RGBA, GL_UNSIGNED_BYTE, bytes_.data());
}

void GroundShadow::find_dark_cells() {
  constexpr int side = size / cells;
  constexpr Bytes light = {255, 255, 255, 255};
  dark_cells_.clear();
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      // What is read between texels also comes from the nearest one outside.
      const auto begin = [](int cell) { return std::max(0, cell * side - 1); };
      const auto end = [](int cell) { return std::min(size, (cell + 1) * side + 1); };
      bool dark = false;
      for (int y = begin(row); y < end(row); ++y) {
        for (int x = begin(column); x < end(column); ++x) {
          dark = dark || bytes_[static_cast<std::size_t>(y * size + x)] != light;
        }
      }
      if (dark) dark_cells_.push_back({column, row});
    }
  }
}

void GroundShadow::bind(GLuint unit) const {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glBindSampler(unit, sampler_.name());
}

}  // namespace pneuma::render
