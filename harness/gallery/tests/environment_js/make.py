"""Writes the files that environment.test.mjs reads: python3 make.py, with the packages OpenEXR 3.5 and numpy.

The samples follow from formulas, which environment.test.mjs states again.
"""

from pathlib import Path

import numpy as np
import OpenEXR

FOLDER = Path(__file__).parent / "files"
COMPRESSIONS = {
    "none": OpenEXR.NO_COMPRESSION,
    "rle": OpenEXR.RLE_COMPRESSION,
    "zips": OpenEXR.ZIPS_COMPRESSION,
    "zip": OpenEXR.ZIP_COMPRESSION,
    "piz": OpenEXR.PIZ_COMPRESSION,
    "pxr24": OpenEXR.PXR24_COMPRESSION,
    "b44": OpenEXR.B44_COMPRESSION,
    "dwaa": OpenEXR.DWAA_COMPRESSION,
}
TYPES = {"half": np.float16, "float": np.float32, "uint": np.uint32}


def samples(width, height, part, kind):
    """Returns a channel."""
    y, x = np.mgrid[0:height, 0:width]
    whole = (x * (part + 1) + y * y) % 37 // 5 + part
    divisor = {"half": 8, "float": 3, "uint": 1}[kind]
    return (whole / divisor).astype(TYPES[kind])


def write(name, compression, channels, **header):
    """Writes a file of the given channels."""
    given = {"compression": COMPRESSIONS[compression], "type": OpenEXR.scanlineimage, **header}
    OpenEXR.File(given, dict(channels)).write(str(FOLDER / f"{name}.exr"))


def colours(width, height, kind, names="RGB"):
    """Returns channels by name."""
    return {name: samples(width, height, part, kind) for part, name in enumerate(names)}


def main():
    """Writes all."""
    FOLDER.mkdir(exist_ok=True)
    for compression in ("none", "rle", "zips", "zip", "piz"):
        for kind in TYPES:
            # More rows than a chunk has, the last being incomplete.
            size = (10, 8) if compression == "none" else (11, 61) if kind == "half" else (7, 35)
            write(f"{compression}_{kind}", compression, colours(*size, kind))
    write("luminance", "zip", colours(6, 4, "half", "Y"))
    more = {"A": samples(6, 4, 5, "half"), "Z": samples(6, 4, 6, "float")}
    write("alpha_and_depth", "zip", colours(6, 4, "half") | more)
    window = {
        "dataWindow": (np.array([-2, 1], np.int32), np.array([7, 9], np.int32)),
        "displayWindow": (np.array([0, 0], np.int32), np.array([5, 11], np.int32)),
    }
    write("windows", "zip", colours(10, 9, "half"), **window)
    write("decreasing", "rle", colours(6, 9, "half"), lineOrder=OpenEXR.DECREASING_Y)
    for compression in ("pxr24", "b44", "dwaa"):
        write(compression, compression, colours(8, 4, "half"))
    write("layer", "zip", {f"diffuse.{name}": plane for name, plane in colours(6, 4, "half").items()})
    write("depth_alone", "zip", {"Z": samples(6, 4, 0, "float")})
    write("tiles", "zip", colours(6, 4, "half"), type=OpenEXR.tiledimage, tiles=OpenEXR.TileDescription())
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    parts = [OpenEXR.Part(dict(header), dict(colours(6, 4, "half")), name) for name in ("left", "right")]
    OpenEXR.File(parts).write(str(FOLDER / "parts.exr"))


main()
