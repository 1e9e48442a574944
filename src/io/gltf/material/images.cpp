#include "io/gltf/material/images.hpp"

#include "base/memory_account.hpp"
#include "base/text/printable.hpp"
#include "io/file.hpp"
#include "io/gltf/bytes/resource.hpp"
#include "io/gltf/bytes/uri.hpp"
#include "io/gltf/document/properties.hpp"
#include "io/gltf/extensions/extensions.hpp"
#include "io/gltf/material/image_problems.hpp"
#include "io/gltf/material/textures.hpp"
#include "io/image/decode/decode_image.hpp"
#include "io/image/decode/image_header.hpp"
#include "io/image/decode/ktx2_colors.hpp"
#include "scene/material_textures.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace microtrace::io::gltf {
namespace {

/// The maximum size of an image file in bytes.
constexpr std::size_t kMaxImageBytes = std::size_t{1} << 30U;
/// The maximum total size of all image files in bytes. A file or buffer view counts once for each
/// image that uses it.
constexpr std::uint64_t kMaxBytesOfImages = std::uint64_t{1} << 32U;

std::string_view media_type(ImageFormat format) {
  constexpr std::array<std::string_view, 5> kTypes = {"", "image/png", "image/jpeg", "image/webp",
                                                      "image/ktx2"};
  return kTypes[static_cast<std::size_t>(format)];
}

/// Returns the declared media type of an image. Empty if undeclared.
std::string declared_type(const Element& at) {
  if (const JsonValue* type = at.value->find("mimeType")) return type->string();
  const JsonValue* uri = at.value->find("uri");
  if (uri == nullptr) return {};
  const std::optional<DataUri> data = split_data_uri(uri->string());
  return data ? data->media_type : std::string();
}

/// True if the type is that of the format. Accepts image/jpg, which is not registered but common.
bool is_type_of(std::string_view type, ImageFormat format) {
  return type == media_type(format) || (type == "image/jpg" && format == ImageFormat::jpeg);
}

/// Returns true if a data URI declares the correct media type. Otherwise warns (glTF 2.0, section
/// 2.8), as the Khronos validator does.
bool check_media_type(Asset& asset, const Element& uri, ImageFormat format) {
  constexpr std::array<std::string_view, 2> kNotDecoded = {"image/avif", "image/vnd-ms.dds"};
  const std::string type = split_data_uri(uri.value->string())->media_type;
  const bool is_right = format == ImageFormat::unknown
                            ? std::ranges::find(kNotDecoded, type) != kNotDecoded.end()
                            : is_type_of(type, format);
  if (is_right) return true;
  asset.tolerate(uri, "has the media type " + in_quotes(type) + ", but the data is " +
                          (format == ImageFormat::unknown ? "neither PNG, JPEG, WebP nor KTX2"
                                                          : std::string(media_type(format))));
  return false;
}

bool has_file(const Element& image) {
  const JsonValue* uri = image.value->find("uri");
  return uri != nullptr && !is_data_uri(uri->string());
}

/// Returns the place of problems with an image's bytes: the name of its file, if it has one.
Element place_of(const Element& image) {
  return has_file(image) ? image.member("uri") : image;
}

class ImageLoader {
 public:
  ImageLoader(Asset& asset, const BufferViews& views, const ResourceFolders& folders)
      : asset_(asset), views_(views), folders_(folders) {}

