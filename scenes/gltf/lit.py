"""The scenes with light. Together they hold every kind of material and light; each is small, so that emulators and builds
without optimization draw it soon.

materials.glb has 24 balls, one for each kind of scattering, before a checkered wall. textured.glb has a texture in every
slot, masks and blending. lamps.glb is a room with 64 punctual lights and emissive meshes. moving.glb bends, morphs and
rises at --time 0 to 1. media.glb has bodies that scatter light inside. panes.glb
has stained glass in front of the sun and a lamp. far.glb stands where float32 has a number every half meter. ../sky.exr is an environment map.
"""

import math
import struct

from asset import Asset, png, unit

REPEAT, LINEAR, MIP_MAPS, NEAREST = 10497, 9729, 9987, 9728
SMOOTH = {"wrapS": REPEAT, "wrapT": REPEAT, "magFilter": LINEAR, "minFilter": MIP_MAPS}  # a sampler


def ball_points(rows=8, columns=12):
    """The vertices of a unit ball from pole to pole; the two sides of the seam are equal to the last bit."""
    for row in range(rows + 1):
        polar = math.pi * row / rows
        y, ring = (1, 0) if row == 0 else (-1, 0) if row == rows else (math.cos(polar), math.sin(polar))
        for column in range(columns + 1):
            azimuth = 2 * math.pi * (column % columns) / columns
            yield ring * math.sin(azimuth), y, ring * math.cos(azimuth)


def ball(asset, rows=8, columns=12):
    """The attributes and indices of a unit ball with normals and texture coordinates, to share between materials."""
    points = list(ball_points(rows, columns))
    uvs = [(column / columns, row / rows) for row in range(rows + 1) for column in range(columns + 1)]
    triangles = []
    for row in range(rows):
        for column in range(columns):
            a = row * (columns + 1) + column
            b, c, d = a + 1, a + columns + 1, a + columns + 2
            triangles += [(a, c, d)] * (row < rows - 1) + [(a, d, b)] * (row > 0)
    return {"attributes": {"POSITION": asset.positions(points), "NORMAL": asset.numbers("VEC3", points),
                           "TEXCOORD_0": asset.numbers("VEC2", uvs)}, "indices": asset.indices(triangles)}


def quad(asset, corners, uvs=None):
    """A rectangle of two triangles; corners run anticlockwise as seen from the front."""
    attributes = {"POSITION": asset.positions(corners)}
    if uvs:
        attributes["TEXCOORD_0"] = asset.numbers("VEC2", uvs)
    return {"attributes": attributes, "indices": asset.indices([(0, 1, 2), (0, 2, 3)])}


def stand(asset, name, primitive, material, **node):
    """A node with a mesh of one primitive."""
    mesh = asset.add("meshes", {"name": name, "primitives": [dict(primitive, material=material)]})
    asset.node({"name": name, "mesh": mesh, **node})


def material(asset, name, color=(1, 1, 1), metallic=0.0, roughness=0.5, extensions=None, **members):
    """A material; extensions are named without their prefix."""
    pbr = {"baseColorFactor": [*color, members.pop("alpha", 1)], "metallicFactor": metallic, "roughnessFactor": roughness,
           **members.pop("pbr", {})}
    json = {"name": name, "pbrMetallicRoughness": pbr, **members}
    if extensions:
        json["extensions"] = {f"KHR_materials_{key}": value for key, value in extensions.items()}
    return asset.add("materials", json)


def light(asset, name, kind, color, intensity, node, **members):
    extensions = asset.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})
    extensions["lights"].append({"name": name, "type": kind, "color": color, "intensity": intensity, **members})
    asset.node({"name": name, "extensions": {"KHR_lights_punctual": {"light": len(extensions["lights"]) - 1}}, **node})


def camera(asset, position, tilt=0.0, yfov=math.pi / 4):
    """A perspective camera that looks along -z, tilted about x."""
    index = asset.add("cameras", {"type": "perspective", "perspective": {"yfov": yfov, "znear": 0.01}})
    asset.node({"name": "Front", "camera": index, "translation": position,
                "rotation": [math.sin(tilt / 2), 0, 0, math.cos(tilt / 2)]})


