"""Pictures from numbers, with the standard library alone."""
import math
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


def board(size_px, focal_px, corners, tilt_rad, centre):
    """Rows of grey values: a checkerboard of `corners` (columns, rows) inner corners on white paper,
    tilted about its two sides; its middle at `centre` (x, y, distance), in lengths of a square."""
    width, height = size_px
    a, b = tilt_rad
    # columns: where the sides of the board point to, seen from the camera
    along = (math.cos(b), math.sin(a) * math.sin(b), -math.cos(a) * math.sin(b))
    down = (0.0, math.cos(a), math.sin(a))
    board_from_ray = inverse(tuple(zip(along, down, centre)))
    rows = []
    for y in range(height):
        row = bytearray()
        for x in range(width):
            ray = ((x - width / 2) / focal_px, (y - height / 2) / focal_px, 1.0)
            u, v, w = (sum(m * r for m, r in zip(line, ray)) for line in board_from_ray)
            row.append(board_grey(u / w + (corners[0] - 1) / 2, v / w + (corners[1] - 1) / 2, corners))
        rows.append(bytes(row))
    return rows


def board_grey(u, v, corners):
    """Edges as soft as a lens makes them."""
    is_within = -1 < u < corners[0] and -1 < v < corners[1]
    if not is_within:
        is_paper = -1.6 < u < corners[0] + 0.6 and -1.6 < v < corners[1] + 0.6
        return 230 if is_paper else 120
    soft = [max(-1.0, min(1.0, 5 * math.sin(math.pi * side))) for side in (u, v)]
    return round(130 - 100 * soft[0] * soft[1])


def inverse(m):
    """Of a matrix of three rows."""
    def minor(i, j):
        a, b = [k for k in range(3) if k != i]
        c, d = [k for k in range(3) if k != j]
        return (-1) ** (i + j) * (m[a][c] * m[b][d] - m[a][d] * m[b][c])

    determinant = sum(m[0][j] * minor(0, j) for j in range(3))
    return [[minor(j, i) / determinant for j in range(3)] for i in range(3)]


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


def jpeg(rows, width, num_components=1):
    """Every block of 8 x 8 pixels of one value: that of its first pixel. Grey, or with four
    components all of the same value (CMYK). Sides are multiples of 8."""
    # all sizes of a difference have codes of 4 bits, the one symbol of the rest, end of block, one
    # of 1 bit
    sizes = bytes([0, 0, 0, 12] + [0] * 12) + bytes(range(12))
    end = bytes([1] + [0] * 15) + b"\0"
    scan, last = Bits(), 0
    components = range(1, num_components + 1)
    for top in range(0, len(rows), 8):
        for left in range(0, width, 8):
            value = rows[top][left] - 128
            difference, last = value - last, value
            size = abs(difference).bit_length()
            for _ in components:
                scan.add(size, 4)
                scan.add(difference if difference > 0 else difference + (1 << size) - 1, size)
                scan.add(0, 1)
    return (b"\xff\xd8" + segment(0xDB, b"\0" + b"\x08" * 64) +
            segment(0xC0, struct.pack(">BHHB", 8, len(rows), width, num_components) +
                    b"".join(bytes([i, 0x11, 0]) for i in components)) +
            segment(0xC4, b"\x00" + sizes) + segment(0xC4, b"\x10" + end) +
            segment(0xDA, bytes([num_components]) + b"".join(bytes([i, 0]) for i in components) +
                    b"\x00\x3f\x00") + scan.bytes() + b"\xff\xd9")


def cmyk_jpeg(rows, width):
    return jpeg(rows, width, 4)


def png16(rows, width):
    """16 bits, grey."""
    return png([b"".join(struct.pack(">H", 257 * grey) for grey in row) for row in rows], width, 16)


def colour_png(rows, width):
    return png([b"".join(bytes([grey] * 4) for grey in row) for row in rows], width, colour=6)


def pgm(rows, width):
    return f"P5\n# by hand\n{width} {len(rows)}\n255\n".encode() + b"".join(rows)


def bmp(rows, width):
    """24 bits."""
    pixels = bottom_up(rows)
    return (struct.pack("<2sIHHI", b"BM", 54 + len(pixels), 0, 0, 54) +
            struct.pack("<IiiHHIIiiII", 40, width, len(rows), 1, 24, 0, len(pixels), 0, 0, 0, 0) +
            pixels)


def tiff(rows, width):
    """8 bits, grey, one strip."""
    pixels = b"".join(rows)
    entries = [(256, 3, width), (257, 3, len(rows)), (258, 3, 8), (259, 3, 1), (262, 3, 1),
               (273, 4, 8), (277, 3, 1), (278, 3, len(rows)), (279, 4, len(pixels))]
    table = b"".join(struct.pack("<HHII", tag, kind, 1, value) for tag, kind, value in entries)
    return (struct.pack("<2sHI", b"II", 42, 8 + len(pixels)) + pixels +
            struct.pack("<H", len(entries)) + table + bytes(4))


def webp(rows, width):
    """Lossless, all of one colour, for which a pixel takes no bits."""
    fields = [(width - 1, 14), (len(rows) - 1, 14), (0, 1), (0, 3), (0, 1), (0, 1), (0, 1)]
    for symbol in (rows[0][0], 128, 90, 255, 0):
        fields += [(1, 1), (0, 1), (1, 1), (symbol, 8)]
    number, shift = 0, 0
    for value, count in fields:
        number |= value << shift
        shift += count
    data = b"\x2f" + number.to_bytes((shift + 7) // 8 + 1, "little")
    body = b"WEBP" + list_item(b"VP8L", data)
    return b"RIFF" + struct.pack("<I", len(body)) + body


def bottom_up(rows):
    """Pixels as BMP has them: blue, green, red, the lowest row first. The width is a multiple of 4."""
    return b"".join(b"".join(bytes([grey] * 3) for grey in row) for row in reversed(rows))


def avi(pictures, width, fps=10, codec=b"MJPG"):
    """JPEG pictures as a Motion JPEG video, or with the codec "DIB " pixels as bottom_up() has them."""
    height = width * 3 // 4
    kind, compression = (b"00dc", codec) if codec == b"MJPG" else (b"00db", bytes(4))
    frames = b"".join(list_item(kind, picture) for picture in pictures)
    main = struct.pack("<14I", 1_000_000 // fps, 0, 0, 0x10, len(pictures), 0, 1, 0, width, height,
                       0, 0, 0, 0)
    stream = struct.pack("<4s4sIHHIIIIIIIIhhhh", b"vids", codec, 0, 0, 0, 0, 1, fps, 0,
                         len(pictures), 0, 0xFFFFFFFF, 0, 0, 0, width, height)
    bitmap = struct.pack("<IiiHH4sIiiII", 40, width, height, 1, 24, compression, 3 * width * height, 0,
                         0, 0, 0)
    header = list_of(b"hdrl", list_item(b"avih", main) +
                     list_of(b"strl", list_item(b"strh", stream) + list_item(b"strf", bitmap)))
    body = b"AVI " + header + list_of(b"movi", frames)
    return b"RIFF" + struct.pack("<I", len(body)) + body


def list_item(name, data):
    return name + struct.pack("<I", len(data)) + data + b"\0" * (len(data) % 2)


def list_of(name, data):
    return list_item(b"LIST", name + data)
