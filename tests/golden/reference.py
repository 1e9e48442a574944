#!/usr/bin/env python3
"""Renders the three pictures of the assignment independently in float64, to check the renderer's pictures.

    reference.py DIFFERENCES NAME=PPM...      NAME: perspective1, perspective2 or perspective3

Compares each binary PPM with the reference, pixel by pixel. A pixel may differ only if the exact boundary of a color is so
close to the pixel's center that rounding matters. In addition, the file DIFFERENCES must list the pixel as `NAME X Y`. The
exit status is 1 if any other pixel differs, or if a listed one does not.

Shares neither code nor formulas with the renderer. Numbers are as written in the assignment and not rounded to float32. The
equations of all shapes are relative to the eye, the common origin of all rays.

Rounding: the renderer rounds each component of a unit direction and each coordinate of the scene to float32. The first
rounding turns a ray by at most sqrt(3) 2^-25 < 2^-24 radians. The second moves a surface by at most 2^-24 of its
coordinates, which are smaller than its distance from the eye. Seen from the eye, the surface thus moves by less than 2^-24
radians. If a boundary is farther than 2^-23 radians from a pixel's center, the pixel must therefore be equal.
"""
import math
import multiprocessing
import sys

WIDTH, HEIGHT = 640, 480
BOUND = 2.0 ** -23
BLACK = (0, 0, 0)

CAMERAS = {  # position, direction, up, full vertical angle in degrees
    "perspective1": ((0, 0, 10), (0, 0, -1), (0, 1, 0), 60),
    "perspective2": ((-8, 3, 8), (1, -0.1, -1), (0, 1, 0), 45),
    "perspective3": ((-8, 3, 8), (1, -0.1, -1), (1, 1, 0), 45),
}
SPHERES = [  # center, radius, color
    ((-2, 1.7, 0), 2, (255, 0, 0)),
    ((1, -1, 1), 2.2, (0, 255, 0)),
    ((3, 0.8, -2), 2, (0, 0, 255)),
]
PLANES = [((0, -1, 0), (0, 1, 0), (255, 255, 0))]  # point, normal, color
TRIANGLES = [  # corners, color
    (((-2, 3.7, 0), (1, 2, 1), (3, 2.8, -2)), (0, 255, 255)),
    (((3, 2, 3), (3, 2, -3), (-3, 2, -3)), (255, 255, 255)),
]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def times(s, a):
    return (s * a[0], s * a[1], s * a[2])


def unit(a):
    return times(1 / math.sqrt(dot(a, a)), a)


class View:
    """The scene as seen from one eye, and the rays of one picture."""

    def __init__(self, name):
        eye, direction, up, angle = CAMERAS[name]
        self.forward = unit(direction)
        self.right = unit(cross(self.forward, up))
        self.up = cross(self.right, self.forward)
        # Half the window's height at distance 1. Pixels are square.
        self.half = math.tan(math.radians(angle) / 2)
        # A point eye + t d lies on a sphere if |d|^2 t^2 - 2 (d.m) t + (m.m - r^2) = 0, where m leads from the eye to the
        # center.
        self.spheres = []
        for center, radius, color in SPHERES:
            m = minus(center, eye)
            self.spheres.append((m, dot(m, m) - radius * radius, color))
        self.planes = [(n, dot(minus(p, eye), n), color) for p, n, color in PLANES]
        # Three planes contain the eye and an edge of a triangle each. A ray passes through the triangle if it is on the
        # same side of all three. `sides` has the planes' normals.
        self.triangles = []
        for corners, color in TRIANGLES:
            a, b, c = (minus(corner, eye) for corner in corners)
            sides = (cross(a, b), cross(b, c), cross(c, a))
            normal = cross(minus(b, a), minus(c, a))
            self.triangles.append((sides, normal, dot(a, normal), color))

    def direction(self, x, y):
        """Returns the direction to the pixel coordinates (x, y), whose origin is the upper left corner. It does not have
        unit length."""
        across = (2 * x - WIDTH) / HEIGHT * self.half
        above = (HEIGHT - 2 * y) / HEIGHT * self.half
        f, r, u = self.forward, self.right, self.up
        return (
            f[0] + across * r[0] + above * u[0],
            f[1] + across * r[1] + above * u[1],
            f[2] + across * r[2] + above * u[2],
        )

    def color(self, d):
        """Returns the color of the nearest surface in the direction d."""
        dx, dy, dz = d
        nearest, seen = math.inf, BLACK
        dd = dx * dx + dy * dy + dz * dz
        for (mx, my, mz), c, color in self.spheres:
            half_b = dx * mx + dy * my + dz * mz
            discriminant = half_b * half_b - dd * c
            if discriminant < 0:
                continue
            # The eye is outside every sphere, so c > 0 and both roots have the same sign.
            t = (half_b - math.sqrt(discriminant)) / dd
            if 0 < t < nearest:
                nearest, seen = t, color
        for (nx, ny, nz), height, color in self.planes:
            slope = dx * nx + dy * ny + dz * nz
            if slope != 0 and 0 < height / slope < nearest:
                nearest, seen = height / slope, color
        for (p, q, r), (nx, ny, nz), height, color in self.triangles:
            first = dx * p[0] + dy * p[1] + dz * p[2]
            if (dx * q[0] + dy * q[1] + dz * q[2]) * first < 0:
                continue
            if (dx * r[0] + dy * r[1] + dz * r[2]) * first < 0:
                continue
            slope = dx * nx + dy * ny + dz * nz
            if slope != 0 and 0 < height / slope < nearest:
                nearest, seen = height / slope, color
        return seen

    def distance_to(self, color, d):
        """Returns the smallest angle by which d must turn to see `color`. Tries powers of two, in radians, in 32 directions."""
        d = unit(d)
        side = unit(cross(d, self.up))
        above = cross(side, d)
        for exponent in range(-40, 1):
            for step in range(32):
                phi = step * math.pi / 16
                s, c = (2.0 ** exponent * f(phi) for f in (math.sin, math.cos))
                turned = tuple(d[i] + s * side[i] + c * above[i] for i in range(3))
                if self.color(turned) == color:
                    return 2.0 ** exponent
        return math.inf


