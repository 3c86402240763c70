#include "render/passes/ground_shadow.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "render/light/contact_shade.h"
#include "render/light/ground_light.h"

namespace pneuma::render {
namespace {

constexpr int size = GroundShadow::size;
static_assert(size % GroundShadow::cells == 0);
constexpr std::size_t texels = static_cast<std::size_t>(size) * size;
// What is seen of the sky changes slowly over the ground: one point for so many texels a side.
constexpr int texels_per_point = 4;
constexpr int points = size / texels_per_point;
constexpr int texels_per_contact = 2;
constexpr int contact_size = size / texels_per_contact;  // texels on a side
// Texels between the weights of a blur: crisper, a slanted edge would show the texels as steps.
constexpr float least_step = 0.4f;
constexpr int block = 8;  // points on a side that are lit together
static_assert(points % block == 0 && block * block <= Receivers::most);

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

/// sRGB is close to linear to the power of 1 / 2.2, and so are products.
std::uint8_t byte_of(float left) {
  return static_cast<std::uint8_t>(255.0f * std::pow(left, 1.0f / 2.2f) + 0.5f);
}

/// The green channel, close to the luminance.
constexpr int green = 1;

/// The two around a texel of what there is one for so many texels a side.
struct Between {
  int first;
  float rest;  // of the way to the next

  Between(int texel, int texels_for_one) {
    const int count = size / texels_for_one;
    const float at =
        std::clamp((static_cast<float>(texel) + 0.5f) / static_cast<float>(texels_for_one) - 0.5f,
                   0.0f, static_cast<float>(count) - 1.001f);
    first = static_cast<int>(at);
    rest = at - static_cast<float>(first);
  }

