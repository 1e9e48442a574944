"""Renders pictures and data into arrays."""

from __future__ import annotations

import operator
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, SupportsIndex

import numpy as np
import numpy.typing as npt
from microtrace_program import find_denoiser

from . import _core
from ._arrays import (
    as_crop,
    as_float,
    as_instance,
    as_integer,
    as_names,
    as_path,
    as_real,
    as_size,
    as_text,
    as_threads,
    as_vector,
)
from ._brief import Vector
from .cameras import Camera, PerspectiveCamera, as_degrees
from .errors import SceneWarning, warn_caller
from .lights import Environment
from .prepared import PreparedScene
from .scene import Scene
from .shutter import Shutter

Array = npt.NDArray[Any]
Quantity = Literal[
    "color",
    "depth",
    "distance",
    "position",
    "normal",
    "face_normal",
    "uv",
    "barycentric",
    "albedo",
    "object",
    "primitive",
    "material",
    "variance",
    "samples",
    "denoise_albedo",
    "denoise_normal",
    "emission",
    "noisy",
    "denoise_emission",
]
ToneMap = Literal["none", "khronos-pbr-neutral", "aces", "agx"]

#: For each quantity, how many numbers a pixel has, and whether they are integers.
_QUANTITIES: dict[str, tuple[int, bool]] = {
    name: (width, is_integer) for name, width, is_integer in _core.quantities
}


def _layout(name: str, transparent: bool) -> tuple[int, bool]:
    """Returns the number of an array's channels, and whether they are integers."""
    return (4 if transparent else 3, False) if name == "color" else _QUANTITIES[name]


