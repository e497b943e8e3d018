#!/usr/bin/env python3
"""mcap_conformance.py FOLDER OUT: makes the conformance files of the MCAP project from their descriptions.

FOLDER holds, in sub-folders, NAME.json, which describes a file record by record, and NAME.mcap: the file, or a
pointer of Git LFS with its SHA-256. OUT/NAME.mcap is the file, OUT/NAME.txt its messages: a line
`log_time byte byte ...` each. A file whose checksum is not that of the pointer ends the program.
"""
import hashlib
import json
import pathlib
import struct
import sys
import zlib

MAGIC = b"\x89MCAP0\r\n"
CODES = {"Header": 1, "Footer": 2, "Schema": 3, "Channel": 4, "Message": 5, "Chunk": 6, "MessageIndex": 7,
         "ChunkIndex": 8, "Statistics": 11, "SummaryOffset": 14, "DataEnd": 15}
# the fields of each record in their order: u8 ... u64, text, bytes (to the end), data (with its length), maps
LAYOUTS = {
    "Header": [("profile", "text"), ("library", "text")],
    "Footer": [("summary_start", "Q"), ("summary_offset_start", "Q"), ("summary_crc", "I")],
    "Schema": [("id", "H"), ("name", "text"), ("encoding", "text"), ("data", "data")],
    "Channel": [("id", "H"), ("schema_id", "H"), ("topic", "text"), ("message_encoding", "text"),
                ("metadata", "texts")],
    "Message": [("channel_id", "H"), ("sequence", "I"), ("log_time", "Q"), ("publish_time", "Q"), ("data", "bytes")],
    "ChunkIndex": [("message_start_time", "Q"), ("message_end_time", "Q"), ("chunk_start_offset", "Q"),
                   ("chunk_length", "Q"), ("message_index_offsets", "counts"), ("message_index_length", "Q"),
                   ("compression", "text"), ("compressed_size", "Q"), ("uncompressed_size", "Q")],
    "Statistics": [("message_count", "Q"), ("schema_count", "H"), ("channel_count", "I"), ("attachment_count", "I"),
                   ("metadata_count", "I"), ("chunk_count", "I"), ("message_start_time", "Q"),
                   ("message_end_time", "Q"), ("channel_message_counts", "counts")],
    "SummaryOffset": [("group_opcode", "B"), ("group_start", "Q"), ("group_length", "Q")],
    "DataEnd": [("data_section_crc", "I")],
}
UNPADDED = {"Message", "DataEnd", "Footer", "Chunk"}


def text(value):
    return struct.pack("<I", len(value.encode())) + value.encode()


def field(kind, value):
    if kind == "text":
        return text(value)
    if kind in ("bytes", "data"):
        raw = bytes(int(byte) for byte in value)
        return raw if kind == "bytes" else struct.pack("<I", len(raw)) + raw
    if kind in ("texts", "counts"):
        entries = b"".join(text(key) + text(entry) if kind == "texts" else struct.pack("<HQ", int(key), int(entry))
                           for key, entry in value.items())
        return struct.pack("<I", len(entries)) + entries
    return struct.pack("<" + kind, int(value))


def record(name, content, padding=b""):
    return struct.pack("<BQ", CODES[name], len(content + padding)) + content + padding


def described(entry, padding):
    fields = dict(entry["fields"])
    content = b"".join(field(kind, fields[name]) for name, kind in LAYOUTS[entry["type"]])
    return record(entry["type"], content, b"" if entry["type"] in UNPADDED else padding)


def chunk_of(entries, padding, has_index):
    """Schemas, channels and messages as one chunk, and its message index."""
    body, places = b"", []
    for entry in entries:
        if entry["type"] == "Message":
            places.append((int(dict(entry["fields"])["log_time"]), len(body)))
        body += described(entry, b"")
    first, last = (places[0][0], places[-1][0]) if places else (0, 0)
    crc = zlib.crc32(body)
    content = struct.pack("<QQQI", first, last, len(body), crc) + text("") + struct.pack("<Q", len(body)) + body
    index = b""
    if has_index and places:
        pairs = b"".join(struct.pack("<QQ", *place) for place in places)
        index = record("MessageIndex", struct.pack("<HI", 1, len(pairs)) + pairs, padding)
    return record("Chunk", content) + index


def file_of(description):
    features = description["meta"]["variant"]["features"]
    padding = b"\x01\xff\xff" if "pad" in features else b""
    data, is_summary, loose = MAGIC, False, []
    for entry in description["records"]:
        if entry["type"] in ("Schema", "Channel", "Message") and "ch" in features and not is_summary:
            loose.append(entry)
            continue
        if loose:
            data += chunk_of(loose, padding, "mx" in features)
            loose = []
        is_summary = is_summary or entry["type"] == "DataEnd"
        data += described(entry, padding)
    return data + MAGIC


def main():
    folder, out = map(pathlib.Path, sys.argv[1:])
    for path in sorted(folder.glob("*/*.json")):
        description = json.loads(path.read_text())
        content = file_of(description)
        pointer = path.with_suffix(".mcap").read_bytes()
        expected = pointer.split(b"sha256:")[1][:64].decode() if b"git-lfs" in pointer[:60] \
            else hashlib.sha256(pointer).hexdigest()
        if hashlib.sha256(content).hexdigest() != expected:
            sys.exit(f"{path}: the file made from it has another checksum than {path.stem}.mcap")
        (out / f"{path.stem}.mcap").write_bytes(content)
        lines = []
        for entry in description["records"]:
            if entry["type"] == "Message":
                fields = dict(entry["fields"])
                lines.append(" ".join([fields["log_time"], *fields["data"]]) + "\n")
        (out / f"{path.stem}.txt").write_text("".join(lines))


main()
