"""Reads the OpenEXR files that the program writes: a single part with scan lines, uncompressed or ZIP-compressed.

Implements the specification of the file format (https://openexr.com/en/latest/OpenEXRFileLayout.html). Tests thus don't
depend on the library that wrote the file.
"""
import struct
import zlib

TYPES = {0: ("I", 4), 1: ("e", 2), 2: ("f", 4)}  # UINT, HALF, FLOAT
LINES_PER_CHUNK = {0: 1, 2: 1, 3: 16}  # none, ZIPS, ZIP


class Exr:
    """An OpenEXR file. `channels` maps names to lists of rows of numbers, and `types` maps them to "I", "e" or "f". Windows
    are (x0, y0, x1, y1), where x1 and y1 are the first column and row outside."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        magic, version = struct.unpack_from("<II", data)
        assert magic == 20000630 and version & 0xFF == 2 and version & 0x1A00 == 0, "not a plain scan line file"
        self.attributes, at = {}, 8
        while data[at]:
            name, at = self._string(data, at)
            _, at = self._string(data, at)
            (size,) = struct.unpack_from("<i", data, at)
            self.attributes[name] = data[at + 4:at + 4 + size]
            at += 4 + size
        at += 1
        self.data_window = self._window("dataWindow")
        self.display_window = self._window("displayWindow")
        self.types = {}
        listing, place = self.attributes["channels"], 0
        while listing[place]:
            name, place = self._string(listing, place)
            kind, _, x_sampling, y_sampling = struct.unpack_from("<iIii", listing, place)
            assert (x_sampling, y_sampling) == (1, 1)
            self.types[name] = TYPES[kind][0]
            place += 16
        x0, y0, x1, y1 = self.data_window
        self.width, self.height = x1 - x0, y1 - y0
        self._read_lines(data, at)

    @staticmethod
    def _string(data, at):
        end = data.index(b"\0", at)
        return data[at:end].decode(), end + 1

    def _window(self, name):
        x0, y0, x1, y1 = struct.unpack("<4i", self.attributes[name])
        return x0, y0, x1 + 1, y1 + 1

    def _read_lines(self, data, at):
        compression = self.attributes["compression"][0]
        lines = LINES_PER_CHUNK[compression]
        count = -(-self.height // lines)
        offsets = struct.unpack_from(f"<{count}Q", data, at)
        self.channels = {name: [None] * self.height for name in self.types}
        line_size = self.width * sum(struct.calcsize(t) for t in self.types.values())
        for offset in offsets:
            y, size = struct.unpack_from("<ii", data, offset)
            row = y - self.data_window[1]
            rows = min(lines, self.height - row)
            chunk = data[offset + 8:offset + 8 + size]
            if compression != 0 and size < rows * line_size:
                chunk = self._unzip(chunk)
            assert len(chunk) == rows * line_size
            place = 0
            for line in range(row, row + rows):
                for name, kind in self.types.items():
                    values = struct.unpack_from(f"<{self.width}{kind}", chunk, place)
                    self.channels[name][line] = values
                    place += self.width * struct.calcsize(kind)

    @staticmethod
    def _unzip(chunk):
        """Decompresses a chunk. Undoes the predictor (differences of bytes) and the separation of even and odd bytes."""
        raw = bytearray(zlib.decompress(chunk))
        for i in range(1, len(raw)):
            raw[i] = (raw[i - 1] + raw[i] - 128) & 0xFF
        half = (len(raw) + 1) // 2
        result = bytearray(len(raw))
        result[0::2] = raw[:half]
        result[1::2] = raw[half:]
        return bytes(result)
