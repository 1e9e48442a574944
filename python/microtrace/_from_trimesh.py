"""Makes scenes from objects of trimesh, or other objects with the same attributes."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._arrays import as_array
from .images import Image
from .materials import Material, Texture
from .scene import Scene


def scene_from(source: Any) -> Scene:
    """See microtrace.scene_of."""
    scene = Scene()
    if isinstance(source, Scene):
        return source
    if hasattr(source, "graph") and hasattr(source, "geometry"):
        for node in source.graph.nodes_geometry:
            transform, name = source.graph[node]
            _add(scene, source.geometry[name], str(node), transform)
    elif hasattr(source, "vertices") and hasattr(source, "faces"):
        _add(scene, source, "", None)
    else:
        raise TypeError(
            f"expected a mesh with vertices and faces, or a trimesh.Scene, not {type(source)}"
        )
    return scene


def _add(scene: Scene, mesh: Any, name: str, transform: Any) -> None:
    if not hasattr(mesh, "faces"):
        return  # paths and point clouds
    visual: Any = getattr(mesh, "visual", None)
    kind = getattr(visual, "kind", None)
    uv = getattr(visual, "uv", None)
    vertices, faces = as_array(mesh.vertices, "vertices"), as_array(mesh.faces, "faces")
    colors = None
    normals = _loaded_normals(mesh)
    if kind == "vertex":
        colors = np.asarray(visual.vertex_colors, np.uint8)
    elif kind == "face":  # gives each face vertices of its own
        corners = faces.ravel()
        vertices, normals = vertices[corners], None if normals is None else normals[corners]
        faces = np.arange(len(corners)).reshape(-1, 3)
        colors = np.repeat(np.asarray(visual.face_colors, np.uint8), 3, axis=0)
    scene.add_mesh(
        vertices,
        faces,
        normals=normals,
        uv=None if uv is None else _downward(np.asarray(uv)),
        colors=colors,
        material=_material(getattr(visual, "material", None), has_uv=uv is not None),
        transform=transform,
        name=name,
    )


def _loaded_normals(mesh: Any) -> Any:
    """Returns the normals that were loaded with the mesh, not those that trimesh computes on
    demand. trimesh keeps both in the same place."""
    cache = getattr(mesh, "_cache", None)
    if cache is None:
        return getattr(mesh, "vertex_normals", None)
    if not hasattr(cache, "cache"):
        return None
    cache.verify()  # forgets what belongs to earlier vertices
    normals = cache.cache.get("vertex_normals")
    if normals is None or len(normals) != len(mesh.vertices):
        return None
    # The function behind the property computes normals without looking for known ones. Loaded
    # normals are those of float32 numbers, so they differ by more than this tolerance.
    compute = getattr(getattr(type(mesh).vertex_normals, "fget", None), "__wrapped__", None)
    is_computed = compute is not None and np.allclose(normals, compute(mesh), rtol=0, atol=1e-10)
    return None if is_computed else normals


def _downward(uv: Any) -> Any:
    """Converts texture coordinates: v points up in trimesh and down in glTF."""
    result = np.array(uv, np.float64)
    result[:, 1] = 1 - result[:, 1]
    return result


def _material(source: Any, *, has_uv: bool) -> Material | None:
    if source is None:
        return None
    is_phong = hasattr(source, "to_pbr")  # SimpleMaterial, which has a diffuse color
    if is_phong:
        source = source.to_pbr()
    result = Material(name=str(getattr(source, "name", None) or ""))
    base = getattr(source, "baseColorFactor", None)
    if base is not None:
        factor = np.asarray(base)
        if factor.dtype == np.uint8:
            factor = factor / 255
        numbers = [float(x) for x in factor] + [1.0] * (4 - len(factor))
        result.base_color_factor = (numbers[0], numbers[1], numbers[2], numbers[3])
    # If a glTF file specifies no factor, its default of 1 applies.
    metallic, roughness = (getattr(source, n, None) for n in ("metallicFactor", "roughnessFactor"))
    result.metallic_factor = float(not is_phong) if metallic is None else float(metallic)
    result.roughness_factor = 1.0 if roughness is None else float(roughness)
    emissive = getattr(source, "emissiveFactor", None)
    if emissive is not None:
        red, green, blue = (float(x) for x in emissive)
        result.emissive_factor = (red, green, blue)
    result.double_sided = bool(getattr(source, "doubleSided", False))
    mode = getattr(source, "alphaMode", None)
    if mode is not None:
        result.alpha_mode = str(mode).lower()  # type: ignore[assignment]
    cutoff = getattr(source, "alphaCutoff", None)
    if cutoff is not None:
        result.alpha_cutoff = float(cutoff)
    if not has_uv:
        return result
    result.base_color_texture = _texture(getattr(source, "baseColorTexture", None))
    result.metallic_roughness_texture = _texture(getattr(source, "metallicRoughnessTexture", None))
    result.normal_texture = _texture(getattr(source, "normalTexture", None))
    result.emissive_texture = _texture(getattr(source, "emissiveTexture", None))
    return result


def _texture(picture: Any) -> Texture | None:
    """Makes a texture from a Pillow image."""
    return None if picture is None else Texture(image=Image(picture))
