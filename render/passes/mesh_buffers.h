// Meshes in GL's memory.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "render/frame/frame.h"
#include "render/passes/gl_objects.h"

namespace pneuma::render {

/// A mesh of the frame at hand, ready to be drawn. Attributes: 0 position, 1 normal, 2 colour.
struct DrawnMesh {
  GLuint vao;
  GLsizei index_count;
  bool smooth;  // has normals
};

/// What meshes share is uploaded once per MeshShape and kept while that object lives; positions and
/// normals are streamed each frame.
class MeshBuffers {
 public:
  /// The frame must have passed check_frame.
  void upload(const std::vector<Mesh>& meshes);

  const std::vector<DrawnMesh>& meshes() const { return drawn_; }

  /// How many shapes are kept at present.
  std::size_t shape_count() const { return shapes_.size(); }

 private:
  struct Shape {
    Buffer indices;
    Buffer colours;
    GLsizei index_count = 0;
  };
  using Key = std::weak_ptr<const MeshShape>;

  const Shape& shape_of(const std::shared_ptr<const MeshShape>& shape);
  void forget_dead_shapes();

  // Ordered by owner: a new shape at a dead one's address is another one.
  std::map<Key, Shape, std::owner_less<Key>> shapes_;
  Buffer stream_;
  std::vector<Vec3f> staging_;
  std::vector<Vao> vaos_;
  std::vector<DrawnMesh> drawn_;
};

}  // namespace pneuma::render
