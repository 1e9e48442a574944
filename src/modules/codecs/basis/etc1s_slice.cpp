#include "modules/codecs/basis/etc1s.hpp"

#include <algorithm>
#include <utility>

namespace basis {
namespace {

constexpr const char* kDamaged = "an ETC1S slice is damaged";

/// Reads a number stored in groups of `width` bits. A bit after each group says whether another
/// group follows.
std::uint64_t read_groups(BitReader& bits, unsigned width) {
  std::uint64_t result = 0;
  for (unsigned shift = 0; shift < 32; shift += width) {
    const std::uint32_t group = bits.read(width + 1);
    result |= std::uint64_t{group & ((1U << width) - 1)} << shift;
    if (group >> width == 0) return result;
  }
  throw Damage(kDamaged);
}

/// The history of recently used selectors, in approximate move-to-front order.
class History {
 public:
  explicit History(std::size_t size) : values_(size), next_(size / 2) {}

  void add(std::uint32_t value) {
    if (values_.empty()) return;
    values_[next_] = value;
    if (++next_ == values_.size()) next_ = values_.size() / 2;
  }

  std::uint32_t use(std::size_t index) {
    if (index >= values_.size()) throw Damage(kDamaged);
    const std::uint32_t value = values_[index];
    std::swap(values_[index], values_[index / 2]);
    return value;
  }

 private:
  std::vector<std::uint32_t> values_;
  std::size_t next_;
};

/// Decodes the references of blocks to codebook entries, row by row.
class SliceDecoder {
 public:
  SliceDecoder(const Codebooks& books, Bytes slice, std::uint32_t blocks_x)
      : books_(books),
        bits_(slice),
        history_(books.history_size),
        above_(blocks_x),
        odd_row_((blocks_x + 1) / 2) {}

  std::uint32_t endpoint(std::uint32_t x, std::uint32_t y) {
    if (x % 2 == 0) prediction_ = y % 2 == 0 ? even_row_prediction(x) : odd_row_[x / 2];
    const std::uint32_t way = prediction_ & 3U;
    prediction_ >>= 2U;
    // `last_` is the left block's endpoint. In `above_`, this row's endpoints overwrite those of
    // the row above.
    const std::uint32_t upper = above_[x];
    if (way == 0) {
      if (x == 0) throw Damage(kDamaged);
    } else if (way == 1) {
      if (y == 0) throw Damage(kDamaged);
      last_ = upper;
    } else if (way == 2) {
      if (x == 0 || y == 0) throw Damage(kDamaged);
      last_ = upper_left_;
    } else {
      const auto count = static_cast<std::uint32_t>(books_.endpoints.size());
      last_ += books_.endpoint_deltas.decode(bits_);
      if (last_ >= count) last_ -= count;
      if (last_ >= count) throw Damage(kDamaged);
    }
    upper_left_ = upper;
    above_[x] = last_;
    return last_;
  }

  std::uint32_t selector() {
    const auto count = static_cast<std::uint32_t>(books_.selectors.size());
    const std::uint32_t symbol = selector_symbol(count);
    if (symbol >= count) return history_.use(symbol - count);
    history_.add(symbol);
    return symbol;
  }

 private:
  /// Decodes the endpoint predictions of 2 x 2 blocks, 2 bits each, and stores those of the bottom
  /// two blocks for the next row.
  std::uint32_t even_row_prediction(std::uint32_t x) {
    constexpr std::uint32_t kRepeat = 256, kLeastRepeats = 3;
    if (repeats_ > 0) {
      --repeats_;
    } else if (const std::uint32_t symbol = books_.predictions.decode(bits_); symbol < kRepeat) {
      last_prediction_ = symbol;
    } else if (symbol == kRepeat) {
      repeats_ = read_groups(bits_, 4) + kLeastRepeats - 1;
    } else {
      throw Damage(kDamaged);
    }
    odd_row_[x / 2] = static_cast<std::uint8_t>(last_prediction_ >> 4U);
    return last_prediction_;
  }

  /// Returns an index into the codebook, or the codebook's size `count` plus an index into the
  /// history.
  std::uint32_t selector_symbol(std::uint32_t count) {
    constexpr std::uint32_t kLeastRun = 3, kLongRun = 63;
    if (run_ > 0) {
      --run_;
      return count;
    }
    const std::uint32_t symbol = books_.selector_symbols.decode(bits_);
    if (symbol != count + books_.history_size) return symbol;
    const std::uint32_t length = books_.history_runs.decode(bits_);
    run_ = (length == kLongRun ? read_groups(bits_, 7) : length) + kLeastRun - 1;
    return count;
  }

  const Codebooks& books_;
  BitReader bits_;
  History history_;
  std::vector<std::uint32_t> above_;   // from the current column on, endpoints of the row above
  std::vector<std::uint8_t> odd_row_;  // predictions for pairs of blocks
  std::uint32_t upper_left_ = 0, last_ = 0, prediction_ = 0, last_prediction_ = 0;
  std::uint64_t repeats_ = 0, run_ = 0;
};

/// ETC1's modifiers, in the order of selector values (Khronos Data Format Specification 1.3, table
/// 116).
constexpr std::array<std::array<int, 4>, 8> kModifiers = {{{-8, -2, 2, 8},
                                                           {-17, -5, 5, 17},
                                                           {-29, -9, 9, 29},
                                                           {-42, -13, 13, 42},
                                                           {-60, -18, 18, 60},
                                                           {-80, -24, 24, 80},
                                                           {-106, -33, 33, 106},
                                                           {-183, -47, 47, 183}}};

/// Returns the four colors of a block.
std::array<Color, 4> palette(const Endpoint& endpoint) {
  std::array<Color, 4> result{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const int base = endpoint.color[c] << 3 | endpoint.color[c] >> 2;
      result[i][c] =
          static_cast<std::uint8_t>(std::clamp(base + kModifiers[endpoint.intensity][i], 0, 255));
    }
    result[i][3] = result[i][1];  // alpha slices store alpha in green
  }
  return result;
}

void decode_slice(const Codebooks& books, Bytes slice, const Texels& texels, std::uint32_t first,
                  std::uint32_t end) {
  SliceDecoder decoder(books, slice, texels.blocks_x());
  for (std::uint32_t y = 0; y < texels.blocks_y(); ++y) {
    for (std::uint32_t x = 0; x < texels.blocks_x(); ++x) {
      const std::array<Color, 4> colors = palette(books.endpoints[decoder.endpoint(x, y)]);
      const Selector& selector = books.selectors[decoder.selector()];
      Block block;
      for (std::size_t i = 0; i < 16; ++i) block[i] = colors[selector[i / 4] >> 2 * (i % 4) & 3];
      texels.set_block(x, y, block, first, end);
    }
  }
}

}  // namespace

void decode_color_slice(const Codebooks& books, const Texels& texels) {
  decode_slice(books, books.color_slice, texels, 0, 3);
}

void decode_second_slice(const Codebooks& books, const Texels& texels, std::uint32_t channel) {
  decode_slice(books, books.second_slice, texels, channel, channel + 1);
}

}  // namespace basis