def checkered_wall(asset, half_width, half_height, z, squares):
    """Squares in two colors, by COLOR_0 of vertices that neighbors do not share."""
    points, colors, triangles = [], [], []
    rows = max(1, round(squares * half_height / half_width))
    for row in range(rows):
        for column in range(squares):
            x0, x1 = (half_width * (2 * (column + i) / squares - 1) for i in (0, 1))
            y0, y1 = (half_height * (2 * (row + i) / rows - 1) for i in (0, 1))
            a = len(points)
            points += [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]
            colors += [(0.85, 0.8, 0.7) if (row + column) % 2 else (0.12, 0.2, 0.35)] * 4
            triangles += [(a, a + 1, a + 2), (a, a + 2, a + 3)]
    primitive = {"attributes": {"POSITION": asset.positions(points), "COLOR_0": asset.numbers("VEC3", colors)},
                 "indices": asset.indices(triangles)}
    stand(asset, "Wall", primitive, material(asset, "paint", roughness=0.8, doubleSided=True))


def materials():
    asset = Asset()
    volume = {"thicknessFactor": 0.5, "attenuationDistance": 0.6, "attenuationColor": [0.25, 0.75, 0.5]}
    film = {"iridescenceFactor": 1, "iridescenceIor": 1.4, "iridescenceThicknessMaximum": 420}
    sheen = {"sheenColorFactor": [0.7, 0.4, 0.9], "sheenRoughnessFactor": 0.4}
    through = {"transmissionFactor": 1}
    paper = {"diffuseTransmissionFactor": 0.6, "diffuseTransmissionColorFactor": [0.9, 0.5, 0.2]}
    kinds = [
        ("plastic", (0.7, 0.1, 0.1), 0, 0.3, None),
        ("chalk", (0.8, 0.8, 0.75), 0, 1, None),
        ("mirror", (0.95, 0.9, 0.85), 1, 0, None),
        ("gold", (0.95, 0.7, 0.25), 1, 0.45, None),
        ("half metal", (0.3, 0.6, 0.9), 0.5, 0.25, None),
        ("dense", (0.1, 0.3, 0.1), 0, 0.15, {"ior": {"ior": 2.2}}),
        ("tinted shine", (0.2, 0.2, 0.25), 0, 0.4, {"specular": {"specularFactor": 0.7, "specularColorFactor": [1, 0.5, 0.2]}}),
        ("lacquer", (0.6, 0.05, 0.3), 0, 0.6, {"clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.05}}),
        ("coated metal", (0.2, 0.5, 0.8), 1, 0.35, {"clearcoat": {"clearcoatFactor": 0.8, "clearcoatRoughnessFactor": 0.4}}),
        ("velvet", (0.15, 0.02, 0.2), 0, 0.9, {"sheen": sheen}),
        ("coated velvet", (0.1, 0.1, 0.3), 0, 0.7, {"sheen": sheen, "clearcoat": {"clearcoatFactor": 0.6, "clearcoatRoughnessFactor": 0.2}}),
        ("oil", (0.1, 0.1, 0.1), 0, 0.2, {"iridescence": film}),
        ("anodized", (0.8, 0.8, 0.8), 1, 0.3, {"iridescence": film}),
        ("glass", (1, 1, 1), 0, 0, {"transmission": through, "volume": volume}),
        ("frosted", (1, 1, 1), 0, 0.35, {"transmission": through, "volume": volume, "ior": {"ior": 1.4}}),
        ("prism", (1, 1, 1), 0, 0, {"transmission": through, "volume": {"thicknessFactor": 1}, "dispersion": {"dispersion": 4}, "ior": {"ior": 1.7}}),
        ("bubble", (0.9, 1, 0.9), 0, 0, {"transmission": through}),
        ("soap", (1, 1, 1), 0, 0.25, {"transmission": through, "iridescence": film}),
        ("brushed", (0.9, 0.85, 0.8), 1, 0.4, {"anisotropy": {"anisotropyStrength": 0.7, "anisotropyRotation": 0.5}}),
        ("brushed plastic", (0.1, 0.35, 0.3), 0, 0.4, {"anisotropy": {"anisotropyStrength": 0.6}}),
        ("paper", (0.9, 0.9, 0.85), 0, 0.8, {"diffuse_transmission": paper}),
        ("wax", (0.9, 0.9, 0.85), 0, 0.5, {"diffuse_transmission": paper, "volume": volume}),
        ("ember", (0.1, 0.1, 0.1), 0, 0.9, {"emissive_strength": {"emissiveStrength": 3}}),
    ]
    primitive = ball(asset)
    tangents = [unit((z, 0, -x)) if abs(y) < 1 else (1, 0, 0) for x, y, z in ball_points()]
    with_tangents = dict(primitive, attributes={
        **primitive["attributes"],
        "TANGENT": asset.numbers("VEC4", [(*tangent, 1) for tangent in tangents])})
    for place in range(24):
        if place < len(kinds):
            name, color, metallic, roughness, extensions = kinds[place]
            emission = {"emissiveFactor": [1, 0.4, 0.1]} if name == "ember" else {}
            index = material(asset, name, color, metallic, roughness, extensions, **emission)
        else:
            name = "specular glossiness"
            index = asset.add("materials", {"name": name, "extensions": {"KHR_materials_pbrSpecularGlossiness": {
                "diffuseFactor": [0.2, 0.3, 0.1, 1], "specularFactor": [0.3, 0.3, 0.4], "glossinessFactor": 0.7}}})
        x, y = place % 6 - 2.5, 1.5 - place // 6
        stand(asset, name, with_tangents if name.startswith("brushed") else primitive, index,
              translation=[x, y, 0], scale=[0.45] * 3)
    checkered_wall(asset, 3.2, 2.4, -0.8, 16)
    camera(asset, [0, 0, 5.6])
    return asset


def pattern(size, channels, f):
    """A PNG whose samples are f(u, v), each channel from 0 to 1."""
    return png(size, channels, lambda x, y: (round(255 * min(1, max(0, c))) for c in f((x + 0.5) / size, (y + 0.5) / size)))


def bumps(u, v):
    """The normals of waves across the texture, of whole periods."""
    x, y = 0.35 * math.cos(6 * math.pi * u), 0.35 * math.cos(4 * math.pi * v)
    length = math.sqrt(x * x + y * y + 1)
    return (0.5 + 0.5 * x / length, 0.5 + 0.5 * y / length, 0.5 + 0.5 / length)


def leaf_color(u, v):
    """A green disc with a soft edge of alpha."""
    return 0.2 + 0.6 * u, 0.7, 0.2, 1.2 - 2.4 * math.hypot(u - 0.5, v - 0.5)


def textured():
    asset = Asset()
    color = asset.texture("color", pattern(16, 3, lambda u, v: (
        0.2 + 0.7 * (int(4 * u) % 2), 0.3 + 0.5 * v, 0.8 - 0.6 * (int(4 * v) % 2))), SMOOTH)
    # Each channel says something else to each of its slots.
    data = asset.texture("data", pattern(16, 4, lambda u, v: (
        0.5 + 0.5 * math.sin(2 * math.pi * u), 0.15 + 0.8 * v, float((int(4 * u) + int(4 * v)) % 2), 0.2 + 0.8 * u)), SMOOTH)
    normal = asset.texture("normal", pattern(16, 3, bumps), SMOOTH)
    glow = asset.texture("glow", pattern(8, 3, lambda u, v: (
        1.0, 0.6 * v, 0.1) if (int(8 * u) + int(8 * v)) % 3 == 0 else (0, 0, 0)), dict(SMOOTH, magFilter=NEAREST))
    leaf = asset.texture("leaf", pattern(16, 4, leaf_color), SMOOTH)

    def use(texture, **members):
        return {"index": texture, **members}

    def slot(**slots):
        return {name: use(texture) for name, texture in slots.items()}

    turned = {"KHR_texture_transform": {"offset": [0.1, 0.2], "rotation": 0.4, "scale": [2, 1.5]}}
    volume = {"thicknessFactor": 1, "attenuationDistance": 0.7, "attenuationColor": [0.8, 0.5, 0.2]}
    base = {"baseColorTexture": use(color)}
    balls = [
        dict(name="metallic-roughness", metallic=1, roughness=1,
             pbr={**base, "metallicRoughnessTexture": use(data)}, normalTexture=use(normal, scale=0.8)),
        dict(name="glowing", color=(0.2, 0.2, 0.2), emissiveFactor=[1, 1, 1], emissiveTexture=use(glow)),
        dict(name="turned", roughness=0.35, pbr={"baseColorTexture": use(color, extensions=turned)},
             normalTexture=use(normal, extensions=turned)),
        dict(name="coat", roughness=0.7, pbr=base, normalTexture=use(normal, scale=0.3), extensions={"clearcoat": {
            "clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.6,
            **slot(clearcoatTexture=data, clearcoatRoughnessTexture=data, clearcoatNormalTexture=normal)}}),
        dict(name="cloth", color=(0.2, 0.1, 0.1), roughness=0.9, extensions={"sheen": {
            "sheenColorFactor": [0.9, 0.9, 0.9], "sheenRoughnessFactor": 0.8,
            **slot(sheenColorTexture=color, sheenRoughnessTexture=data)}}),
        dict(name="film", metallic=1, roughness=0.25, extensions={"iridescence": {
            "iridescenceFactor": 1, "iridescenceThicknessMinimum": 150, "iridescenceThicknessMaximum": 600,
            **slot(iridescenceTexture=data, iridescenceThicknessTexture=data)}}),
        dict(name="window", roughness=0.2, extensions={
            "transmission": {"transmissionFactor": 1, **slot(transmissionTexture=data)},
            "volume": {**volume, **slot(thicknessTexture=data)}}),
        dict(name="brushed", metallic=1, roughness=0.4, color=(0.9, 0.8, 0.6), normalTexture=use(normal, scale=0.2), extensions={"anisotropy": {
            "anisotropyStrength": 0.8, **slot(anisotropyTexture=normal)}}),
        dict(name="shade", roughness=0.8, extensions={"diffuse_transmission": {
            "diffuseTransmissionFactor": 0.8, **slot(diffuseTransmissionTexture=data, diffuseTransmissionColorTexture=color)}}),
        dict(name="shine", color=(0.05, 0.05, 0.1), roughness=0.3, extensions={"specular": slot(
            specularTexture=data, specularColorTexture=color)}),
        dict(name="cut out", pbr={"baseColorTexture": use(leaf)}, alphaMode="MASK", alphaCutoff=0.4, doubleSided=True),
        dict(name="blended", pbr={"baseColorTexture": use(leaf)}, alpha=0.8, alphaMode="BLEND", doubleSided=True),
    ]
    primitive = ball(asset)
    for place, members in enumerate(balls):
        index = material(asset, **members)
        stand(asset, members["name"], primitive, index, translation=[place % 4 - 1.5, 1 - place // 4, 0], scale=[0.46] * 3)
    floor = material(asset, "floor", roughness=0.6, pbr={"baseColorTexture": use(color)}, normalTexture=use(normal))
    stand(asset, "Floor", quad(asset, [(-3, -1.55, 1.5), (3, -1.55, 1.5), (3, -1.55, -2), (-3, -1.55, -2)],
                               [(0, 3), (4, 3), (4, 0), (0, 0)]), floor)
    light(asset, "Key", "directional", [1, 0.95, 0.9], 2.5, {"rotation": unit((-0.35, 0.3, 0.1, 0.88))})
    camera(asset, [0, 0.1, 4.6], -0.03)
    return asset


def lamps():
    asset = Asset()
    plaster = material(asset, "plaster", (0.75, 0.72, 0.68), roughness=0.9)
    red = material(asset, "red", (0.65, 0.08, 0.06), roughness=0.6)
    steel = material(asset, "steel", (0.8, 0.8, 0.82), 1, 0.3)
    panel = material(asset, "panel", (0, 0, 0), emissiveFactor=[1, 0.85, 0.6],
                     extensions={"emissive_strength": {"emissiveStrength": 4}})
    pearl = material(asset, "pearl", (0.1, 0.1, 0.1), emissiveFactor=[0.3, 0.6, 1])
    room = {"Floor": [(-2, -1, 2), (2, -1, 2), (2, -1, -2), (-2, -1, -2)],
            "Back": [(-2, -1, -2), (2, -1, -2), (2, 1.4, -2), (-2, 1.4, -2)],
            "Ceiling": [(-2, 1.4, -2), (2, 1.4, -2), (2, 1.4, 2), (-2, 1.4, 2)],
            "Left": [(-2, -1, 2), (-2, -1, -2), (-2, 1.4, -2), (-2, 1.4, 2)],
            "Right": [(2, -1, -2), (2, -1, 2), (2, 1.4, 2), (2, 1.4, -2)]}
    for name, corners in room.items():
        stand(asset, name, quad(asset, corners), red if name == "Left" else plaster)
    stand(asset, "Panel", quad(asset, [(-0.5, 1.38, -1.2), (0.5, 1.38, -1.2), (0.5, 1.38, -0.6), (-0.5, 1.38, -0.6)]), panel)
    primitive = ball(asset)
    stand(asset, "Steel", primitive, steel, translation=[-0.7, -0.5, -0.6], scale=[0.5] * 3)
    stand(asset, "Egg", primitive, plaster, translation=[0.8, -0.45, -0.9], scale=[0.4, 0.55, 0.4])
    stand(asset, "Pearl", primitive, pearl, translation=[0.2, -0.85, 0.2], scale=[0.15] * 3)
    # A garland of 60 along the walls, points and spots in turn, with colors around the wheel.
    for i in range(60):
        angle = 2 * math.pi * i / 60
        place = [1.8 * math.cos(angle), 0.6 + 0.3 * math.sin(5 * angle), 1.8 * math.sin(angle)]
        color = [0.55 + 0.45 * math.cos(angle + 2 * math.pi * k / 3) for k in range(3)]
        if i % 3 == 2:  # A quarter turn about x: -z becomes -y.
            half = math.pi / 4
            light(asset, f"Spot {i}", "spot", color, 1.2, {"translation": place, "rotation": [-math.sin(half), 0, 0, math.cos(half)]},
                  spot={"innerConeAngle": 0.2, "outerConeAngle": 0.3 + 0.01 * i})
        else:
            ranged = {"range": 1.5} if i % 2 else {}
            light(asset, f"Point {i}", "point", color, 0.12, {"translation": place}, **ranged)
    for i in range(4):
        angle = 0.15 * (i - 1.5)
        light(asset, f"Sun {i}", "directional", [1, 0.9, 0.8], 0.1,
              {"rotation": [0, math.sin(angle), 0, math.cos(angle)]})
    camera(asset, [0, 0.1, 4.4], -0.03)
    return asset


def animate(asset, node, path, times, kind, values, interpolation="LINEAR"):
    """A channel of the asset's one animation."""
    time = asset.numbers("SCALAR", [(t,) for t in times], target=None)
    asset.json["accessors"][time].update(min=[times[0]], max=[times[-1]])
    animation = asset.json.setdefault("animations", [{"name": "Move", "channels": [], "samplers": []}])[0]
    animation["samplers"].append({"input": time, "output": asset.numbers(kind, values, target=None), "interpolation": interpolation})
    animation["channels"].append({"sampler": len(animation["samplers"]) - 1, "target": {"node": node, "path": path}})


def tube(asset, rings=9, sides=8):
    """A pole of two bones, along y from 0 to 2: attributes with weights that pass from one to the other."""
    points, normals, joints, weights, triangles = [], [], b"", [], []
    for ring in range(rings):
        for side in range(sides):
            angle = 2 * math.pi * side / sides
            c, s = math.cos(angle), math.sin(angle)
            height = 2 * ring / (rings - 1)
            points.append((0.25 * c, height, 0.25 * s))
            normals.append((c, 0, s))
            upper = min(1, max(0, height - 0.5))
            joints += struct.pack("4B", 0, 1, 0, 0)
            weights.append((1 - upper, upper, 0, 0))
            if ring + 1 < rings:
                a, b = ring * sides + side, ring * sides + (side + 1) % sides
                triangles += [(a, a + sides, b + sides), (a, b + sides, b)]
    joint_accessor = asset.add("accessors", {"bufferView": asset.view(joints, 34962), "componentType": 5121, "type": "VEC4",
                                             "count": len(points)})
    return {"attributes": {"POSITION": asset.positions(points), "NORMAL": asset.numbers("VEC3", normals),
                           "JOINTS_0": joint_accessor, "WEIGHTS_0": asset.numbers("VEC4", weights)},
            "indices": asset.indices(triangles)}


def moving():
    asset = Asset()
    rubber = material(asset, "rubber", (0.1, 0.4, 0.7), roughness=0.35, doubleSided=True)
    clay = material(asset, "clay", (0.8, 0.35, 0.2), roughness=0.8)
    chrome = material(asset, "chrome", (0.9, 0.9, 0.9), 1, 0.15)
    ground = material(asset, "ground", (0.5, 0.5, 0.45), roughness=0.9)
    # A bending pole.
    upper = asset.add("nodes", {"name": "Upper", "translation": [0, 1, 0]})
    lower = asset.add("nodes", {"name": "Lower", "translation": [-1.2, 0, 0], "children": [upper]})
    asset.json["scenes"][0]["nodes"].append(lower)
    matrices = [(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -y, 0, 1) for y in (0, 1)]
    inverse = asset.numbers("MAT4", matrices, target=None)
    skin = asset.add("skins", {"joints": [lower, upper], "inverseBindMatrices": inverse})
    stand(asset, "Pole", tube(asset), rubber, skin=skin)
    animate(asset, upper, "rotation", [0, 1], "VEC4", [(0, 0, 0, 1), (0, 0, -math.sin(0.6), math.cos(0.6))])
    # A ball that becomes a top.
    primitive = ball(asset)
    moves = [(0.4 * x * (1 - abs(y)), -0.3 * y, 0.4 * z * (1 - abs(y))) for x, y, z in ball_points()]
    top = dict(primitive, targets=[{"POSITION": asset.positions(moves)}], material=clay)
    mesh = asset.add("meshes", {"name": "Top", "primitives": [top], "weights": [0]})
    node = asset.add("nodes", {"name": "Top", "mesh": mesh, "translation": [0.2, 0.6, 0], "scale": [0.6] * 3})
    asset.json["scenes"][0]["nodes"].append(node)
    animate(asset, node, "weights", [0, 0.5, 1], "SCALAR", [(v,) for v in (0, 0, 0, 0, 1, 0, 0, 0, 0)], "CUBICSPLINE")
    # One that rises.
    stand(asset, "Riser", primitive, chrome, scale=[0.35] * 3)
    animate(asset, asset.json["scenes"][0]["nodes"][-1], "translation", [0, 1], "VEC3", [(1.5, 0.35, 0), (1.5, 1.6, 0.2)])
    stand(asset, "Ground", quad(asset, [(-3, 0, 2), (3, 0, 2), (3, 0, -2), (-3, 0, -2)]), ground)
    light(asset, "Lamp", "point", [1, 0.9, 0.8], 25, {"translation": [1, 3.5, 2.5]})
    light(asset, "Fill", "directional", [0.6, 0.7, 1], 0.8, {"rotation": unit((-0.3, -0.4, 0, 0.87))})
    camera(asset, [0.1, 1.1, 4.6], -0.05)
    return asset


def media():
    """Balls of scattering media, with refracting, clear and diffuse surfaces, before a checkered wall. One contains ice in
    water; another overlaps a ball of glass."""
    asset = Asset()
    primitive = ball(asset)
    glass, paper = {"transmissionFactor": 1}, {"diffuseTransmissionFactor": 1}

    def medium(distance, color, scatter, anisotropy=0):
        return {"volume": {"thicknessFactor": 1, "attenuationDistance": distance, "attenuationColor": color},
                "volume_scatter": {"multiscatterColor": scatter, "scatterAnisotropy": anisotropy}}

    kinds = [
        ("milk", 0.05, {"transmission": glass, "ior": {"ior": 1.35}, **medium(0.1, [0.5, 0.5, 0.5], [0.95, 0.93, 0.88], 0.5)}),
        ("jade", 0.3, {"transmission": glass, "ior": {"ior": 1.6}, **medium(0.2, [0.5, 0.7, 0.4], [0.2, 0.6, 0.3])}),
        ("mist", 0, {"transmission": glass, "ior": {"ior": 1}, "specular": {"specularFactor": 0},
                     **medium(1, [0.3, 0.3, 0.3], [1, 1, 1], 0.7)}),
        ("skin", 0.4, {"diffuse_transmission": paper, **medium(0.1, [0.7, 0.3, 0.15], [0.8, 0.5, 0.4])}),
        ("candle", 0.5, {"diffuse_transmission": paper, **medium(0.3, [0.6, 0.5, 0.3], [0.9, 0.8, 0.5], -0.3)}),
        ("stained", 0, {"transmission": glass, **medium(0.5, [0.2, 0.6, 0.9], [0, 0, 0.9])}),
    ]
    for place, (name, roughness, extensions) in enumerate(kinds):
        stand(asset, name, primitive, material(asset, name, roughness=roughness, extensions=extensions),
              translation=[place % 3 - 1, 0.5 - place // 3, 0], scale=[0.46] * 3)
    bodies = [("water", 1.33, [0.9, 0.7, 0.6], [1, -0.5, 0], 0.3), ("ice", 1.31, [0.8, 0.9, 0.9], [1, -0.5, 0.1], 0.15),
              ("pearl", 1.5, [0.9, 0.5, 0.7], [1.3, 0.2, 0.2], 0.25)]
    for name, ior, color, center, radius in bodies:
        look = material(asset, name, roughness=0, extensions={
            "transmission": glass, "ior": {"ior": ior},
            "volume": {"thicknessFactor": 1, "attenuationDistance": 0.3, "attenuationColor": color}})
        stand(asset, name, primitive, look, translation=center, scale=[radius] * 3)
    checkered_wall(asset, 1.8, 1.4, -0.8, 12)
    light(asset, "Key", "directional", [1, 0.95, 0.9], 2, {"rotation": unit((-0.35, 0.3, 0.1, 0.88))})
    camera(asset, [0, 0, 3.2])
    return asset


def panes():
    """Leaning panes of clear glass, one for each kind, whose colors the sun casts on a floor. Before the fifth, half-transparent
    one is another, and the sixth is one-sided, as seen from behind."""
    asset = Asset()
    floor = material(asset, "floor", [0.7, 0.7, 0.7], roughness=0.8)
    stand(asset, "floor", quad(asset, [(-3, 0, 2), (3, 0, 2), (3, 0, -2), (-3, 0, -2)]), floor)
    clear = {"transmission": {"transmissionFactor": 1}}
    kinds = [
        ("red", [0.9, 0.1, 0.1], {}, {}),
        ("frosted", [0.2, 0.8, 0.3], {"transmission": {"transmissionFactor": 0.5}}, {}),
        ("coated", [0.2, 0.4, 0.9], {"clearcoat": {"clearcoatFactor": 0.8, "clearcoatRoughnessFactor": 0.2},
                                     "sheen": {"sheenColorFactor": [0.3, 0.2, 0.1], "sheenRoughnessFactor": 0.5}}, {}),
        ("soap", [1, 1, 1], {"iridescence": {"iridescenceFactor": 1}, "specular": {"specularColorFactor": [1, 0.8, 0.6]}}, {}),
        ("veil", [0.9, 0.8, 0.1], {}, {"alphaMode": "BLEND", "alpha": 0.6}),
        ("back", [0.8, 0.2, 0.8], {}, {"doubleSided": False}),
    ]
    looks = [material(asset, name, color, roughness=0, extensions={**clear, **extensions}, **{"doubleSided": True, **members})
             for name, color, extensions, members in kinds]
    corners = [(-0.4, 0.1, 0), (0.4, 0.1, 0), (0.4, 1.3, -0.5), (-0.4, 1.3, -0.5)]
    for i, look in enumerate([*looks, looks[0]]):
        place = [i - 2.5, 0, 0] if i < 6 else [1.7, 0.2, 0.4]
        pane = quad(asset, corners if i != 5 else corners[::-1])
        stand(asset, f"pane {i}", pane, look, translation=place)
    lamp = material(asset, "lamp", [0, 0, 0], emissiveFactor=[1, 0.9, 0.7], doubleSided=True,
                    extensions={"emissive_strength": {"emissiveStrength": 20}})
    stand(asset, "lamp", quad(asset, [(-2.6, 0.8, -1.5), (-2.3, 0.8, -1.5), (-2.3, 1.1, -1.5), (-2.6, 1.1, -1.5)]), lamp)
    light(asset, "Sun", "directional", [1, 0.95, 0.9], 3, {"rotation": unit((-0.2, 0.9, 0.15, 0.1))})
    camera(asset, [0, 1.6, 4.2], tilt=-0.25)
    return asset


def far():
    """Some balls on the Earth's surface, in meters from its center."""
    asset = Asset()
    place = [4510731.25, 4510731.5, 3000.75]
    primitive = ball(asset)
    glass = material(asset, "glass", roughness=0.1, extensions={"transmission": {"transmissionFactor": 1}, "volume": {
        "thicknessFactor": 1, "attenuationDistance": 1, "attenuationColor": [0.4, 0.6, 0.9]}})
    looks = [material(asset, "plaster", (0.8, 0.7, 0.6), roughness=0.9), glass, material(asset, "copper", (0.9, 0.5, 0.35), 1, 0.3)]
    for i, look in enumerate(looks):
        x, y, z = place
        stand(asset, f"Ball {i}", primitive, look, translation=[x + 1.1 * (i - 1), y, z], scale=[0.5] * 3)
    ground = material(asset, "ground", (0.35, 0.45, 0.3), roughness=0.9)
    x, y, z = place
    stand(asset, "Ground", quad(asset, [(-3, -0.5, 2), (3, -0.5, 2), (3, -0.5, -3), (-3, -0.5, -3)]), ground,
          translation=place)
    light(asset, "Lamp", "spot", [1, 0.95, 0.85], 60, {"translation": [x, y + 3, z + 3], "rotation": unit((-0.38, 0, 0, 0.92))},
          spot={"innerConeAngle": 0.3, "outerConeAngle": 0.6})
    light(asset, "Sky", "directional", [0.6, 0.75, 1], 1, {"rotation": unit((-0.5, 0.2, 0.1, 0.84))})
    camera(asset, [x, y + 0.6, z + 4], -0.15)
    return asset


def exr(width, height, pixel):
    """An OpenEXR file of pixel(x, y) in half floats, without compression."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    half = 1
    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", half, 0, 1, 1) for name in (b"B", b"G", b"R"))
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", 20000630, 2) + b"".join([
        attribute("channels", "chlist", channels + b"\0"), attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", window), attribute("displayWindow", "box2i", window),
        attribute("lineOrder", "lineOrder", b"\0"), attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1))]) + b"\0"
    rows = []
    for y in range(height):
        colors = [pixel(x, y) for x in range(width)]
        data = b"".join(struct.pack(f"<{width}e", *(color[c] for color in colors)) for c in (2, 1, 0))
        rows.append(struct.pack("<ii", y, len(data)) + data)
    start = len(header) + 8 * height
    offsets = (start + y * len(rows[0]) for y in range(height))
    return header + struct.pack(f"<{height}Q", *offsets) + b"".join(rows)


def sky():
    """An environment map of 32 x 16: blue above, brown below, a sun of one pixel and a soft window."""
    def pixel(x, y):
        height = math.cos(math.pi * (y + 0.5) / 16)
        if (x, y) == (25, 4):
            return (60, 55, 45)
        if 8 <= x < 13 and 5 <= y < 9:
            return (1.6, 2, 2.6)
        return (0.15, 0.22, 0.3 + 0.25 * height) if height > 0 else (0.12, 0.1, 0.06)

    return exr(32, 16, pixel)


SCENES = {"materials": materials, "textured": textured, "lamps": lamps, "moving": moving, "media": media, "panes": panes, "far": far}
