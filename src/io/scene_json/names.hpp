#pragma once
/// Unique names.

#include "io/json/reader.hpp"

#include <string>
#include <unordered_map>

namespace microtrace::io {

/// The names within one array of a JSON scene, which must be unique.
class Names {
 public:
  /// The member "name", or the pointer without its first slash if there is none. Throws Error.
  std::string read(const JsonReader& json);

 private:
  std::unordered_map<std::string, std::string> pointers_;  // by name
};

}  // namespace microtrace::io
