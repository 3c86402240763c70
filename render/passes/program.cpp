#include "render/passes/program.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "render/context/context.h"

namespace pneuma::render {
namespace {

class Shader {
 public:
  Shader(GLenum stage, std::string_view program, std::string_view preamble, std::string_view source)
      : name_(glCreateShader(stage)) {
    constexpr std::string_view version = "#version 330 core\n";
    const std::array<const char*, 3> texts = {version.data(), preamble.data(), source.data()};
    const std::array<GLint, 3> lengths = {static_cast<GLint>(version.size()),
                                          static_cast<GLint>(preamble.size()),
                                          static_cast<GLint>(source.size())};
    glShaderSource(name_, 3, texts.data(), lengths.data());
    glCompileShader(name_);
    GLint compiled = GL_FALSE;
    glGetShaderiv(name_, GL_COMPILE_STATUS, &compiled);
    if (compiled == GL_TRUE) return;
    std::array<char, 4096> log = {};
    glGetShaderInfoLog(name_, static_cast<GLsizei>(log.size()), nullptr, log.data());
    glDeleteShader(name_);
    throw GlError(
        GlFailure::shader_refused,
        fmt::format("the {} shader of '{}' does not compile: {}; update libosmesa6",
                    stage == GL_VERTEX_SHADER ? "vertex" : "fragment", program, log.data()));
  }
  ~Shader() { glDeleteShader(name_); }
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;

  GLuint name() const { return name_; }

 private:
  GLuint name_;
};

}  // namespace

Program::Program(std::string_view name, std::string_view preamble, std::string_view vertex,
                 std::string_view fragment) {
  const Shader vertex_shader(GL_VERTEX_SHADER, name, preamble, vertex);
  const Shader fragment_shader(GL_FRAGMENT_SHADER, name, preamble, fragment);
  name_ = glCreateProgram();
  glAttachShader(name_, vertex_shader.name());
  glAttachShader(name_, fragment_shader.name());
  glLinkProgram(name_);
  GLint linked = GL_FALSE;
  glGetProgramiv(name_, GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return;
  std::array<char, 4096> log = {};
  glGetProgramInfoLog(name_, static_cast<GLsizei>(log.size()), nullptr, log.data());
  glDeleteProgram(name_);
  throw GlError(
      GlFailure::shader_refused,
      fmt::format("the program '{}' does not link: {}; update libosmesa6", name, log.data()));
}

Program::~Program() { glDeleteProgram(name_); }

GLint Program::uniform(const char* name) const {
  const GLint location = glGetUniformLocation(name_, name);
  if (location < 0) throw std::logic_error(fmt::format("no uniform '{}' in the shader", name));
  return location;
}

void set_uniform(GLint location, int value) { glUniform1i(location, value); }
void set_uniform(GLint location, float value) { glUniform1f(location, value); }
void set_uniform(GLint location, const Eigen::Vector2f& value) {
  glUniform2fv(location, 1, value.data());
}
void set_uniform(GLint location, const Eigen::Vector3f& value) {
  glUniform3fv(location, 1, value.data());
}
void set_uniform(GLint location, const Eigen::Vector4f& value) {
  glUniform4fv(location, 1, value.data());
}
void set_uniform(GLint location, const Eigen::Matrix4f& value) {
  glUniformMatrix4fv(location, 1, GL_FALSE, value.data());  // Eigen's columns are GL's
}

}  // namespace pneuma::render
