#include "render/passes/ground_shadow.h"

#include <Eigen/LU>
#include <algorithm>

namespace pneuma::render {
namespace {

constexpr int size = 160;  // texels on a side; blurred, so that more would not show

constexpr const char* vertex_source = R"(
out vec2 at;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;  // one triangle over everything
  at = corner;
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
)";

constexpr const char* cover_source = R"(
in vec2 at;
out vec4 cover;
uniform sampler2DShadow lit;
uniform sampler2D depths;
uniform vec2 texel;        // of the shadow map, and of this picture
uniform vec3 ground;       // depth of the ground = dot(ground, vec3(at, 1))
uniform float softness;    // per unit of depth between a caster and the ground

void main() {
  // Four reads of two by two texels: the mean over this texel of the small picture.
  float quarter = texel.y * 0.25;
  vec4 offset = vec4(-quarter, quarter, 0.0, 0.0);
  const float anything = 0.99999;
  float lit_share = 0.25 * (texture(lit, vec3(at + offset.xx, anything)) +
                            texture(lit, vec3(at + offset.xy, anything)) +
                            texture(lit, vec3(at + offset.yx, anything)) +
                            texture(lit, vec3(at + offset.yy, anything)));
  float nearest = min(min(texture(depths, at + offset.xx).r, texture(depths, at + offset.xy).r),
                      min(texture(depths, at + offset.yx).r, texture(depths, at + offset.yy).r));
  float soft = clamp((dot(ground, vec3(at, 1.0)) - nearest) * softness, 0.0, 1.0);
  cover = vec4(1.0 - lit_share, (1.0 - lit_share) * soft, 0.0, 1.0);
}
)";

constexpr const char* blur_source = R"(
in vec2 at;
out vec4 blurred;
uniform sampler2D picture;
uniform vec2 texel_step;

void main() {
  // Binomial weights 1 8 28 56 70 56 28 8 1 over 256, close to a Gaussian; each pair of
  // neighbours is one read between the two.
  const float near = 84.0 / 256.0, far = 9.0 / 256.0;
  vec2 one = texel_step * (56.0 + 2.0 * 28.0) / 84.0;
  vec2 three = texel_step * (3.0 * 8.0 + 4.0) / 9.0;
  blurred = texture(picture, at) * (70.0 / 256.0) +
            (texture(picture, at + one) + texture(picture, at - one)) * near +
            (texture(picture, at + three) + texture(picture, at - three)) * far;
}
)";

}  // namespace

GroundShadow::Picture::Picture() {
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size, size, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture.name(), 0);
}

GroundShadow::GroundShadow()
    : cover_("ground shadow", "", vertex_source, cover_source),
      cover_texel_(cover_.uniform("texel")),
      cover_ground_(cover_.uniform("ground")),
      cover_softness_(cover_.uniform("softness")),
      blur_("blur", "", vertex_source, blur_source),
      blur_step_(blur_.uniform("texel_step")) {
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  // The map's margin is free of casters, so that its edge says: no shadow. Bytes that are clamped
  // to the edge are what llvmpipe reads fastest.
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  cover_.use();
  set_uniform(cover_.uniform("lit"), 0);
  set_uniform(cover_.uniform("depths"), 1);
  blur_.use();
  set_uniform(blur_.uniform("picture"), 0);
}

void GroundShadow::draw(const ShadowMap& map) {
  glViewport(0, 0, size, size);
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(no_attributes_.name());

  map.bind_comparing(0);
  map.bind_depths(1);
  cover_.use();
  set_uniform(cover_texel_, Eigen::Vector2f(map.texel(), 1.0f / size));
  // The ground is z = 0. In the map's coordinates q = A p + b that plane reads
  // n.(q - b) = 0 with n = A^-T e_z, so its depth is (n.b - n_x u - n_y v) / n_z.
  const Eigen::Matrix3f to_map = map.world_to_map().topLeftCorner<3, 3>();
  const Vec3f offset = map.world_to_map().topRightCorner<3, 1>();
  const Vec3f normal = to_map.inverse().transpose() * Vec3f::UnitZ();
  set_uniform(cover_ground_, Vec3f(-normal.x() / normal.z(), -normal.y() / normal.z(),
                                   normal.dot(offset) / normal.z()));
  // A shadow is at its softest a third of the scene's size below its caster.
  set_uniform(cover_softness_, map.depth_range() / (0.35f * map.extent()));
  glBindFramebuffer(GL_FRAMEBUFFER, wide_.framebuffer.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);

  // Nine weights spread over two and a half steps to each side, to the eye.
  const float wide_step = 0.4f * map.edge();
  const float narrow_step = std::min(0.5f * wide_step, 1.0f / size);
  blur_.use();
  blur(wide_, scratch_, {narrow_step, 0.0f});
  blur(scratch_, narrow_, {0.0f, narrow_step});
  blur(narrow_, scratch_, {wide_step, 0.0f});
  blur(scratch_, wide_, {0.0f, wide_step});
}

void GroundShadow::blur(const Picture& from, const Picture& to, const Eigen::Vector2f& step) {
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, from.texture.name());
  glBindSampler(0, sampler_.name());
  glBindFramebuffer(GL_FRAMEBUFFER, to.framebuffer.name());
  set_uniform(blur_step_, step);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void GroundShadow::bind(GLuint narrow_unit, GLuint wide_unit) const {
  glActiveTexture(GL_TEXTURE0 + narrow_unit);
  glBindTexture(GL_TEXTURE_2D, narrow_.texture.name());
  glBindSampler(narrow_unit, sampler_.name());
  glActiveTexture(GL_TEXTURE0 + wide_unit);
  glBindTexture(GL_TEXTURE_2D, wide_.texture.name());
  glBindSampler(wide_unit, sampler_.name());
}

}  // namespace pneuma::render
