#include "dataset/annotations/coco.hpp"

#include "dataset/annotations/json_text.hpp"
#include "io/json/reader.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <array>

namespace microtrace::dataset {
namespace {

std::string bbox(const Mask& mask) {
  const PixelRect& box = mask.box();
  return json_array(std::array{box.x0, box.y0, box.size().width, box.size().height});
}

std::string segmentation(const Mask& mask, ImageSize size) {
  return JsonText('{')
      .json_member("size", json_array(std::array{size.height, size.width}))
      .member("counts", compressed_counts(column_counts(mask, size)))
      .text();
}

/// Returns the last line of a part.
std::string end_of_part(std::size_t annotations) {
  return JsonText('{').member("annotations", static_cast<std::uint64_t>(annotations)).text();
}

/// Separates the name of the category from the members in the line of an annotation. JSON escapes
/// tabs in names.
constexpr char kSeparator = '\t';

/// The line of an annotation: the name of its category, as JSON, and its members.
struct AnnotationLine {
  std::string_view category, members;

  explicit AnnotationLine(std::string_view line)
      : category(line.substr(0, line.find(kSeparator))),
        members(line.substr(std::min(category.size() + 1, line.size()))) {}

  /// Throws Error if the line is damaged.
  [[nodiscard]] std::string name() const {
    const io::JsonDocument document(category, "");
    return io::JsonReader(document).string();
  }
  [[nodiscard]] bool has_members() const {
    return members.starts_with('{') && members.find(',') != std::string_view::npos;
  }
  /// Returns the annotation with its ids. The first member is image_id.
  [[nodiscard]] std::string with(std::uint64_t id, std::uint32_t category_id) const {
    const std::size_t rest = members.find(',');
    std::string text = "{\"id\":" + std::to_string(id) + ',';
    text.append(members.substr(1, rest - 1)).append(",\"category_id\":");
    return text.append(std::to_string(category_id)).append(members.substr(rest));
  }
};

[[noreturn]] void refuse_part(std::size_t index) {
  throw Error(ErrorKind::io, "",
              "the annotations of view " + std::to_string(index) +
                  " are damaged or incomplete; render this view again");
}

/// Returns the name of a line's category.
std::string name_of(const AnnotationLine& line, std::size_t index) {
  try {
    if (line.has_members()) return line.name();
  } catch (const Error&) {  // refused below, like a line without members
  }
  refuse_part(index);
}

/// Returns the lines of a part without the last one.
std::vector<std::string_view> lines_of(std::string_view part, std::size_t index) {
  std::vector<std::string_view> lines;
  for (std::size_t end = 0; (end = part.find('\n')) != std::string_view::npos;) {
    lines.push_back(part.substr(0, end));
    part.remove_prefix(end + 1);
  }
  if (lines.size() < 2 || !part.empty() || lines.back() != end_of_part(lines.size() - 2))
    refuse_part(index);
  lines.pop_back();
  return lines;
}

}  // namespace

std::string category_name(CocoCategories by, const Scene& scene, const Object& object) {
  std::string name = by == CocoCategories::objects ? object.name.str()
                     : object.material             ? scene.materials[*object.material].name
                                                   : std::string();
  return name.empty() ? "unnamed" : name;
}

std::uint32_t Categories::number_of(const std::string& name) {
  const auto number = static_cast<std::uint32_t>(names_.size() + 1);
  const auto [place, is_new] = numbers_.emplace(name, number);
  if (is_new) names_.push_back(name);
  return place->second;
}

void Categories::add(const Scene& scene) {
  for (const Object& object : scene.objects) number_of(category_name(by_, scene, object));
}

std::string coco_part(const DrawnView& view, CocoCategories by, const Masks& visible,
                      const Masks* amodal) {
  JsonText image('{');
  image.member("id", view.index)
      .member("width", view.size.width)
      .member("height", view.size.height);
  if (!view.color_file.empty()) image.member("file_name", view.color_file);
  std::string text = image.text() + '\n';
  const Scene& scene = view.scene->scene();
  for (const auto& [index, mask] : visible) {
    const Object& object = scene.objects.at(index);
    JsonText annotation('{');
    annotation.member("image_id", view.index)
        .json_member("segmentation", segmentation(mask, view.size))
        .member("area", mask.area())
        .json_member("bbox", bbox(mask))
        .member("iscrowd", 0)
        .member("object", index)
        .member("object_name", object.name.str());
    if (const Mask* whole = amodal != nullptr ? find_mask(*amodal, index) : nullptr) {
      annotation.json_member("amodal_segmentation", segmentation(*whole, view.size))
          .member("amodal_area", whole->area())
          .json_member("amodal_bbox", bbox(*whole))
          .member("occlude_rate", static_cast<double>(whole->area() - mask.area()) /
                                      static_cast<double>(whole->area()));
    }
    io::append_json(text, category_name(by, scene, object));
    text += kSeparator;
    text.append(annotation.text()) += '\n';
  }
  return text.append(end_of_part(visible.size())) += '\n';
}

void join_coco(Categories categories, std::size_t count,
               const std::function<std::string(std::size_t)>& part,
               const std::function<void(std::string_view)>& out) {
  std::string text = "{\"info\":{\"description\":\"rendered by microtrace\"},\"licenses\":[],\n";
  std::string_view separator = "\"images\":[\n";
  for (std::size_t i = 0; i < count; ++i) {
    const std::string bytes = part(i);
    text.append(separator).append(lines_of(bytes, i).front());
    separator = ",\n";
    out(text);
    text.clear();
  }
  text.append(count == 0 ? "\"images\":[" : "").append("],\n");
  separator = "\"annotations\":[\n";
  std::uint64_t id = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string bytes = part(i);
    const std::vector<std::string_view> lines = lines_of(bytes, i);
    for (std::size_t k = 1; k < lines.size(); ++k) {
      const AnnotationLine line(lines[k]);
      text.append(separator).append(line.with(++id, categories.number_of(name_of(line, i))));
      separator = ",\n";
    }
    out(text);
    text.clear();
  }
  text.append(id == 0 ? "\"annotations\":[" : "").append("],\n");
  JsonText list('[');
  for (std::size_t k = 0; k < categories.names().size(); ++k) {
    list.json_item(JsonText('{')
                       .member("id", static_cast<std::uint64_t>(k + 1))
                       .member("name", categories.names()[k])
                       .member("supercategory", std::string_view())
                       .text());
  }
  out(text.append("\"categories\":").append(list.text()).append("}\n"));
}

}  // namespace microtrace::dataset
