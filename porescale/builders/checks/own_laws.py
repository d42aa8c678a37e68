"""Laws of a user's file: whether they compile, and whether what they return can be used."""

from collections.abc import Sequence

from porescale.common.compiled.own import OwnLaw
from porescale.common.compiled.own_kernel import compile_for
from porescale.common.core.errors import Fault, InputError
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.own import OwnContact, numbers_of
from porescale.scene.contact import Contact


def check_own_contact(contact: Contact, laws: Sequence[ContactLaw], mass: float, radius: float) -> None:
    """InputError where [contact] names a user's law that cannot be compiled or is none, of the smallest grain.

    laws : all of the scene;  mass (kg/m), radius (m) : of the smallest grain, which touches a wall.
    """
    if not isinstance(contact.law, OwnLaw):
        return
    for law in laws:
        assert isinstance(law, OwnContact)
        try:
            compile_for(contact.law, 1e-3 * radius, 0.0, radius, mass, numbers_of(law.units, law.numbers), count=1)
        except InputError as error:
            raise InputError([_at("contact.law", fault) for fault in error.faults]) from None
        problem = law.problem(mass, radius)
        if problem:
            repair = f"correct {contact.law.name} in {contact.law.place}"
            raise InputError(Fault("contact.law", contact.law.reference, problem, repair=repair))


def _at(key: str, fault: Fault) -> Fault:
    """The fault, of a key."""
    return Fault(key, fault.value, fault.problem, fault.unit, fault.allowed, fault.repair)
