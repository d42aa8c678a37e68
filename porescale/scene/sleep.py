"""[sleep]: grains that rest are left out of contact steps until something disturbs them."""

from porescale.common.schema.sections import Section, quantity


class Sleep(Section):
    """Grains fall asleep that are slow and in balance, and wake when they are out of balance by ``share`` of their
    weight (in fluid: less lift): dem/resting/sleep.py.  Off without this section; series.csv gives how many sleep.
    """

    share: float = quantity("", 0.05, gt=0, le=0.5, help="share of a grain's weight by which it may be out of balance")
    after: float | None = quantity(
        "s", None, gt=0, le=1e9, help="time for which a grain must rest (default: 100 oscillations of a contact)"
    )
