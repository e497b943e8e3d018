"""Small changes of a file, drawn from a seeded generator."""
import re

NUMBERS = [b"0", b"-0", b"-1", b"1e-320", b"1e-30", b"1e30", b"1e100", b"1e200", b"1e308", b"-1e308",
           b"1e999", b"nan", b"-nan", b"inf", b"-inf", b"2147483647", b"2147483648", b"-2147483649",
           b"4294967296", b"9223372036854775807", b"18446744073709551616", b"0x10", b"+1", b"1,5",
           b"1e", b"."]
BYTES = [b"\0", b"\xff", b"\xef\xbb\xbf", b"\x1b[2J", b"\r", b"\n", b"\t", b"\"", b"'", b"%s%n", b"{}",
         b"[", b"&a *a", b"\xc2\x9b", b"../", b"#", b"-" * 300, b"9" * 400, b"x" * 100_000]
NUMBER = re.compile(rb"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?")


def flip_bits(draw, data):
    changed = bytearray(data)
    for _ in range(draw.choice([1, 1, 2, 5, 20])):
        at = draw.randrange(len(changed))
        changed[at] ^= 1 << draw.randrange(8)
    return bytes(changed)


def flip_bits_of_header(draw, data):
    """The first bytes, where sizes stand."""
    size = min(len(data), 64)
    return flip_bits(draw, data[:size]) + data[size:]


def cut(draw, data):
    return data[:draw.randrange(len(data))]


def repeat(draw, data):
    start = draw.randrange(len(data))
    end = draw.randrange(start, len(data)) + 1
    return data[:end] + data[start:end] * draw.choice([1, 2, 50]) + data[end:]


def leave_out(draw, data):
    start = draw.randrange(len(data))
    return data[:start] + data[start + draw.randint(1, max(1, len(data) // 4)):]


def insert(draw, data):
    at = draw.randrange(len(data) + 1)
    return data[:at] + draw.choice(BYTES) + data[at:]


def overwrite_integer(draw, data):
    """Four bytes become a size that no file has."""
    at = draw.randrange(max(1, len(data) - 4))
    value = draw.choice([0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x10000, 65535])
    return data[:at] + value.to_bytes(4, draw.choice(["big", "little"])) + data[at + 4:]


def change_number(draw, data):
    found = list(NUMBER.finditer(data[:200_000]))
    if not found:
        return flip_bits(draw, data)
    for place in sorted(draw.sample(found, min(len(found), draw.choice([1, 1, 1, 3]))),
                        key=lambda match: -match.start()):
        data = data[:place.start()] + draw.choice(NUMBERS) + data[place.end():]
    return data


def change_lines(draw, data):
    lines = data.split(b"\n")
    a, b = draw.randrange(len(lines)), draw.randrange(len(lines))
    how = draw.randrange(4)
    if how == 0:
        lines[a], lines[b] = lines[b], lines[a]
    elif how == 1:
        del lines[a]
    elif how == 2:
        lines.insert(b, lines[a])
    else:
        return data.replace(b"\n", draw.choice([b"\r\n", b"\r", b" ", b"\n\n"]))
    return b"\n".join(lines)


def empty(_draw, _data):
    return b""


TEXT = [change_number] * 6 + [change_lines] * 3 + [insert, insert, cut, repeat, leave_out, flip_bits,
                                                   empty]
BINARY = [flip_bits] * 3 + [flip_bits_of_header] * 4 + [overwrite_integer] * 3 + [
    cut, repeat, leave_out, insert, empty]


def is_text(data):
    return b"\0" not in data[:4096]


def mutate(draw, data):
    for _ in range(draw.choice([1, 1, 1, 2, 3])):
        if data:
            data = draw.choice(TEXT if is_text(data) else BINARY)(draw, data)
    return data
