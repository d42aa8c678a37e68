"""The picture of `porescale homogenise`: what is written on it can be read."""

import numpy as np

from porescale.analysis.material import Known
from porescale.cli import homogenise_picture
from porescale.cli.homogenise_picture import BARS, picture
from porescale.cli.homogenise_rates import Rates


def test_labels_of_the_picture_lie_within_it(monkeypatch):
    figures = []
    monkeypatch.setattr(homogenise_picture, "png", lambda figure, _: figures.append(figure) or b"")
    strain = np.linspace(0.0, 0.1, 50)
    test = {"strain": strain, "sine": np.full(50, 0.5), "volume": -strain}
    found = {name: Known((0.2317, 0.3519), "rad" if "angle" in name else "m2") for name in BARS}
    picture([test], found, Rates())
    (figure,) = figures

    def inside():
        figure.draw_without_rendering()
        boxes = [axis.label.get_window_extent() for axes in figure.axes for axis in (axes.xaxis, axes.yaxis)]
        return all(it.x0 >= 0.0 and it.x1 <= figure.bbox.x1 and 0.0 <= it.y0 <= it.y1 <= figure.bbox.y1 for it in boxes)

    assert inside()
    label = figure.axes[2].xaxis.label
    label.set_text(label.get_text().replace("\n", " "))  # the twin: in one line its end is cut off
    assert not inside()
