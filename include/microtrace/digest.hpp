#pragma once
/// A non-cryptographic hash of byte strings.

#include <microtrace/export.hpp>

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace microtrace {

/// A 64-bit hash, the same on every machine. Two different inputs collide with a probability of
/// about 2^-64. Not secure against deliberate collisions.
class Digest {
 public:
  /// Appends bytes. The result depends only on the sequence of bytes, not on its division into
  /// calls.
  void add(std::string_view bytes) {
    for (; !bytes.empty() && filled_ != 0; bytes.remove_prefix(1)) add_byte(bytes[0]);
    for (; bytes.size() >= 8; bytes.remove_prefix(8)) {
      std::uint64_t word = 0;
      for (std::size_t i = 8; i-- > 0;) word = word << 8U | static_cast<unsigned char>(bytes[i]);
      mix(word);
    }
    for (const char byte : bytes) add_byte(byte);
  }

  [[nodiscard]] std::uint64_t value() const {
    Digest ended = *this;
    ended.mix(rest_);
    ended.mix(8 * words_ + filled_);  // the length in bytes distinguishes inputs that differ only
                                      // in trailing zeros
    return ended.state_ ^ ended.state_ >> 29U;
  }

 private:
  void add_byte(char byte) {
    rest_ |= std::uint64_t{static_cast<unsigned char>(byte)} << (8 * filled_);
    if (++filled_ < 8) return;
    mix(rest_);
    filled_ = 0;
    rest_ = 0;
  }

  // Mixes one word into the state, with a multiplier and shifts of SplitMix64 (S. Vigna).
  void mix(std::uint64_t word) {
    state_ = (state_ ^ word) * 0xbf58476d1ce4e5b9U;
    state_ ^= state_ >> 31U;
    ++words_;
  }

  std::uint64_t state_ = 0x9e3779b97f4a7c15U, words_ = 0;
  std::uint64_t rest_ = 0;  ///< bytes of an incomplete word
  unsigned filled_ = 0;     ///< number of bytes in rest_
};

/// During its lifetime, hashes all bytes that the library reads on this thread from files and
/// standard input. If several objects exist on a thread, only the most recent one hashes.
class MICROTRACE_EXPORT ReadDigest {
 public:
  ReadDigest();
  ~ReadDigest();
  ReadDigest(const ReadDigest&) = delete;
  ReadDigest& operator=(const ReadDigest&) = delete;

  [[nodiscard]] std::uint64_t value() const { return digest_.value(); }

 private:
  Digest digest_;
  Digest* former_;
};

}  // namespace microtrace
