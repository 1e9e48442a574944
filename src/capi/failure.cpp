#include "base/system/free_memory.hpp"
#include "capi/handles.hpp"

#include <microtrace/version.h>

#include <exception>
#include <new>
#include <stdexcept>

namespace microtrace::capi {
namespace {

thread_local std::string message;

/// Stores a message, or an empty one if memory runs out.
void keep(const char* text) noexcept {
  try {
    message = text;
  } catch (...) {
    message.clear();
  }
}

}  // namespace

mt_status failed() noexcept {
  try {
    throw;
  } catch (const Error& error) {
    keep(error.what());
    return static_cast<mt_status>(error.kind());
  } catch (const std::bad_alloc&) {
    keep(out_of_memory());
    return MT_LIMIT;
  } catch (const std::length_error&) {
    keep("a count exceeds the memory");
    return MT_LIMIT;
  } catch (const std::exception& error) {
    keep(error.what());
  } catch (...) {
    keep("an exception of unknown type");
  }
  return MT_INTERNAL;
}

}  // namespace microtrace::capi

const char* mt_last_error() {
  return microtrace::capi::message.c_str();
}

const char* mt_version() {
  return MICROTRACE_VERSION_TEXT;
}