  template <typename Value>
  Value mix(const Value& a, const Value& b) const {
    return a + rest * (b - a);
  }
};

void add_weighted(float weight, const float* from, float* to, int count) {
  for (int i = 0; i < count; ++i) to[i] += weight * from[i];
}

}  // namespace

GroundShadow::GroundShadow()
    : cover_(texels),
      soft_cover_(texels),
      narrow_(texels),
      scratch_(texels),
      ambient_(static_cast<std::size_t>(points) * points),
      bytes_(texels) {
  for (std::size_t i = 0; i < tone_.size(); ++i)
    tone_[i] = byte_of(static_cast<float>(i) / 1023.0f);
  for (int side = size; side > 2; side /= 2) {
    left_.emplace_back(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 1.0f);
  }
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size, size, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  // The map's margin is free of casters: what is clamped to its edge is what bodies take of the
  // sky. Four bytes a texel that are clamped to the edge are what llvmpipe reads fastest.
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void GroundShadow::draw(const ShadowMap& map, const ShadowDepths& depths, const Vec3f& to_light,
                        const BodyTree& bodies, const DrawnSurface& surface) {
  picture_to_map_.setIdentity();
  picture_to_map_(0, 0) = picture_to_map_(1, 1) = static_cast<float>(size) / inner;
  picture_to_map_(0, 3) = picture_to_map_(1, 3) = -static_cast<float>(margin) / inner;
  map_to_world_ = map.world_to_map().inverse();
  world_to_picture_ = picture_to_map_.inverse() * map.world_to_map();
  to_light_ = to_light;
  texel_ = map.extent() / inner;
  measure_cover(map, depths);
  // Nine weights spread over two and a half steps to each side, to the eye.
  const float wide_step = std::max(0.4f * map.edge() * inner, least_step);
  const float narrow_step = std::clamp(0.5f * wide_step, least_step, 1.0f);
  blur(cover_, narrow_step, size);
  blur(soft_cover_, narrow_step, size);
  narrow_ = cover_;
  blur(cover_, wide_step, size);
  blur(soft_cover_, wide_step, size);
  measure_ambient(bodies);
  if (bodies.bodies().empty()) {  // surfaces take no light of each other
    contact_.assign(std::size_t{contact_size} * contact_size, 0.0f);
  } else {
    measure_contact(surface);
  }
  add_up();
  average_down();
  upload();
  find_dark_cells();
}

Eigen::Vector2f GroundShadow::on_ground(float u, float v) const {
  const Eigen::Vector4f at = picture_to_map_ * Eigen::Vector4f(u, v, 0.0f, 1.0f);
  const Vec3f on_map = (map_to_world_ * at).head<3>();
  return (on_map - to_light_ * (on_map.z() / to_light_.z())).head<2>();
}

void GroundShadow::measure_cover(const ShadowMap& map, const ShadowDepths& shadow_depths) {
  const Vec3f ground = ground_depth(map);
  // A shadow is at its softest a third of the scene's size below its caster.
  const float softness = map.depth_range() / (0.35f * map.extent());
  const int map_size = map.size();
  const auto first = [map_size](int texel) { return texel * map_size / inner; };
  std::ranges::fill(cover_, 0.0f);
  std::ranges::fill(soft_cover_, 0.0f);
  std::vector<float> nearest(static_cast<std::size_t>(map_size));
  std::vector<float> covered(static_cast<std::size_t>(map_size));
  for (int y = 0; y < inner; ++y) {
    std::ranges::fill(nearest, 1.0f);
    std::ranges::fill(covered, 0.0f);
    for (int row = first(y); row < first(y + 1); ++row) {
      const float* depths = shadow_depths.row(row);
      const float across = 1.0f / static_cast<float>(map_size);
      const Vec3f begin = {0.5f * across, (static_cast<float>(row) + 0.5f) * across, 1.0f};
      const float of_ground = ground.dot(begin), slope = ground.x() * across;
      for (std::size_t i = 0; i < nearest.size(); ++i) {
        // What is sunk lies behind the ground.
        const float limit = std::min(1.0f, of_ground + slope * static_cast<float>(i));
        nearest[i] = std::min(nearest[i], depths[i]);
        covered[i] += depths[i] < limit ? 1.0f : 0.0f;
      }
    }
    for (int x = 0; x < inner; ++x) {
      float depth = 1.0f;
      float sum = 0.0f;
      for (int column = first(x); column < first(x + 1); ++column) {
        depth = std::min(depth, nearest[static_cast<std::size_t>(column)]);
        sum += covered[static_cast<std::size_t>(column)];
      }
      const int count = (first(x + 1) - first(x)) * (first(y + 1) - first(y));
      const float fraction = sum / static_cast<float>(count);
      const Vec3f at = {(static_cast<float>(x) + 0.5f) / inner,
                        (static_cast<float>(y) + 0.5f) / inner, 1.0f};
      const auto texel = static_cast<std::size_t>((y + margin) * size + x + margin);
      cover_[texel] = fraction;
      soft_cover_[texel] = fraction * std::clamp((ground.dot(at) - depth) * softness, 0.0f, 1.0f);
    }
  }
}

void GroundShadow::blur(Picture& picture, float step, int side) {
  make_kernel(step, kernel_);
  const int radius = static_cast<int>(kernel_.size() / 2);
  // Beyond the edges there is nothing: the map's margin is free of casters.
  std::ranges::fill(scratch_, 0.0f);
  for (int d = -radius; d <= radius; ++d) {
    const float weight = kernel_[static_cast<std::size_t>(d + radius)];
    for (int y = std::max(0, -d); y < std::min(side, side - d); ++y) {
      add_weighted(weight, picture.data() + (y + d) * side, scratch_.data() + y * side, side);
    }
  }
  std::ranges::fill(picture, 0.0f);
  for (int y = 0; y < side; ++y) {
    for (int d = -radius; d <= radius; ++d) {
      const int begin = std::max(0, -d);
      const int end = std::min(side, side - d);
      add_weighted(kernel_[static_cast<std::size_t>(d + radius)],
                   scratch_.data() + y * side + begin + d, picture.data() + y * side + begin,
                   end - begin);
    }
  }
}

void GroundShadow::measure_ambient(const BodyTree& bodies) {
  const GroundLight light(to_light_);
  const auto coordinate = [](int point) {
    return (static_cast<float>(point) + 0.5f) / static_cast<float>(points);
  };
  for (int row = 0; row < points; row += block) {
    for (int column = 0; column < points; column += block) {
      receivers_.begin(block * block);
      for (int i = 0; i < block * block; ++i) {
        const Eigen::Vector2f at =
            on_ground(coordinate(column + i % block), coordinate(row + i / block));
        receivers_.add({at.x(), at.y(), 0.0f}, Vec3f::UnitZ());
      }
      gather(bodies, receivers_);
      for (int i = 0; i < block * block; ++i) {
        ambient_[static_cast<std::size_t>((row + i / block) * points + column + i % block)] =
            light.ambient(left_at(receivers_, static_cast<std::size_t>(i)));
      }
    }
  }
}

void GroundShadow::measure_contact(const DrawnSurface& surface) {
  constexpr float reach = 7.0f;  // texels
  constexpr float step = 0.7f;   // so that the blur reaches about as far
  const GroundPicture picture = {world_to_picture_, contact_size, reach * texel_};
  if (measure_nearness(surface.vertices(), surface.triangles(), picture, contact_)) {
    blur(contact_, step, contact_size);
  }
}

void GroundShadow::add_up() {
  const Eigen::Array4f sun = GroundLight(to_light_).sun;
  std::array<Eigen::Array4f, points> ambient;  // of a row
  std::array<float, contact_size> contact;     // likewise
  std::vector<Between> columns_of_points, columns_of_contact;
  for (int x = 0; x < size; ++x) {
    columns_of_points.emplace_back(x, texels_per_point);
    columns_of_contact.emplace_back(x, texels_per_contact);
  }
  for (int y = 0; y < size; ++y) {
    const Between rows(y, texels_per_point), contact_rows(y, texels_per_contact);
    const float* touching = contact_.data() + contact_rows.first * contact_size;
    for (int i = 0; i < contact_size; ++i)
      contact[static_cast<std::size_t>(i)] =
          contact_rows.mix(touching[i], touching[contact_size + i]);
    const Eigen::Array4f* at = ambient_.data() + rows.first * points;
    for (int i = 0; i < points; ++i)
      ambient[static_cast<std::size_t>(i)] = rows.mix(at[i], at[points + i]);
    for (int x = 0; x < size; ++x) {
      const auto i = static_cast<std::size_t>(y * size + x);
      const float softness = soft_cover_[i] / std::max(cover_[i], 0.004f);
      const float blocked =
          std::clamp(narrow_[i] + (cover_[i] - narrow_[i]) * softness, 0.0f, 1.0f);
      const Between& columns = columns_of_points[static_cast<std::size_t>(x)];
      const Between& contact_columns = columns_of_contact[static_cast<std::size_t>(x)];
      const auto near = static_cast<std::size_t>(contact_columns.first);
      const float open = 1.0f - contact_columns.mix(contact[near], contact[near + 1]);
      const auto first = static_cast<std::size_t>(columns.first);
      const Eigen::Array4f of_sky = columns.mix(ambient[first], ambient[first + 1]);
      const Eigen::Array4f of_sun = (1.0f - blocked) * sun;
      const Eigen::Array4f left = open * open * of_sky + of_sun;
      // What surfaces see of it: where one comes near the ground it hides from the others.
      left_[0][i] = of_sky[green] + of_sun[green];
      const auto tone = [&](int channel) {
        return tone_[static_cast<std::size_t>(1023.0f * left[channel])];
      };
      bytes_[i] = {tone(0), tone(1), tone(2), 255};
    }
  }
}

void GroundShadow::average_down() {
  for (std::size_t level = 1; level < left_.size(); ++level) {
    const Picture& from = left_[level - 1];
    Picture& to = left_[level];
    const int side = size >> level;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const float* at = from.data() + 4 * y * side + 2 * x;
        to[static_cast<std::size_t>(y * side + x)] =
            0.25f * (at[0] + at[1] + at[2 * side] + at[2 * side + 1]);
      }
    }
  }
}