class Picture(Mapping[str, Array]):
    """Rendered arrays by name. They are also attributes: `picture["depth"] is picture.depth`.

    Arrays of one picture have shape (height, width) or (height, width, channels); pixel (0, 0) is
    the upper left one. Arrays of several pictures have an additional first axis for the cameras.

    - color: float32, linear Rec. 709, 3 channels. Pictures rendered with transparent=True have
      premultiplied colors and alpha, 4 channels.
    - depth, distance: float32; infinite where nothing is visible. The other data arrays are 0
      there.
    - position, normal, face_normal, barycentric, albedo: float32, 3 channels; uv: float32, 2
      channels. face_normal faces the viewer, and normal is on the side that the viewer sees.
    - object, primitive, material: uint32; 1 + the index in Scene.objects, the mesh's faces, and
      Scene.materials. The material of objects without one is 0.
    - variance, samples: float32; the variance of the mean luminance of the samples over the
      background, and the number of samples.
    - denoise_albedo, denoise_normal: float32, 3 channels; means over the samples.
    - emission, noisy: float32, 3 channels; light that arrives without being scattered, and the
      colors before denoising.
    - denoise_emission: float32, 3 channels; emission with at least 256 samples where lamps may be
      visible.
    """

    def __init__(
        self,
        arrays: dict[str, Array],
        exposure: float,
        tone_map: str,
        denoiser: str = "",
        *,
        is_stack: bool,
        part: tuple[int, int, int, int],
    ) -> None:
        self._arrays = arrays
        self._is_stack = is_stack
        self._exposure = exposure
        self._tone_map = tone_map
        self._denoiser = denoiser
        self._part = part  # size of the whole picture, and position of these pixels in it

    def __getitem__(self, name: str) -> Array:
        try:
            return self._arrays[name]
        except KeyError:
            known = name == "color" or name in _QUANTITIES
            hint = f"add {name!r} to aovs" if known else f"known are {', '.join(self._arrays)}"
            raise KeyError(f"{name!r} was not rendered; {hint}") from None

    def __getattr__(self, name: str) -> Array:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_"):
            raise AttributeError(f"{name} can't be replaced; change the array's elements")
        super().__setattr__(name, value)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._arrays]

    def _ipython_key_completions_(self) -> list[str]:
        return list(self._arrays)

    def __iter__(self) -> Iterator[str]:
        return iter(self._arrays)

    def __len__(self) -> int:
        return len(self._arrays)

    # Comparing arrays, as mappings do, has no single result.
    __eq__ = object.__eq__
    __hash__ = object.__hash__

    def __repr__(self) -> str:
        arrays = ", ".join(f"{name} {array.shape}" for name, array in self.items())
        return f"Picture({arrays})"

    def tonemap(self, exposure: float | None = None, tone_map: ToneMap | None = None) -> Array:
        """Returns the colors as 8-bit sRGB: the numbers that the program writes to a PNG.

        Args:
            exposure: in stops; colors are multiplied by 2^exposure. Default: that of render().
            tone_map: default: "khronos-pbr-neutral" for path-traced pictures, "none" for others.

        Returns:
            A uint8 array of the color's shape. Colors with alpha are not premultiplied.
        """
        color = self["color"]
        result = np.empty(color.shape, np.uint8)
        settings = self._display(exposure, tone_map)
        for index in np.ndindex(color.shape[:-3]):
            _core.encode(color[index], *settings, result[index])
        return result

    def save(
        self,
        path: str | bytes | PathLike[str],
        exposure: float | None = None,
        tone_map: ToneMap | None = None,
    ) -> None:
        """Writes one picture to .png, .ppm, .exr or, if the package was built with OpenImageIO,
        .jpg and other formats. `pip install` builds it without. The file appears whole or not at
        all.

        .exr stores color and all other arrays as channels, in the program's layout, and the
        position of a crop in the whole picture. Other formats store only the color. The path "-" is
        standard output, which gets a PPM file.

        Raises:
            KeyError: the color was not rendered.
            ValueError: this is a stack of several pictures.
            FileError: the file can't be written.
        """
        if self["color"].ndim != 3:
            raise ValueError("save one picture of the stack, such as picture.one(0)")
        path = as_path(path, "path")
        is_exr = Path(path).suffix.lower() == ".exr"
        rest = {k: v for k, v in self.items() if k != "color"} if is_exr else {}
        settings = self._display(exposure, tone_map)
        _core.save(self["color"], *settings, self._denoiser, rest, self._part, path)

    def one(self, index: SupportsIndex) -> Picture:
        """Returns one picture of a stack, by its camera's index. The arrays are views.

        Raises:
            ValueError: this is not a stack.
            IndexError: there is no such picture.
        """
        if not self._is_stack:
            raise ValueError("this is a single picture, not a stack")
        try:
            number = operator.index(index)
        except TypeError:
            raise TypeError(f"index must be an integer, not {index!r}") from None
        arrays = {k: v[number] for k, v in self.items()}
        return Picture(
            arrays,
            self._exposure,
            self._tone_map,
            self._denoiser,
            is_stack=False,
            part=self._part,
        )

    def _display(self, exposure: float | None, tone_map: str | None) -> tuple[float, str]:
        return (
            self._exposure if exposure is None else as_real(exposure, "exposure", -64, 64),
            self._tone_map if tone_map is None else as_text(tone_map, "tone_map"),
        )

    def _repr_png_(self) -> bytes | None:
        """Displays the picture in Jupyter."""
        if "color" not in self or self["color"].ndim != 3:
            return None
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "picture.png"
            self.save(path)
            return path.read_bytes()


def frame(
    scene: Scene | PreparedScene,
    azimuth: float = 30.0,
    elevation: float = 25.0,
    *,
    vertical_fov_degrees: float = 45.0,
    size: tuple[int, int] | None = None,
) -> PerspectiveCamera:
    """Returns a camera that shows the whole scene in pictures of this size, including vertices that
    no face uses.

    Args:
        scene: the scene, whose bounded shapes are framed.
        azimuth: degrees about +y. The camera is on the +z side at 0, and on the +x side at 90.
        elevation: degrees above the horizontal, in [-90, 90].
        vertical_fov_degrees: vertical field of view in degrees, in (0, 180).
        size: width and height; default: the scene's.

    Raises:
        ValueError: a number is out of range.
    """
    prepared = _prepared(scene)
    camera: PerspectiveCamera = _core.frame(
        prepared._core,
        as_real(azimuth, "azimuth", -1e9, 1e9),
        as_real(elevation, "elevation", -90, 90),
        as_degrees(vertical_fov_degrees),
        prepared._core.size if size is None else as_size(size),
    )
    return camera


