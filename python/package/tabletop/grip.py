"""The openings that grippers take on order.

Recordings, leader arms and policies tell where fingers are to be: on a held thing that is where it stops them. Fingers that go just there touch nothing, and those
that are sent a hair wider let go.
"""

PRESS = 0.1
"""By how many units fingers feel for a thing between them when they close, and by how many an order has to exceed their opening for them to let go of it."""

SLACK = 0.02
"""By how many units an order may be narrower than the opening before fingers close."""


def closes(ordered: float, opening: float) -> bool:
    """Whether fingers with this opening close on this order."""
    return ordered < opening - SLACK


def kept(ordered: float, opening: float) -> float:
    """The opening to which fingers go that hold something, have this opening and are ordered to have another."""
    return ordered if ordered > opening + PRESS else opening - SLACK


def pressed(ordered: float, opening: float, holds: bool) -> float:
    """The opening to which fingers go that close on whatever they are about to reach."""
    if holds:
        return kept(ordered, opening)
    return ordered - PRESS if closes(ordered, opening) else ordered
