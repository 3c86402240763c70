#include "assets/serialise_model.h"

#include <cstdint>
#include <cstring>

namespace pneuma::assets {
namespace {

// The arrays one by one, each after its length; the names last, a line each.

void append(std::string& text, const void* data, std::size_t bytes) {
  text.append(static_cast<const char*>(data), bytes);
}

template <class T>
void append(std::string& text, const std::vector<T>& values) {
  const std::uint64_t count = values.size();
  append(text, &count, sizeof count);
  append(text, values.data(), values.size() * sizeof(T));
}

template <class T>
void take(std::string_view& text, std::vector<T>& values) {
  std::uint64_t count = 0;
  const bool has_count = text.size() >= sizeof count;
  if (has_count) std::memcpy(&count, text.data(), sizeof count);
  if (!has_count || count > (text.size() - sizeof count) / sizeof(T)) {
    throw ModelError("the importer's answer is damaged");
  }
  text.remove_prefix(sizeof count);
  values.resize(count);
  if (count > 0) {
    std::memcpy(static_cast<void*>(values.data()), text.data(), count * sizeof(T));
  }
  text.remove_prefix(count * sizeof(T));
}

}  // namespace

std::string serialise(const Model& model) {
  std::string text, names;
  append(text, model.mesh.vertices);
  append(text, model.mesh.triangles);
  append(text, model.parts);
  for (const std::string& name : model.part_names) names += name + '\n';
  return text + names;
}

Model deserialise(std::string_view text) {
  Model model;
  take(text, model.mesh.vertices);
  take(text, model.mesh.triangles);
  take(text, model.parts);
  for (std::size_t end; (end = text.find('\n')) != text.npos; text.remove_prefix(end + 1)) {
    model.part_names.emplace_back(text.substr(0, end));
  }
  return model;
}

}  // namespace pneuma::assets
