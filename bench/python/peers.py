"""Runs the same queries with microtrace and its peers, on one thread."""

from __future__ import annotations

import numpy as np

import microtrace as mt

FOV = 45.0


def texture():
    """Returns a checkerboard of 512 x 512 pixels."""
    grid = (np.indices((512, 512)) // 32).sum(0) % 2
    return np.repeat((grid * 200 + 40).astype(np.uint8)[..., None], 3, -1)


def smooth_normals(vertices, faces):
    corners = vertices[faces]
    normals = np.zeros_like(vertices)
    each = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    for k in range(3):
        np.add.at(normals, faces[:, k], each)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)


def frame(eye):
    """Returns the camera's unit vectors forward, right and up."""
    forward = -eye / np.linalg.norm(eye)
    right = np.cross(forward, (0, 1, 0))
    right /= np.linalg.norm(right)
    return forward, right, np.cross(right, forward)


def directions(eye, size):
    """directions of the rays through the pixel centers, scaled to depth 1: (height, width, 3)
    float32."""
    width, height = size
    forward, right, up = frame(eye)
    scale = 2 * np.tan(np.radians(FOV) / 2) / height
    x = (np.arange(width) + 0.5 - width / 2) * scale
    y = (height / 2 - np.arange(height) - 0.5) * scale
    return (forward + x[None, :, None] * right + y[:, None, None] * up).astype(np.float32)


def interpolated(normals, faces, primitive, second, third):
    """Interpolates shading normals by barycentric coordinates."""
    n = normals[faces[primitive]]
    result = n[..., 0, :] * (1 - second - third)[..., None] + n[..., 1, :] * second[..., None] + n[..., 2, :] * third[..., None]
    return result / np.linalg.norm(result, axis=-1, keepdims=True)


def microtrace_views(vertices, faces, uv, size):
    scene = mt.Scene()
    material = mt.Material(base_color_texture=texture())
    scene.add_mesh(vertices, faces, smooth_normals(vertices, faces), uv, material=material)
    prepared = scene.prepare()

    def render(eye):
        camera = mt.look_at(tuple(eye), (0, 0, 0), vertical_fov_degrees=FOV)
        p = mt.render(prepared, camera, size, aovs=["depth", "normal", "face_normal", "object"], threads=1)
        return p.depth, p.normal, p.face_normal, p.object

    return render


def open3d_views(vertices, faces, uv, size):
    import open3d as o3d

    scene = o3d.t.geometry.RaycastingScene(nthreads=1)
    scene.add_triangles(o3d.core.Tensor(vertices), o3d.core.Tensor(faces))
    normals = smooth_normals(vertices, faces)

    def render(eye):
        d = directions(eye, size)
        rays = np.empty((*d.shape[:2], 6), np.float32)
        rays[..., :3], rays[..., 3:] = eye, d
        found = scene.cast_rays(o3d.core.Tensor(rays), nthreads=1)
        t, ids = found["t_hit"].numpy(), found["geometry_ids"].numpy()
        hit = np.isfinite(t)
        st = found["primitive_uvs"].numpy()[hit]
        shading = np.zeros_like(d)
        shading[hit] = interpolated(normals, faces, found["primitive_ids"].numpy()[hit], st[:, 0], st[:, 1])
        return t, shading, found["primitive_normals"].numpy(), ids

    return render


def embreex_views(vertices, faces, uv, size):
    cast = embreex_caster(vertices, faces)
    normals = smooth_normals(vertices, faces)
    corners = vertices[faces]
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(flat, axis=1, keepdims=True)
    flat = np.divide(flat, lengths, out=np.zeros_like(flat), where=lengths > 0)

    def render(eye):
        d = directions(eye, size)
        rays = np.empty((d.shape[0] * d.shape[1], 6), np.float32)
        rays[:, :3], rays[:, 3:] = eye, d.reshape(-1, 3)
        t, primitive, u, v = cast(rays)
        hit = primitive >= 0
        shading, geometric = np.zeros((2, len(rays), 3), np.float32)
        shading[hit] = interpolated(normals, faces, primitive[hit], u[hit], v[hit])
        geometric[hit] = flat[primitive[hit]]
        depth = np.where(hit, t, np.inf).reshape(size[::-1])
        return depth, shading, geometric, hit.astype(np.uint32)

    return render


