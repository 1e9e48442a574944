#pragma once
/// Reads unique names.

#include "io/json/reader.hpp"

#include <string>
#include <unordered_map>

namespace microtrace::io {

/// The names in one array of a JSON scene, which must be unique.
class Names {
 public:
  /// Reads the member "name". If it is absent, returns the pointer without its first slash. Throws
  /// Error.
  std::string read(const JsonReader& json);

 private:
  std::unordered_map<std::string, std::string> pointers_;  // by name
};

}  // namespace microtrace::io
