"""Decks of the DEMseg tutorial as text, for tests: short runs of what it prints."""

from pathlib import Path

MATERIAL = "2.5d0 1.0d8 0.25d8 0.0d0 0.0d0 0.0d0"
DOMAIN = "-10.0d0 10.0d0 0.0d0 10.0d0 0.0d0"


def grains(*rows: str, dt: str = "5.0d-5", material: str = MATERIAL, domain: str = DOMAIN) -> str:
    """in_gm.dat of mode 1: the numbers of bodies, then the bodies."""
    return "\n".join(["1 0 0", f"{dt} 0.0 -980.0d0", "1", material, domain, *rows]) + "\n"


DISC = grains("1 0 0", "1 1 1", "0.0d0 0.0d0 0.0d0", "1 2.0d0", "0.0d0 5.0d0 0.0d0")
CLUMP = grains("1 0 0", "1 1 2", "0 0 0", "1 2.0d0", "0.0d0 5.0d0 0.0d0", "2 1.0d0", "2.0d0 6.0d0 0.0d0")
SEGMENT = grains("0 1 0", "1 1 1", "0 0 0", "1 -2.0d0 2.0d0", "2.0d0 4.0d0", dt="2.0d-5")
TRIANGLE = grains(
    "0 1 0", "1 1 3", "0 0 0", "1 -2 2", "2 4", "2 2 4", "1 7", "3 1 7", "-2 2", dt="2.0d-5"
)  # fmt: skip
PUSHED = grains(
    "1 1 0", "1 1 1", "0 0 0", "1 2.0d0", "0 5 0", "2 1 1", "0 0 0", "1 -3.0d0 1.0d0", "-3.0d0 6.0d0", dt="2.0d-5"
)  # fmt: skip
PUSH = ("1", "2", "1", "2 0 1.0d4 1 0.0d0 1 0.0d0")


def boundary(head: str = "0 0 400 100 10", *rows: str) -> str:
    """in_bc.dat: the head, then the rest (default: nothing recorded or controlled)."""
    return "\n".join([head, *(rows or ("0", "0"))]) + "\n"


def write(folder: Path, gm: str = DISC, bc: str = "", **more: str) -> Path:
    """The folder of a deck; ``more``: in_cf0="…" and the like."""
    folder.mkdir(parents=True, exist_ok=True)
    files = {"in_gm": gm, "in_bc": bc or boundary(), **more}
    for name, text in files.items():
        (folder / f"{name}.dat").write_text(text, encoding="utf-8")
    return folder


def chain(count: int = 20) -> str:
    """in_gm.dat of the chain of I-4 and II-3: discs 2 apart of radius 1.1 in a wide domain, without weight."""
    rows = [f"{count} 0 0"]
    for k in range(count):
        rows += [f"{k + 1} 1 1", "0 0 0", "1 1.1d0", f"{2 * k + 10}. 50 0"]
    text = grains(*rows, dt="1d-5", domain="0 100 0 100 0")
    return text.replace("-980.0d0", "0.0d0")
