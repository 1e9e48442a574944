"""Writes scenes that glTF and Mitsuba 3 can both represent, once for each.

Mitsuba's `diffuse` is a glTF dielectric without a specular part (KHR_materials_specular with factor 0). A conductor
that reflects all light is nearly the same in both: Mitsuba omits multiple scattering between microfacets, which is
little on smooth surfaces.
"""
import dataclasses

import mitsuba as mi
import numpy as np

import files
import textures

YFOV = 40.0


@dataclasses.dataclass
class Scene:
    name: str
    mitsuba: dict
    options: list
    depth: int = 6


def quad(corner, along, up):
    corner, along, up = (np.array(v, float) for v in (corner, along, up))
    return {"positions": np.array([corner, corner + along, corner + along + up, corner + up]),
            "triangles": np.array([[0, 1, 2], [0, 2, 3]])}


def textured_quad(corner, along, up):
    """Like quad(), with normals and texture coordinates. The first row of the texture is at the end of `up`."""
    mesh = quad(corner, along, up)
    n = np.cross(along, up)
    return mesh | {"normals": np.tile(n / np.linalg.norm(n), (4, 1)), "uvs": np.array([[0, 1], [1, 1], [1, 0], [0, 0]], float)}


def joined(meshes):
    """One mesh of several that have the same attributes."""
    starts = np.cumsum([0] + [len(m["positions"]) for m in meshes[:-1]])
    result = {key: np.concatenate([m[key] for m in meshes]) for key in meshes[0] if key != "triangles"}
    return result | {"triangles": np.concatenate([m["triangles"] + start for m, start in zip(meshes, starts)])}


def box(low, high):
    """Returns the six faces of a box. Their front sides are outside."""
    x, y, z = np.diag(np.subtract(high, low).astype(float))
    low, high = np.array(low, float), np.array(high, float)
    return [quad(low, y, x), quad(low, z, y), quad(low, x, z), quad(high, -x, -y), quad(high, -y, -z), quad(high, -z, -x)]


