#include "base/little_endian.hpp"
#include "base/memory_account.hpp"
#include "base/system/float_environment.hpp"
#include "io/checkpoint/bytes.hpp"
#include "io/checkpoint/pixel_blocks.hpp"
#include "io/file.hpp"
#include "io/output/atomic_file.hpp"
#include "io/output/output_target.hpp"
#include "scene/validate/validate.hpp"

#include <microtrace/checkpoint.hpp>
#include <microtrace/digest.hpp>
#include <microtrace/error.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// The file contains a magic text, a version, the members in the order in which the functions below
// read them, and a digest of everything before it. Pixels and the values of channels are stored in
// blocks (pixel_blocks.hpp), each after its size in bytes. All numbers are unsigned and
// little-endian. Floating-point numbers are stored as their bits.

namespace microtrace {
namespace {

constexpr std::string_view kMagic = "microtrace samples\n";
constexpr std::uint32_t kVersion = 5;
constexpr std::size_t kMaxFileSize = std::size_t{1} << 36U;
constexpr std::uint32_t kMostSamples = 65536;  // per pixel; sample ranges end at or below it
constexpr std::uint32_t kMaxIdentity = 1U << 20U, kMaxChannels = 256, kMaxChannelName = 256;
constexpr std::size_t kLeastBlock = 16;  // bytes

/// How the values of a channel are stored.
enum class Values : std::uint32_t { computed, floats, integers };

std::string encode_head(const Checkpoint& checkpoint) {
  const SampleSums& sums = checkpoint.sums;
  std::string bytes(kMagic);
  append_little(bytes, kVersion);
  append_little(bytes, static_cast<std::uint32_t>(checkpoint.identity.size()));
  bytes += checkpoint.identity;
  append_little(bytes, std::uint32_t{checkpoint.has_alpha});
  append_little(bytes, std::uint32_t{checkpoint.has_lens});
  append_little(bytes, std::uint32_t{checkpoint.has_ground});
  append_little(bytes, checkpoint.samples);
  append_little(bytes, std::bit_cast<std::uint64_t>(checkpoint.display.exposure));
  append_little(bytes, static_cast<std::uint32_t>(checkpoint.display.tone_map));
  for (const std::uint32_t number : {sums.whole.width, sums.whole.height, sums.window.x0,
                                     sums.window.y0, sums.window.x1, sums.window.y1})
    append_little(bytes, number);
  for (const float number : {sums.background.x, sums.background.y, sums.background.z})
    append_little(bytes, number);
  append_little(bytes, static_cast<std::uint32_t>(sums.ranges().size()));
  for (const SampleRange& range : sums.ranges()) {
    append_little(bytes, range.first);
    append_little(bytes, range.last);
  }
  return bytes;
}

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& message) {
  throw Error(ErrorKind::io, path.string(), message);
}

[[noreturn]] void fail_as_damaged(const std::filesystem::path& path) {
  fail(path, "is damaged or was cut off; remove it and render its samples again");
}

/// Decodes the members between the version and the pixels. The result has as many pixels as its
/// window.
Checkpoint decode_head(io::ByteReader& reader, const std::filesystem::path& path) {
  const auto word = [&] { return reader.number<std::uint32_t>(); };
  Checkpoint checkpoint;
  const std::uint32_t identity_size = word();
  const auto identity = reader.take(std::min(identity_size, kMaxIdentity));
  if (!identity) fail_as_damaged(path);
  checkpoint.identity = *identity;
  checkpoint.has_alpha = word() != 0;
  checkpoint.has_lens = word() != 0;
  checkpoint.has_ground = word() != 0;
  checkpoint.samples = word();
  checkpoint.display.exposure = std::bit_cast<double>(reader.number<std::uint64_t>());
  const std::uint32_t tone_map = word();
  if (tone_map >= kToneMaps.size()) fail_as_damaged(path);
  checkpoint.display.tone_map = kToneMaps[tone_map];
  ImageSize whole;
  PixelRect window;
  for (std::uint32_t* number :
       {&whole.width, &whole.height, &window.x0, &window.y0, &window.x1, &window.y1})
    *number = word();
  Vec3 background(0);
  for (float* number : {&background.x, &background.y, &background.z})
    *number = std::bit_cast<float>(word());
  const std::uint32_t range_count = word();
  const bool is_window = window.x0 < window.x1 && window.x1 <= whole.width &&
                         window.y0 < window.y1 && window.y1 <= whole.height;
  if (!is_window || range_count > kMostSamples) fail_as_damaged(path);
  std::vector<SampleRange> ranges(range_count);
  std::uint32_t end = 0;
  for (SampleRange& range : ranges) {
    range.first = word();
    range.last = word();
    const bool is_next = range.first >= end && range.first < range.last;
    if (!is_next || range.last > kMostSamples) fail_as_damaged(path);
    end = range.last;
  }
  const ImageSize size = window.size();
  const std::uint64_t pixels = std::uint64_t{size.width} * size.height;
  // Refuses a small file that claims to have many pixels before it allocates memory for them.
  const std::uint64_t blocks = pixels / io::kBlockPixels;
  if (reader.is_short() || pixels > kMaxImagePixels || reader.left() / kLeastBlock < blocks)
    fail_as_damaged(path);
  take_memory(pixels * sizeof(PixelSum), "the samples of a checkpoint");
  checkpoint.sums = SampleSums(whole, window, background);
  for (const SampleRange& range : ranges) checkpoint.sums.note(range);
  return checkpoint;
}

/// Writes the parts of a checkpoint to its file.
class CheckpointWriter {
 public:
  explicit CheckpointWriter(const std::filesystem::path& path) : file_(path) {}

