"""Files spoiled as people and disks spoil them: every spoiling is a function of the text and of a seed."""

import json
import random
import re
from collections.abc import Callable, Sequence
from pathlib import Path

import h5py
import numpy as np

NUMBERS = (
    "nan", "inf", "-inf", "-1", "0", "1e308", "-1e308", "1e-320", "9" * 400, "0x10", "1_0", "true", '"x"', "''", "[]",
    "{}", "[[1, 2], 3]",
    "1979-05-27", "0.1.2", "", '"1 parsec"', '"5 kg"', "2**9", "\N{RIGHT-TO-LEFT OVERRIDE}7", "\x00",
)  # fmt: skip
WORDS = (
    "", "x", "../../etc/passwd", "/dev/zero", "%s%n", "a" * 5000, "{0.__class__}", "\x1b[2J", "\N{SNOWMAN}", '"', "[",
    "]]",
)  # fmt: skip

Spoil = Callable[[bytes, random.Random], bytes]


def _lines(content: bytes) -> list[bytes]:
    return content.splitlines(keepends=True) or [b""]


def cut(content: bytes, dice: random.Random) -> bytes:
    """The rest is missing."""
    return content[: dice.randrange(len(content) + 1)]


def flip(content: bytes, dice: random.Random) -> bytes:
    """Some bits are others."""
    spoilt = bytearray(content or b"\x00")
    for _ in range(dice.choice((1, 1, 2, 8))):
        spoilt[dice.randrange(len(spoilt))] ^= 1 << dice.randrange(8)
    return bytes(spoilt)


def noise(content: bytes, dice: random.Random) -> bytes:
    """Something else was written over a part of it."""
    at = dice.randrange(len(content) + 1)
    return content[:at] + dice.randbytes(dice.choice((1, 16, 300))) + content[at + dice.randrange(40) :]


def _exchanged(
    content: bytes, dice: random.Random, what: str, others: Callable[[list[re.Match[str]]], Sequence[str]]
) -> bytes:  # fmt: skip
    """One place that the pattern ``what`` finds is one of ``others``, of all places found."""
    text = content.decode("utf-8", "surrogateescape")
    found = list(re.finditer(what, text))
    if not found:
        return content
    one = dice.choice(found)
    return (text[: one.start()] + dice.choice(others(found)) + text[one.end() :]).encode("utf-8", "surrogateescape")


def number(content: bytes, dice: random.Random) -> bytes:
    """A number is another one, or none."""
    return _exchanged(content, dice, r"(?<![\w.])[-+]?\d[\d.]*(?:[edED][-+]?\d+)?", lambda _: NUMBERS)


def word(content: bytes, dice: random.Random) -> bytes:
    """A word is another one."""
    return _exchanged(content, dice, r"[A-Za-z_]\w*", lambda found: (*WORDS, dice.choice(found).group()))


def line(content: bytes, dice: random.Random) -> bytes:
    """A line is gone, there twice, or elsewhere."""
    lines = _lines(content)
    taken = lines.pop(dice.randrange(len(lines)))
    for _ in range(dice.choice((0, 1, 2))):
        lines.insert(dice.randrange(len(lines) + 1), taken)
    return b"".join(lines)


def deep(content: bytes, dice: random.Random) -> bytes:
    """Brackets within brackets."""
    at = dice.randrange(len(content) + 1)
    return content[:at] + dice.choice((b"[", b"{a=", b"a.")) * dice.choice((30, 3000)) + content[at:]


def ends(content: bytes, dice: random.Random) -> bytes:
    """Another system's line ends, a byte order mark, another encoding."""
    return dice.choice(
        (content.replace(b"\n", b"\r\n"), content.replace(b"\n", b"\r"), b"\xef\xbb\xbf" + content,
         content.decode("latin-1").encode("utf-16"))
    )  # fmt: skip


SPOILS: tuple[Spoil, ...] = (cut, flip, noise, number, number, number, word, word, line, deep, ends)


def spoiled(content: bytes, seed: int) -> bytes:
    """``content`` spoilt once or a few times; the same for the same seed."""
    dice = random.Random(seed)
    for _ in range(dice.choice((1, 1, 1, 2, 4))):
        content = dice.choice(SPOILS)(content, dice)
    return content


def renumbered(checkpoint: Path, number: object) -> None:
    """A checkpoint says that it is of another format; None: of none."""
    with h5py.File(checkpoint, "r+") as file:
        tree = json.loads(file["tree"][...].tobytes())
        del file["tree"]
        text = json.dumps({"content": tree["content"]} | ({} if number is None else {"format": number}))
        file.create_dataset("tree", data=np.frombuffer(text.encode(), np.uint8), fletcher32=True, chunks=True)
