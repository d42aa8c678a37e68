"""Several materials in one system: which law holds between which.

Each material has its law with itself.  Between two of them, in the absence of a law of their own:
    stiffness (moduli, for Hertz)  in series, 2 k1 k2/(k1 + k2): each body gives as much as in contact with its like;
    damping                        the mean damping ratio (mean of c/sqrt(k), at any mass): for little damping the
                                   restitution is the geometric mean;
    friction, rolling friction     the smaller one.
Like materials get their own law to the bit.  The rule is the same between discs and for walls, plates and rectangles,
which are made of a material, too.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.dem.contact.law import ContactLaw

MOST = 255  # materials: discs name theirs in a byte


@dataclass(frozen=True)
class Materials:
    """Laws by the name of the material, in the order of their numbers.

    between : laws of pairs of names (in either order) that override the rule;  walls : name of the material of walls,
    plates and rectangles (default: the first).  Raises InputError on unknown names and on laws that do not mix.
    """

    laws: Mapping[str, ContactLaw]
    between: Mapping[tuple[str, str], ContactLaw] = field(default_factory=dict)
    walls: str | None = None

    def __post_init__(self) -> None:
        if not 1 <= len(self.laws) <= MOST:
            raise InputError(Fault("materials", len(self.laws), "number of materials", allowed=f"1 to {MOST}"))
        for name in {name for pair in self.between for name in pair} | ({self.walls} - {None}):
            if name not in self.laws:
                raise InputError(Fault("material", name, "no such material", allowed=", ".join(self.laws)))
        kinds = {type(law) for law in (*self.laws.values(), *self.between.values())}
        if len(kinds) > 1:
            raise InputError(Fault("materials", "linear and hertz", "all laws of a system must be of one kind"))
        for one in self.laws:
            for other in self.laws:
                self.law(one, other)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the materials, in the order of their numbers."""
        return tuple(self.laws)

    @property
    def wall(self) -> str:
        """Name of the material of the walls."""
        return self.names[0] if self.walls is None else self.walls

    def law(self, one: str, other: str) -> ContactLaw:
        """The law between two materials."""
        for pair in ((one, other), (other, one)):
            if pair in self.between:
                return self.between[pair]
        if one == other:
            return self.laws[one]
        first, second = self.laws[one], self.laws[other]
        return first.mixed(second)

    def all(self) -> list[ContactLaw]:
        """Every law in use, pairs and walls."""
        return [self.law(one, other) for one in self.laws for other in self.laws]

    def table(self) -> NDArray[np.float64]:
        """Rows of all pairs, (m, m, COLUMNS)."""
        return np.array([[self.law(one, other).row() for other in self.laws] for one in self.laws])

    def against(self, material: str) -> list[ContactLaw]:
        """The laws of a surface of ``material`` with discs of each material."""
        return [self.law(material, other) for other in self.laws]