def render(
    scene: Scene | PreparedScene,
    camera: Camera | Sequence[Camera] | None = None,
    size: tuple[int, int] | None = None,
    *,
    spp: int | None = None,
    aovs: Iterable[Quantity] = ("color",),
    integrator: Literal["path", "flat"] | None = None,
    environment: Environment | None = None,
    background: Vector | None = None,
    transparent: bool = False,
    filter: Literal["box", "blackman-harris"] = "box",
    seed: int = 0,
    max_depth: int = 32,
    bsdf: Literal["conserving", "spec"] = "conserving",
    guiding: bool = False,
    ground: bool | float = False,
    crop: tuple[int, int, int, int] | None = None,
    denoise: bool = False,
    exposure: float | Literal["auto"] | None = None,
    shutter: Shutter | None = None,
    threads: int = 0,
    progress: Callable[[float], bool | None] | bool = False,
) -> Picture:
    """Renders pictures. Their bytes equal those of the program with the same options.

    Args:
        scene: the scene. To render it many times, prepare it once.
        camera: one camera or several. Default: the scene's first camera, or one that frames the
            scene.
        size: width and height in pixels. Default: the scene's size.
        spp: samples per pixel. Default: 64 for path tracing, otherwise 1.
        aovs: the arrays to render; see Picture. If they include none of color, variance, samples,
            emission, noisy and the denoise arrays, no light is computed and rendering takes only
            milliseconds.
        integrator: "path" for path tracing or "flat" for base colors without lighting. Default: the
            scene's integrator.
        environment: replaces the scene's environment.
        background: replaces the scene's background, even if it is the scene's environment; linear
            Rec. 709, from 0 to 1.
        transparent: omits the background, even if it is the scene's environment, and adds alpha to
            the color.
        filter: the pixel filter.
        seed: random seed. Different seeds give different noise.
        max_depth: maximum path length, up to 65536. 1 shows only emission; 2 adds direct light.
        bsdf: the formulas for surfaces. "conserving" keeps the energy of light that is scattered
            several times; "spec" has those of the glTF specification, for comparisons with other
            renderers.
        guiding: lets paths first learn where light arrives from, for light that is hard to find.
            The mean of pictures is the same. Can't be combined with a shutter.
        ground: adds a horizontal ground that shows only shadows, so a path-traced model doesn't
            seem to float: at this y or, if True, at the lowest point of the scene. With
            transparent=True, shadows are black with alpha.
        crop: (x0, y0, x1, y1): renders only the pixels with x0 <= x < x1 and y0 <= y < y1 of the
            picture. They equal those of the whole picture, unless they are denoised. Arrays have
            the size of this part.
        denoise: removes the noise of path-traced colors by the library Open Image Denoise, which
            pip install '.[denoise]' in a clone of the repository installs.
        exposure: the exposure, in stops, with which 8-bit colors are shown; color itself doesn't
            depend on it. "auto" is the exposure nearest to 0 at which surfaces are neither blown
            out nor black to the first camera; a small picture of 48 pixels is rendered for it.
            Default: "auto" for path-traced glTF assets, and scenes from arrays that have lights,
            else 0.
        shutter: renders motion blur. Colors, variance and samples show the scenes and cameras of
            the shutter; other arrays show `scene` and `camera`.
        threads: number of threads; 0 means all processors. It has no effect on the arrays.
        progress: a function that is called with the finished fraction of the work, in [0, 1]. It
            cancels the rendering by returning False. The calls come from the threads that render,
            one at a time. True shows a progress bar if tqdm is installed and sys.stderr exists.

    Raises:
        ValueError: an argument is invalid.
        CanceledError: progress returned False.
        LimitError: there is not enough memory.
        UnsupportedError: Open Image Denoise is not installed.

    Warns:
        SceneWarning: the ground has no height, and the scene no lowest point.
    """
    prepared = _prepared(scene)
    size = prepared._core.size if size is None else as_size(size)
    wanted = _checked(aovs)
    default_method = "flat" if prepared._core.is_flat else "path"
    method = default_method if integrator is None else as_text(integrator, "integrator")
    denoiser = _denoiser(wanted, method) if denoise else ""
    names = _with_features(wanted) if denoise else wanted
    if camera is None:
        cameras: list[Camera] = [prepared._core.default_camera(size)]
        is_stack = False
    else:
        is_stack = isinstance(camera, Sequence)
        cameras = list(camera) if isinstance(camera, Sequence) else [camera]
    for name, is_set in (("guiding", bool(guiding)), ("bsdf", as_text(bsdf, "bsdf") == "spec")):
        if is_set and method == "flat":
            raise ValueError(f'{name} has an effect only with integrator="path"')
    if shutter is not None and denoise:
        raise ValueError("denoise can't be combined with a shutter")
    if shutter is not None and len(cameras) > 1:
        raise ValueError("a shutter has its own cameras; render one camera at a time")
    if crop is None:
        width, height = size
    else:
        crop = as_crop(crop, size)
        width, height = crop[2] - crop[0], crop[3] - crop[1]
    arrays: dict[str, Array] = {}
    for name in names:
        channels, is_integer = _layout(name, transparent)
        shape = (len(cameras), height, width, channels)
        arrays[name] = _core.picture_array(shape, is_integer)
    arguments = {
        "size": size,
        "spp": None if spp is None else as_integer(spp, "spp", 1, 65536),
        "integrator": method,
        "environment": environment,
        "hides_environment": bool(transparent) or background is not None,
        "background": None if background is None else _as_background(background),
        "filter": as_text(filter, "filter"),
        "seed": as_integer(seed, "seed", 0, 2**32 - 1),
        "max_depth": as_integer(max_depth, "max_depth", 1, 65536),
        "bsdf": bsdf,
        "guiding": bool(guiding),
        "ground": _ground_arguments(ground, method),
        "crop": crop,
        "shutter": None if shutter is None else _shutter_arguments(shutter),
        "threads": as_threads(threads),
    }
    if is_ground_missing(prepared, ground):
        warn_caller(missing_ground())
    stops = _exposure(exposure, prepared, method, wanted)
    if stops is None:
        stops = _core.automatic_exposure(prepared._core, cameras[0], arguments) if cameras else 0.0
    tone_map = "none"
    with _shown(progress, len(cameras)) as show:
        for k, each in enumerate(cameras):
            outputs = {name: array[k] for name, array in arrays.items()}
            share = None if show is None else (lambda x, k=k: show((k + x) / len(cameras)))
            tone_map = _core.render(prepared._core, each, outputs, {**arguments, "progress": share})
    if denoise:
        _denoise(arrays, wanted, cameras, arguments["ground"] is not None, as_threads(threads))
    for name, array in arrays.items():
        if array.shape[-1] == 1:
            array = array[..., 0]
        arrays[name] = array if is_stack else array[0]
    part = (*size, *((0, 0) if crop is None else crop[:2]))
    return Picture(arrays, stops, tone_map, denoiser, is_stack=is_stack, part=part)


