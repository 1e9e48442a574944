#pragma once
/// Annotations for object detection and instance segmentation in the JSON format of COCO
/// (https://cocodataset.org/#format-data).

#include "dataset/annotations/drawn_view.hpp"
#include "dataset/annotations/masks.hpp"

#include <microtrace/annotations.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::dataset {

/// Returns the name of an object's category.
[[nodiscard]] std::string category_name(CocoCategories by, const Scene& scene,
                                        const Object& object);

/// The categories of a data set, numbered from 1 in the order in which they were added.
class Categories {
 public:
  explicit Categories(CocoCategories by) : by_(by) {}

  /// Adds the categories of all objects of a scene, in their order.
  void add(const Scene& scene);

  /// Returns the number of the category with this name, which is added if it is new.
  std::uint32_t number_of(const std::string& name);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  CocoCategories by_;
  std::vector<std::string> names_;
  std::map<std::string, std::uint32_t, std::less<>> numbers_;
};

/// Returns a view's part of the annotations, for join_coco(): lines of JSON, which are the
/// image, the name of the category and an annotation without ids for each visible object, and the
/// number of annotations: views may show different scenes, whose objects and materials differ. If
/// `amodal` is not null, annotations also have the members amodal_segmentation, amodal_area,
/// amodal_bbox and occlude_rate, the hidden fraction of the amodal area (as in COCO Amodal).
[[nodiscard]] std::string coco_part(const DrawnView& view, CocoCategories by, const Masks& visible,
                                    const Masks* amodal = nullptr);

/// Passes the JSON file for the parts of `count` views to `out`. Image ids are the views' indices.
/// Annotation ids count from 1 in the order of the parts. Categories that are new follow the given
/// ones. Calls part(i) twice for each i, in order, and keeps one part in memory at a time. Throws
/// Error (io) if a part is incomplete.
void join_coco(Categories categories, std::size_t count,
               const std::function<std::string(std::size_t)>& part,
               const std::function<void(std::string_view)>& out);

}  // namespace microtrace::dataset
