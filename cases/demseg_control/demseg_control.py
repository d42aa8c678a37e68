"""A segment moved and pushed into a disc: the tutorial's decks of controlled bodies, and the record that it prints."""

from pathlib import Path

from matplotlib.figure import Figure

from porescale.demseg import draw_shapes, trace
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
BODY = "body 2: "


def measure() -> tuple[dict[str, float], Figure]:
    """Where the segment comes to, what the record of the pushed one says at steps 10 and 20, and work."""
    moved, pushed = trace(HERE / "moved"), trace(HERE / "pushed")
    place = pushed.record[BODY + "place x"]
    numbers = {
        "moved: place x at the end": float(moved.record[BODY + "place x"][-1]),
        "moved: angle at the end": float(moved.record[BODY + "angle"][-1]),
        "pushed: place x at step 10": float(place[1]),
        "pushed: place x at step 20": float(place[2]),
        "pushed: work of the force over force times way": float(
            pushed.energy["enxf"][20] / (1e4 * (place[20] - place[0]))
        ),
    }
    figure, axes = stage(3, 12.0, 3.2)
    for k, which in enumerate((0, 60, 120, 200)):
        draw_shapes(axes[0], moved, which, f"C{k}")
    for label, made in (("moved", moved), ("pushed", pushed)):
        axes[1].plot(made.energy["time"], made.record[BODY + "place x"], lw=1, label=label)
        axes[2].plot(made.energy["time"], made.record[BODY + "force x"], lw=0.8, label=label)
    axes[0].set(xlabel="x", ylabel="y", title="moved: at 0, 0.12, 0.24 and 0.4")
    axes[1].set(xlabel="time", ylabel="place x of the segment")
    axes[2].set(xlabel="time", ylabel="force x of contacts on it")
    axes[1].legend(fontsize=7)
    return numbers, figure


if __name__ == "__main__":
    asked = options(__doc__ or "", HERE)
    raise SystemExit(conclude(HERE, *measure(), asked.out))