def _ground_arguments(ground: bool | float, integrator: str) -> dict[str, float | None] | None:
    """Returns the core's description of the ground: None, or its height, which may be None."""
    if isinstance(ground, np.bool_):
        ground = bool(ground)
    if ground is False:
        return None
    if integrator != "path":
        raise ValueError('a ground shows shadows, which need integrator="path"')
    return {
        "height": None
        if ground is True
        else as_real(ground, "ground", -3e38, 3e38, "True, False or a height")
    }


def is_ground_missing(prepared: PreparedScene, ground: bool | float) -> bool:
    """Returns True if a ground has no height and the scene no lowest point."""
    wants_lowest = isinstance(ground, (bool, np.bool_)) and bool(ground)
    return wants_lowest and not prepared._core.has_bounded_object


def missing_ground() -> SceneWarning:
    """Makes the warning about a ground that can't be placed."""
    message = (
        "no object is bounded, so the scene has no lowest point for the ground; "
        "give a height, as in ground=0"
    )
    return SceneWarning(message)


def _exposure(
    exposure: float | str | None, prepared: PreparedScene, integrator: str, names: list[str]
) -> float | None:
    """Returns the exposure in stops, or None for an automatic one."""
    if isinstance(exposure, str) and exposure == "auto":
        return None
    if exposure is None:
        is_lit = integrator == "path" and "color" in names and prepared._core.has_lights
        return None if is_lit and not prepared._core.is_flat else 0.0
    return as_real(exposure, "exposure", -64, 64, 'a number, "auto" or None')


#: The arrays that denoising needs.
_FEATURES = ("denoise_albedo", "denoise_normal", "emission", "denoise_emission")


