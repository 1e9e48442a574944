#pragma once
/// The objects of a scene, of which there may be millions.

#include <microtrace/export.hpp>
#include <microtrace/object_name.hpp>
#include <microtrace/shape.hpp>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace microtrace {

/// A shape and its material.
struct Object {
  ObjectName name{};
  Shape shape;
  std::optional<std::uint32_t> material{};  ///< index into Scene::materials; nothing: Material{}
};

/// Consecutive objects that differ only in their placements and in the numbers of their names, or a
/// single object.
struct ObjectRun {
  const Object* first;          ///< the first object
  std::size_t begin, count;     ///< indices in Objects
  const Placement* placements;  ///< of each mesh; null for a single object

  /// Returns the mesh of the object with index begin + i, or null if its shape is not a mesh.
  [[nodiscard]] PlacedMesh mesh(std::size_t i) const {
    const auto* mesh = std::get_if<Mesh>(&first->shape);
    if (mesh == nullptr) return {};
    return placements != nullptr ? PlacedMesh(*mesh, placements + i) : PlacedMesh(*mesh);
  }
};

/// Reads and changes like a std::vector<Object>. Runs of instances are stored as one object and the
/// placements of all. Their objects are made when they are first read one by one: use runs() to
/// read scenes that may have many instances. Any number of threads may read a const object. Access
/// to one that isn't const, also by begin() or an index, is a change: it calls edit().
class MICROTRACE_EXPORT Objects {
 public:
  using value_type = Object;
  using size_type = std::size_t;
  using difference_type = std::ptrdiff_t;
  using reference = Object&;
  using const_reference = const Object&;
  using iterator = std::vector<Object>::iterator;
  using const_iterator = std::vector<Object>::const_iterator;

  Objects() = default;
  Objects(std::vector<Object> objects)  // NOLINT(google-explicit-constructor)
      : firsts_(std::move(objects)) {}
  Objects(std::initializer_list<Object> objects) : firsts_(objects) {}

  [[nodiscard]] std::size_t size() const {
    return spans_.empty() ? firsts_.size() : spans_.back().end();
  }
  [[nodiscard]] bool empty() const { return firsts_.empty(); }

  /// Returns the objects one by one.
  [[nodiscard]] const std::vector<Object>& all() const {
    return spans_.empty() ? firsts_ : made_all();
  }
  [[nodiscard]] const Object& operator[](std::size_t i) const { return all()[i]; }
  [[nodiscard]] const Object& at(std::size_t i) const { return all().at(i); }
  [[nodiscard]] const Object& front() const { return firsts_.front(); }
  [[nodiscard]] const Object& back() const { return all().back(); }
  [[nodiscard]] const_iterator begin() const { return all().begin(); }
  [[nodiscard]] const_iterator end() const { return all().end(); }

  /// Returns the objects as a modifiable vector, in which each object of a run is stored.
  [[nodiscard]] std::vector<Object>& edit();
  [[nodiscard]] Object& operator[](std::size_t i) { return edit()[i]; }
  [[nodiscard]] Object& at(std::size_t i) { return edit().at(i); }
  [[nodiscard]] Object& front() { return edit().front(); }
  [[nodiscard]] Object& back() { return edit().back(); }
  [[nodiscard]] iterator begin() { return edit().begin(); }
  [[nodiscard]] iterator end() { return edit().end(); }
  template <class... Arguments>
  iterator insert(const_iterator at, Arguments&&... arguments) {
    const auto place = editable(at);
    return edit().insert(place, std::forward<Arguments>(arguments)...);
  }
  iterator erase(const_iterator at) { return erase(at, at + 1); }
  iterator erase(const_iterator first, const_iterator last) {
    const std::ptrdiff_t count = last - first;
    const auto begin = editable(first);  // ends the life of `last`
    return edit().erase(begin, begin + count);
  }
  void resize(std::size_t size, const Object& value) { edit().resize(size, value); }
  void pop_back() { edit().pop_back(); }

  void clear() { *this = Objects(); }
  void reserve(std::size_t runs) { firsts_.reserve(runs); }
  void push_back(Object object);
  /// Appends a run of instances. `object` is a mesh without a placement and without segments. The
  /// instances have these placements and the names object.name.with_number(0), (1), (2) and so on.
  /// Throws Error (usage) for other shapes.
  void push_back_run(Object object, std::vector<Placement> placements);
  /// Appends objects, and keeps their runs.
  void append(Objects&& more);

  /// The runs, in the order of their objects.
  class Runs {
   public:
    class Iterator {
     public:
      Iterator(const Objects& objects, std::size_t i) : objects_(&objects), i_(i) {}
      [[nodiscard]] ObjectRun operator*() const { return objects_->run(i_); }
      Iterator& operator++() {
        ++i_;
        return *this;
      }
      [[nodiscard]] bool operator==(const Iterator& other) const { return i_ == other.i_; }

     private:
      const Objects* objects_;
      std::size_t i_;
    };

    explicit Runs(const Objects& objects) : objects_(objects) {}
    [[nodiscard]] Iterator begin() const { return {objects_, 0}; }
    [[nodiscard]] Iterator end() const { return {objects_, size()}; }
    [[nodiscard]] std::size_t size() const { return objects_.firsts_.size(); }

   private:
    const Objects& objects_;
  };
  [[nodiscard]] Runs runs() const { return Runs(*this); }
  [[nodiscard]] ObjectRun run(std::size_t i) const {
    if (spans_.empty())
      return {.first = &firsts_[i], .begin = i, .count = 1, .placements = nullptr};
    const Span& span = spans_[i];
    return {.first = &firsts_[i],
            .begin = span.begin,
            .count = span.end() - span.begin,
            .placements = span.placements ? span.placements->data() : nullptr};
  }
  /// Returns the index of the run that contains the object with this index.
  [[nodiscard]] std::size_t run_of(std::size_t object) const {
    return spans_.empty() ? object : find_run(object);
  }
  /// Returns the first object of the run that contains the object with this index. They differ at
  /// most in name and placement.
  [[nodiscard]] const Object& first_of(std::size_t object) const { return firsts_[run_of(object)]; }
  /// Calls f(object) for the first object of each run, whose material it may change for all.
  template <class F>
  void edit_runs(const F& f) {
    for (Object& object : firsts_) f(object);
    forget_made();
  }
  /// Returns the name of the object with this index.
  [[nodiscard]] ObjectName name(std::size_t object) const;

 private:
  struct Span {
    std::size_t begin;                                           // index of the first object
    std::shared_ptr<const std::vector<Placement>> placements{};  // null for a single object

    [[nodiscard]] std::size_t end() const { return begin + (placements ? placements->size() : 1); }
  };
  struct Made;

  /// Returns the place in edit() of an iterator of all().
  [[nodiscard]] const_iterator editable(const_iterator at) {
    const std::ptrdiff_t i = at - all().begin();
    return edit().cbegin() + i;
  }
  void add_spans();
  void forget_made();
  [[nodiscard]] const std::vector<Object>& made_all() const;
  [[nodiscard]] std::size_t find_run(std::size_t object) const;

  std::vector<Object> firsts_;  // the first object of each run
  std::vector<Span> spans_;     // of each run; empty if all are single objects
  std::shared_ptr<Made> made_;  // all objects, if there are spans; shared by copies
};

}  // namespace microtrace
