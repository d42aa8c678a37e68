"""What a scene measures on its grains: rows of regions.csv and forces.csv, contacts and coarse-grained fields.

Nothing is computed unless the scene requests it.  Everything is taken from the list of contacts that the next
contact step would use, and changes nothing.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from porescale.builders.initial.frames import Placed, disc_count, free_rows
from porescale.builders.initial.walls import WallPlaces, middles
from porescale.builders.parts.flow_fields import ratio_column
from porescale.builders.parts.frame_measures import solid_areas, solid_in
from porescale.builders.stepper import Row
from porescale.builders.system import System
from porescale.common.core.types import AnyArray
from porescale.common.record.model import Cloud, Grid, Snapshot
from porescale.common.record.part import Part
from porescale.common.schema.names import names_of
from porescale.dem.bodies.rigid import areas, as_bodies, body_of
from porescale.dem.discs import Discs
from porescale.dem.forces.rectangle import BOTTOM, RIGHT, TOP
from porescale.dem.forces.rectangle import LEFT as LEFT_FACE
from porescale.dem.forces.walls import HIGH, LOW, SIDES, X
from porescale.dem.grains import Grains
from porescale.dem.measures.coarse_graining import CoarseGrained, Raster
from porescale.dem.measures.contact_list import Contacts
from porescale.dem.measures.contacts import contacts
from porescale.dem.measures.fabric import LEAST_WITH_FRICTION, LEAST_WITHOUT, contact_numbers, loads, rattlers
from porescale.dem.measures.fabric import coordination as coordination_of
from porescale.dem.measures.fabric import fabric as fabric_of
from porescale.dem.measures.loads import on_discs, on_surface
from porescale.dem.measures.motion import Motion, motion
from porescale.dem.measures.porosity import disc_shares, void_ratio
from porescale.dem.measures.region import Region
from porescale.dem.measures.stress import contact_stress, kinetic_stress, principal
from porescale.dem.motion.periodic_cell import Straining
from porescale.scene.measures.coarse_graining import CoarseGraining

KERNEL_WIDTH = 2.5
"""Width of the kernel in mean diameters where a scene gives none: some twenty grains are felt at a point."""
WIDEST = 1.5
"""The least of it in diameters of the largest grain: alone it then fills 5/9 of its middle, and never more than all."""
ROUNDED = 1e-9
"""Of a side of the box: places as close as this are the same but for round-off."""
FIELDS, CONTACTS = "grain_fields", "contacts"
"""Names of the grid and of the cloud in snapshots."""


class GrainInstruments(Part):
    """The regions, the wall forces, the contacts and the coarse graining of a scene."""

    def __init__(self, system: System) -> None:
        assert system.grains
        scene, grains, placed = system.scene, system.grains, system.frames
        self.clock, self.grains, self.placed = system.clock, grains, placed
        self.walls = WallPlaces(scene.domain, scene.wall) if scene.output.forces else None
        self.contacts, self.coarse_graining = scene.output.contacts, scene.coarse_graining
        named = zip(names_of(scene.region, "region"), scene.region, strict=True)
        self.regions = [(name, Region(it.lower, it.upper)) for name, it in named]
        self.held = ~np.isin(np.arange(grains.discs.count), free_rows(grains, placed, system.held))
        self.held_discs = range(disc_count(grains) - system.held, disc_count(grains))
        friction = max(law.friction for law in grains.laws)
        self.least = LEAST_WITH_FRICTION if friction > 0.0 else LEAST_WITHOUT
        self.first = ratio_column(scene.grains)

    def tables(self) -> dict[str, Row]:
        """A row of regions.csv and of forces.csv, where the scene requests them."""
        tables: dict[str, Row] = {}
        if not (self.regions or self.walls):
            return tables
        found, first = contacts(self.grains), {"time (s)": self.clock.time} | self.first
        if self.regions:
            loose = self.rattling(found)
            tables["regions"] = dict(first)
            for name, region in self.regions:
                row = region_row(self.grains, found, region, loose, self.held, self.placed)
                tables["regions"] |= {f"{name} {column}": value for column, value in row.items()}
        if self.walls:
            tables["forces"] = first | self._forces(found, self.walls)
        return tables

    def rattling(self, found: Contacts) -> NDArray[np.bool_]:
        """Which discs carry nothing, (n,): all of a clump or none."""
        number = body_of(self.grains)
        loose: NDArray[np.bool_] = rattlers(found.of_bodies(number), len(number), self.least, self.held)[number]
        return loose

    def _forces(self, found: Contacts, walls: WallPlaces) -> Row:
        """Force of the grains on every wall, plate and rectangle with its moment about the middle of it (a free wall:
        about its point), where walls are that move, and of all contacts on every held disc, about its centre.

        NAME force x (N/m) : of the grains on the wall, plate or rectangle
        NAME force y (N/m) : of the grains on it
        NAME moment (N m/m) : of the grains about its middle, of a free wall about its point
        disc K force x (N/m) : of all contacts on the held disc
        disc K force y (N/m) : of all contacts on it
        disc K moment (N m/m) : of all contacts about its centre
        """
        grains = self.grains
        row: Row = {}
        box = Region(grains.box.lower, grains.box.upper)
        within = replace(found, point=box.near(found.point, grains.period))  # a side is a period long, a wall endless
        points = middles(grains)
        points += [(float(it[X]), 0.5 * float(it[LOW] + it[HIGH])) for it in grains.plates]
        points += [
            (0.5 * float(it[LEFT_FACE] + it[RIGHT]), 0.5 * float(it[BOTTOM] + it[TOP])) for it in grains.rectangles
        ]
        for name, middle in zip(found.names, points, strict=True):
            shown = f"{name} wall" if name in SIDES else name
            fx, fy, moment = on_surface(within if name in SIDES else found, name, middle)
            row |= {f"{shown} force x (N/m)": fx, f"{shown} force y (N/m)": fy, f"{shown} moment (N m/m)": moment}
        row |= walls.row(grains)
        for k, (fx, fy, moment) in enumerate(on_discs(found, grains.discs, list(self.held_discs))):
            row |= {f"disc {k} force x (N/m)": float(fx), f"disc {k} force y (N/m)": float(fy),
                    f"disc {k} moment (N m/m)": float(moment)}  # fmt: skip
        return row

    def show(self, snapshot: Snapshot) -> None:
        """Contacts, quantities of each grain from them, and fields, where the scene requests them."""
        if not (self.contacts or self.coarse_graining):
            return
        found = contacts(self.grains)
        if self.contacts:
            snapshot.clouds[CONTACTS] = contact_cloud(found, self.grains)
            split, number = disc_count(self.grains), body_of(self.grains)
            touching = contact_numbers(found.of_bodies(number), len(number))[number]
            loose = self.rattling(found)
            for name, rows in (("grains", slice(split)), ("frames", slice(split, None))):
                if name in snapshot.clouds:
                    snapshot.clouds[name].data["contact_number"] = touching[rows].astype(np.int32)
                    snapshot.clouds[name].data["rattler"] = loose[rows]
        if self.coarse_graining:
            snapshot.grids[FIELDS] = self._fields(found, self.coarse_graining)

    def _fields(self, found: Contacts, section: CoarseGraining) -> Grid:
        """The coarse-grained fields of a snapshot."""
        grains = self.grains
        radius = grains.discs.radius
        least = max(KERNEL_WIDTH * float(radius.mean()), WIDEST * float(radius.max()))
        width = section.width or max(2.0 * least, section.spacing)
        cell = grains.cell if isinstance(grains.cell, Straining) else None
        periodic = grains.box.periodic if cell is None else (False, False)
        raster = Raster.over(grains.box.lower, grains.box.upper, section.spacing, width, periodic)
        discs = _without_mass(grains.discs, self.held)
        area = solid_areas(grains, self.placed)
        fields = CoarseGrained(raster, discs, found, conserve=cell is None, cell=cell, area=area)
        cells: dict[str, AnyArray] = {}
        units: dict[str, str] = {}
        for name in section.fields:
            value = getattr(fields, "contact_stress" if name == "stress" else name)
            if value.ndim == 2:
                cells[name] = value.astype(np.float32)
            elif value.ndim == 3:
                cells[name] = np.zeros((*value.shape[:2], 3), np.float32)
                cells[name][..., :2] = value
            else:
                cells |= _components(name, value)
            units |= {key: UNITS[name] for key in cells if key not in units}
        return Grid(raster.lower, raster.spacing, cells, units)


UNITS = {"density": "kg/m^3", "solid_fraction": "", "velocity": "m/s", "strain_rate": "1/s", "stress": "Pa",
         "kinetic_stress": "Pa"}  # fmt: skip
"""Units of the fields."""


def _components(name: str, value: AnyArray) -> dict[str, AnyArray]:
    """A tensor (rows, columns, 2, 2) by component, and its two invariants: mean and largest shear."""
    parts = {f"{name}_{a}{b}": value[..., i, j] for i, a in enumerate("xy") for j, b in enumerate("xy")}
    if name == "strain_rate":
        del parts[f"{name}_yx"]  # symmetric by definition
    half, mixed = 0.5 * (value[..., 0, 0] - value[..., 1, 1]), 0.5 * (value[..., 0, 1] + value[..., 1, 0])
    parts[f"{name}_mean"] = 0.5 * (value[..., 0, 0] + value[..., 1, 1])
    parts[f"{name}_shear"] = np.hypot(half, mixed)
    return {key: part.astype(np.float32) for key, part in parts.items()}


def contact_cloud(found: Contacts, grains: Grains) -> Cloud:
    """Contacts as points with their bodies, geometry and forces: a table, and lines along ``branch`` as glyphs.

    second is -1 at a surface, whose number is then in ``surface`` (order: walls, plates, rectangles).
    """
    names = "normal_force", "tangential_force", "overlap", "spring"
    data: dict[str, AnyArray] = {
        "first": found.first.astype(np.int32), "second": found.second.astype(np.int32),
        "surface": found.surface.astype(np.int32), "sliding": found.sliding,
        **{name: getattr(found, name) for name in names},
    }  # fmt: skip
    for name in ("normal", "branch", "force"):
        data[name] = np.zeros((found.count, 3))
        data[name][:, :2] = getattr(found, name)
    units = dict(zip((*names, "branch", "force"), ("N/m", "N/m", "m", "m", "m", "N/m"), strict=True))
    point = Region(grains.box.lower, grains.box.upper).near(found.point, grains.period)
    return Cloud(point, data, units)


def _without_mass(discs: Discs, held: AnyArray) -> Discs:
    """The discs with no mass where they are held: what is held is solid, and has no mass of its own."""
    return replace(discs, mass=np.where(held, 0.0, discs.mass))


def _moving(grains: Grains, region: Region, weight: AnyArray) -> Motion:
    """The affine motion of the discs of a region, (n,) weights, in a strained cell too."""
    at, velocity = region.about(grains.discs.position, grains.period), grains.discs.velocity
    if isinstance(grains.cell, Straining):
        velocity = velocity + at @ grains.steering.gradient().T
    return motion(at, velocity, weight)


def with_sides(region: Region, grains: Grains) -> Region:
    """The region, a ROUNDED of the box larger where it ends at a side that is not periodic, so that it holds the points
    of contacts with walls there: its own upper and right edges hold none, and points lie on sides to round-off."""
    box, ends = grains.box, (list(region.lower), list(region.upper))
    for axis in range(2):
        near = ROUNDED * (box.upper[axis] - box.lower[axis])
        for edges, side, out in ((ends[0], box.lower, -near), (ends[1], box.upper, near)):
            if not box.periodic[axis] and abs(edges[axis] - side[axis]) < near:
                edges[axis] = side[axis] + out
    (left, bottom), (right, top) = ends
    return Region((left, bottom), (right, top))


def region_row(
    grains: Grains, found: Contacts, region: Region, loose: AnyArray, held: AnyArray, placed: Sequence[Placed] = ()
) -> Row:
    """The quantities of a region, by column with unit.

    A region stays where it is, also in a strained cell, whose images are measured wherever they reach into it.
    Porosity and velocities weigh discs by their area and mass inside, members of clumps by their share of it; polygons
    (``placed``) take their exact area, and move with their corners; held ones, and those that are controlled in all
    components, have no mass; coordination and rattlers are of discs and clumps whose centre is inside, without these;
    fabric and forces of contacts whose point is inside, or on a side of the box at which the region ends.

    porosity () : share of the region that is no grain
    void ratio () : pores over grains
    stress xx (Pa) : of contacts, by branch and force over the region's area; compression > 0
    stress yy (Pa) : the same, upright
    stress xy (Pa) : the same; the first index is that of the force
    stress yx (Pa) : the same
    mean stress (Pa) : half of the sum of the principal stresses
    deviator stress (Pa) : half of their difference
    major stress direction (rad) : of the largest compression, from the x axis
    kinetic stress xx (Pa) : of the grains' velocities about their mean
    kinetic stress yy (Pa) : the same, upright
    kinetic stress xy (Pa) : the same
    coordination number () : mean, of discs and clumps whose centre is inside
    share of rattlers () : share of the grains that carry nothing
    contacts () : number whose point is inside
    fabric anisotropy () : a of the density of directions of contacts (1 + a cos 2(theta - direction))/(2 pi)
    fabric direction (rad) : to which most contacts point, from the x axis
    mean normal force (N/m) : of the contacts inside; what bonds take off is not in it
    largest over mean normal force () : likewise
    share of sliding contacts () : share of the contacts inside whose friction is at its limit
    velocity x (m/s) : mean of the grains, by mass
    velocity y (m/s) : the same, up
    strain rate xx (1/s) : of the best affine motion; extension > 0
    strain rate yy (1/s) : the same, upright
    strain rate xy (1/s) : the same, half of the rate of shear
    rotation (rad/s) : of the best affine motion, anticlockwise
    """
    d, period = grains.discs, grains.period
    bodies, number = _without_mass(as_bodies(grains), held), body_of(grains)
    others = held | (number != np.arange(d.count))
    discs = disc_count(grains)
    share = disc_shares(region, d.position, d.radius, period)
    solid = float(share[:discs] @ areas(grains)[:discs]) + solid_in(grains, placed, region)
    pores = 1.0 - solid / region.area
    stress, kinetic = contact_stress(region, found, period), kinetic_stress(region, bodies, period)
    mean, deviator, angle = principal(stress)
    inside = region.holds(bodies.position, period) & ~others
    reaching = with_sides(region, grains)
    here = found.chosen(reaching.holds(found.point, period) & loads(found))
    fabric, force = fabric_of(found, reaching, period), here.normal_force
    moving = _moving(grains, region, bodies.mass * share)
    neighbours = coordination_of(found.of_bodies(number), region, bodies.position, period, loose, others)
    nan = float("nan")
    return {
        "porosity ()": pores,
        "void ratio ()": void_ratio(pores),
        "stress xx (Pa)": float(stress[0, 0]), "stress yy (Pa)": float(stress[1, 1]),
        "stress xy (Pa)": float(stress[0, 1]), "stress yx (Pa)": float(stress[1, 0]),
        "mean stress (Pa)": mean, "deviator stress (Pa)": deviator, "major stress direction (rad)": angle,
        "kinetic stress xx (Pa)": float(kinetic[0, 0]), "kinetic stress yy (Pa)": float(kinetic[1, 1]),
        "kinetic stress xy (Pa)": float(kinetic[0, 1]),
        "coordination number ()": neighbours,
        "share of rattlers ()": float(loose[inside].mean()) if inside.any() else nan,
        "contacts ()": float(fabric.contacts),
        "fabric anisotropy ()": fabric.anisotropy, "fabric direction (rad)": fabric.angle,
        "mean normal force (N/m)": float(force.mean()) if here.count else nan,
        "largest over mean normal force ()": float(force.max() / force.mean()) if here.count else nan,
        "share of sliding contacts ()": float(here.sliding.mean()) if here.count else nan,
        "velocity x (m/s)": float(moving.velocity[0]), "velocity y (m/s)": float(moving.velocity[1]),
        "strain rate xx (1/s)": float(moving.strain_rate[0, 0]),
        "strain rate yy (1/s)": float(moving.strain_rate[1, 1]),
        "strain rate xy (1/s)": float(moving.strain_rate[0, 1]),
        "rotation (rad/s)": moving.rotation,
    }  # fmt: skip
