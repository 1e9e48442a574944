#pragma once
/// The lighting of a picture: emitters, the environment, and light sampling.

#include "base/lazy.hpp"
#include "render/lanes/shading_kernels.hpp"
#include "render/lighting/environment_guide.hpp"
#include "render/lighting/ground_light.hpp"
#include "render/lights/choose_lights.hpp"
#include "render/lights/emitters.hpp"
#include "render/lights/environment/environment_light.hpp"
#include "render/lights/light_sample.hpp"

#include <microtrace/hit.hpp>
#include <microtrace/math.hpp>

#include <memory>
#include <optional>
#include <span>

namespace microtrace {

/// All light of a picture. Immutable; any number of threads may use it.
class Lighting {
 public:
  /// The emitters and `visibility` must outlive this object. `is_seen` is true if the environment
  /// is visible to camera rays. `visibility` is null unless the scene is enclosed.
  Lighting(const Emitters& emitters, std::optional<EnvironmentLight> environment, bool is_seen,
           const SkyVisibility* visibility);

  /// Working memory for sample().
  struct Choices {
    LightChoices<kShadingLanes> points{};
    TriangleChoices<kShadingLanes> triangles{};
    PunctualChoices<kShadingLanes> punctual{};
    EnvironmentSamples<kShadingLanes> environment{};
  };
  /// Samples a light for each of `count` points. points.p and n are the points, points.choice
  /// selects the light, and triangles.u the position on it. If a uniform environment is selected
  /// without a guide, the sample has no light, because uniform environments are left to BSDF
  /// sampling.
  void sample(const ShadingKernels& kernels, int count, Choices& choices,
              LightSamples<kShadingLanes>& samples) const;

  /// True if sample() can return light.
  [[nodiscard]] bool can_sample() const {
    return emitters_.has_near() || emitters_.has_far() || samples_environment();
  }

  /// True if paths can reach light by chance: the environment or emissive surfaces.
  [[nodiscard]] bool may_surround() const { return environment_ || emitters_.has_surfaces(); }

  /// True if paths can reach emissive surfaces by chance.
  [[nodiscard]] bool has_surfaces() const { return emitters_.has_surfaces(); }

  /// True if the environment is visible to camera rays.
  [[nodiscard]] bool is_seen() const { return is_seen_; }

  /// The environment's radiance from a unit direction.
  [[nodiscard]] Vec3 environment(const Vec3& wi) const {
    return environment_ ? environment_->radiance(wi) : Vec3(0);
  }
  [[nodiscard]] bool has_environment() const { return environment_ != nullptr; }
  /// True if the environment's radiance is the same from everywhere.
  [[nodiscard]] bool has_uniform_environment() const {
    return environment_ && environment_->is_uniform();
  }
  /// Rays that leave the scene.
  struct Escapes {
    MapLanes<kShadingLanes> lights{};         ///< d holds the directions, of any length
    LightChoices<kShadingLanes> origins{};    ///< p and n are LightSampleContexts
    EnvironmentCells<kShadingLanes> cells{};  ///< working memory
  };
  /// Makes the directions in these lanes unit vectors, and sets the environment's radiance and the
  /// pdf with which sample() would sample them. Leaves out the pdf for rays from the camera.
  void environment(const ShadingKernels& kernels, Lanes lanes, bool from_camera,
                   Escapes& escapes) const;

  /// The pdf with which sample() would sample the point of an emissive surface that a path from the
  /// context hits after `distance`. `cosine` is the cosine of the angle between the path and the
  /// surface normal.
  [[nodiscard]] float emitter_pdf(PrimitiveId id, const LightSampleContext& context, float distance,
                                  float cosine) const;

  /// The light on a ground below the scene of this lighting.
  [[nodiscard]] const GroundLight& ground(const Scene& scene) const {
    return ground_.get([&] { return std::make_unique<GroundLight>(scene, environment_.get()); });
  }

 private:
  /// The guide's cell for a surface; null if there is no guide.
  [[nodiscard]] const EnvironmentGuide::Cell* cell(const Vec3& p, const Vec3& n) const {
    return guide_ ? &guide_->at(p, n) : nullptr;
  }
  [[nodiscard]] KindProbabilities<1> probabilities(const LightSampleContext& context,
                                                   const EnvironmentGuide::Cell* cell) const {
    return kind_probabilities<1>(setup_, in_tree_units<1>(setup_.space, context.p), context.n,
                                 cell != nullptr ? cell->share : 1);
  }
  /// Finds the guide's cells for the surfaces in these lanes. Sets points.share.
  void find_cells(const ShadingKernels& kernels, Lanes lanes, LightChoices<kShadingLanes>& points,
                  EnvironmentCells<kShadingLanes>& cells) const;
  /// Sets the samples of the lanes for which the environment is selected.
  void sample_environment(const ShadingKernels& kernels, int count, Choices& choices,
                          LightSamples<kShadingLanes>& samples) const;
  /// Sets the sample of a lane for which a near light is selected, unless it is a triangle of a
  /// mesh or a punctual light, which kernels sample.
  void sample_near(int lane, Choices& choices, LightSamples<kShadingLanes>& samples) const;
  [[nodiscard]] bool samples_environment() const {
    return environment_ && (guide_ || !environment_->is_uniform());
  }

  const Emitters& emitters_;
  std::unique_ptr<const EnvironmentLight> environment_;
  bool is_seen_;
  std::unique_ptr<const EnvironmentGuide> guide_;
  LightChoiceSetup setup_;
  Lazy<GroundLight> ground_;
};

}  // namespace microtrace
