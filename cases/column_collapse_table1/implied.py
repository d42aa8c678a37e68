"""Table 1's four numbers of the fluid, each beside what the other three imply, as `porescale check` refuses them."""

import re
from pathlib import Path

from matplotlib.figure import Figure

from porescale import InputError, load
from porescale.output import draw, options, stage

HERE = Path(__file__).resolve().parent
IMPLIED = re.compile(r"imply ([0-9.e+-]+)")


def refused() -> list[tuple[str, float, float, str]]:
    """Key, printed and implied value, and unit, of each number that does not go with the others."""
    try:
        load(HERE)
    except InputError as error:
        found = [(fault, IMPLIED.search(fault.problem)) for fault in error.faults]
        return [
            (it.key.rpartition(".")[2], float(str(it.value)), float(said[1]), it.unit) for it, said in found if said
        ]
    return []


def figure_of(rows: list[tuple[str, float, float, str]]) -> Figure:
    """What is implied over what is printed, a line each."""
    figure, (axes,) = stage(1, 8.0, 2.6)
    for at, (_, printed, implied, unit) in enumerate(rows):
        axes.plot([1.0, implied / printed], [at, at], color="0.7", zorder=0)
        axes.plot(1.0, at, "o", color="C0", label="printed" if at == 0 else None)
        axes.plot(implied / printed, at, "s", color="C3", label="implied by the other three" if at == 0 else None)
        axes.annotate(f"{implied:.3g}{' ' * bool(unit)}{unit}, printed {printed:g}", (implied / printed, at), (0, 7),
                      textcoords="offset points", ha="center", fontsize=8)  # fmt: skip
    axes.set_yticks(range(len(rows)), [key.replace("_", " ") for key, *_ in rows])
    axes.set(xscale="log", xlim=(0.04, 12.0), ylim=(-0.5, len(rows) - 0.3), xlabel="over the printed value")
    axes.legend(loc="lower left", fontsize=8)
    return figure


if __name__ == "__main__":
    asked = options(__doc__ or "", HERE)
    asked.out.mkdir(parents=True, exist_ok=True)
    draw(figure_of(refused()), asked.out / "picture.png")
    print(f"picture: {asked.out / 'picture.png'}")