  /// Sets `problem` if the image can't be read.
  std::shared_ptr<const Image> load(const Element& at, ImageUse use,
                                    std::optional<ImageProblem>& problem) {
    using enum ImageProblem::Kind;
    if (const std::optional<Refusal> refusal = refusal_of_file(at)) {
      problem = {refusal->is_violation ? violation : limitation, at.member("uri"),
                 refusal->reason + "; "};
      note_unread_resource(at.member("uri"), folders_);
      return nullptr;
    }
    if (is_missing(at)) {
      problem = {violation, at.member("uri"), "names a file that does not exist; "};
      note_unread_resource(at.member("uri"), folders_);
      add_to_read_digest("missing image");  // the picture is another one
      return nullptr;
    }
    std::string storage;
    MemoryAccount file(memory_account().budget());
    const std::optional<std::string_view> bytes = bytes_of(at, storage, file);
    if (!bytes) {
      problem = {limitation, at, "is in a buffer that has no data; "};
      return nullptr;
    }
    bytes_ += bytes->size();
    if (bytes_ > kMaxBytesOfImages) {
      asset_.fail(at, "brings the image files to more than 4 GiB, the limit", ErrorKind::limit);
    }
    const ImageHeader header = read_image_header(*bytes);
    const JsonValue* uri = at.value->find("uri");
    const bool is_right = uri == nullptr || !is_data_uri(uri->string()) ||
                          check_media_type(asset_, at.member("uri"), header.format);
    if (header.format == ImageFormat::unknown) {
      problem = {limitation, place_of(at), "is neither PNG, JPEG, WebP nor KTX2; "};
      return nullptr;
    }
    if (header.state == ImageHeader::State::damaged) {
      problem = {damaged_header, place_of(at), "holds a damaged image, whose header has no size; "};
      return nullptr;
    }
    if (header.state == ImageHeader::State::cut_off) {
      problem = {violation, place_of(at), "holds an image that is truncated; "};
      return nullptr;
    }
    const std::string type = declared_type(at);
    if (is_right && !type.empty() && !is_type_of(type, header.format)) {
      asset_.tolerate(at, "is declared as " + in_quotes(std::string(type)) + ", but it is " +
                              std::string(media_type(header.format)));
    }
    if (type != media_type(header.format)) check_extension(at, header.format);
    if (header.format == ImageFormat::ktx2) check_ktx2(at, header, *bytes, use);
    return use.is_wanted() ? decode(at, header, *bytes, problem) : nullptr;
  }

 private:
  [[nodiscard]] std::optional<Refusal> refusal_of_file(const Element& image) const {
    return has_file(image) ? refusal_of(image.member("uri"), folders_) : std::nullopt;
  }
  [[nodiscard]] bool is_missing(const Element& image) const {
    return has_file(image) && is_missing_resource(image.member("uri"), folders_);
  }

  std::optional<std::string_view> bytes_of(const Element& at, std::string& storage,
                                           MemoryAccount& memory) const {
    const MemoryScope scope(memory);
    if (const JsonValue* view = at.value->find("bufferView")) {
      return views_.bytes(index_from(*view));
    }
    const Element uri = at.member("uri");
    storage = is_data_uri(uri.value->string())
                  ? decode_data_uri(asset_, uri)
                  : read_resource(asset_, uri, folders_, "image", kMaxImageBytes);
    return storage;
  }

  /// Warns if an image's format needs an extension that the asset does not declare. check_images
  /// has already checked declared media types.
  void check_extension(const Element& at, ImageFormat format) {
    const auto known = std::ranges::find(extensions(), media_type(format), &Extension::image_type);
    if (known == extensions().end() || asset_.uses(known->name)) return;
    asset_.tolerate(at, "is " + std::string(known->image_type) + ", which needs extension " +
                            std::string(known->name));
  }

  /// Warns about violations of KHR_texture_basisu that don't prevent decoding. The decoder rejects
  /// files with other violations.
  void check_ktx2(const Element& at, const ImageHeader& header, std::string_view bytes,
                  ImageUse use) {
    if (header.width % 4 != 0 || header.height % 4 != 0) {
      asset_.tolerate(at, "has sides that are not multiples of 4, as KHR_texture_basisu requires");
    }
    const std::optional<Ktx2Colors> colors = read_ktx2_colors(bytes);
    if (!colors) return;
    if (colors->is_premultiplied) {
      asset_.tolerate(at, "declares premultiplied alpha; the colors are used as they are");
    }
    // An image may be used both for its colors and for data in its alpha. Alpha is linear in either
    // encoding.
    const bool is_srgb = colors->encoding == ColorEncoding::srgb;
    if (!use.is_wanted() || (colors->encoding && (is_srgb ? use.srgb : use.linear))) return;
    asset_.tolerate(at, std::string("declares its values ") +
                            (!colors->encoding ? "neither sRGB nor linear"
                             : is_srgb         ? "sRGB"
                                               : "linear") +
                            ", but materials use them as " + (use.srgb ? "sRGB" : "linear") +
                            ", which takes precedence");
  }

