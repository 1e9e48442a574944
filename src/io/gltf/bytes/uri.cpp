#include "io/gltf/bytes/uri.hpp"

#include "base/memory_account.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <utility>

namespace microtrace::io::gltf {
namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool starts_with_ignoring_case(std::string_view text, std::string_view start) {
  return text.size() >= start.size() && std::equal(start.begin(), start.end(), text.begin(),
                                                   [](char a, char b) { return a == lower(b); });
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : -1;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const char l = lower(c);
  return l >= 'a' && l <= 'f' ? l - 'a' + 10 : -1;
}

/// Decodes base64 without white space.
std::optional<std::string> decode_digits(std::string_view text) {
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
  const std::size_t digits = text.size() - padding;
  if (digits % 4 == 1 || (padding != 0 && text.size() % 4 != 0)) return std::nullopt;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < digits; ++i) {
    const int digit = base64_digit(text[i]);
    if (digit < 0) return std::nullopt;
    bits = bits << 6U | static_cast<std::uint32_t>(digit);
    // In each group of four digits, every digit after the first completes a byte.
    if (i % 4 != 0) bytes += static_cast<char>(bits >> (6 - 2 * (i % 4)) & 0xFFU);
  }
  return bytes;
}

/// Returns true if a colon precedes the first slash, as it does after a scheme. Relative paths must
/// escape such colons (RFC 3986, section 4.2).
bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string_view::npos && colon < uri.find('/');
}

/// Returns true for a path such as C:\folder\file.
bool is_windows_path(std::string_view uri) {
  return uri.size() > 2 && uri[1] == ':' && (uri[2] == '\\' || uri[2] == '/') &&
         std::isalpha(static_cast<unsigned char>(uri[0])) != 0;
}

}  // namespace

bool is_data_uri(std::string_view uri) {
  return starts_with_ignoring_case(uri, "data:");
}

std::optional<DataUri> split_data_uri(std::string_view uri) {
  constexpr std::string_view kScheme = "data:", kMarker = ";base64";
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  std::string_view type = uri.substr(kScheme.size(), comma - kScheme.size());
  const bool is_base64 =
      type.size() >= kMarker.size() &&
      starts_with_ignoring_case(type.substr(type.size() - kMarker.size()), kMarker);
  if (is_base64) type.remove_suffix(kMarker.size());
  if (type.ends_with(';') || type.find(";;") != std::string_view::npos) return std::nullopt;
  std::string media_type(type.substr(0, type.find(';')));
  std::ranges::transform(media_type, media_type.begin(), lower);
  return DataUri{
      .media_type = std::move(media_type), .is_base64 = is_base64, .data = uri.substr(comma + 1)};
}

std::optional<std::string> decode_percent(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const int high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
    if (high < 0 || low < 0) return std::nullopt;
    result += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return result;
}

std::optional<std::string> decode_base64(std::string_view text) {
  std::optional<std::string> bytes = decode_digits(text);
  if (bytes) return bytes;
  const MemoryAccount copy = temporary_memory(text.size(), "the data of data URIs");
  std::string digits(text);
  std::erase_if(digits, [](char c) {
    return std::string_view(" \t\n\f\r").find(c) != std::string_view::npos;
  });
  return digits.size() == text.size() ? std::nullopt : decode_digits(digits);
}

RelativePath relative_path(std::string_view uri) {
  std::optional<std::string> path = decode_percent(uri);
  const bool has_stray_percent = !path;
  if (!path) path = uri;
  if (path->empty()) return {.refusal = "is empty", .is_invalid = true};
  if (is_windows_path(uri))
    return {.refusal = "is an absolute path of Windows; use a path relative to the asset",
            .is_invalid = true};
  if (has_scheme(uri))
    return {.refusal = "has a scheme; only data: URIs and relative paths are supported"};
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (std::ranges::any_of(*path, is_control)) {
    return {.refusal = "has a control character", .is_invalid = true};
  }
  std::ranges::replace(*path, '\\', '/');
  if (path->starts_with('/')) {
    return {*path, "is absolute; use a path relative to the asset", true};
  }
  // Resolves "." and ".." by name, so that the path checked here is the path that is opened later.
  const std::filesystem::path plain = std::filesystem::path(*path).lexically_normal();
  if (*plain.begin() == "..") {
    return {*path, "leaves the asset's folder by \"..\"; move the file into it", true};
  }
  return {.path = plain.string(), .has_stray_percent = has_stray_percent};
}

}  // namespace microtrace::io::gltf
