#pragma once
/// Looks up the textures of surfaces in lanes.

#include "render/bsdf/base_surface.hpp"
#include "render/lanes/shading_kernels.hpp"
#include "render/lanes/textured_lanes.hpp"
#include "render/textures/read_texel.hpp"
#include "simd/transpose.hpp"

namespace microtrace {
inline namespace MICROTRACE_KERNELS {

/// The texel addresses of all lanes.
struct alignas(64) TexelAddresses {
  using Ints = std::int32_t[kShadingLanes];
  Ints level, columns, left, right, top, bottom;
  LaneFloats right_share, bottom_share;

  template <int N>
  void find(const TexelLayout& layout, const HitLanes& hits, const LaneFloats& widths, int i) {
    const auto& m = layout.grid_from_uv;
    const Float<N> u = load<N>(hits.first_uv[0] + i), v = load<N>(hits.first_uv[1] + i);
    const Float<N> width =
        load<N>(widths + i) * load<N>(hits.first_uv_scale + i) * layout.width_scale;
    const TexelAddress<N> at = texel_address<N>(layout.grid, m[0][0] * u + m[1][0] * v + m[2][0],
                                                m[0][1] * u + m[1][1] * v + m[2][1], width);
    const auto put = [&](const auto& from, auto* to) {
      __builtin_memcpy(to + i, &from, sizeof from);
    };
    put(at.level, level);
    put(at.columns, columns);
    put(at.x.first, left);
    put(at.x.second, right);
    put(at.y.first, top);
    put(at.y.second, bottom);
    put(at.x.share, right_share);
    put(at.y.share, bottom_share);
  }
  [[nodiscard]] TexelAddress<1> operator[](int i) const {
    return {.level = level[i],
            .columns = columns[i],
            .x = {.first = left[i], .second = right[i], .share = right_share[i]},
            .y = {.first = top[i], .second = bottom[i], .share = bottom_share[i]}};
  }
};

template <class Visit>
inline void for_each_lane(Lanes lanes, const Visit& visit) {
  for (; lanes != 0; lanes &= lanes - 1) visit(__builtin_ctz(lanes));
}

/// Calls visit(i, part) for each N lanes from i on of which some are wanted; `part` are these.
template <int N, class Visit>
inline void for_each_part(Lanes lanes, const Visit& visit) {
  for (int i = 0; i < kShadingLanes; i += N) {
    const Lanes part = lanes >> i & kAllLanes<N>;
    if (part != 0) visit(i, part);
  }
}

/// Stores a value in these lanes.
template <int N>
inline void store_in(Lanes lanes, const Float<N>& value, float* to) {
  store<N>(to, select<N>(lanes, value, load<N>(to)));
}

/// Reads all textures of these lanes.
template <int N>
void read_textures(const TexturedSurface& surface, Lanes lanes, const HitLanes& hits,
                   const LaneFloats& widths, TexturedLanes& to) {
  TexelAddresses addresses[TexturedSurface::kValues];
  for_each_part<N>(lanes, [&](int i, Lanes) {
    for (int k = 0; k < surface.layout_count; ++k)
      addresses[k].template find<N>(surface.layouts[k], hits, widths, i);
  });
  const auto reads = [&](const auto& visit) {
    for (int k = 0; k < surface.read_count; ++k) {
      const TexturedSurface::Read& read = surface.reads[k];
      visit(read, addresses[read.layout]);
    }
  };
  reads([&](const TexturedSurface::Read& read, const TexelAddresses& at) {
    for_each_lane(lanes, [&](int lane) { prefetch_texel(read.texels, at[lane]); });
  });
  Lanes found = 0;
  reads([&](const TexturedSurface::Read& read, const TexelAddresses& at) {
    alignas(64) float rows[kShadingLanes][4];
    for_each_lane(lanes, [&](int lane) {
      const FourFloats texel = read_texel(read.texels, at[lane]);
      __builtin_memcpy(rows[lane], &texel, sizeof texel);
    });
    for_each_part<N>(lanes, [&](int i, Lanes part) {
      std::uint32_t indices[N];
      for (int k = 0; k < N; ++k) indices[k] = static_cast<std::uint32_t>(i + k);
      Float<N> columns[4];
      load_rows<N>(rows[0], indices, columns);
      for (int c = 0; c < 4; ++c) store_in<N>(part, columns[c], to.values[read.value][c] + i);
    });
    found |= Lanes{1} << read.value;
  });
  for (int value = 0; value < TexturedSurface::kValues; ++value) {
    if ((found >> value & 1U) != 0) continue;
    for_each_part<N>(lanes, [&](int i, Lanes part) {
      for (auto& channel : to.values[value]) store_in<N>(part, all<N>(1), channel + i);
    });
  }
}

/// Sets the parts of the surfaces in these lanes that textures change, to.covers and to.opaque.
template <int N>
void load_textured(const TexturedSurface& surface, Lanes lanes, const HitLanes& hits,
                   const LaneFloats& widths, TexturedLanes& to, SurfaceLanes& surfaces,
                   NormalMapLanes& normals) {
  using F = Float<N>;
  read_textures<N>(surface, lanes, hits, widths, to);
  to.covers = to.opaque = 0;
  for_each_part<N>(lanes, [&](int i, Lanes part) {
    const auto value = [&](TexelValue which, int channel) {
      return load<N>(to.values[static_cast<int>(which)][channel] + i);
    };
    const auto factor = [&](int channel) {
      return surface.base_color[channel] * load<N>(to.color[channel] + i);
    };
    Floats3<N> color;
    color.x = factor(0) * value(TexelValue::base_color, 0);
    color.y = factor(1) * value(TexelValue::base_color, 1);
    color.z = factor(2) * value(TexelValue::base_color, 2);
    const bsdf::BaseSurface<N> base(color, surface, value(TexelValue::metallic_roughness, 1),
                                    value(TexelValue::metallic_roughness, 2));
    store_in<N>(part, base.color.x, surfaces.base_color[0] + i);
    store_in<N>(part, base.color.y, surfaces.base_color[1] + i);
    store_in<N>(part, base.color.z, surfaces.base_color[2] + i);
    store_in<N>(part, base.metallic, surfaces.metallic + i);
    store_in<N>(part, base.roughness, surfaces.roughness + i);
    for (int axis = 0; axis < 3; ++axis)
      store_in<N>(part, value(TexelValue::normal, axis), normals.texel[axis] + i);
    store_in<N>(part, all<N>(surface.normal_scale), normals.scale + i);
    Lanes dark = kAllLanes<N>;
    for (int channel = 0; channel < 3; ++channel) {
      const F emission = value(TexelValue::emission, channel) * surface.emission[channel];
      dark &= less_equal<N>(emission, F{}) & less_equal<N>(F{}, emission);
    }
    const F alpha = factor(3) * value(TexelValue::alpha, 3);
    const Lanes covers = part & less_equal<N>(load<N>(to.least_alpha + i), alpha);
    to.covers |= covers << i;
    to.opaque |= (covers & dark) << i;
  });
}

}  // namespace MICROTRACE_KERNELS
}  // namespace microtrace
