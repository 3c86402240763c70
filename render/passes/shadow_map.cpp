#include "render/passes/shadow_map.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pneuma::render {
namespace {

constexpr const char* vertex_source = R"(
layout(location = 0) in vec3 position;
uniform mat4 world_to_clip;
void main() { gl_Position = world_to_clip * vec4(position, 1.0); }
)";

constexpr const char* fragment_source = "void main() {}\n";

/// From world to axes of the light: x and y across it, z the way it shines. Left-handed, as GL's
/// clip space is, so that front faces stay front faces.
Eigen::Matrix3f light_axes(const Vec3f& to_light) {
  const Vec3f z = -to_light;
  const Vec3f helper = std::abs(z.z()) < 0.9f ? Vec3f::UnitZ() : Vec3f::UnitX();
  const Vec3f x = helper.cross(z).normalized();
  Eigen::Matrix3f axes;
  axes << x.transpose(), x.cross(z).transpose(), z.transpose();
  return axes;
}

}  // namespace

ShadowMap::ShadowMap(int size)
    : size_(size),
      program_("shadow map", "", vertex_source, fragment_source),
      world_to_clip_(program_.uniform("world_to_clip")) {
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  // The map's margin is free of casters: its edge says that what lies beyond is lit.
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glBindTexture(GL_TEXTURE_2D, depth_.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, size, size, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
               nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.name(), 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
}

void ShadowMap::fit(const View& view, const Light& light) {
  const Eigen::Matrix3f axes = light_axes(view.to_light);
  Box seen;
  for (int i = 0; i < 8; ++i) seen.grow(axes * view.casters.corner(i));
  const Vec3f size = seen.max - seen.min;
  const float span = std::max(size.head<2>().maxCoeff(), 1e-6f);
  // Room on each side for the soft edge, which is wider the further the shadow falls.
  const float pad = (light.softness + 0.02f) * span;
  extent_ = span + 2.0f * pad;
  edge_ = 0.5f * light.softness * span / extent_;
  const Vec3f origin = seen.centre() - Vec3f(0.5f * extent_, 0.5f * extent_, 0.0f);
  const float depth_pad = 0.01f * size.z() + 1e-6f;
  depth_range_ = size.z() + 2.0f * depth_pad;

  world_to_map_.setIdentity();
  world_to_map_.topLeftCorner<3, 3>() = axes;
  world_to_map_(0, 3) = -origin.x();
  world_to_map_(1, 3) = -origin.y();
  world_to_map_(2, 3) = -(seen.min.z() - depth_pad);
  world_to_map_.topRows<2>() /= extent_;
  world_to_map_.row(2) /= depth_range_;
}

void ShadowMap::draw(const View& view, const Light& light, const SurfaceBuffers& surface) {
  fit(view, light);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, size_, size_);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_FRONT);
  glClear(GL_DEPTH_BUFFER_BIT);
  program_.use();
  Mat4f map_to_clip = 2.0f * Mat4f::Identity();
  map_to_clip.col(3) = Eigen::Vector4f(-1.0f, -1.0f, -1.0f, 1.0f);
  set_uniform(world_to_clip_, Mat4f(map_to_clip * world_to_map_));
  surface.draw();
  glDisable(GL_CULL_FACE);
}

void ShadowMap::bind(GLuint unit) const {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, depth_.name());
  glBindSampler(unit, sampler_.name());
}

void ShadowMap::read(ShadowDepths& depths) const {
  depths.size = size_;
  depths.world_to_map = world_to_map_;
  depths.depths.resize(static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size_, size_, GL_DEPTH_COMPONENT, GL_FLOAT, depths.depths.data());
}

bool ShadowDepths::lit(const Vec3f& point) const {
  const Vec3f at = (world_to_map * point.homogeneous()).head<3>();
  const auto texel = [this](float coordinate) {
    return std::clamp(static_cast<int>(coordinate * static_cast<float>(size)), 0, size - 1);
  };
  return row(texel(at.y()))[texel(at.x())] >= at.z();
}

}  // namespace pneuma::render