  void write(std::string_view bytes) {
    digest_.add(bytes);
    file_.write(bytes);
  }

  template <class Value>
  void write_blocks(const std::vector<Value>& values) {
    io::for_each_block(std::span(values), [&](std::span<const Value> block) {
      const std::string_view encoded = blocks_.encode(block);
      std::string size;
      append_little(size, static_cast<std::uint32_t>(encoded.size()));
      write(size);
      write(encoded);
    });
  }

  void write(const Channel& channel, bool is_only_for_denoising) {
    const bool is_computed = is_computed_channel(channel.name);
    const bool is_float = std::holds_alternative<std::vector<float>>(channel.values);
    std::string head;
    append_little(head, static_cast<std::uint32_t>(channel.name.size()));
    head += channel.name;
    append_little(head, static_cast<std::uint32_t>(is_computed ? Values::computed
                                                   : is_float  ? Values::floats
                                                               : Values::integers));
    append_little(head, std::uint32_t{is_only_for_denoising});
    write(head);
    if (!is_computed) std::visit([&](const auto& values) { write_blocks(values); }, channel.values);
  }

  /// Writes the end of the file. Returns the file, which must still be committed.
  io::AtomicFile& end() {
    std::string end;
    append_little(end, digest_.value());
    file_.write(end);
    file_.sync();
    return file_;
  }

 private:
  io::AtomicFile file_;
  Digest digest_;
  io::BlockWriter blocks_;
};

/// Reads blocks and channels.
class BlocksOfFile {
 public:
  BlocksOfFile(io::ByteReader& reader, const std::filesystem::path& path)
      : reader_(reader), path_(path), blocks_(path) {}

  template <class Value>
  void read(std::vector<Value>& values) {
    io::for_each_block(std::span(values), [&](std::span<Value> block) {
      const auto encoded = reader_.take(reader_.number<std::uint32_t>());
      if (reader_.is_short() || !encoded || !blocks_.decode(*encoded, block))
        fail_as_damaged(path_);
    });
  }

  /// Appends a channel to those of the checkpoint.
  void read_channel(Checkpoint& checkpoint) {
    const std::size_t pixels = checkpoint.sums.pixels.size();
    const auto name = reader_.take(std::min(reader_.number<std::uint32_t>(), kMaxChannelName));
    const auto kind = static_cast<Values>(reader_.number<std::uint32_t>());
    const bool is_only_for_denoising = reader_.number<std::uint32_t>() != 0;
    const bool is_known = name && !reader_.is_short() && kind <= Values::integers &&
                          is_computed_channel(*name) == (kind == Values::computed);
    if (!is_known) fail_as_damaged(path_);
    if (is_only_for_denoising) checkpoint.only_for_denoising.emplace_back(*name);
    Channel& channel =
        checkpoint.channels.emplace_back(Channel{.name = std::string(*name), .values = {}});
    if (kind == Values::computed) return;
    if (reader_.left() / kLeastBlock < pixels / io::kBlockPixels) fail_as_damaged(path_);
    take_memory(pixels * sizeof(float), "the channels of a checkpoint");
    if (kind == Values::floats) {
      read(channel.values.emplace<0>(pixels));
    } else {
      read(channel.values.emplace<1>(pixels));
    }
  }

