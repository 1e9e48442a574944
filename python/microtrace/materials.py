"""Materials: the metallic-roughness model of glTF 2.0 and the KHR_materials_* extensions.

Names are those of glTF in snake case. Section numbers refer to the glTF 2.0 specification. Colors
are linear Rec. 709. Comments on textures give the encoding, then the channel that stores each
quantity. The defaults describe a white, rough, two-sided surface.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf
from typing import Literal

import numpy as np
import numpy.typing as npt

from ._brief import Brief
from .images import Image

Color = tuple[float, float, float]
ColorAlpha = tuple[float, float, float, float]
Wrap = Literal["repeat", "mirrored_repeat", "clamp_to_edge"]


@dataclass(eq=False, repr=False)
class Texture(Brief):
    """An image with wrapping and filter modes (section 3.8.4)."""

    image: Image | None = None  #: None means white
    name: str = ""
    wrap_s: Wrap = "repeat"
    wrap_t: Wrap = "repeat"
    magnification: Literal["nearest", "linear"] = "linear"
    minification: Literal["nearest", "linear"] = "linear"
    mip: Literal["none", "nearest", "linear"] = "linear"  #: "none": only the base level


@dataclass(eq=False, repr=False)
class TextureUse(Brief):
    """A texture with the texture coordinates by which a material uses it."""

    texture: Texture = field(default_factory=Texture)
    uv_set: int = 0  #: index into Mesh.uv
    #: The two rows of a matrix that is applied to the mesh's (u, v, 1) (KHR_texture_transform).
    texture_from_uv: tuple[Color, Color] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))


#: Accepted in place of a TextureUse: a texture, an image, or an array of pixels.
AnyTexture = TextureUse | Texture | Image | npt.NDArray[np.uint8] | npt.NDArray[np.uint16]


@dataclass(eq=False, repr=False)
class Specular(Brief):
    """Reflectance of a dielectric (KHR_materials_specular)."""

    specular_factor: float = 1.0  #: in [0, 1]
    specular_texture: AnyTexture | None = None  #: linear; alpha: factor
    #: Reflectance factor at normal incidence; not negative.
    specular_color_factor: Color = (1.0, 1.0, 1.0)
    specular_color_texture: AnyTexture | None = None  #: sRGB


@dataclass(eq=False, repr=False)
class Transmission(Brief):
    """Transmission through the surface of a dielectric (KHR_materials_transmission)."""

    transmission_factor: float = 0.0  #: in [0, 1]
    transmission_texture: AnyTexture | None = None  #: linear; r: factor


@dataclass(eq=False, repr=False)
class Volume(Brief):
    """A medium inside the surface (KHR_materials_volume)."""

    thickness_factor: float = 0.0  #: 0: a thin wall
    thickness_texture: AnyTexture | None = None  #: linear; g: thickness
    attenuation_distance: float = inf  #: world units, positive
    attenuation_color: Color = (1.0, 1.0, 1.0)  #: each in [0, 1]


@dataclass(eq=False, repr=False)
class VolumeScatter(Brief):
    """Scattering in the medium of the volume (KHR_materials_volume_scatter, a draft of 2025). It
    has no effect if Volume.attenuation_distance is infinite, which is the default."""

    multiscatter_color: Color = (0.0, 0.0, 0.0)  #: color of a thick body, each in [0, 1]
    scatter_anisotropy: float = 0.0  #: mean cosine of scattering angles, in [-1, 1]


@dataclass(eq=False, repr=False)
class Clearcoat(Brief):
    """A coat with index of refraction 1.5 over all other layers (KHR_materials_clearcoat)."""

    clearcoat_factor: float = 0.0  #: in [0, 1]
    clearcoat_roughness_factor: float = 0.0  #: in [0, 1]
    clearcoat_texture: AnyTexture | None = None  #: linear; r: factor
    clearcoat_roughness_texture: AnyTexture | None = None  #: linear; g: roughness
    clearcoat_normal_texture: AnyTexture | None = None  #: linear; tangent space
    clearcoat_normal_scale: float = 1.0  #: scales the texture's x and y


@dataclass(eq=False, repr=False)
class Sheen(Brief):
    """Fibers over all layers except the coat (KHR_materials_sheen)."""

    sheen_color_factor: Color = (0.0, 0.0, 0.0)  #: each in [0, 1]
    sheen_roughness_factor: float = 0.0  #: in [0, 1]
    sheen_color_texture: AnyTexture | None = None  #: sRGB
    sheen_roughness_texture: AnyTexture | None = None  #: linear; alpha: roughness


@dataclass(eq=False, repr=False)
class Anisotropy(Brief):
    """Elongated highlights (KHR_materials_anisotropy)."""

    anisotropy_strength: float = 0.0  #: in [0, 1]
    anisotropy_rotation: float = 0.0  #: radians, counterclockwise from the tangent
    anisotropy_texture: AnyTexture | None = None  #: linear; rg: direction, b: strength


@dataclass(eq=False, repr=False)
class Iridescence(Brief):
    """A thin film over the surface (KHR_materials_iridescence)."""

    iridescence_factor: float = 0.0  #: in [0, 1]
    iridescence_ior: float = 1.3  #: index of refraction of the film, at least 1
    iridescence_thickness_minimum: float = 100.0  #: nanometers
    iridescence_thickness_maximum: float = 400.0  #: nanometers
    iridescence_texture: AnyTexture | None = None  #: linear; r: factor
    iridescence_thickness_texture: AnyTexture | None = None  #: linear; g: minimum to maximum


@dataclass(eq=False, repr=False)
class DiffuseTransmission(Brief):
    """Diffuse transmission through the surface (KHR_materials_diffuse_transmission)."""

    diffuse_transmission_factor: float = 0.0  #: in [0, 1]
    diffuse_transmission_texture: AnyTexture | None = None  #: linear; alpha: factor
    diffuse_transmission_color_factor: Color = (1.0, 1.0, 1.0)  #: each in [0, 1]
    diffuse_transmission_color_texture: AnyTexture | None = None  #: sRGB


@dataclass(eq=False, repr=False)
class SpecularGlossiness(Brief):
    """Replaces metallic and roughness; the base color is then the diffuse color
    (KHR_materials_pbrSpecularGlossiness, archived)."""

    specular_factor: Color = (1.0, 1.0, 1.0)  #: each in [0, 1]
    glossiness_factor: float = 1.0  #: in [0, 1]
    specular_glossiness_texture: AnyTexture | None = None  #: rgb, sRGB; alpha: glossiness


@dataclass(eq=False, repr=False)
class Material(Brief):
    """The material of a surface. Factors are multiplied by textures. glTF's default for
    metallic_factor is 1. Here it is 0, so that a material with only a base_color_factor isn't a
    metal."""

    name: str = ""
    base_color_factor: ColorAlpha = (1.0, 1.0, 1.0, 1.0)  #: with alpha, each in [0, 1]
    base_color_texture: AnyTexture | None = None  #: sRGB, alpha linear
    alpha_mode: Literal["opaque", "mask", "blend"] = "opaque"  #: section 3.9.4
    alpha_cutoff: float = 0.5
    double_sided: bool = True  #: False: back faces are culled
    unlit: bool = False  #: shows the base color without lighting (KHR_materials_unlit)
    metallic_factor: float = 0.0  #: in [0, 1]
    roughness_factor: float = 1.0  #: in [0, 1]
    metallic_roughness_texture: AnyTexture | None = None  #: linear; g: roughness, b: metallic
    normal_texture: AnyTexture | None = None  #: linear; tangent space
    normal_scale: float = 1.0  #: scales the texture's x and y
    occlusion_texture: AnyTexture | None = None  #: linear; r
    occlusion_strength: float = 1.0  #: in [0, 1]
    emissive_factor: Color = (0.0, 0.0, 0.0)  #: includes KHR_materials_emissive_strength
    emissive_texture: AnyTexture | None = None  #: sRGB
    ior: float = 1.5  #: at least 1, or 0 for infinity (KHR_materials_ior)
    dispersion: float = 0.0  #: 20 / Abbe number (KHR_materials_dispersion)
    specular: Specular | None = None
    transmission: Transmission | None = None
    volume: Volume | None = None
    volume_scatter: VolumeScatter | None = None
    clearcoat: Clearcoat | None = None
    sheen: Sheen | None = None
    anisotropy: Anisotropy | None = None
    iridescence: Iridescence | None = None
    diffuse_transmission: DiffuseTransmission | None = None
    specular_glossiness: SpecularGlossiness | None = None
