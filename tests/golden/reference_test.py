"""Tests that reference.py detects wrong pictures."""
import contextlib
import io
import math
import pathlib
import tempfile
import unittest

import reference

NAME = "perspective1"
VIEW = reference.View(NAME)
PICTURE = reference.render_rows((NAME, 0, reference.HEIGHT))


def compare(pixels, listed=()):
    """Returns the number of faults found in a picture, and the text that is printed about them."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "a.ppm"
        path.write_bytes(b"P6\n640 480\n255\n" + pixels)
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            faults = reference.compare(NAME, PICTURE, path, set(listed))
        return faults, out.getvalue()


def with_pixel(x, y, color):
    pixels = bytearray(PICTURE)
    at = 3 * (y * reference.WIDTH + x)
    pixels[at:at + 3] = bytes(color)
    return bytes(pixels)


class Reference(unittest.TestCase):
    def test_corner_rays_of_the_assignment(self):
        for x, y, wanted in (
            (0.5, 479.5, (-0.5543, -0.415508, -0.721183)),
            (639.5, 479.5, (0.5543, -0.415508, -0.721183)),
            (0.5, 0.5, (-0.5543, 0.415508, -0.721183)),
            (639.5, 0.5, (0.5543, 0.415508, -0.721183)),
        ):
            for got, want in zip(reference.unit(VIEW.direction(x, y)), wanted):
                self.assertAlmostEqual(got, want, delta=5e-7)

    def test_own_picture_has_no_faults(self):
        self.assertEqual(compare(PICTURE)[0], 0)

    def test_horizon_is_the_middle(self):
        black, yellow = b"\0\0\0", b"\xff\xff\0"
        row = 3 * reference.WIDTH
        self.assertEqual(PICTURE[239 * row:239 * row + 3], black)
        self.assertEqual(PICTURE[240 * row:240 * row + 3], yellow)

    def test_a_wrong_pixel_is_a_fault_even_if_listed(self):
        faults, text = compare(with_pixel(10, 10, (255, 0, 0)), [(NAME, 10, 10)])
        self.assertEqual(faults, 1)
        self.assertIn("WRONG", text)

    def test_a_neighbor_of_an_edge_is_a_fault(self):
        # The horizon is half a pixel away from the pixel centers of row 240. This is far more than the rounding error.
        faults, text = compare(with_pixel(10, 240, (0, 0, 0)))
        self.assertEqual(faults, 1)
        self.assertIn("WRONG", text)

    def test_a_color_of_no_surface_is_a_fault(self):
        self.assertEqual(compare(with_pixel(10, 10, (1, 2, 3)))[0], 1)

    def test_a_listed_pixel_must_differ(self):
        self.assertEqual(compare(PICTURE, [(NAME, 5, 5)])[0], 1)

    def test_distance_to_the_horizon(self):
        for angle in (2.0 ** -30, 2.0 ** -20, 2.0 ** -10):
            # The ray passes left of every shape, and the plane's horizon is 0.75 * angle above it.
            below = (-0.6, -math.tan(0.75 * angle) * math.hypot(0.6, 1), -1)
            self.assertEqual(VIEW.distance_to((0, 0, 0), below), angle)


if __name__ == "__main__":
    unittest.main()