def ball(center, radius, rows=64):
    v, u = np.meshgrid(np.linspace(0, np.pi, rows + 1), np.linspace(0, 2 * np.pi, 2 * rows + 1), indexing="ij")
    n = np.stack([np.sin(v) * np.sin(u), np.cos(v), np.sin(v) * np.cos(u)], -1).reshape(-1, 3)
    first = (np.arange(rows)[:, None] * (2 * rows + 1) + np.arange(2 * rows)).ravel()
    below = first + 2 * rows + 1
    triangles = np.concatenate([np.stack([first, below, below + 1], -1),
                                np.stack([first, below + 1, first + 1], -1)])
    positions = n * radius + center
    corners = positions[triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return {"positions": positions, "normals": n, "uvs": np.zeros((len(n), 2)), "triangles": triangles[area > 1e-9]}


class Both:
    """Builds a scene in both formats at the same time."""

    def __init__(self, folder, name, depth=6):
        self.folder, self.name, self.depth, self.options = folder, name, depth, ["--env", "0,0,0"]
        self.glb = files.Glb()
        self.glb.document["extensionsUsed"] = ["KHR_materials_specular", "KHR_materials_emissive_strength"]
        lens = {"yfov": float(np.radians(YFOV)), "aspectRatio": 4 / 3, "znear": 0.01}
        self.glb.add_node(camera=self.glb.add("cameras", {"type": "perspective", "perspective": lens}),
                          translation=[0, 0, 4])
        film = {"type": "hdrfilm", "width": 128, "height": 96, "rfilter": {"type": "box"}, "pixel_format": "rgb"}
        camera = {"type": "perspective", "fov": YFOV, "fov_axis": "y", "film": film,
                  "to_world": mi.ScalarTransform4f().look_at([0, 0, 4], [0, 0, 0], [0, 1, 0])}
        self.mitsuba = {"type": "scene", "integrator": {"type": "path", "max_depth": depth, "rr_depth": 100},
                        "sensor": camera}

    def add(self, mesh, color=(0.5, 0.5, 0.5), emission=0.0, conductor=None, emissive_png=None, mask_png=None):
        """Adds a mesh. `conductor` is the roughness of a conductor that reflects all light; without it, the surface is
        diffuse. `emissive_png` is a texture of the emission, and `mask_png` a gray texture: black parts are missing."""
        shape = self.add_shape(mesh)
        base = {"baseColorFactor": [*map(float, color), 1], "metallicFactor": 0}
        material = {"doubleSided": True, "pbrMetallicRoughness": base}
        if conductor is None:
            material["extensions"] = {"KHR_materials_specular": {"specularFactor": 0}}
            bsdf = {"type": "diffuse", "reflectance": {"type": "rgb", "value": list(color)}}
            shape["face_normals"] = "normals" not in mesh
        else:
            base |= {"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 1, "roughnessFactor": conductor}
            bsdf = {"type": "roughconductor", "material": "none", "distribution": "ggx", "alpha": conductor**2}
        bsdf = {"type": "twosided", "bsdf": bsdf} if not emission else bsdf
        if mask_png:
            base["baseColorTexture"] = self.alpha_texture(mask_png)
            material |= {"alphaMode": "MASK", "alphaCutoff": 0.5}
            opacity = {"type": "bitmap", "filename": str(mask_png), "raw": True, "filter_type": "nearest"}
            bsdf = {"type": "mask", "opacity": opacity, "bsdf": bsdf}
        if emission:
            material |= {"emissiveFactor": [1, 1, 1], "doubleSided": False}
            material.setdefault("extensions", {})["KHR_materials_emissive_strength"] = {"emissiveStrength": emission}
            shape["emitter"] = {"type": "area", "radiance": {"type": "rgb", "value": emission}}
            if emissive_png:
                material["emissiveTexture"] = self.glb.texture(emissive_png)
                x = np.array(mi.Bitmap(str(emissive_png))) / np.float32(255)
                light = emission * np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)
                shape["emitter"]["radiance"] = {"type": "bitmap", "bitmap": mi.Bitmap(light.astype(np.float32)), "raw": True}
        shape["bsdf"] = bsdf
        has_texture = emissive_png or mask_png
        self.add_node({k: v for k, v in mesh.items() if k != "uvs" or has_texture}, material)

    def add_textured(self, mesh, maps, metallic=1.0):
        """Adds a mesh with the textures base_color, metallic_roughness and normal of `maps` in glTF, and base_color,
        metallic, roughness and normal in Mitsuba."""
        base = {"baseColorTexture": self.glb.texture(maps["base_color"]), "metallicFactor": metallic,
                "metallicRoughnessTexture": self.glb.texture(maps["metallic_roughness"])}
        material = {"doubleSided": True, "normalTexture": self.glb.texture(maps["normal"]), "pbrMetallicRoughness": base}
        bitmap = {name: {"type": "bitmap", "filename": str(maps[name]), "raw": name != "base_color"} for name in maps}
        principled = {"type": "principled", "base_color": bitmap["base_color"], "roughness": bitmap["roughness"],
                      "metallic": bitmap["metallic"] if metallic else 0.0, "eta": 1.5}
        self.add_shape(mesh)["bsdf"] = {"type": "twosided", "bsdf": {
            "type": "normalmap", "normalmap": bitmap["normal"], "bsdf": principled}}
        self.add_node(mesh, material)

    def add_coated(self, mesh, color, metallic, roughness):
        """Adds a mesh with a clear coat."""
        used = self.glb.document["extensionsUsed"]
        used += {"KHR_materials_clearcoat"} - set(used)
        material = {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": metallic, "roughnessFactor": roughness},
                    "doubleSided": True, "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.1}}}
        self.add_shape(mesh)["bsdf"] = {"type": "twosided", "bsdf": {
            "type": "principled", "base_color": {"type": "rgb", "value": list(color)}, "metallic": metallic, "roughness": roughness,
            "clearcoat": 1.0, "clearcoat_gloss": 0.91, "eta": 1.5}}
        self.add_node({key: values for key, values in mesh.items() if key != "uvs"}, material)

    def add_shape(self, mesh):
        """Adds a mesh for Mitsuba. Returns its shape, without a material."""
        number = len(self.mitsuba)
        path = self.folder / f"{self.name}_{number}.ply"
        files.write_ply(path, mesh)
        return self.mitsuba.setdefault(f"shape{number}", {"type": "ply", "filename": str(path)})

    def add_node(self, mesh, material):
        """Adds a mesh for microtrace."""
        primitive = self.glb.primitive(mesh, self.glb.add("materials", material))
        self.glb.add_node(mesh=self.glb.add("meshes", {"primitives": [primitive]}))

    def alpha_texture(self, gray_png):
        """A white texture whose alpha is the gray value of a file."""
        gray = np.array(mi.Bitmap(str(gray_png)))
        gray = gray.reshape(gray.shape[:2])
        path = gray_png.with_name(f"{gray_png.stem}_alpha.png")
        mi.Bitmap(np.dstack([np.full_like(gray, 255)] * 3 + [gray])).write(str(path))
        texture = self.glb.texture(path)
        self.glb.document["textures"][texture["index"]]["sampler"] = self.glb.add("samplers", {"magFilter": 9728, "minFilter": 9728})
        return texture

    def add_glass(self, mesh):
        """Adds a closed mesh of smooth clear glass."""
        self.add_shape(mesh)["bsdf"] = {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}
        used = self.glb.document["extensionsUsed"]
        used += {"KHR_materials_transmission", "KHR_materials_volume"} - set(used)
        material = {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}, "extensions": {
            "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 1}}}
        self.add_node({key: values for key, values in mesh.items() if key != "uvs"}, material)

    def add_point(self, place, intensity):
        document = self.glb.document
        if "extensions" not in document:
            document["extensionsUsed"].append("KHR_lights_punctual")
            document["extensions"] = {"KHR_lights_punctual": {"lights": []}}
        lights = document["extensions"]["KHR_lights_punctual"]["lights"]
        lights.append({"type": "point", "intensity": intensity})
        self.glb.add_node(translation=list(place), extensions={"KHR_lights_punctual": {"light": len(lights) - 1}})
        self.mitsuba[f"point{len(lights)}"] = {"type": "point", "position": list(place), "intensity": {"type": "rgb", "value": intensity}}

    def finish(self):
        self.glb.write(self.folder / f"{self.name}.glb")
        return Scene(self.name, self.mitsuba, self.options, self.depth)


def add_room(scene):
    scene.add(quad((-1, -1, -1), (2, 0, 0), (0, 2, 0)), (0.7, 0.7, 0.7))
    scene.add(quad((-1, -1, 1), (2, 0, 0), (0, 0, -2)), (0.7, 0.7, 0.7))
    scene.add(quad((-1, 1, -1), (2, 0, 0), (0, 0, 2)), (0.7, 0.7, 0.7))
    scene.add(quad((-1, -1, 1), (0, 0, -2), (0, 2, 0)), (0.6, 0.1, 0.1))
    scene.add(quad((1, -1, -1), (0, 0, 2), (0, 2, 0)), (0.1, 0.5, 0.1))
    for side in box((-0.6, -1, -0.5), (-0.1, 0.2, 0.1)) + box((0.1, -1, 0), (0.6, -0.4, 0.5)):
        scene.add(side, (0.6, 0.6, 0.6))


def write(folder):
    lamp = Both(folder, "room_under_lamp")
    add_room(lamp)
    lamp.add(quad((-0.3, 0.98, -0.3), (0.6, 0, 0), (0, 0, 0.6)), (0, 0, 0), emission=12.0)
    # In glTF, light passes through the back of a one-sided surface; in Mitsuba, it doesn't. A two-sided surface blocks
    # it.
    lamp.add(quad((-0.3, 0.985, -0.3), (0.6, 0, 0), (0, 0, 0.6)), (0, 0, 0))
    yield lamp.finish()

    point = Both(folder, "room_under_point")
    add_room(point)
    point.add_point((0.2, 0.7, 0.3), 3.0)
    yield point.finish()

    mi.Bitmap(textures.sky(1024).astype(np.float32)).write(str(folder / "sky.exr"))
    sky = Both(folder, "balls_under_sky")
    sky.add(quad((-9, -1, 9), (18, 0, 0), (0, 0, -18)), (0.5, 0.4, 0.3))
    sky.add(ball((-0.9, -0.2, 0), 0.8), (0.7, 0.7, 0.7))
    sky.add(ball((0.9, -0.2, 0), 0.8), conductor=0.1)
    sky.mitsuba["sky"] = {"type": "envmap", "filename": str(folder / "sky.exr"),
                          "to_world": mi.ScalarTransform4f().rotate([0, 1, 0], 90)}
    sky.options = ["--env", "sky.exr"]
    yield sky.finish()

    furnace = Both(folder, "conductors_in_furnace", depth=12)
    for i, roughness in enumerate((0.1, 0.2, 0.3)):
        furnace.add(ball((1.2 * i - 1.2, 0, 0), 0.55), conductor=roughness)
    furnace.mitsuba["light"] = {"type": "constant", "radiance": {"type": "rgb", "value": 1.0}}
    furnace.options = ["--env", "1,1,1"]
    yield furnace.finish()
