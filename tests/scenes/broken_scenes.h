// Scenes with one thing wrong: the place and the words of the message.
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace pneuma::scenes {

struct BrokenScene {
  const char* name;
  std::string text;
  int line;
  int column;
  std::vector<std::string> words;  // all of them are in the message
};

inline void PrintTo(const BrokenScene& broken, std::ostream* out) { *out << broken.name; }

std::vector<BrokenScene> broken_scenes();

}  // namespace pneuma::scenes
