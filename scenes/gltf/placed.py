"""The scene instances.glb: a ball and a leaf, each of which several nodes place, also mirrored, sheared and far away. Their
textures use different sets of texture coordinates.
"""

import math

from asset import Asset
from lit import SMOOTH, ball, bumps, camera, leaf_color, light, material, pattern, quad, stand


def place(asset, mesh, name, **node):
    """Places a mesh by a node, and returns the node."""
    asset.node({"name": name, "mesh": mesh, **node})
    return asset.json["nodes"][-1]


def instances():
    asset = Asset()
    color = asset.texture("color", pattern(32, 3, lambda u, v: (
        0.2 + 0.7 * (int(8 * u) % 2), 0.3 + 0.5 * v, 0.8 - 0.6 * (int(8 * v) % 2))), SMOOTH)
    normal = asset.texture("normal", pattern(16, 3, bumps), SMOOTH)
    leaf = asset.texture("leaf", pattern(32, 4, leaf_color), SMOOTH)
    primitive = ball(asset)
    columns, rows = 12, 8
    wide = [(12 * column / columns, 8 * row / rows) for row in range(rows + 1) for column in range(columns + 1)]
    primitive["attributes"]["TEXCOORD_1"] = asset.numbers("VEC2", wide)
    striped = material(asset, "striped", roughness=0.4, pbr={"baseColorTexture": {"index": color}},
                       normalTexture={"index": normal, "texCoord": 1, "scale": 0.5})
    sphere = asset.add("meshes", {"name": "Ball", "primitives": [dict(primitive, material=striped)]})
    turn = [math.sin(0.4), 0, 0, math.cos(0.4)]
    place(asset, sphere, "Plain", translation=[-1.4, 0.5, 0], scale=[0.45] * 3)
    place(asset, sphere, "Mirrored", translation=[-0.35, 0.5, 0.1], scale=[-0.45, 0.45, 0.45], rotation=turn)
    sheared = asset.add("nodes", {"name": "Sheared", "mesh": sphere, "rotation": turn})
    asset.node({"name": "Stretched", "translation": [0.7, 0.5, -0.2], "scale": [0.5, 0.3, 0.6], "children": [sheared]})
    place(asset, sphere, "Flat", translation=[1.5, 0.3, 0.2], scale=[0.3, 0.05, 0.4], rotation=turn)
    child = asset.add("nodes", {"name": "Child", "mesh": sphere, "translation": [0, 3.2, 0], "scale": [0.4, 0.6, 0.4]})
    place(asset, sphere, "Parent", translation=[-0.9, 0.1, 1], scale=[0.2] * 3, rotation=turn)["children"] = [child]
    place(asset, sphere, "Far", translation=[120.5, 40.25, -400], scale=[60] * 3)
    corners = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
    square = quad(asset, corners, [(0, 0), (0, 0), (0, 0), (0, 0)])
    square["attributes"]["TEXCOORD_1"] = asset.numbers("VEC2", [(0, 1), (1, 1), (1, 0), (0, 0)])
    green = material(asset, "leaf", roughness=0.6, pbr={"baseColorTexture": {"index": leaf, "texCoord": 1}}, alphaMode="MASK",
                     alphaCutoff=0.4, doubleSided=True)
    blade = asset.add("meshes", {"name": "Leaf", "primitives": [dict(square, material=green)]})
    for i in range(5):
        angle = 0.3 * i - 0.5
        place(asset, blade, f"Leaf {i}", translation=[0.55 * i - 1.1, 0.25, 1.2], scale=[0.3, (-1) ** i * 0.25, 0.3],
              rotation=[0, math.sin(angle), 0, math.cos(angle)])
    ground = material(asset, "ground", (0.5, 0.5, 0.45), roughness=0.9)
    stand(asset, "Ground", quad(asset, [(-3, 0, 2.5), (3, 0, 2.5), (3, 0, -2), (-3, 0, -2)]), ground)
    light(asset, "Lamp", "point", [1, 0.9, 0.8], 25, {"translation": [1, 3.5, 2.5]})
    camera(asset, [0.1, 0.9, 4.4], -0.05)
    return asset