float GroundShadow::left_below(const Vec3f& position, const Vec3f& normal) const {
  const auto [ahead, distance] = seen_ground(normal.z());
  // A vertex stands for the surface around it, most of which is away from where it touches.
  const float height = std::max(position.z(), 5.0f * texel_);
  const float away = height * ahead / std::max(normal.head<2>().norm(), 1e-6f);
  const Eigen::Vector4f foot(position.x() + away * normal.x(), position.y() + away * normal.y(),
                             0.0f, 1.0f);
  const Eigen::Vector2f at = (world_to_picture_ * foot).head<2>();
  const float fraction = fraction_beyond(at);
  if (fraction <= 0.0f) return 1.0f;
  // Half of what a surface that faces the ground sees of it lies within its height.
  const float width = 2.0f * height * distance;
  const float level = std::clamp(std::log2(std::max(width / texel_, 1.0f)), 0.0f,
                                 static_cast<float>(left_.size()) - 1.001f);
  const auto whole = static_cast<std::size_t>(level);
  const float left = std::lerp(left_at_level(whole, at), left_at_level(whole + 1, at),
                               level - static_cast<float>(whole));
  return std::lerp(1.0f, left, fraction);
}

float GroundShadow::fraction_beyond(const Eigen::Vector2f& at) {
  const Eigen::Vector2f nearest = at.cwiseMax(0.0f).cwiseMin(1.0f);
  const float near = std::max(0.0f, 1.0f - (at - nearest).norm() / fading);
  return near * near;
}