def render_rows(job):
    name, first, last = job
    view = View(name)
    return b"".join(
        bytes(view.color(view.direction(x + 0.5, y + 0.5)))
        for y in range(first, last)
        for x in range(WIDTH)
    )


def read_pixels(path):
    with open(path, "rb") as file:
        data = file.read()
    header = b"P6\n%d %d\n255\n" % (WIDTH, HEIGHT)
    if not data.startswith(header) or len(data) != len(header) + 3 * WIDTH * HEIGHT:
        sys.exit(f"{path}: not a binary PPM of {WIDTH}x{HEIGHT} pixels")
    return data[len(header):]


def read_differences(path):
    with open(path, encoding="ascii") as file:
        lines = (line.split("#")[0].split() for line in file)
        return {(name, int(x), int(y)) for name, x, y in filter(None, lines)}


def compare(name, reference, path, listed):
    """Prints every difference. Returns the number of those that exceed rounding or are not listed."""
    pixels = read_pixels(path)
    view = View(name)
    differing = {
        i // 3 for i in range(0, len(pixels), 3) if pixels[i:i + 3] != reference[i:i + 3]
    }
    faults = 0
    for index in sorted(differing):
        x, y = index % WIDTH, index // WIDTH
        here = tuple(pixels[3 * index:3 * index + 3])
        wanted = tuple(reference[3 * index:3 * index + 3])
        angle = view.distance_to(here, view.direction(x + 0.5, y + 0.5))
        verdict = "rounding, listed"
        if angle > BOUND:
            verdict = "WRONG"
        elif (name, x, y) not in listed:
            verdict = "rounding, NOT LISTED"
        faults += verdict != "rounding, listed"
        if faults <= 20:
            print(f"{name} {x} {y}: {here}, reference {wanted}, boundary within {angle:.3g}: {verdict}")
    for _, x, y in sorted(entry for entry in listed if entry[0] == name):
        if y * WIDTH + x not in differing:
            print(f"{name} {x} {y}: listed, but does not differ")
            faults += 1
    print(f"{name}: {len(differing)} pixels differ, {faults} faults")
    return faults


def main():
    listed = read_differences(sys.argv[1])
    pictures = dict(argument.split("=", 1) for argument in sys.argv[2:])
    if not pictures:
        sys.exit(__doc__)
    rows = 40
    jobs = [(name, y, y + rows) for name in pictures for y in range(0, HEIGHT, rows)]
    with multiprocessing.Pool(2) as pool:
        blocks = pool.map(render_rows, jobs, chunksize=1)
    faults = 0
    for name, path in pictures.items():
        mine = b"".join(block for job, block in zip(jobs, blocks) if job[0] == name)
        faults += compare(name, mine, path, listed)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
