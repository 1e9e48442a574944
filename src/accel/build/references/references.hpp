#pragma once
#include "accel/build/references/reference.hpp"
#include "accel/build/references/shape_box.hpp"
#include "accel/build/references/shape_reader.hpp"

#include <microtrace/page_allocator.hpp>
#include <microtrace/primitives.hpp>

#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace microtrace::build {

/// A bounded primitive, or a stored reference.
class CodedItem {
 public:
  /// Number of bits of a position, and of a mark.
  static constexpr unsigned kPositionBits = 28, kMarkBits = 3;

  CodedItem() = default;
  /// `number` is the id of a primitive or the index of a stored reference.
  CodedItem(bool is_stored, std::uint32_t number) : number_(number), tagged_code_(is_stored) {}

  [[nodiscard]] bool is_stored() const { return (tagged_code_ & 1U) != 0; }
  [[nodiscard]] std::uint32_t number() const { return number_; }
  void set_number(std::uint32_t number) { number_ = number; }
  /// A position along a space-filling curve and a mark. Both are the same for triangles with the
  /// same vertices. The mark distinguishes most other triangles with the same box, such as the two
  /// halves of a parallelogram.
  [[nodiscard]] std::uint32_t code() const { return tagged_code_ >> 1U; }
  [[nodiscard]] std::uint32_t position() const { return code() >> kMarkBits; }
  void set_code(std::uint32_t position, std::uint32_t mark) {
    tagged_code_ = position << (kMarkBits + 1) | mark << 1U | (tagged_code_ & 1U);
  }
  /// Different for any two items.
  [[nodiscard]] std::uint64_t key() const { return std::uint64_t{tagged_code_} << 32U | number_; }

 private:
  std::uint32_t number_, tagged_code_;
};

/// Maximum number of items per cell.
inline constexpr std::size_t kCellSize = 32;

/// References to the bounded primitives of a scene. Most are computed when they are needed, which
/// is faster than reading them from memory, because neighbors share vertices.
struct References {
  const Primitives* primitives = nullptr;
  PageVector<CodedItem> items{};
  PageVector<Reference> stored{};  ///< pieces of triangles, and instances
  /// The start of each cell of sorted items, and the end of the last. Empty if the items are not
  /// sorted.
  PageVector<std::uint32_t> cells{};
  std::vector<PrimitiveId> unbounded{};
  std::uint32_t triangle_weight = kTriangleWeight;  ///< or kUnsharedWeight
  double area = 0;                   ///< half the surface area of all bounded primitives' boxes
  Box box{};                         ///< of all bounded primitives
  std::vector<PrimitiveId> large{};  ///< all that are large enough for presplit()

  /// Stores references and adds their items.
  void store(PageVector<Reference> references);
  /// Moves the stored references to the order of the items.
  void order_stored();
  /// Removes the items for which f(item) is true.
  template <class F>
  void remove_if(const F& f) {
    if (std::erase_if(items, f) > 0) cells.clear();
  }
};

/// Reads references. Each thread needs its own reader.
class ReferenceReader {
 public:
  explicit ReferenceReader(const References& references)
      : references_(&references), shapes_(*references.primitives) {}

  /// Returns the reference of items[i], and expects that those of the next items are read soon.
  [[nodiscard]] Reference operator()(std::span<const CodedItem> items, std::size_t i) {
    const std::size_t ahead = i + ShapeReader::kAhead;
    if (ahead < items.size()) shapes_.prefetch(items[ahead].number());
    return (*this)(items[i]);
  }
  [[nodiscard]] Reference operator()(const CodedItem& item) {
    return item.is_stored() ? references_->stored[item.number()] : of_primitive(item.number());
  }

  /// Returns the mark of an item.
  [[nodiscard]] std::uint32_t mark(const CodedItem& item) {
    if (item.is_stored()) return 0;
    return shapes_.visit(item.number(), []<class AnyShape>(const AnyShape& shape) {
      if constexpr (std::is_same_v<AnyShape, Triangle>)
        return mark(shape);
      else
        return std::uint32_t{0};
    });
  }

  /// Returns the reference of a bounded primitive.
  [[nodiscard]] Reference of_primitive(PrimitiveId id) {
    return shapes_.visit(id, [&]<class AnyShape>(const AnyShape& shape) {
      if constexpr (std::is_same_v<AnyShape, Plane>) {
        return Reference();  // unbounded
      } else {
        const Box box = box_of(shape);
        return Reference(box, id, weight(shape, box));
      }
    });
  }

 private:
  [[nodiscard]] static std::uint32_t mark(const Triangle& t) {
    if (t.a == t.b || t.b == t.c || t.c == t.a) return 0;  // the set has fewer vertices
    const Float4 a = lanes(t.a), b = lanes(t.b), c = lanes(t.c);
    const auto median = std::bit_cast<UInt4>(max(min(a, b), min(max(a, b), c)));
    const std::uint32_t mixed = median[0] * 0x9E3779B1U ^ median[1] * 0x85EBCA77U ^ median[2];
    return mixed * 0xC2B2AE3DU >> (32 - CodedItem::kMarkBits);
  }

  // A float32 test can never exclude a hit with a triangle of three equal vertices, so each of them
  // needs its own box, like other primitives.
  template <class AnyShape>
  [[nodiscard]] std::uint32_t weight(const AnyShape&, const Box& box) const {
    const bool in_block = std::is_same_v<AnyShape, Triangle> && fits_blocks(box) && !is_point(box);
    return in_block ? references_->triangle_weight : kOtherWeight;
  }

  const References* references_;
  ShapeReader shapes_;
};

/// Divides the primitives of a scene's objects into bounded and unbounded ones, and omits empty
/// ones. is_instance[i] is true for objects to be left out. Throws Error (limit) if there are more
/// primitives than a tree can address. The items are not sorted.
[[nodiscard]] References gather(const Primitives& primitives, const std::vector<bool>& is_instance);

}  // namespace microtrace::build
