#include "io/gltf/check/features.hpp"

#include "base/text/printable.hpp"
#include "io/gltf/extensions/extensions.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

namespace microtrace::io::gltf {
namespace {

Support support_of(std::string_view name) {
  const Extension* known = find_extension(name);
  return known != nullptr ? known->support : Support::none;
}

using Version = std::pair<unsigned, unsigned>;

/// Parses a version of the form major.minor in decimal digits.
std::optional<Version> parse_version(std::string_view text) {
  Version version;
  const char* end = text.data() + text.size();
  const auto major = std::from_chars(text.data(), end, version.first);
  if (major.ec != std::errc{} || major.ptr == end || *major.ptr != '.') return std::nullopt;
  const auto minor = std::from_chars(major.ptr + 1, end, version.second);
  if (minor.ec != std::errc{} || minor.ptr != end) return std::nullopt;
  return version;
}

std::optional<Version> version(const Asset& asset, const Element& info, const char* key) {
  const JsonValue* value = info.value->find(key);
  if (value == nullptr) return std::nullopt;
  const std::optional<Version> parsed = parse_version(value->string());
  if (!parsed) asset.fail(info.member(key), "must be a string like \"2.0\"");
  return parsed;
}

void check_version(Asset& asset) {
  const Element info = asset.root().member("asset");
  if (asset.root().value->find("asset") == nullptr) {
    asset.fail(asset.root(), "lacks the required property \"asset\": this is not glTF 2.0");
  }
  const std::optional<Version> written = version(asset, info, "version");
  const std::optional<Version> least = version(asset, info, "minVersion");
  if (!written) asset.fail(info, "lacks the required property \"version\"");
  if (written->first != 2) {
    asset.fail(info.member("version"), "only glTF 2 is supported; export the asset as glTF 2.0",
               ErrorKind::unsupported);
  }
  if (*written > Version{2, 0}) {
    asset.warn(info.member("version"), "is newer than glTF 2.0; the asset is read as glTF 2.0");
  }
  if (!least) return;
  const Element at = info.member("minVersion");
  if (least->first > 2) {
    asset.fail(at, "requires a later version than glTF 2, the supported one",
               ErrorKind::unsupported);
  }
  if (*least > *written) {
    asset.tolerate(at, "is greater than version");
  } else if (*least > Version{2, 0}) {
    asset.warn(at, "is newer than glTF 2.0; features of later versions are ignored");
  }
}

/// Warns about an extension that is required but not used, which glTF 2.0, section 3.12, forbids.
void check_extension(Asset& asset, const Element& at) {
  if (at.value->kind() != JsonValue::Kind::string) asset.fail(at, "must be a string");
  const std::string& name = at.value->string();
  if (!asset.uses(name)) {
    asset.tolerate(at, "is missing from extensionsUsed; the requirement is ignored");
  } else if (support_of(name) == Support::none) {
    asset.fail(at,
               "the asset requires extension " + in_quotes(name) +
                   ", which is not supported; export it without the extension",
               ErrorKind::unsupported);
  }
}

/// Warns if the extension for quantized meshes is used but not required. Readers without it can't
/// read such an asset.
void check_quantization(Asset& asset) {
  constexpr std::string_view kName = "KHR_mesh_quantization";
  if (asset.requires_extension(kName)) return;
  const std::vector<JsonValue>& used = asset.array("extensionsUsed");
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i].string() != kName) continue;
    asset.tolerate(asset.element("extensionsUsed", i), "must also be listed in extensionsRequired");
  }
}

class FeatureSearch {
 public:
  explicit FeatureSearch(Asset& asset) : asset_(asset) {}

  void material(const Element& at) {
    present(at, "emissiveTexture", emission);
    if (const JsonValue* factor = at.value->find("emissiveFactor")) {
      const auto shines = [](const JsonValue& item) { return item.number() != 0; };
      if (std::ranges::any_of(factor->items(), shines)) {
        asset_.warn(at.member("emissiveFactor"), emission);
      }
    }
  }

  void present(const Element& at, const char* key, const std::string& message) {
    if (at.value->find(key) != nullptr) asset_.warn(at.member(key), message);
  }

 private:
  inline static const std::string emission =
      "flat pictures ignore emission and show the base color";

  Asset& asset_;
};

}  // namespace

void check_requirements(Asset& asset) {
  if (asset.root().value->kind() != JsonValue::Kind::object) {
    asset.fail(asset.root(), "must be an object: this is not glTF 2.0");
  }
  check_version(asset);
  check_quantization(asset);
  for (std::size_t i = 0; i < asset.array("extensionsRequired").size(); ++i) {
    check_extension(asset, asset.element("extensionsRequired", i));
  }
}

void warn_of_ignored_features(Asset& asset, SurfaceDetail detail) {
  const std::vector<JsonValue>& used = asset.array("extensionsUsed");
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (support_of(used[i].string()) == Support::full) continue;
    asset.warn(asset.element("extensionsUsed", i),
               "extension " + in_quotes(used[i].string()) + " is not supported; it is ignored");
  }
  if (detail != SurfaceDetail::color) return;
  FeatureSearch search(asset);
  for (std::size_t i = 0; i < asset.array("materials").size(); ++i) {
    search.material(asset.element("materials", i));
  }
}

}  // namespace microtrace::io::gltf