  std::shared_ptr<const Image> decode(const Element& at, const ImageHeader& header,
                                      std::string_view bytes,
                                      std::optional<ImageProblem>& problem) {
    const std::uint64_t pixels = std::uint64_t{header.width} * header.height;
    if (pixels_ + pixels > kMaxTexturePixels) {
      asset_.fail(at, "brings the images to more than 2^28 pixels, the limit", ErrorKind::limit);
    }
    DecodedImage decoded = decode_image(bytes);
    if (decoded.image) pixels_ += pixels;
    if (decoded.no_module) {
      add_to_read_digest("without decoder");  // the picture is another one
      problem = {ImageProblem::Kind::limitation, at, kNotDecoded, ": " + decoded.complaint};
      return nullptr;
    }
    if (decoded.too_large) {
      asset_.fail(at, "has more pixels than its header states or than fit in memory",
                  ErrorKind::limit);
    }
    if (!decoded.image) {
      problem = {ImageProblem::Kind::violation, place_of(at), kNotDecoded,
                 ": " + decoded.complaint};
      return nullptr;
    }
    if (!decoded.complaint.empty()) {
      asset_.tolerate(place_of(at), "holds an incomplete image: " + decoded.complaint);
    }
    if (const JsonValue* name = at.value->find("name")) decoded.image->name = name->string();
    return std::make_shared<const Image>(std::move(*decoded.image));
  }

  static constexpr const char* kNotDecoded = "can't be decoded, so ";

  Asset& asset_;
  const BufferViews& views_;
  const ResourceFolders& folders_;
  std::uint64_t bytes_ = 0, pixels_ = 0;
};

}  // namespace

std::vector<ImageUse> image_uses(std::span<const Material> materials,
                                 const std::vector<bool>& drawn, std::span<const Texture> textures,
                                 std::size_t images, SurfaceDetail detail) {
  std::vector<ImageUse> uses(images);
  const auto reads = [detail](const Material& material, MaterialTexture texture) {
    if (detail == SurfaceDetail::all) return affects_light(material, texture);
    if (texture != MaterialTexture::base_color) return false;
    return detail != SurfaceDetail::shape || material.alpha_mode != AlphaMode::opaque;
  };
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (!drawn[i]) continue;
    for_each_named_texture(
        materials[i], [&](MaterialTexture texture, const TextureUse& use, ColorEncoding encoding) {
          const auto& image = textures[use.texture].image;
          if (!image || !reads(materials[i], texture)) return;
          (encoding == ColorEncoding::srgb ? uses[*image].srgb : uses[*image].linear) = true;
        });
  }
  return uses;
}

std::vector<std::shared_ptr<const Image>> load_images(Asset& asset, const BufferViews& views,
                                                      const ResourceFolders& folders,
                                                      std::vector<ImageUse> uses,
                                                      std::vector<Texture>& textures) {
  std::vector<std::vector<std::uint32_t>> choices;
  for (const JsonValue& json : asset.array("textures")) choices.push_back(images_of(json));
  ImageLoader loader(asset, views, folders);
  std::vector<std::shared_ptr<const Image>> images(uses.size());
  std::vector<std::optional<ImageProblem>> problems(uses.size());
  const auto load = [&](std::size_t i) {
    images[i] = loader.load(asset.element("images", i), uses[i], problems[i]);
  };
  for (std::size_t i = 0; i < uses.size(); ++i)
    if (uses[i].is_wanted()) load(i);
  for (std::size_t i = 0; i < textures.size(); ++i) {
    std::optional<std::uint32_t>& image = textures[i].image;
    for (std::size_t k = 1; k < choices[i].size(); ++k) {
      if (images[*image] || !uses[*image].is_wanted()) break;
      const ImageUse use = uses[*image];
      image = choices[i][k];
      if (uses[*image].is_wanted()) continue;
      uses[*image] = use;
      load(*image);
    }
  }
  for (std::size_t i = 0; i < uses.size(); ++i)
    if (!uses[i].is_wanted()) load(i);
  report_problems(asset, problems, uses, textures, choices);
  return images;
}

}  // namespace microtrace::io::gltf
