"""Makes the helmet's textures and the sky."""
import numpy as np

import files

SIZE = 2048


def noise(random, size, cells):
    """Returns periodic noise in [0, 1], interpolated smoothly between random values on a grid of cells x cells."""
    grid = random.random((cells, cells)).astype(np.float32)
    at = np.arange(size, dtype=np.float32) * cells / size
    low = at.astype(int)
    f = at - low
    f = f * f * (3 - 2 * f)
    high = (low + 1) % cells
    rows = grid[low] * (1 - f)[:, None] + grid[high] * f[:, None]
    return rows[:, low] * (1 - f) + rows[:, high] * f


def cloudy(random, first, octaves):
    """Returns a sum of noises of several scales, in [0, 1]."""
    sum_, weight = np.zeros((SIZE, SIZE), np.float32), 0.0
    for i in range(octaves):
        sum_ += noise(random, SIZE, first << i) * 0.5**i
        weight += 0.5**i
    return sum_ / weight


def smooth(x, low, high):
    t = np.clip((x - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def bytes_of(x):
    return (np.clip(x, 0, 1) * 255 + 0.5).astype(np.uint8)


def maps():
    """Returns {name: uint8 pixels}."""
    random = np.random.default_rng(1)
    y, x = np.mgrid[0:SIZE, 0:SIZE].astype(np.float32) / SIZE
    wear, fine, dirt = cloudy(random, 8, 7), cloudy(random, 128, 4), cloudy(random, 4, 8)
    seam = np.minimum(np.abs((x * 12) % 1 - 0.5), np.abs((y * 12) % 1 - 0.5))
    seam = smooth(seam, 0.01, 0.03)
    is_visor = ((x < 0.5) & (y > 0.62)).astype(np.float32)
    bare = np.maximum(smooth(wear, 0.52, 0.6), is_visor)  # areas without paint
    lamp = ((np.abs((x * 12) % 1 - 0.25) < 0.06) & (np.abs((y * 30) % 1 - 0.5) < 0.25) &
            (np.abs(y - 0.4) < 0.04) & (np.abs(x - 0.5) > 0.06)).astype(np.float32)

    paint = np.stack([0.75 + 0.2 * fine, 0.36 + 0.1 * fine, 0.1 + 0.05 * dirt], -1)
    steel = np.stack([0.72 + 0.1 * fine, 0.71 + 0.1 * fine, 0.69 + 0.1 * fine], -1)
    color = paint + (steel - paint) * bare[..., None]
    color *= ((0.35 + 0.65 * seam) * (0.55 + 0.45 * smooth(dirt, 0.3, 0.6)))[..., None]
    roughness = 0.25 + 0.5 * dirt + 0.15 * (1 - bare) + 0.1 * (fine - 0.5)
    roughness = np.where(is_visor > 0, 0.12 + 0.15 * fine, roughness)

    height = 4 * seam + 1.5 * wear + 0.6 * fine * (1 - is_visor)
    slope_x = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) * 0.7
    slope_y = (np.roll(height, -1, 0) - np.roll(height, 1, 0)) * 0.7
    n = np.stack([-slope_x, slope_y, np.ones_like(height)], -1)
    n /= np.linalg.norm(n, axis=-1, keepdims=True)
    rough, metal = bytes_of(roughness), bytes_of(bare)
    return {"base_color": bytes_of(color), "normal": bytes_of(n / 2 + 0.5), "roughness": rough,
            "metallic": metal, "metallic_roughness": np.stack([np.zeros_like(rough), rough, metal], -1),
            "emissive": bytes_of(lamp[..., None] * np.array([0.3, 0.8, 1.0], np.float32))}


def sky(width=512):
    """Returns a sky over brown ground. The sun is about 3 degrees wide, 45 degrees high, and to the right of the front."""
    height = width // 2
    v, u = (np.mgrid[0:height, 0:width] + 0.5) / np.array([height, width])[:, None, None]
    theta, phi = v * np.pi, (u - 0.5) * 2 * np.pi
    d = np.stack([np.cos(phi) * np.sin(theta), np.cos(theta), np.sin(phi) * np.sin(theta)], -1)
    up = d[..., 1:2]
    above = smooth(up, -0.02, 0.02)
    pixels = (0.25 + 0.6 * (1 - np.abs(up)) ** 3) * np.array([0.55, 0.75, 1.1]) * above
    pixels += np.array([0.18, 0.14, 0.1]) * (1 - above)
    sun = np.array([0.5, np.sqrt(0.5), 0.5])
    return pixels + smooth(d @ sun, np.cos(0.035), np.cos(0.02))[..., None] * np.array([900, 800, 650])


def write(folder):
    for name, pixels in maps().items():
        files.write_png(folder / f"{name}.png", pixels)
    files.write_hdr(folder / "sky.hdr", sky())