float GroundShadow::left_at_level(std::size_t level, const Eigen::Vector2f& at) const {
  const int side = size >> level;
  const auto texel = [side](float coordinate, float& rest) {
    const float place = std::clamp(coordinate * static_cast<float>(side) - 0.5f, 0.0f,
                                   static_cast<float>(side) - 1.001f);
    const int first = static_cast<int>(place);
    rest = place - static_cast<float>(first);
    return first;
  };
  float right = 0.0f;
  float up = 0.0f;
  const int column = texel(at.x(), right);
  const int row = texel(at.y(), up);
  const float* left = left_[level].data() + row * side + column;
  return std::lerp(std::lerp(left[0], left[1], right), std::lerp(left[side], left[side + 1], right),
                   up);
}

void GroundShadow::upload() {
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size, size, GL_RGBA, GL_UNSIGNED_BYTE, bytes_.data());
}

void GroundShadow::find_dark_cells() {
  constexpr auto reach = static_cast<int>(fading * cells);
  dark_cells_.clear();
  for (int row = -reach; row < cells + reach; ++row) {
    for (int column = -reach; column < cells + reach; ++column) {
      if (is_dark(column, row)) dark_cells_.push_back({column, row});
    }
  }
}

bool GroundShadow::is_dark(int column, int row) const {
  constexpr int side = size / cells;
  // What is read between texels also comes from the nearest one outside, and what is read beyond
  // the border from there.
  const auto begin = [](int cell) { return std::clamp(cell * side - 1, 0, size - 1); };
  const auto end = [](int cell) { return std::clamp((cell + 1) * side + 1, 1, size); };
  std::uint8_t least = 255;
  for (int y = begin(row); y < end(row); ++y) {
    for (int x = begin(column); x < end(column); ++x) {
      const auto& left = bytes_[static_cast<std::size_t>(y * size + x)];
      least = std::min({least, left[0], left[1], left[2]});
    }
  }
  // The cell's point nearest to the picture: its far side where it lies before it.
  const auto near_side = [](int cell) {
    return static_cast<float>(cell < 0 ? cell + 1 : cell) / static_cast<float>(cells);
  };
  // Less than half a step of eight bits is none.
  return fraction_beyond({near_side(column), near_side(row)}) * static_cast<float>(255 - least) >=
         0.5f;
}

void GroundShadow::bind(GLuint unit) const {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glBindSampler(unit, sampler_.name());
}

}  // namespace pneuma::render
