"""What is done to a file: cut off, bits turned over, numbers and bytes of its head changed, hostile names put in."""

import io
import re
import zipfile
from collections.abc import Callable

import numpy as np

Mutation = Callable[[bytes, np.random.Generator], bytes]

_HEAD = 2000
_NUMBER = re.compile(rb"(?<![\w.])-?\d+(?:\.\d+)?(?![\w.])")
_WORD = re.compile(rb"[A-Za-z_]{3,}")
_NUMBERS = (
    b"0",
    b"-1",
    b"1",
    b"255",
    b"65536",
    b"2147483647",
    b"4294967296",
    b"99999999999999999999",
    b"nan",
    b"1e400",
)
HOSTILE_NAMES = (
    b"\\ud800",
    "\ud800".encode("utf-8", "surrogatepass"),
    b"\n2026-01-01 INFO forged",
    b"\\n2026-01-01 INFO forged",
    b"\x1b[31mred\x1b[0m",
    b"\\u001b[1m",
    b"../../../etc/passwd",
    b"/dev/zero",
    b"http://127.0.0.1:1/x",
    b"data:;base64,AAAA",
    b"%s%n%99999999d{0.__class__}",
    "\u202egnp.\u0000".encode(),
    b"<!ENTITY a SYSTEM 'file:///etc/passwd'>&a;",
    b"A" * 300_000,
    b"\xff\xfe\x00",
    b"__proto__",
    b"' OR 1=1 --",
)


def cut_off(data: bytes, rng: np.random.Generator) -> bytes:
    """Keep the beginning."""
    return data[: int(rng.integers(len(data)))]


def with_bits_turned(data: bytes, rng: np.random.Generator) -> bytes:
    """Turn one to sixteen bits over, in the head or anywhere."""
    changed = bytearray(data)
    within = len(data) if rng.random() < 0.5 else min(len(data), _HEAD)
    for place in rng.integers(within, size=int(rng.integers(1, 17))):
        changed[place] ^= 1 << int(rng.integers(8))
    return bytes(changed)


def with_edited_head(data: bytes, rng: np.random.Generator) -> bytes:
    """Change a number of the head, or four of its bytes where it has no numbers as text."""
    found = list(_NUMBER.finditer(data[:_HEAD]))
    if found and rng.random() < 0.7:
        place = found[int(rng.integers(len(found)))]
        return data[: place.start()] + _NUMBERS[int(rng.integers(len(_NUMBERS)))] + data[place.end() :]
    at = int(rng.integers(min(len(data), 200)))
    word = int(rng.choice([0, 1, 0x7FFFFFFF, 0xFFFFFFFF, 0x80000000])).to_bytes(4, "little")
    return data[:at] + word + data[at + (4 if rng.random() < 0.7 else 0) :]


def with_hostile_name(data: bytes, rng: np.random.Generator) -> bytes:
    """Put a hostile string in place of a word, or of a line's end."""
    name = HOSTILE_NAMES[int(rng.integers(len(HOSTILE_NAMES)))]
    found = list(_WORD.finditer(data[:_HEAD])) or list(_WORD.finditer(data))
    if not found:
        return name + data
    place = found[int(rng.integers(len(found)))]
    return data[: place.start()] + name + data[place.end() :]


def with_rows_shuffled(data: bytes, rng: np.random.Generator) -> bytes:
    """Repeat, leave out or exchange a stretch."""
    a, b = sorted(int(place) for place in rng.integers(len(data), size=2))
    which = int(rng.integers(3))
    return (data[:b] + data[a:], data[:a] + data[b:], data[b:] + data[:a])[which]


MUTATIONS: dict[str, Mutation] = {
    "cut off": cut_off,
    "bits": with_bits_turned,
    "head": with_edited_head,
    "names": with_hostile_name,
    "stretches": with_rows_shuffled,
}


def mutated(data: bytes, kind: str, rng: np.random.Generator) -> bytes:
    """Mutate a file; half of the zip archives inside of one of their entries, so that it still unpacks."""
    if not data:
        return data
    if data.startswith(b"PK") and zipfile.is_zipfile(io.BytesIO(data)) and rng.random() < 0.7:
        return _inside(data, kind, rng)
    return MUTATIONS[kind](data, rng)


def _inside(data: bytes, kind: str, rng: np.random.Generator) -> bytes:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        entries = {name: archive.read(name) for name in archive.namelist()}
    filled = [name for name, content in entries.items() if content]
    chosen = filled[int(rng.integers(len(filled)))]
    entries[chosen] = MUTATIONS[kind](entries[chosen], rng)
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in entries.items():
            archive.writestr(zipfile.ZipInfo(name), content)
    return out.getvalue()
