"""Measuring a finished run: what [[probe]], [[flux]], [[line]] and [[region]] say, from its snapshots.

The instruments of a simulation read the state of a snapshot in place of its own: numbers and columns are those of the
run, but for the single precision in which fields are stored.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from porescale.builders.derive import Derived, derive
from porescale.builders.initial.grains import UNTOUCHED, box_of
from porescale.builders.parts.flow_fields import total_pressure
from porescale.builders.parts.flow_instruments import FlowInstruments
from porescale.builders.parts.grain_instruments import CONTACTS, GrainInstruments, region_row
from porescale.builders.stepper import Clock, Fields
from porescale.common.core.errors import Fault, InputError, warn
from porescale.common.record.model import Cloud, Snapshot
from porescale.common.record.open_run import Run
from porescale.common.schema.sections import scene_as_dict
from porescale.dem.discs import Discs, make_discs
from porescale.dem.grains import Grains
from porescale.dem.measures.contact_list import NOBODY, Contacts
from porescale.lbm.scales import Scales
from porescale.output.lines import profiles
from porescale.scene.scene import Scene

WITHOUT_CONTACTS = ("porosity", "void ratio", "kinetic stress", "velocity", "strain rate", "rotation")
"""Quantities of a region that need no contacts, by the beginning of their columns."""
BODIES = ("clump", "segment", "polygon", "container", "rock", "material", "cell")
"""Sections with which snapshots alone do not say what a region holds: which discs are one body, or how heavy."""
Table = dict[str, list[Any]]


def measure_run(run: Run, scene: Scene) -> dict[str, Table]:
    """Tables by name ("probes", "flux", "lines", "regions"), each columns by name, with rows for every snapshot.

    scene : that of the run, with the sections to measure in place of its own.  InputError where snapshots do not hold
    what is needed; PorescaleWarning where columns are left out for that reason.
    """
    rows: dict[str, list[dict[str, float]]] = {}
    if scene.region:
        _require_discs_alone(scene)
    derived = derive(scene)
    flow = _Flow(scene, derived) if scene.probe or scene.flux else None
    left_out = set()
    if flow and scene.flux and (scene.grains or scene.disc or scene.rectangle):
        left_out.add("flux of solid, which snapshots do not hold")
    for snapshot in run.snapshots():
        found: dict[str, dict[str, float]] = flow.tables(snapshot) if flow else {}
        if scene.region:
            found["regions"] = {"time (s)": snapshot.time} | _regions(scene, derived, snapshot)
            if CONTACTS not in snapshot.clouds:
                left_out.add("what regions read of contacts, recorded with output.contacts = true")
        for name, row in found.items():
            rows.setdefault(name, []).append(row)
    for what in sorted(left_out):
        warn(f"not measured: {what}")
    tables = {name: {key: [row[key] for row in each] for key in each[0]} for name, each in rows.items()}
    if scene.line:
        tables["lines"] = profiles(run, scene_as_dict(scene)["line"])
    return tables


@dataclass
class _Recorded:
    """The fluid of a snapshot.  scales : of the run's lattice;  gravity : m/s^2;  snapshot : at which it is read."""

    scales: Scales
    gravity: tuple[float, float]
    snapshot: Snapshot | None = None

    def fields(self) -> Fields:
        """Density excess (kg/m^3), velocity (m/s) and solid fraction, as of a simulation, each (ny, nx)."""
        assert self.snapshot
        cells = self.snapshot.grids["fields"].cells
        pressure, velocity = cells["pressure"].astype(float), cells["velocity"].astype(float)
        still = total_pressure(self.gravity, self.scales, np.zeros_like(pressure))
        excess = (pressure - still) / self.scales.pressure * self.scales.density
        solid = cells.get("solid_fraction", np.zeros_like(pressure)).astype(float)
        return excess, velocity[..., 0], velocity[..., 1], solid


