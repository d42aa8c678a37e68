"""How a simulation shows itself: fields by name, plots to scale, and what notebooks display."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import replace
from textwrap import shorten
from typing import TYPE_CHECKING

from porescale.common.api.simulation import BaseSimulation
from porescale.common.core.html import data_url

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from porescale.common.api.fields import Field
    from porescale.common.api.report import Report
    from porescale.common.core.types import AnyArray
    from porescale.common.pictures.initial import Initial
    from porescale.common.pictures.look import Look
    from porescale.common.pictures.shown import Picture
    from porescale.common.record.model import Snapshot


class ShownSimulation(BaseSimulation):
    """A simulation whose fields are read and plotted, and that notebooks show."""

    @abstractmethod
    def _sizes(self) -> str:
        """Cells, grains, particles in words."""

    @abstractmethod
    def _report(self) -> Report:
        """The report of `check` on its scene."""

    @abstractmethod
    def _look(self) -> Look:
        """How it is shown."""

    @abstractmethod
    def _fields(self) -> dict[str, Field]:
        """All fields now, by name."""

    @abstractmethod
    def _with_field(self, snapshot: Snapshot, look: Look, name: str, field: Field) -> Look:
        """Put a field into a snapshot, and the look that shows it."""

    @abstractmethod
    def _initial(self, snapshot: Snapshot) -> Initial:
        """What the picture of its scene shows of a snapshot of it."""

    def scene_picture(self) -> Picture:
        """The state now to scale, with everything in the scene labelled and a lens on its resolution.

        It is what `check --picture` and a scene's ``picture`` show of the built initial state.
        """
        from porescale.common.pictures.initial import initial_pixels
        from porescale.common.pictures.shown import Picture

        snapshot = self.snapshot()
        return Picture(initial_pixels(snapshot, self._initial(snapshot)), self.name)

    @property
    def field_names(self) -> list[str]:
        """Names of the fields that there are: of the cells of a fluid, else of the grains or particles."""
        return list(self._fields())

    def field(self, name: str) -> AnyArray:
        """A field now, in SI: (ny, nx) of the cells of a fluid, row 0 lowest; (n,) of particles, or of dry grains, in
        the order of `positions`.  A copy.  InputError, with the nearest name, where there is none of that name.
        """
        return self._named(name).values

    def _named(self, name: str) -> Field:
        from porescale.common.record.columns import missing

        fields = self._fields()
        if name not in fields:
            raise missing("field", name, fields, "this simulation")
        return fields[name]

    def plot(
        self,
        ax: Axes | None = None,
        *,
        field: str | None = None,
        limits: tuple[float, float] | None = None,
        title: str | None = None,
        bar: bool = True,
    ) -> Axes:
        """Draw the state now, to scale, into ``ax`` (None: a new figure of pyplot); returns the axes.

        field : that colours cells, particles or dry grains, of `field_names` (None: what pictures of a run show);
        limits : range of its colours, low and high, SI;  title : above the axes;  bar : a colour bar or legend beside
        them.  InputError where there is no such field, or the limits are no low and high number.
        """
        from porescale.common.pictures.axes import draw, size_of

        snapshot, look = self.snapshot(), self._look()
        unit = ""
        if field is not None:
            found = self._named(field)
            look, unit = self._with_field(snapshot, look, field, found), found.unit
        if limits is not None:
            from porescale.common.pictures.choose import limits_of

            pair = limits_of("limits", limits, unit)
            look = replace(look, limits=pair, cloud_limits=pair)
        if title is not None:
            look = replace(look, title=title)
        if ax is None:
            from matplotlib import pyplot

            _, ax = pyplot.subplots(figsize=size_of(look), layout="constrained")
        return draw(snapshot, look, ax, bar=bar)

    def __repr__(self) -> str:
        time = f"t = {self.time:.6g} s, step {self.step} of {self.step_seconds:.4g} s"
        return f"Simulation {shorten(self.name, 90, placeholder=' …')!r}\n{time}\n{self._sizes()}"

    def _repr_png_(self) -> bytes:
        from porescale.common.evidence.files import new_figure, png
        from porescale.common.pictures.axes import size_of

        figure = new_figure(*size_of(self._look()))
        self.plot(figure.add_subplot())
        return png(figure, round(figure.dpi))

    def _repr_html_(self) -> str:
        from html import escape

        picture = data_url("image/png", self._repr_png_())
        lines = "<br>".join(escape(line) for line in repr(self).splitlines())
        table = self._report()._repr_html_()
        return f"<p>{lines}</p><img src='{picture}'>{table}"