 private:
  io::ByteReader& reader_;
  const std::filesystem::path& path_;
  io::BlockReader blocks_;
};

/// Writes all of the file. Returns it as CheckpointWriter::end() does.
io::AtomicFile& write_to(CheckpointWriter& file, const Checkpoint& checkpoint) {
  file.write(encode_head(checkpoint));
  file.write_blocks(checkpoint.sums.pixels);
  std::string count;
  append_little(count, static_cast<std::uint32_t>(checkpoint.channels.size()));
  file.write(count);
  for (const Channel& channel : checkpoint.channels) {
    file.write(channel, std::ranges::binary_search(checkpoint.only_for_denoising, channel.name));
  }
  return file.end();
}

}  // namespace

void save_checkpoint(const Checkpoint& checkpoint, const std::filesystem::path& path) {
  const FloatEnvironment environment;
  CheckpointWriter file(path);
  write_to(file, checkpoint).commit();
}

bool replace_checkpoint(const Checkpoint& checkpoint, const std::filesystem::path& path,
                        const FileState& known) {
  CheckpointWriter file(path);
  return write_to(file, checkpoint).commit_over(known);
}

Checkpoint load_checkpoint(const std::filesystem::path& path) {
  MemoryAccount memory(memory_account().budget());  // of the file's bytes
  const std::string bytes = [&] {
    const MemoryScope scope(memory);
    return io::read_file(path, kMaxFileSize, [&](std::string_view first) {
      if (!first.starts_with(kMagic)) fail(path, "is not a checkpoint of microtrace");
    });
  }();
  io::ByteReader reader(std::string_view(bytes).substr(kMagic.size()));
  const auto version = reader.number<std::uint32_t>();
  if (version != kVersion && !reader.is_short()) {
    fail(path, "has version " + std::to_string(version) + " of its format, not " +
                   std::to_string(kVersion) + "; use the program that wrote it");
  }
  if (bytes.size() < kMagic.size() + 12) fail_as_damaged(path);
  const std::string_view content = std::string_view(bytes).substr(0, bytes.size() - 8);
  io::ByteReader end(std::string_view(bytes).substr(content.size()));
  Digest digest;
  digest.add(content);
  if (end.number<std::uint64_t>() != digest.value()) fail_as_damaged(path);
  reader = io::ByteReader(content.substr(kMagic.size() + sizeof(kVersion)));
  Checkpoint checkpoint = decode_head(reader, path);
  checkpoint.file = path;
  BlocksOfFile blocks(reader, path);
  blocks.read(checkpoint.sums.pixels);
  const auto channels = reader.number<std::uint32_t>();
  if (channels > kMaxChannels) fail_as_damaged(path);
  for (std::uint32_t i = 0; i < channels; ++i) blocks.read_channel(checkpoint);
  std::ranges::sort(checkpoint.only_for_denoising);
  if (reader.is_short() || reader.left() != 0) fail_as_damaged(path);
  return checkpoint;
}

Film picture_of(const Checkpoint& checkpoint) {
  Film film = develop(checkpoint.sums,
                      checkpoint.has_alpha ? Film::Alpha::premultiplied : Film::Alpha::none);
  film.display = checkpoint.display;
  film.has_lens = checkpoint.has_lens;
  film.has_ground = checkpoint.has_ground;
  film.channels = checkpoint.channels;
  compute_channels(checkpoint.sums, film.channels);
  return film;
}

void check_checkpoint_path(const std::filesystem::path& path) {
  if (path == "-" || io::is_stream(path))
    throw Error(ErrorKind::usage, path.string(), "can't be a checkpoint; name a file");
  io::check_target(path);
}

}  // namespace microtrace
