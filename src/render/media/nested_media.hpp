#pragma once
#include "render/media/medium.hpp"

#include <cstdint>
#include <deque>

namespace microtrace {

/// The media of the bodies around a point, from the body that a path entered last outward. Where
/// bodies overlap, the first of these media is present. Null stands for the vacuum around all
/// bodies.
struct NestedMedia {
  const Medium* medium;
  const NestedMedia* outer;

  std::uint32_t number = 0;                    ///< in the table, counted from 1
  int depth = 1;                               ///< number of media
  mutable const NestedMedia* inner = nullptr;  ///< a list of these media with another one within
  const NestedMedia* next = nullptr;           ///< next member of that list
};

/// What lies on the other side of a surface.
struct Beyond {
  const NestedMedia* media;         ///< the media behind the surface
  const Medium* outside = nullptr;  ///< the medium around the body that the surface encloses; null
                                    ///< for a vacuum
};

/// The nested media of paths (C. Schmidt and B. Budge, Simple nested dielectrics in ray traced
/// images, 2002). Priorities, which glTF doesn't have, are replaced by the order in which a path
/// enters bodies: of a body that lies within another one, the surface is entered last, so its
/// medium has the highest priority. Each combination of media is stored once, so a path's state is
/// one number.
class NestedMediaTable {
 public:
  /// Forgets all media, which invalidates all pointers and numbers.
  void clear();

  /// True if no path has been in a medium.
  [[nodiscard]] bool empty() const { return all_.empty(); }

  /// The media with this number; null for 0, which stands for the vacuum.
  [[nodiscard]] const NestedMedia* at(std::uint32_t number) const {
    return number == 0 ? nullptr : &all_[number - 1];
  }
  [[nodiscard]] static std::uint32_t number_of(const NestedMedia* media) {
    return media == nullptr ? 0 : media->number;
  }

  /// Follows a path in `here` to the other side of a surface that encloses the medium `own`, or
  /// null if the surface is a thin wall. `front` is true if the path arrives from outside.
  [[nodiscard]] Beyond cross(const Medium* own, bool front, const NestedMedia* here);

  /// The media without the innermost one that is `own`. The same media if there is none.
  [[nodiscard]] const NestedMedia* without(const NestedMedia* media, const Medium& own);

  /// True if a path in `here` doesn't notice that it leaves a body with the medium `own` (null for
  /// thin walls), because it has since entered a body that overlaps the surface.
  [[nodiscard]] static bool is_hidden(const Medium* own, bool front, const NestedMedia* here);

 private:
  /// Deeper nesting occurs only if surfaces aren't closed. The outermost medium is then forgotten.
  static constexpr int kMostNested = 8;

  const NestedMedia* with(const NestedMedia* media, const Medium& own);
  const NestedMedia* without_outermost(const NestedMedia& media);

  std::deque<NestedMedia> all_;
  NestedMedia vacuum_{.medium = nullptr, .outer = nullptr, .depth = 0};  // owns the first list
};

}  // namespace microtrace
