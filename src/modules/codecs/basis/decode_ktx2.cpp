#include "modules/codecs/basis/etc1s.hpp"
#include "modules/codecs/basis/ktx2.hpp"
#include "modules/codecs/basis/texels.hpp"
#include "modules/codecs/basis/uastc.hpp"
#include "modules/codecs/codecs.hpp"

#include <new>
#include <string>
#include <vector>
#include <zstd.h>

// All decoding uses integer arithmetic, so it gives the same bits on every machine.

namespace basis {
namespace {

/// Returns the texture's blocks, which have `size` bytes in all. If they are compressed,
/// decompresses them into `storage`.
Bytes uastc_blocks(const Ktx2& ktx2, std::size_t size, std::vector<unsigned char>& storage) {
  if (!ktx2.is_zstd) return ktx2.level;
  // The headers of frames need not state their sizes.
  storage.resize(size);
  const std::size_t written =
      ZSTD_decompress(storage.data(), size, ktx2.level.data(), ktx2.level.size());
  if (ZSTD_isError(written) != 0) {
    throw Damage(std::string("the Zstandard data is damaged: ") + ZSTD_getErrorName(written));
  }
  if (written != size) throw Damage("the Zstandard data does not have the size of the blocks");
  return storage;
}

/// Gives texels that have only red and green a blue of 0.
void keep_red_and_green(Channels channels, Block& block) {
  if (channels == Channels::rgb || channels == Channels::rgba) return;
  const std::size_t green = channels == Channels::red_alpha ? 3 : 1;
  for (Color& color : block) color = {color[0], color[green], 0, 255};
}

void decode_uastc(const Ktx2& ktx2, const Texels& texels) {
  std::vector<unsigned char> storage;
  const std::size_t row = std::size_t{texels.blocks_x()} * kUastcBlockSize;
  const Bytes blocks = uastc_blocks(ktx2, row * texels.blocks_y(), storage);
  for (std::uint32_t y = 0; y < texels.blocks_y(); ++y) {
    for (std::uint32_t x = 0; x < texels.blocks_x(); ++x) {
      const Bytes bytes = blocks.subspan(y * row + x * kUastcBlockSize, kUastcBlockSize);
      Block block = decode_uastc_block(bytes);
      keep_red_and_green(ktx2.channels, block);
      texels.set_block(x, y, block, 0, texels.channels);
    }
  }
}

void decode_etc1s(const Ktx2& ktx2, const Texels& texels) {
  const Codebooks books = read_codebooks(ktx2);
  decode_color_slice(books, texels);
  if (ktx2.channels == Channels::rgba) decode_second_slice(books, texels, 3);
  if (ktx2.channels == Channels::red_alpha) {
    decode_second_slice(books, texels, 1);
    const std::size_t count = std::size_t{texels.width} * texels.height;
    for (std::size_t i = 0; i < count; ++i) texels.samples[i * texels.channels + 2] = 0;
  }
}

bool decode(Bytes file, const MicrotraceImageSink& sink) {
  const Ktx2 ktx2 = read_ktx2(file);
  const MicrotraceImageHeader header{ktx2.width, ktx2.height,
                                     ktx2.channels == Channels::rgba ? 4U : 3U, 8};
  auto* samples = static_cast<unsigned char*>(sink.begin(sink.context, &header));
  if (samples == nullptr) return false;
  const Texels texels{samples, header.width, header.height, header.channels};
  if (ktx2.format == TexelFormat::uastc) {
    decode_uastc(ktx2, texels);
  } else {
    decode_etc1s(ktx2, texels);
  }
  return true;
}

}  // namespace
}  // namespace basis

int decode_ktx2(const unsigned char* bytes, std::size_t size, const MicrotraceImageSink& sink) {
  try {
    return basis::decode(basis::Bytes(bytes, size), sink) ? 1 : 0;
  } catch (const basis::Damage& damage) {
    sink.complain(sink.context, damage.what());
  } catch (const std::bad_alloc&) {
    sink.complain(sink.context, "needs more memory than there is");
  }
  return 0;
}
