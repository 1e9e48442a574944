"""Exact ray queries and pictures of 3D scenes."""

from ._core import version as __version__
from .cameras import (
    CalibratedCamera,
    Camera,
    EnvironmentCamera,
    FisheyeDistortion,
    OrthographicCamera,
    PerspectiveCamera,
    RationalDistortion,
    cameras,
    look_at,
)
from .errors import (
    CanceledError,
    Diagnostic,
    Error,
    FileError,
    LimitError,
    SceneError,
    SceneWarning,
    UnsupportedError,
    UsageError,
)
from .images import Image, RadianceMap, load_map
from .lights import DirectionalLight, Environment, Light, PointLight, SpotLight
from .materials import (
    Anisotropy,
    Clearcoat,
    DiffuseTransmission,
    Iridescence,
    Material,
    Sheen,
    Specular,
    SpecularGlossiness,
    Texture,
    TextureUse,
    Transmission,
    Volume,
)
from .pictures import Picture, frame, render
from .prepared import AllHits, ClosestPoints, Hits, OpenMeshWarning, PreparedScene
from .scene import Scene, SceneFile, load, scene_of
from .shapes import Disc, Mesh, Object, Plane, Quadric, Shape, Sphere, Triangle
