#include "render/media/nested_media.hpp"

namespace microtrace {
namespace {

bool contains(const NestedMedia* media, const Medium* own) {
  for (; media != nullptr; media = media->outer) {
    if (media->medium == own) return true;
  }
  return false;
}

}  // namespace

void NestedMediaTable::clear() {
  all_.clear();
  vacuum_.inner = nullptr;
}

Beyond NestedMediaTable::cross(const Medium* own, bool front, const NestedMedia* here) {
  if (own == nullptr) return {.media = here};
  // On the front, the path is still outside, and on the back it will be.
  const NestedMedia* around = front ? here : without(here, *own);
  return {.media = front ? with(here, *own) : around,
          .outside = around == nullptr ? nullptr : around->medium};
}

const NestedMedia* NestedMediaTable::with(const NestedMedia* media, const Medium& own) {
  if (media != nullptr && media->depth == kMostNested) {
    media = without_outermost(*media);
  }
  const NestedMedia& outer = media == nullptr ? vacuum_ : *media;
  for (const NestedMedia* known = outer.inner; known != nullptr; known = known->next) {
    if (known->medium == &own) return known;
  }
  all_.push_back({.medium = &own,
                  .outer = media,
                  .number = static_cast<std::uint32_t>(all_.size() + 1),
                  .depth = outer.depth + 1,
                  .next = outer.inner});
  outer.inner = &all_.back();
  return outer.inner;
}

const NestedMedia* NestedMediaTable::without_outermost(const NestedMedia& media) {
  if (media.outer == nullptr) return nullptr;
  return with(without_outermost(*media.outer), *media.medium);
}

const NestedMedia* NestedMediaTable::without(const NestedMedia* media, const Medium& own) {
  if (!contains(media, &own)) return media;
  if (media->medium == &own) return media->outer;
  return with(without(media->outer, own), *media->medium);
}

bool NestedMediaTable::is_hidden(const Medium* own, bool front, const NestedMedia* here) {
  return own != nullptr && !front && here != nullptr && here->medium != own &&
         contains(here->outer, own);
}

}  // namespace microtrace
