"""The scene: its sections.  SI numbers or texts with units; an absent section builds nothing."""

from collections.abc import Mapping
from typing import Any, ClassVar

import pydantic

from porescale.common.core.constants import GRAVITY
from porescale.common.schema.look import LookSection
from porescale.common.schema.scene import SceneBase
from porescale.common.schema.sections import Refused, quantity
from porescale.lbm.scales import NAMES
from porescale.scene.bodies.bonds import Bonds
from porescale.scene.bodies.clump import Clump
from porescale.scene.bodies.control import Controlled
from porescale.scene.bodies.disc import Disc
from porescale.scene.bodies.gate import Gate
from porescale.scene.bodies.rectangle import Rectangle
from porescale.scene.bodies.ring import Ring
from porescale.scene.bodies.rock import Rock
from porescale.scene.bodies.segments import Container, PolygonBody, SegmentBody
from porescale.scene.bodies.wall import Wall
from porescale.scene.cell import Cell
from porescale.scene.contact import Contact, Material
from porescale.scene.domain import Domain
from porescale.scene.fluid import Fluid
from porescale.scene.grains import Grains
from porescale.scene.lattice import disagreements
from porescale.scene.lubrication import Lubrication
from porescale.scene.measures.coarse_graining import CoarseGraining
from porescale.scene.measures.homogenise import Homogenise
from porescale.scene.measures.line import Flux, Line
from porescale.scene.measures.loads import Loads
from porescale.scene.measures.permeability import Permeability
from porescale.scene.measures.probe import Probe
from porescale.scene.measures.region import Region
from porescale.scene.output import Output
from porescale.scene.run import Run
from porescale.scene.sleep import Sleep
from porescale.scene.time import Time

QUICK = 500_000
"""Cells of a lattice that are built within a second."""
FEW = 400
"""Squares of a diameter in a packing that settles within seconds."""


class Scene(SceneBase):
    """A scene: box, time, output, and the parts it needs."""

    elsewhere: ClassVar[Mapping[str, str]] = {"tank": "continuum-sph"}

    title: str = pydantic.Field("", description="title, of pictures and reports")
    gravity: tuple[float, float] = quantity("m/s^2", (0.0, -GRAVITY), ge=-1e6, le=1e6, help="acceleration of free fall")
    domain: Domain
    time: Time
    output: Output
    fluid: Fluid | None = None
    grains: Grains | None = None
    contact: Contact | None = None
    material: tuple[Material, ...] = ()
    clump: tuple[Clump, ...] = ()
    segment: tuple[SegmentBody, ...] = ()
    polygon: tuple[PolygonBody, ...] = ()
    container: tuple[Container, ...] = ()
    bonds: tuple[Bonds, ...] = ()
    rock: Rock | None = None
    control: tuple[Controlled, ...] = ()
    wall: tuple[Wall, ...] = ()
    cell: Cell | None = None
    gate: Gate | None = None
    disc: tuple[Disc, ...] = ()
    rectangle: tuple[Rectangle, ...] = ()
    ring: Ring | None = None
    probe: tuple[Probe, ...] = ()
    line: tuple[Line, ...] = ()
    flux: tuple[Flux, ...] = ()
    loads: Loads | None = None
    permeability: Permeability | None = None
    region: tuple[Region, ...] = ()
    coarse_graining: CoarseGraining | None = None
    homogenise: Homogenise | None = None
    lubrication: Lubrication | None = None
    sleep: Sleep | None = None
    run: Run | None = None
    look: LookSection | None = None

    @classmethod
    def _schema(cls, schema: dict[str, Any]) -> dict[str, Any]:
        bonds = schema["properties"]["bonds"]
        schema["properties"]["bonds"] = {"anyOf": [bonds["items"], {"type": "array", "items": bonds["items"]}]}
        return schema

    @pydantic.field_validator("bonds", mode="before")
    @classmethod
    def _one_or_more(cls, given: Any) -> Any:
        """[bonds] is the same as one [[bonds]]."""
        return [given] if isinstance(given, Mapping) else given

    @property
    def drawn_at_once(self) -> bool:
        """Whether next to nothing must be settled or pressed before it is drawn, and the lattice is no large one."""
        packing, spacing = self.grains.packing if self.grains else None, self.fluid.spacing if self.fluid else None
        large = spacing is not None and self.domain.width * self.domain.height > QUICK * spacing**2
        many = packing is not None and packing.width * packing.height > FEW * packing.diameter**2
        return not many and self.rock is None and not large

    @pydantic.model_validator(mode="before")
    @classmethod
    def _checked(cls, table: Any) -> Any:
        """No scene without the checks between its sections."""
        if not cls.checks:
            raise RuntimeError("checks between sections are registered by porescale.builders.scene: import it")
        return table

    @pydantic.field_validator("fluid")
    @classmethod
    def _agreed(cls, fluid: Fluid | None, info: pydantic.ValidationInfo) -> Fluid | None:
        """Four numbers of a lattice must agree; checked here, since their repair depends on the box."""
        if fluid is None or any(getattr(fluid, name) is None for name in NAMES):
            return fluid
        domain = info.data.get("domain")  # absent where it is itself at fault
        width, height = (domain.width, domain.height) if domain else (0.0, 0.0)
        faults = disagreements({name: getattr(fluid, name) for name in NAMES}, width, height)
        if faults:
            raise Refused(*faults)
        return fluid
