#pragma once
#include <microtrace/export.hpp>

#include <memory>

namespace microtrace {

struct MapTables;
struct Environment;

/// What pictures have in common, kept from one to the next: the tables by which the map of their
/// environment is sampled, as long as the map is the same object. Has no influence on pictures. One
/// rendering at a time uses it.
class MICROTRACE_EXPORT RenderCache {
 public:
  RenderCache();
  ~RenderCache();
  RenderCache(const RenderCache&) = delete;
  RenderCache& operator=(const RenderCache&) = delete;

  /// For src/render/lights: those of an environment that is not uniform, made if they are not here.
  [[nodiscard]] std::shared_ptr<const MapTables> tables_of(const Environment& environment);

 private:
  std::shared_ptr<const MapTables> last_;
  bool is_studio_ = false;
};

}  // namespace microtrace
