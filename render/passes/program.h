// A linked shader program and its uniforms.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "render/context/gl.h"

namespace pneuma::render {

class Program {
 public:
  /// Compiles and links the two stages; each is preceded by the version line and `preamble`, where
  /// the variants of a pass differ. Throws GlError(shader_refused) with GL's own message.
  Program(std::string_view name, std::string_view preamble, std::string_view vertex,
          std::string_view fragment);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const { glUseProgram(name_); }

  /// To be looked up once, after linking. Throws std::logic_error for a name that is not used.
  GLint uniform(const char* name) const;

 private:
  GLuint name_ = 0;
};

// All of them set a uniform of the program in use.
void set_uniform(GLint location, int value);
void set_uniform(GLint location, float value);
void set_uniform(GLint location, const Eigen::Vector2f& value);
void set_uniform(GLint location, const Eigen::Vector3f& value);
void set_uniform(GLint location, const Eigen::Vector4f& value);
void set_uniform(GLint location, const Eigen::Matrix4f& value);

}  // namespace pneuma::render
