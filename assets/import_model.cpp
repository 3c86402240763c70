// The only file that includes assimp.
#include "assets/import_model.h"

#include <assimp/BaseImporter.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <new>
#include <set>

#include "assets/model_file.h"
#include "assets/obj_numbers.h"
#include "assets/sandbox.h"
#include "assets/serialise_model.h"

namespace pneuma::assets {
namespace {

/// Of what the importer says: a mistake of a known line says it better.
constexpr std::string_view unreadable = "cannot be read as what its ending says";

/// What the importer sees of the disk: the model under a name of our own, and .bin files beside it
/// when the format has such.
class OneModel : public Assimp::IOSystem {
 public:
  OneModel(std::filesystem::path path, const std::string& bytes, std::size_t most_bytes)
      : path_(std::move(path)), bytes_(bytes), most_bytes_(most_bytes), bytes_read_(bytes.size()) {
    const std::string ending = path_.extension().string();
    name_ = "model" + ending;
    std::transform(name_.begin(), name_.end(), name_.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    has_buffers_ = name_ == "model.gltf" || name_ == "model.glb";
  }

  const std::string& name() const { return name_; }

  bool Exists(const char* file) const override { return file == name_ || is_buffer(file); }
  char getOsSeparator() const override { return '/'; }

  Assimp::IOStream* Open(const char* file, const char*) override {
    if (file == name_) return stream(bytes_);
    if (!is_buffer(file)) return nullptr;
    buffers_.push_back(read_model_file(beside(file), most_bytes_, bytes_read_));
    bytes_read_ += buffers_.back().size();
    return stream(buffers_.back());
  }

  void Close(Assimp::IOStream* file) override { delete file; }

 private:
  static Assimp::IOStream* stream(const std::string& bytes) {
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                      bytes.size());
  }

  std::filesystem::path beside(const std::string& file) const { return path_.parent_path() / file; }

  bool is_buffer(const std::string& file) const {
    std::error_code error;
    return has_buffers_ && file.ends_with(".bin") && file.find('/') == file.npos &&
           std::filesystem::is_regular_file(beside(file), error);
  }

  std::filesystem::path path_;
  const std::string& bytes_;
  std::size_t most_bytes_;
  std::size_t bytes_read_;
  std::string name_;
  bool has_buffers_ = false;
  std::vector<std::string> buffers_;
};

/// A name of the file, fit for a terminal.
std::string readable_name(const aiString& name) {
  constexpr std::size_t longest = 64;
  std::string text(name.C_Str());
  if (text.size() > longest) text.resize(longest);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text;
}

std::string in_object(const aiMesh& mesh) {
  const std::string name = readable_name(mesh.mName);
  return name.empty() ? name : fmt::format(" of object '{}'", name);
}

/// Later steps of the importer rely on what is checked here.
void check_mesh(const aiMesh& mesh) {
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D& p = mesh.mVertices[v];
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
    throw ModelError(fmt::format("vertex {}{} is not finite: ({:g}, {:g}, {:g})", v,
                                 in_object(mesh), p.x, p.y, p.z));
  }
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    for (unsigned i = 0; i < face.mNumIndices; ++i) {
      if (face.mIndices[i] < mesh.mNumVertices) continue;
      throw ModelError(fmt::format("face {}{} uses vertex {}, but there are {} vertices", f,
                                   in_object(mesh), face.mIndices[i], mesh.mNumVertices));
    }
  }
}

class Collector {
 public:
  explicit Collector(const ImportLimits& limits) : limits_(limits) {}

  Model collect(const aiScene& scene, const Eigen::Matrix4d& to_file_axes) {
    std::vector<Visit> open = {{scene.mRootNode, to_file_axes}};
    while (!open.empty()) {  // not by calling itself: files nest nodes as deeply as they like
      const Visit visit = open.back();
      open.pop_back();
      const Eigen::Matrix4d transform = visit.transform * matrix(visit.node->mTransformation);
      for (unsigned i = 0; i < visit.node->mNumMeshes; ++i) {
        const unsigned index = visit.node->mMeshes[i];
        if (index >= scene.mNumMeshes) throw ModelError("an object has a mesh that is not there");
        add(*scene.mMeshes[index], *visit.node, transform);
      }
      for (unsigned i = visit.node->mNumChildren; i-- > 0;) {
        open.push_back({visit.node->mChildren[i], transform});
      }
    }
    return std::move(model_);
  }

