#pragma once
/// Names that differ from each other.

#include "io/json/reader.hpp"

#include <string>
#include <unordered_map>

namespace microtrace::io {

/// The names within one array of a JSON scene, unique.
class Names {
 public:
  /// The member "name", or where there is none the pointer without its first slash. Throws Error.
  std::string read(const JsonReader& json);

 private:
  std::unordered_map<std::string, std::string> pointers_;  // by name
};

}  // namespace microtrace::io
