"""A packing that is pressed together fills the box, and its friction has springs to act on."""

from porescale.builders.initial.contact_laws import law_class, merged
from porescale.common.core.errors import Fault
from porescale.scene.packing import SAME, Packing
from porescale.scene.scene import Scene


def check_compressed(scene: Scene, faults: list[Fault]) -> None:
    """Add faults of a compressed packing: it fills the box, since nothing else would hold it together, and friction
    given for it acts under the law of [contact], unlike that of settling, which has a law of its own."""
    packing = scene.grains.packing if scene.grains else None
    if packing is None or not packing.compress or scene.rock:
        return
    if scene.contact and not law_class(scene.contact).compresses:
        problem = "packings are compressed under the linear law only"
        faults.append(Fault("contact.law", str(scene.contact.law), problem, repair='let it settle, or take "linear"'))
    elif scene.contact:
        faults += _without_effect(scene, packing)
    domain = scene.domain
    for key, start, length, size in (
        ("width", packing.left, packing.width, domain.width), ("height", packing.bottom, packing.height, domain.height),
    ):  # fmt: skip
        if abs(start) > SAME * size or abs(length - size) > SAME * size:
            problem = "a compressed packing fills the box, whose sides hold it"
            repair = "make the packing as large as the box, or let it settle"
            faults.append(Fault(f"grains.packing.{key}", length, problem, "m", f"{size:g}", repair))


def _without_effect(scene: Scene, packing: Packing) -> list[Fault]:
    """Faults of friction that was given for compressing, and has no spring or dashpot along contacts to act on."""
    assert scene.contact
    own = next((it for it in scene.material if it.name == packing.material), next(iter(scene.material), None))
    numbers, law, faults = merged(scene.contact, own), law_class(scene.contact), []
    stiff = numbers.get("tangential_stiffness", 0.0) > 0.0
    slides = not law.friction_problem(numbers | {"friction": 1.0})  # a coefficient of rolling takes the spring alone
    for key, acts in (("settling_friction", slides), ("settling_rolling_friction", stiff)):
        value = getattr(packing, key)
        if value > 0.0 and packing.gives(key) and not acts:
            problem = "has no effect on what is compressed: contacts have no tangential_stiffness"
            repair = "give contact.tangential_stiffness, half of the normal one say, or leave it out"
            faults.append(Fault(f"grains.packing.{key}", value, problem, repair=repair))
    return faults