class _Flow:
    """The instruments of the fluid, over recorded fields."""

    def __init__(self, scene: Scene, derived: Derived) -> None:
        assert derived.scales
        self.clock, self.fluid = Clock(derived.model_step), _Recorded(derived.scales, scene.gravity)
        self.scene, self.derived, self.coupled, self.held = scene, derived, None, 0
        stand_in: Any = self
        self.instruments = FlowInstruments(stand_in)

    def part(self, kind: type) -> _Recorded:
        """The fluid, for the instruments."""
        return self.fluid

    def tables(self, snapshot: Snapshot) -> dict[str, dict[str, float]]:
        """A row of each table."""
        self.fluid.snapshot, self.clock.time = snapshot, snapshot.time
        return self.instruments.tables()


def _require_discs_alone(scene: Scene) -> None:
    """InputError where regions need more than the discs of snapshots."""
    given = [name for name in BODIES if getattr(scene, name)]
    if given:
        problem = f"cannot be measured afterwards in a run with [{given[0]}]"
        raise InputError(Fault("region", None, problem, repair="put [[region]] into the scene, and run it"))


def _regions(scene: Scene, derived: Derived, snapshot: Snapshot) -> dict[str, float]:
    """A row of regions.csv without its time."""
    law = derived.law or UNTOUCHED
    discs = _discs(scene, snapshot.clouds["grains"])
    grains = Grains(discs, law, box_of(scene.domain), wall_law=derived.wall_law)
    for it in scene.control:
        grains.hold(it.of[1], *(axis.prescribes for axis in (it.x, it.y, it.rotation)))
    stand_in: Any = _Grains(scene, grains)
    instruments, cloud = GrainInstruments(stand_in), snapshot.clouds.get(CONTACTS)
    found = _contacts(discs, cloud)
    loose = instruments.rattling(found)
    row = dict(instruments.first)
    for name, region in instruments.regions:
        own = region_row(instruments.grains, found, region, loose, instruments.held)
        if cloud is None:
            own = {key: value for key, value in own.items() if key.startswith(WITHOUT_CONTACTS)}
        row |= {f"{name} {key}": value for key, value in own.items()}
    return row


class _Grains:
    """What the instruments of grains read of a system."""

    def __init__(self, scene: Scene, grains: Grains) -> None:
        self.scene, self.grains, self.clock, self.held = scene, grains, Clock(1.0), len(scene.disc)
        self.frames: list[Any] = []


def _discs(scene: Scene, cloud: Cloud) -> Discs:
    """The discs of a snapshot, those that are held last, with the masses they had."""
    count = len(cloud.position)
    density = np.full(count, scene.grains.density if scene.grains else 1.0)
    density[count - len(scene.disc) :] = scene.fluid.density if scene.fluid else 1000.0
    return make_discs(cloud.position, cloud.data["radius"], density, cloud.data["velocity"][:, :2], cloud.data["spin"])


def _contacts(discs: Discs, cloud: Cloud | None) -> Contacts:
    """The contacts of a snapshot; none where they were not recorded.  Torques, which no region reads, are zero."""
    none = np.zeros(0)
    data: dict[str, Any] = cloud.data if cloud else {}
    first = np.asarray(data.get("first", none), np.int64)
    whole = {name: np.asarray(data.get(name, none), float)
             for name in ("overlap", "normal_force", "tangential_force", "spring")}  # fmt: skip
    flat = {name: np.asarray(data.get(name, np.zeros((0, 3))))[:, :2] for name in ("normal", "branch", "force")}
    return Contacts(
        first=first,
        second=np.asarray(data.get("second", none), np.int64),
        surface=np.asarray(data.get("surface", np.full(0, NOBODY)), np.int64),
        names=(),
        point=cloud.position if cloud else np.zeros((0, 2)),
        start=discs.position[first],
        torque=np.zeros((len(first), 2)),
        sliding=np.asarray(data.get("sliding", none), bool),
        **whole,
        **flat,
    )