def _denoiser(names: list[str], integrator: str) -> str:
    """Returns the name of the denoiser. Raises an error if the arrays can't be denoised."""
    if "color" not in names:
        raise ValueError("denoise needs color in aovs")
    if integrator == "flat":
        raise ValueError('denoise needs integrator="path"; other pictures have no noise')
    find_denoiser()
    return _core.denoiser_name()


def _with_features(names: list[str]) -> list[str]:
    return names + [name for name in _FEATURES if name not in names]


def _denoise(
    arrays: dict[str, Array],
    wanted: list[str],
    cameras: Sequence[Camera | None],
    has_ground: bool,
    threads: int,
) -> None:
    """Denoises the colors of a stack of pictures in place. Removes arrays that are not wanted."""
    for k, (color, camera) in enumerate(zip(arrays["color"], cameras)):
        has_lens = isinstance(camera, PerspectiveCamera) and camera.lens_radius > 0
        features = {name: arrays[name][k] for name in _FEATURES}
        _core.denoise(color, features, has_lens, has_ground, threads)
    for name in _FEATURES:
        if name not in wanted:
            del arrays[name]


def _prepared(scene: Scene | PreparedScene) -> PreparedScene:
    if isinstance(scene, PreparedScene):
        return scene
    if isinstance(scene, Scene):
        return scene.prepare()
    raise TypeError(f"expected a Scene or a PreparedScene, not {type(scene).__name__}")


def _shutter_arguments(shutter: Shutter) -> tuple[Any, ...]:
    def moment(time: float) -> tuple[Any, Camera]:
        scene, camera = shutter.moment(time)
        return _prepared(scene)._core, camera

    as_instance(shutter, "shutter", Shutter)
    if not callable(shutter.moment):
        raise TypeError(f"moment must be a function of the time, not {shutter.moment!r}")
    times = as_integer(shutter.times, "times", 1, 65536)
    if times.bit_count() != 1:
        raise ValueError(f"times must be a power of two from 1 to 65536, not {times}")
    begin, end = (as_float(getattr(shutter, name), name) for name in ("open", "close"))
    if not -np.inf < begin <= end < np.inf:
        raise ValueError(f"open and close must be finite, and open at most close: {begin}, {end}")
    return moment, begin, end, times


def _checked(aovs: Iterable[str]) -> list[str]:
    names = as_names(aovs, "aovs")
    for name in names:
        if name != "color" and name not in _QUANTITIES:
            raise ValueError(f"unknown AOV {name!r} in aovs; use color, {', '.join(_QUANTITIES)}")
    if not names:
        raise ValueError("aovs must name at least one array")
    return names


def _as_background(value: Vector) -> Vector:
    """Returns a color that pictures can show. Raises TypeError or ValueError otherwise."""
    color = as_vector(value, "background")
    if min(color) < 0 or max(color) > 1:
        raise ValueError(f"background must have numbers from 0 to 1, not {value!r}")
    return color


def _until_false(progress: Callable[[float], Any]) -> Callable[[float], bool | None]:
    """Returns a function that returns False exactly if `progress` does; NumPy's False counts."""

    def go_on(share: float) -> bool | None:
        result = progress(share)
        return not isinstance(result, (bool, np.bool_)) or bool(result)

    return go_on


class _shown:
    """A context manager that provides the progress function; None if there is none."""

    def __init__(
        self, progress: Callable[[float], bool | None] | bool, count: int, unit: str = "picture"
    ) -> None:
        if not callable(progress) and not isinstance(progress, (bool, type(None))):
            raise TypeError(f"progress must be a function, True or False, not {progress!r}")
        self._function = _until_false(progress) if callable(progress) else None
        self._bar: Any = None
        if progress is True and sys.stderr is not None:  # pythonw and daemons have none
            try:
                from tqdm.auto import tqdm  # type: ignore[import-untyped,unused-ignore]
            except ImportError:
                return
            self._bar = tqdm(total=count, unit=unit)
            self._function = self._advance

    def _advance(self, share: float) -> None:
        self._bar.update(share * self._bar.total - self._bar.n)

    def __enter__(self) -> Callable[[float], bool | None] | None:
        return self._function

    def __exit__(self, *exception: object) -> None:
        if self._bar is not None:
            self._bar.close()