def mitsuba_scene(vertices, faces, uv, variant):
    import mitsuba as mi

    mi.set_variant(variant)
    mesh = mi.Mesh("model", len(vertices), len(faces), has_vertex_normals=True, has_vertex_texcoords=True)
    values = mi.traverse(mesh)
    arrays = {"vertex_positions": vertices, "vertex_normals": smooth_normals(vertices, faces),
              "vertex_texcoords": uv, "faces": faces}
    for name, array in arrays.items():
        values[name] = type(values[name])(array.ravel())
    values.update()
    return mi.load_dict({"type": "scene", "model": mesh})


def mitsuba_scalar_views(vertices, faces, uv, size):
    import mitsuba as mi

    scene = mitsuba_scene(vertices, faces, uv, "scalar_rgb")
    kinds = "depth:depth,shading:sh_normal,geometric:geo_normal,object:shape_index"
    integrator = mi.load_dict({"type": "aov", "aovs": kinds})
    sensor = mi.load_dict({
        "type": "perspective", "fov": FOV, "fov_axis": "y",
        "film": {"type": "hdrfilm", "width": size[0], "height": size[1], "rfilter": {"type": "box"},
                 "pixel_format": "rgb", "component_format": "float32"},
        "sampler": {"type": "independent", "sample_count": 1}})
    pose = mi.traverse(sensor)

    def render(eye):
        mi.set_variant("scalar_rgb")
        pose["to_world"] = mi.ScalarTransform4f().look_at(eye.tolist(), [0, 0, 0], [0, 1, 0])
        pose.update()
        film = np.array(mi.render(scene, sensor=sensor, integrator=integrator, spp=1))
        depth = np.where(film[..., -8] > 0, film[..., -8], np.inf)
        return depth, film[..., -7:-4], film[..., -4:-1], film[..., -1]

    return render


def mitsuba_llvm_views(vertices, faces, uv, size):
    """Doesn't use a film, because accumulation in a film takes longer than tracing the rays."""
    import drjit as dr
    import mitsuba as mi

    variant = "llvm_ad_rgb"
    scene = mitsuba_scene(vertices, faces, uv, variant)
    dr.set_thread_count(1)
    width, height = size
    scale = 2 * np.tan(np.radians(FOV) / 2) / height

    def render(eye):
        mi.set_variant(variant)
        # Opaque numbers are arguments of the compiled code, so the same code serves all views.
        o, forward, right, up = (mi.Vector3f(*(dr.opaque(mi.Float, float(x)) for x in v)) for v in (eye, *frame(eye)))
        pixel = dr.arange(mi.UInt32, width * height)
        x = (mi.Float(pixel % width) + 0.5 - width / 2) * scale
        y = (height / 2 - mi.Float(pixel // width) - 0.5) * scale
        at = scene.ray_intersect(mi.Ray3f(mi.Point3f(o), forward + x * right + y * up))
        hit = at.is_valid()
        found = (dr.select(hit, at.t, dr.inf), dr.select(hit, at.sh_frame.n, 0), dr.select(hit, at.n, 0),
                 dr.select(hit, dr.reinterpret_array(mi.UInt32, at.shape), 0))
        dr.eval(found)
        return tuple(np.array(x).T.reshape(*size[::-1], *x.shape[:-1]) for x in found)

    return render


def embreex_caster(vertices, faces):
    from embreex import rtcore_scene
    from embreex.mesh_construction import TriangleMesh

    scene = rtcore_scene.EmbreeScene(robust=True)
    TriangleMesh(scene, vertices.astype(np.float32), faces.astype(np.int32))

    def cast(rays):
        found = scene.run(np.ascontiguousarray(rays[:, :3]), np.ascontiguousarray(rays[:, 3:]), output=True)
        return found["tfar"], found["primID"], found["u"], found["v"]

    return cast


def casters(vertices, faces):
    """Returns {name: function}. Each function maps rays (n, 6) to t and triangle indices; the index
    of a miss is negative."""
    import open3d as o3d

    scene = mt.Scene()
    scene.add_mesh(vertices, faces)
    prepared = scene.prepare()
    open3d_scene = o3d.t.geometry.RaycastingScene(nthreads=1)
    open3d_scene.add_triangles(o3d.core.Tensor(vertices), o3d.core.Tensor(faces))
    embreex = embreex_caster(vertices, faces)

    def by_microtrace(rays):
        hits = prepared.intersect(rays, fields=("t", "object", "primitive"), threads=1)
        return hits.t, hits.primitive

    def by_open3d(rays):
        found = open3d_scene.cast_rays(o3d.core.Tensor(rays), nthreads=1)
        return found["t_hit"].numpy(), found["primitive_ids"].numpy().view(np.int32)

    return {"microtrace": by_microtrace, "Open3D": by_open3d, "embreex": lambda rays: embreex(rays)[:2]}
