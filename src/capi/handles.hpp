#pragma once
/// The contents of the C API's opaque handles, and the error handling of its functions.

#include <microtrace/error.hpp>
#include <microtrace/film.hpp>
#include <microtrace/io.hpp>
#include <microtrace/microtrace.h>
#include <microtrace/prepared_scene.hpp>

#include <cstddef>
#include <cstring>
#include <string>

struct mt_scene {
  microtrace::PreparedScene prepared;
  microtrace::SceneFormat format;
  std::string warnings{};
};

struct mt_film {
  microtrace::Film film;
};

namespace microtrace::capi {

/// Sets the message of mt_last_error() from the exception that is being handled.
mt_status failed() noexcept;

/// Runs f, which throws the library's exceptions, and returns the status.
template <class F>
mt_status guarded(const F& f) noexcept {
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

/// The options, with defaults for the members that the caller's version of the header lacks; null:
/// all defaults.
template <class Options>
[[nodiscard]] Options complete(const Options* options, void (*init)(Options*)) {
  Options result;
  init(&result);
  if (options == nullptr) return result;
  if (options->size < sizeof options->size || options->size > sizeof result)
    throw Error(ErrorKind::usage, "",
                "the options' size is not one of this library: initialize them by ..._init()");
  std::memcpy(&result, options, options->size);
  return result;
}

}  // namespace microtrace::capi
