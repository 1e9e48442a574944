#pragma once
/// Types shared by the shading kernels of all instruction sets: input, output, and the table of
/// functions. These are plain data only, because functions in a header that other files include
/// must not be compiled for a specific instruction set.
///
/// A kernel performs the same computation for up to kShadingLanes paths.

#include "render/lanes/environment_lanes.hpp"
#include "render/lanes/features.hpp"
#include "render/lanes/film_lanes.hpp"
#include "render/lanes/flat_lanes.hpp"
#include "render/lanes/guide_lanes.hpp"
#include "render/lanes/light_lanes.hpp"
#include "render/lanes/surface_lanes.hpp"
#include "render/lanes/textured_lanes.hpp"

#include <cstddef>
#include <cstdint>

namespace microtrace {

/// The values of SurfacePoint for `width` hits of mesh triangles.
template <int width>
struct alignas(width * sizeof(float)) HitArrays {
  using Floats = float[width];

  Floats o[3], d[3];
  Floats corners[3][3];  ///< [corner][axis]
  Floats normals[3][3];  ///< normals of the vertices; zero if the mesh has none
  Floats uv[3][2];       ///< texture coordinates of set 0; zero if the mesh has none
  // The kernel sets the members below.
  Floats is_sure;  ///< 1 if the other results are valid, otherwise 0
  Floats p[3], n[3], ns[3], weights[3], first_uv[2];
  Floats from_behind;  ///< 1 if the ray hits the back, otherwise 0
  Floats distance, first_uv_scale;
  Floats area;  ///< twice the triangle's area
};
using HitLanes = HitArrays<kShadingLanes>;

/// Points on surfaces whose shading normals are needed.
struct alignas(64) NormalLanes {
  LaneFloats d[3];            ///< direction of the incoming ray
  LaneFloats n[3], ns[3];     ///< geometric and interpolated normal of the front side
  LaneFloats side;            ///< 1 if the ray hits the front, -1 if it hits the back
  LaneFloats tangents[3][3];  ///< tangents of the vertices, [vertex][axis]
  LaneFloats weights[3];      ///< barycentric weights of the vertices
  LaneFloats handedness;      ///< handedness of the tangents; 0 if there are no tangents
};
/// The texels of a normal texture at these points.
struct alignas(64) NormalMapLanes {
  LaneFloats texel[3], scale;
  LaneFloats is_mapped;  ///< 0 if there is no texture
  // The kernel sets the members below.
  LaneFloats normal[3];  ///< shading normal on the ray's side
};

/// Path vertices on surfaces with the same bsdf::Features, for direct light and the next direction.
struct alignas(64) ScatterLanes {
  LaneFloats d[3];  ///< direction of the incoming ray
  LaneFloats frame_n[3];
  LaneFloats outwards[3];  ///< geometric normal on the ray's side
  SurfaceLanes surface;
  LaneFloats throughput[3];
  LaneFloats through_weight[3];  ///< weight of light that crosses the surface
  /// Members of LightSample; light is 0 if there is no sample.
  LaneFloats light_wi[3], light[3], light_pdf;
  std::uint32_t key[kShadingLanes], index[kShadingLanes];  ///< key and index of sampling::Sobol
  // Only with ScatterSetup::is_guided:
  LaneFloats u[2], chances[2];  ///< the pairs of random numbers `direction_pair` and `lobe_pair`
  LaneFloats guide_part;        ///< probability of sampling the guide
  LaneFloats guide_wi[3];       ///< the guide's sample
  LaneFloats light_guide_pdf;   ///< the guide's pdf of light_wi
  // For finish_guided():
  LaneFloats guide_pdf;   ///< the guide's pdf of wi
  LaneFloats brightness;  ///< of PathGuide::Cell; negative where paths are not guided
  LaneFloats is_smooth;   ///< 1 if the BSDF samples better than the guide, otherwise 0
  // The kernel sets the members below.
  LaneFloats shadow[3];  ///< contribution of the light if it is not occluded
  LaneFloats pdf;        ///< pdf of the next direction; 0 if there is none
  LaneFloats is_below;   ///< 1 if the next direction is below the surface, otherwise 0
  LaneFloats wi[3], next_throughput[3];
};

/// Parameters that all paths of a ScatterLanes share.
struct ScatterSetup {
  bsdf::Features features;
  std::uint32_t direction_pair, lobe_pair;
  float most_survival;  ///< maximum survival probability; 1 disables Russian roulette
  /// True if directions are sampled by a mixture of BSDF and guide. The kernel then neither divides
  /// next_throughput by the pdf nor plays Russian roulette, and ScatterLanes::pdf is the BSDF's;
  /// finish_guided() does the rest.
  bool is_guided = false;
};

/// An array of 32-bit values whose lanes are appended to another one.
struct ColumnCopy {
  const float* from;
  float* to;
};
/// The lanes to append: the elements from + i of the source for each bit i. The first one becomes
/// element `to`.
struct AppendedLanes {
  std::uint32_t lanes;  ///< one bit for each of kShadingLanes lanes
  std::size_t from, to;
  /// True if the arrays to which lanes are appended have only kShadingLanes elements. Otherwise,
  /// kShadingLanes elements from `to` on may be overwritten.
  bool fills_lanes = false;
};

struct ShadingKernels {
  const char* name;
  /// Appends lanes to all of these arrays. Returns the number of lanes.
  int (*append)(const ColumnCopy* columns, int column_count, const AppendedLanes& which);
  /// Computes sampling::Sobol(keys[i], indices[i]).pair(number) for kShadingLanes samples.
  void (*random_pairs)(const std::uint32_t* keys, const std::uint32_t* indices,
                       std::uint32_t number, float* x, float* y);
  /// Computes only the first numbers of these pairs.
  void (*random_numbers)(const std::uint32_t* keys, const std::uint32_t* indices,
                         std::uint32_t number, float* x);
  /// Samples positions in pixels, measured from their upper left corners, by these pairs of random
  /// numbers. A filter of null is the box filter.
  void (*sample_positions)(const std::uint32_t* keys, const std::uint32_t* indices,
                           std::uint32_t number, const FilterTable* filter, double* x, double* y);
  /// Adds one sample to each of kShadingLanes consecutive pixels, except samples that are not
  /// numbers or whose terms exceed TermSums::kLimit. Returns the latter's lanes. The samples are
  /// colors with alpha, at a distance of `stride` samples.
  std::uint32_t (*sum_samples)(const SumSetup& setup, const float* samples, std::size_t stride,
                               TermSums& sums, std::size_t pixel);
  void (*find_points)(HitLanes& lanes);
  /// See flat_points.hpp.
  void (*find_flat_points)(const FlatTriangle* triangles, FlatHits& flat, HitLanes& hits);
  void (*load_surfaces)(const FlatSurface* table, const std::uint32_t (&which)[kShadingLanes],
                        SurfaceLanes& to);
  /// See load_textured.hpp.
  void (*load_textured)(const TexturedSurface& surface, std::uint32_t lanes, const HitLanes& hits,
                        const LaneFloats& widths, TexturedLanes& to, SurfaceLanes& surfaces,
                        NormalMapLanes& normals);
  void (*find_normals)(const NormalLanes& points, NormalMapLanes& map);
  void (*choose_lights)(const LightChoiceSetup& setup, LightChoices<kShadingLanes>& lanes);
  void (*sample_triangles)(const TriangleLight* triangles,
                           const TriangleChoices<kShadingLanes>& choices,
                           const LightChoices<kShadingLanes>& points,
                           LightSamples<kShadingLanes>& samples);
  void (*sample_punctual)(const PunctualLight* lights,
                          const PunctualChoices<kShadingLanes>& choices,
                          const LightChoices<kShadingLanes>& points,
                          LightSamples<kShadingLanes>& samples);
  /// Makes these vectors unit vectors.
  void (*normalize)(LaneFloats (&vectors)[3]);
  /// See map_light.hpp.
  void (*find_map_places)(const MapShape& shape, MapLanes<kShadingLanes>& lanes);
  void (*look_up_map)(const MapShape& shape, MapLanes<kShadingLanes>& lanes);
  void (*sample_map)(const MapShape& shape, MapLanes<kShadingLanes>& lanes);
  /// Sets the probabilities of selecting the environment.
  void (*environment_probabilities)(const LightChoiceSetup& setup,
                                    LightChoices<kShadingLanes>& lanes);
  /// See sample_environment.hpp.
  void (*split_environment)(const LightChoices<kShadingLanes>& choices, int count,
                            EnvironmentSamples<kShadingLanes>& samples);
  void (*sample_sphere)(const LaneFloats (&u)[2], LaneFloats (&d)[3]);
  void (*mix_environment_pdfs)(const LaneFloats (&wi)[3], EnvironmentCells<kShadingLanes>& cells,
                               LaneFloats& pdfs);
  void (*finish_environment)(const LightChoices<kShadingLanes>& choices,
                             EnvironmentSamples<kShadingLanes>& from,
                             LightSamples<kShadingLanes>& samples);
  /// See sky_grid.hpp.
  void (*find_sky_cells)(const SkyGrid& grid, const LaneFloats (&p)[3], const LaneFloats (&n)[3],
                         std::uint32_t (&cells)[kShadingLanes]);
  void (*scatter)(const ScatterSetup& setup, ScatterLanes& lanes);
  /// See guide_table.hpp.
  void (*sample_guides)(GuideLanes<kShadingLanes>& lanes);
  void (*guide_pdfs)(GuideLanes<kShadingLanes>& lanes);
  /// Makes directions that scatter() has sampled those of the mixture of BSDF and guide.
  void (*finish_guided)(float most_survival, ScatterLanes& lanes);
};

extern const ShadingKernels kPortableShading;
#if defined(__x86_64__)
extern const ShadingKernels kAvx2Shading, kAvx512Shading;
#endif

}  // namespace microtrace
