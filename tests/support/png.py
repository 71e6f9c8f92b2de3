"""Reads PNG files of 8 bits a channel, for tests that look at pictures."""
import struct
import zlib

import numpy


def read(path):
    """The pixels as an array of height x width x channels."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[colour]
    assert depth == 8
    rows = numpy.frombuffer(zlib.decompress(packed), numpy.uint8).reshape(height, 1 + width * channels)
    out = numpy.zeros((height, width * channels), numpy.uint8)
    above = numpy.zeros(width * channels, int)
    for y in range(height):
        kind, line = rows[y, 0], rows[y, 1:].astype(int)
        if kind == 2:
            line = line + above
        elif kind != 0:
            for k in range(len(line)):
                left = line[k - channels] if k >= channels else 0
                corner = above[k - channels] if k >= channels else 0
                guess = left + above[k] - corner
                near = min((abs(guess - left), 0, left), (abs(guess - above[k]), 1, above[k]), (abs(guess - corner), 2, corner))[2]
                line[k] = (line[k] + {1: left, 3: (left + above[k]) // 2, 4: near}[kind]) % 256
        above = line % 256
        out[y] = above
    return out.reshape(height, width, channels)