 private:
  struct Visit {
    const aiNode* node;
    Eigen::Matrix4d transform;
  };

  static Eigen::Matrix4d matrix(const aiMatrix4x4& m) {
    Eigen::Matrix4d result;
    for (unsigned row = 0; row < 4; ++row) {
      for (unsigned column = 0; column < 4; ++column) {
        result(row, column) = static_cast<double>(m[row][column]);
      }
    }
    return result;
  }

  void add(const aiMesh& mesh, const aiNode& node, const Eigen::Matrix4d& transform) {
    check_size(mesh);
    const int first = static_cast<int>(model_.mesh.vertices.size());
    const std::string node_name = readable_name(node.mName);
    const int part = static_cast<int>(model_.part_names.size());
    model_.part_names.push_back(node_name.empty() ? readable_name(mesh.mName) : node_name);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const Eigen::Vector4d p(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z, 1.0);
      const Vec3 placed = (transform * p).head<3>();
      if (!placed.allFinite()) {
        throw ModelError(fmt::format("vertex {}{} is not finite where its object is placed", v,
                                     in_object(mesh)));
      }
      model_.mesh.vertices.push_back(placed);
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      Triangle triangle;
      for (unsigned i = 0; i < 3; ++i) {
        triangle[i] = first + static_cast<int>(face.mIndices[i]);
      }
      model_.mesh.triangles.push_back(triangle);
      model_.parts.push_back(part);
    }
  }

  /// Instances multiply: what is one mesh in the file may be here a million times.
  void check_size(const aiMesh& mesh) const {
    const auto refuse = [](std::string_view what, std::size_t most) {
      throw ModelError(fmt::format("the file holds more than {} {}, instances counted; {}", most,
                                   what, how_to_keep_counts));
    };
    if (model_.mesh.vertices.size() + mesh.mNumVertices > limits_.vertices) {
      refuse("vertices", limits_.vertices);
    }
    if (model_.mesh.triangles.size() + mesh.mNumFaces > limits_.triangles) {
      refuse("triangles", limits_.triangles);
    }
    if (model_.part_names.size() >= limits_.triangles) refuse("objects", limits_.triangles);
  }

  const ImportLimits& limits_;
  Model model_;
};

/// Only the loaders of the format stay: the others must not get to guess at a file that is none.
void keep_loaders_of(Assimp::Importer& importer, const std::string& ending) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    std::set<std::string> endings;
    importer.GetImporter(i)->GetExtensionList(endings);
    if (!endings.contains(ending)) importer.UnregisterLoader(importer.GetImporter(i));
  }
}

/// Off with all that a surface does not need.
void set_up(Assimp::Importer& importer) {
  importer.SetPropertyInteger(
      AI_CONFIG_PP_RVC_FLAGS,
      aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
          aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
          aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS | aiComponent_MATERIALS);
  // Skeletons and bare animations otherwise come with meshes that are made up.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  for (const char* property :
       {AI_CONFIG_IMPORT_FBX_READ_MATERIALS, AI_CONFIG_IMPORT_FBX_READ_TEXTURES,
        AI_CONFIG_IMPORT_FBX_READ_CAMERAS, AI_CONFIG_IMPORT_FBX_READ_LIGHTS,
        AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, AI_CONFIG_IMPORT_FBX_READ_WEIGHTS}) {
    importer.SetPropertyBool(property, false);
  }
}

/// The 3DS loader makes y the axis that is up; the format's is z, as ours.
Eigen::Matrix4d to_file_axes(Format format) {
  Eigen::Matrix4d result = Eigen::Matrix4d::Identity();
  if (format == Format::a3ds) {
    result.row(1) << 0.0, 0.0, -1.0, 0.0;
    result.row(2) << 0.0, 1.0, 0.0, 0.0;
  }
  return result;
}

