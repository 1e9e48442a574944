#pragma once
/// The contents of the opaque handles of the C API, and the error handling of its functions.

#include "base/system/float_environment.hpp"

#include <microtrace/error.hpp>
#include <microtrace/film.hpp>
#include <microtrace/io.hpp>
#include <microtrace/microtrace.h>
#include <microtrace/prepared_scene.hpp>

#include <cstddef>
#include <cstring>
#include <mutex>
#include <string>
#include <unordered_map>

struct mt_scene {
  microtrace::PreparedScene prepared;
  microtrace::SceneFormat format;
  std::string warnings{};
  mutable std::mutex names_mutex{};
  /// The names of objects that callers have asked for. Elements keep their addresses.
  mutable std::unordered_map<std::size_t, std::string> names{};
};

struct mt_film {
  microtrace::Film film;
};

namespace microtrace::capi {

/// Stores the message of the exception that is being handled for mt_last_error(), and returns the
/// exception's status.
mt_status failed() noexcept;

/// Runs f and returns MT_OK, or the status of an exception that f throws.
template <class F>
mt_status guarded(const F& f) noexcept {
  const FloatEnvironment environment;
  try {
    f();
    return MT_OK;
  } catch (...) {
    return failed();
  }
}

/// Throws Error (usage) if the argument is null.
inline void require(const void* argument, const char* name) {
  if (argument == nullptr) throw Error(ErrorKind::usage, "", std::string(name) + " is NULL");
}

/// Returns a struct whose first members the caller has set, and defaults for those that the
/// caller's version of the header lacks. Throws Error (usage) if its size is impossible.
template <class Struct>
[[nodiscard]] Struct complete(const Struct& own, void (*init)(Struct*)) {
  Struct result;
  init(&result);
  if (own.size < sizeof own.size || own.size > sizeof result)
    throw Error(ErrorKind::usage, "",
                "a struct's size is not one of this library: initialize it by ..._init()");
  std::memcpy(&result, &own, own.size);
  return result;
}

/// Returns the options as above, or the defaults if `options` is null.
template <class Options>
[[nodiscard]] Options complete(const Options* options, void (*init)(Options*)) {
  if (options != nullptr) return complete(*options, init);
  Options result;
  init(&result);
  return result;
}

}  // namespace microtrace::capi
