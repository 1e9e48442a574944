"""Renders the pictures listed in a sha256sum file and compares their bytes.

    golden_test.py PROGRAM SCENES SHA256 FOLDER

Each picture NAME.ppm is rendered flat from SCENES/NAME.json or SCENES/gltf/NAME.glb: with one thread, with two threads, and
as ASCII PPM. The binary pictures stay in FOLDER. The exit status is 1 if any picture differs.
"""
import hashlib
import pathlib
import subprocess
import sys


def decode_ascii(data):
    """Returns the binary PPM with the same pixels as an ASCII PPM."""
    magic, width, height, maximum, *values = data.split()
    if magic != b"P3" or maximum != b"255":
        sys.exit("not an ASCII PPM of 8 bit")
    return b"P6\n%s %s\n255\n" % (width, height) + bytes(map(int, values))


def main():
    program, scenes, listing, folder = map(pathlib.Path, sys.argv[1:])
    faults = []

    def draw(name, output, *options):
        scene = scenes / f"{name}.json"
        if not scene.exists():
            scene = scenes / "gltf" / f"{name}.glb"
        command = [program, scene, "--integrator", "flat", "-q", "-o", output, *options]
        subprocess.run(command, check=True)
        return output.read_bytes()

    def expect(good, what):
        print("ok     " if good else "FAILED ", what)
        if not good:
            faults.append(what)

    entries = [line.split() for line in listing.read_text(encoding="ascii").splitlines()]
    expect(entries, f"{listing.name} lists pictures")
    for wanted, file in entries:
        name = file.removesuffix(".ppm")
        one = draw(name, folder / file, "--threads", "1")
        digest = hashlib.sha256(one).hexdigest()
        expect(digest == wanted, f"{file}: SHA-256 is {digest}, wanted {wanted}")
        two = draw(name, folder / f"{name}-2-threads.ppm", "--threads", "2")
        expect(one == two, f"{file}: the same bytes with two threads")
        ascii_bytes = draw(name, folder / f"{name}-ascii.ppm", "--ppm", "ascii")
        expect(decode_ascii(ascii_bytes) == one, f"{file}: the same pixels in ASCII")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
