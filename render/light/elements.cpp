#include "render/light/elements.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <deque>

#include "render/light/ground_light.h"

namespace pneuma::render {
namespace {

/// The triangles around each vertex.
std::vector<std::vector<std::uint32_t>> rings(const std::vector<Triangle>& triangles) {
  std::uint32_t vertices = 0;
  for (const Triangle& t : triangles) vertices = std::max({vertices, t[0] + 1, t[1] + 1, t[2] + 1});
  std::vector<std::vector<std::uint32_t>> result(vertices);
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    for (const std::uint32_t v : triangles[i]) result[v].push_back(i);
  }
  return result;
}

/// Light on a surface over pi, without what stands in its way.
Light3 open_light(const std::array<Light3, 3>& irradiance, const Light3& floor, float z) {
  return irradiance[0] + z * (irradiance[1] + z * irradiance[2]) + floor * (0.5f - 0.5f * z);
}

/// m, how far a patch reaches beyond its middle: what touches it must not be behind its disc.
float bulge(const Mesh& mesh, const std::vector<std::uint32_t>& patch, const Vec3f& middle,
            const Vec3f& normal) {
  float highest = 0.0f;
  for (const std::uint32_t i : patch) {
    for (const std::uint32_t v : mesh.shape->triangles[i]) {
      highest = std::max(highest, normal.dot(mesh.positions[v] - middle));
    }
  }
  return highest;
}

Element patch_element(const Mesh& mesh, std::span<const Vec3f> albedo,
                      const std::vector<std::uint32_t>& patch) {
  Vec3f area_vector = Vec3f::Zero();
  Vec3f centre = Vec3f::Zero();
  Vec3f colour = Vec3f::Zero();
  float area = 0.0f;
  for (const std::uint32_t i : patch) {
    const auto& [a, b, c] = mesh.shape->triangles[i];
    const auto& x = mesh.positions;
    const Vec3f part = 0.5f * (x[b] - x[a]).cross(x[c] - x[a]);
    const float size = part.norm();
    area_vector += part;
    area += size;
    centre += size / 3.0f * (x[a] + x[b] + x[c]);
    colour += size / 3.0f * (albedo[a] + albedo[b] + albedo[c]);
  }
  const float over = 1.0f / std::max(area, 1e-12f);
  const Vec3f normal = area_vector.stableNormalized();
  return {over * centre + bulge(mesh, patch, over * centre, normal) * normal, normal,
          area_vector.norm(), over * colour.array()};
}

/// The triangles of a patch that has several. They are flat, so that none has to be moved out for
/// what touches it.
void add_parts(const Mesh& mesh, const std::vector<std::uint32_t>& patch, const Light3& radiosity,
               std::vector<Element>& parts) {
  if (patch.size() == 1) return;
  for (const std::uint32_t i : patch) {
    const auto& t = mesh.shape->triangles[i];
    const Vec3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const Vec3f area = 0.5f * (b - a).cross(c - a);
    parts.push_back({(a + b + c) / 3.0f, area.stableNormalized(), area.norm(), radiosity});
  }
}

BodyElements with_whole(BodyElements body) {
  const std::vector<Element>& elements = body.elements;
  Element& whole = body.whole;
  whole = {Vec3f::Zero(), Vec3f::Zero(), 0.0f, Light3::Zero()};
  for (const Element& element : elements) {
    whole.centre += element.area * element.centre;
    whole.radiosity += element.area * element.radiosity;
    whole.area += element.area;
  }
  whole.centre /= std::max(whole.area, 1e-12f);
  whole.radiosity /= std::max(whole.area, 1e-12f);
  whole.area *= 0.25f;
  for (const Element& element : elements) {
    body.radius = std::max(body.radius, (element.centre - whole.centre).norm());
  }
  return body;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> patches(const std::vector<Triangle>& triangles,
                                                std::size_t most) {
  const std::size_t size = (triangles.size() + most - 1) / most;
  const auto around = rings(triangles);
  std::vector<std::vector<std::uint32_t>> result;
  std::vector<bool> taken(triangles.size(), false);
  for (std::uint32_t seed = 0; seed < triangles.size(); ++seed) {
    if (taken[seed]) continue;
    std::vector<std::uint32_t> patch = {seed};
    taken[seed] = true;
    // Breadth first over triangles that share a vertex.
    for (std::size_t next = 0; next < patch.size(); ++next) {
      for (const std::uint32_t v : triangles[patch[next]]) {
        for (const std::uint32_t t : around[v]) {
          if (taken[t] || patch.size() == size) continue;
          taken[t] = true;
          patch.push_back(t);
        }
      }
    }
    result.push_back(std::move(patch));
  }
  return result;
}

BodyElements elements_of(const Mesh& mesh, std::span<const Vec3f> albedo,
                         const std::vector<std::vector<std::uint32_t>>& patches,
                         const Vec3f& to_light, const IsLit& is_lit, bool on_ground) {
  constexpr float usually_open = 0.85f;
  constexpr float left_in_shadow = 0.3f;  // of the ground's light, also next to bodies
  static const Environment environment;
  static const auto irradiance = sky_irradiance(environment);
  BodyElements body;
  for (const std::vector<std::uint32_t>& patch : patches) {
    Element element = patch_element(mesh, albedo, patch);
    const float facing = element.normal.dot(to_light);
    const float floor_left = on_ground && !is_lit(seen_on_ground(element.centre, element.normal))
                                 ? left_in_shadow
                                 : 1.0f;
    Light3 light =
        usually_open * open_light(irradiance, floor_left * environment.floor, element.normal.z());
    if (facing > 0.0f && is_lit(element.centre)) light += facing * environment.sun;
    element.radiosity *= light / (1.0f - (1.0f - usually_open) * element.radiosity);
    body.elements.push_back(element);
    body.first_part.push_back(static_cast<std::uint32_t>(body.parts.size()));
    add_parts(mesh, patch, element.radiosity, body.parts);
  }
  body.first_part.push_back(static_cast<std::uint32_t>(body.parts.size()));
  return with_whole(std::move(body));
}

}  // namespace pneuma::render
