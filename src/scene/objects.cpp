#include <microtrace/error.hpp>
#include <microtrace/objects.hpp>

#include <algorithm>
#include <iterator>
#include <mutex>
#include <variant>

namespace microtrace {
namespace {

/// Returns the object at index i of a run with these placements.
Object object_at(const Object& first, const std::shared_ptr<const std::vector<Placement>>& places,
                 std::size_t i) {
  Object result = first;
  result.name = first.name.with_number(static_cast<std::uint32_t>(i));
  std::get<Mesh>(result.shape).placement = {places, &(*places)[i]};
  return result;
}

}  // namespace

struct Objects::Made {
  std::once_flag flag;
  std::vector<Object> objects;
};

const std::vector<Object>& Objects::made_all() const {
  std::call_once(made_->flag, [this] {
    std::vector<Object> objects;
    objects.reserve(size());
    for (std::size_t i = 0; i < firsts_.size(); ++i) {
      const auto& placements = spans_[i].placements;
      if (!placements) objects.push_back(firsts_[i]);
      for (std::size_t k = 0; placements && k < placements->size(); ++k)
        objects.push_back(object_at(firsts_[i], placements, k));
    }
    made_->objects = std::move(objects);
  });
  return made_->objects;
}

std::vector<Object>& Objects::edit() {
  if (!spans_.empty()) {
    firsts_ = all();
    spans_.clear();
    made_.reset();
  }
  return firsts_;
}

void Objects::add_spans() {
  if (spans_.empty()) {
    spans_.reserve(firsts_.size() + 1);
    for (std::size_t i = 0; i < firsts_.size(); ++i) spans_.push_back({.begin = i});
  }
}

void Objects::forget_made() {
  made_ = spans_.empty() ? nullptr : std::make_shared<Made>();
}

void Objects::push_back(Object object) {
  if (!spans_.empty()) {
    spans_.push_back({.begin = size()});
    forget_made();
  }
  firsts_.push_back(std::move(object));
}

void Objects::push_back_run(Object object, std::vector<Placement> placements) {
  const auto* mesh = std::get_if<Mesh>(&object.shape);
  if (mesh == nullptr || !mesh->segments.empty())
    throw Error(ErrorKind::usage, "", "push_back_run() needs a mesh without segments");
  if (placements.empty()) return;
  add_spans();
  spans_.push_back(
      {.begin = size(),
       .placements = std::make_shared<const std::vector<Placement>>(std::move(placements))});
  forget_made();
  firsts_.push_back(object_at(object, spans_.back().placements, 0));
}

void Objects::append(Objects&& more) {
  if (!spans_.empty() || !more.spans_.empty()) {
    more.add_spans();
    const std::size_t first = size();
    add_spans();
    for (Span& span : more.spans_)
      spans_.push_back({.begin = first + span.begin, .placements = std::move(span.placements)});
    forget_made();
  }
  firsts_.insert(firsts_.end(), std::move_iterator(more.firsts_.begin()),
                 std::move_iterator(more.firsts_.end()));
  more.clear();
}

std::size_t Objects::find_run(std::size_t object) const {
  const auto after = std::ranges::upper_bound(spans_, object, {}, &Span::begin);
  return static_cast<std::size_t>(after - spans_.begin()) - 1;
}

ObjectName Objects::name(std::size_t object) const {
  const ObjectRun own = run(run_of(object));
  if (own.placements == nullptr) return own.first->name;
  return own.first->name.with_number(static_cast<std::uint32_t>(object - own.begin));
}

}  // namespace microtrace
