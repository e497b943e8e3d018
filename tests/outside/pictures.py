"""Pictures from numbers, with the standard library alone."""
import random
import struct
import zlib


def texture(width, height, seed=1):
    """Rows of grey values: rectangles of every size, so that there are corners to find."""
    draw = random.Random(seed)
    rows = [bytearray([128]) * width for _ in range(height)]
    for _ in range(width * height // 120):
        wide, high = draw.randint(3, 14), draw.randint(3, 14)
        left, top = draw.randrange(width), draw.randrange(height)
        grey = draw.randrange(256)
        for row in rows[top:top + high]:
            right = min(left + wide, width)
            row[left:right] = bytes([grey]) * (right - left)
    return [bytes(row) for row in rows]


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def png(rows, width, bits=8, colour=0):
    """Rows of bytes as PNG: `colour` 0 grey, 2 RGB, 4 grey with alpha, 6 RGB with alpha."""
    header = struct.pack(">IIBBBBB", width, len(rows), bits, colour, 0, 0, 0)
    pixels = zlib.compress(b"".join(b"\0" + row for row in rows), 1)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", pixels) +
            chunk(b"IEND", b""))


def depth_png(width, height, units):
    """The same depth everywhere, 16 bits."""
    return png([struct.pack(">H", units) * width] * height, width, bits=16)


class Bits:
    def __init__(self):
        self.bits = ""

    def add(self, value, count):
        self.bits += format(value, f"0{count}b") if count else ""

    def bytes(self):
        padded = self.bits + "1" * (-len(self.bits) % 8)
        data = bytes(int(padded[i:i + 8], 2) for i in range(0, len(padded), 8))
        return data.replace(b"\xff", b"\xff\x00")


def segment(marker, data):
    return struct.pack(">BBH", 0xFF, marker, len(data) + 2) + data


def jpeg(rows, width):
    """Grey, every block of 8 x 8 pixels of one value: that of its first pixel. Sides are multiples
    of 8."""
    # all sizes of a difference have codes of 4 bits, the one symbol of the rest, end of block, one
    # of 1 bit
    sizes = bytes([0, 0, 0, 12] + [0] * 12) + bytes(range(12))
    end = bytes([1] + [0] * 15) + b"\0"
    scan, last = Bits(), 0
    for top in range(0, len(rows), 8):
        for left in range(0, width, 8):
            value = rows[top][left] - 128
            difference, last = value - last, value
            size = abs(difference).bit_length()
            scan.add(size, 4)
            scan.add(difference if difference > 0 else difference + (1 << size) - 1, size)
            scan.add(0, 1)
    return (b"\xff\xd8" + segment(0xDB, b"\0" + b"\x08" * 64) +
            segment(0xC0, struct.pack(">BHHBBBB", 8, len(rows), width, 1, 1, 0x11, 0)) +
            segment(0xC4, b"\x00" + sizes) + segment(0xC4, b"\x10" + end) +
            segment(0xDA, b"\x01\x01\x00\x00\x3f\x00") + scan.bytes() + b"\xff\xd9")


def avi(pictures, width, fps=10):
    """JPEG pictures as a Motion JPEG video."""
    height = width * 3 // 4
    frames = b"".join(list_item(b"00dc", picture) for picture in pictures)
    main = struct.pack("<14I", 1_000_000 // fps, 0, 0, 0x10, len(pictures), 0, 1, 0, width, height,
                       0, 0, 0, 0)
    stream = struct.pack("<4s4sIHHIIIIIIIIhhhh", b"vids", b"MJPG", 0, 0, 0, 0, 1, fps, 0,
                         len(pictures), 0, 0xFFFFFFFF, 0, 0, 0, width, height)
    bitmap = struct.pack("<IiiHH4sIiiII", 40, width, height, 1, 24, b"MJPG", 3 * width * height, 0,
                         0, 0, 0)
    header = list_of(b"hdrl", list_item(b"avih", main) +
                     list_of(b"strl", list_item(b"strh", stream) + list_item(b"strf", bitmap)))
    body = b"AVI " + header + list_of(b"movi", frames)
    return b"RIFF" + struct.pack("<I", len(body)) + body


def list_item(name, data):
    return name + struct.pack("<I", len(data)) + data + b"\0" * (len(data) % 2)


def list_of(name, data):
    return list_item(b"LIST", name + data)