[[noreturn]] void refuse(const Assimp::Importer& importer) {
  std::string reason = importer.GetErrorString();
  if (reason == "std::bad_alloc") throw std::bad_alloc();  // the sandbox knows its limit
  std::replace_if(
      reason.begin(), reason.end(), [](char c) { return c < 0x20 || c == 0x7f; }, ' ');
  throw ModelError(
      fmt::format("{}: {}", unreadable, reason.empty() ? "it holds no model" : reason));
}

Model import_here(const std::filesystem::path& path, const std::string& bytes,
                  const ImportLimits& limits) {
  const Format format = format_of(path);
  Assimp::Importer importer;
  set_up(importer);
  auto* files = new OneModel(path, bytes, limits.bytes);  // the importer deletes it
  importer.SetIOHandler(files);
  keep_loaders_of(importer, files->name().substr(files->name().rfind('.') + 1));
  // Step by step: polygons are cut into triangles, which looks at their corners, only when these
  // are known to exist.
  const aiScene* scene = importer.ReadFile(files->name(), aiProcess_RemoveComponent);
  if (scene == nullptr || scene->mRootNode == nullptr) refuse(importer);
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) check_mesh(*scene->mMeshes[i]);
  scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (scene == nullptr) refuse(importer);
  return Collector(limits).collect(*scene, to_file_axes(format));
}

/// At least twice what valid files take: at most 20 bytes of memory per byte of file (FBX as text)
/// and 0.02 s per MiB were measured, on OBJ, PLY, STL, DAE and FBX files of 20 to 40 MiB. Damaged
/// files that go on for ever are refused the sooner.
ApartLimits sandbox_limits(std::size_t bytes, const ImportLimits& import) {
  ApartLimits limits;
  // A vertex is three doubles, a triangle three indices and a part; names, too.
  limits.answer = std::max(limits.answer, 32 * import.vertices + 32 * import.triangles);
  limits.memory = (std::size_t{512} << 20) + 40 * bytes;
  limits.seconds = 4 + static_cast<int>(2 * (bytes >> 20));
  return limits;
}

/// `file`: as it is; `bytes`: as the importer is to read it.
Model import_apart(const std::filesystem::path& path, Format format, const std::string& file,
                   const std::string& bytes, const ImportLimits& limits) {
  try {
    return deserialise(run_in_sandbox([&] { return serialise(import_here(path, bytes, limits)); },
                                      sandbox_limits(bytes.size(), limits)));
  } catch (const ModelError& error) {
    const std::string reason = error.what();
    const bool tells_no_more = reason.starts_with(unreadable);
    std::string mistake;
    if (format == Format::obj) {
      mistake = obj_mistake(file);
    } else if (tells_no_more) {
      mistake = number_mistake(format, file);
    }
    if (mistake.empty()) throw;
    throw ModelError(tells_no_more ? mistake : fmt::format("{} ({})", mistake, reason));
  }
}

/// "6:7: f names vertex 9 of 4".
bool begins_with_place(const std::string& what) {
  const std::size_t end = what.find_first_not_of("0123456789");
  return end != what.npos && end > 0 && what[end] == ':';
}

}  // namespace

Model import_model(const std::filesystem::path& path, const ImportLimits& limits) {
  try {
    const Format format = format_of(path);
    const std::string file = read_model_file(path, limits.bytes);
    const std::string off = format == Format::off ? without_comments(file) : std::string();
    const std::string& bytes = format == Format::off ? off : file;
    check_model_header(format, bytes, limits.vertices, limits.triangles);
    Model model = import_apart(path, format, file, bytes, limits);
    if (format == Format::obj) {
      number_as_in_obj(file, model);
      // The importer's name for faces before the first object.
      std::ranges::replace(model.part_names, "defaultobject", "");
    }
    if (model.mesh.triangles.empty()) throw ModelError("the model has no triangles");
    return model;
  } catch (const ModelError& error) {
    const std::string what = error.what();
    const char* behind_path = begins_with_place(what) ? ":" : ": ";
    throw ModelError(path.string() + behind_path + what);
  }
}

}  // namespace pneuma::assets
