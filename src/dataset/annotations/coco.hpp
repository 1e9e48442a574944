#pragma once
/// Annotations for object detection and instance segmentation in the JSON format of COCO
/// (https://cocodataset.org/#format-data).

#include "dataset/annotations/drawn_view.hpp"
#include "dataset/annotations/masks.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::dataset {

/// The property of objects that determines their category.
enum class CategoryBy { object_name, material_name };

/// The categories of a data set, numbered from 1 in the order in which they were added.
class Categories {
 public:
  explicit Categories(CategoryBy by) : by_(by) {}

  /// Adds the categories of all objects of a scene, in their order.
  void add(const Scene& scene);

  /// Returns the number of an object's category. Throws Error (usage) if it was not added.
  [[nodiscard]] std::uint32_t of(const Scene& scene, const Object& object) const;

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  [[nodiscard]] std::string name_of(const Scene& scene, const Object& object) const;

  CategoryBy by_;
  std::vector<std::string> names_;
  std::map<std::string, std::uint32_t, std::less<>> numbers_;
};

/// Returns a view's part of the annotations, for join_coco(): lines of JSON, which are the
/// image, an annotation without its id for each visible object, and the number of annotations. If
/// `amodal` is not null, annotations also have the members amodal_segmentation, amodal_area,
/// amodal_bbox and occlude_rate, the hidden fraction of the amodal area (as in COCO Amodal).
[[nodiscard]] std::string coco_part(const DrawnView& view, const Categories& categories,
                                    const Masks& visible, const Masks* amodal = nullptr);

/// Passes the JSON file for the parts of `count` views to `out`. Image ids are the views' indices.
/// Annotation ids count from 1 in the order of the parts. Calls part(i) twice for each i, in order,
/// and keeps one part in memory at a time. Throws Error (io) if a part is incomplete.
void join_coco(const Categories& categories, std::size_t count,
               const std::function<std::string(std::size_t)>& part,
               const std::function<void(std::string_view)>& out);

}  // namespace microtrace::dataset
