"""Counter-surfaces that wear: their position in a stroke, and their loss in it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ngwear.loop.stage import Stage
from ngwear.scene.program import Program
from ngwear.surfaces import WornProfile
from ngwear.wear.sliding_distance import Strokes

Array = NDArray[np.float64]

Counters = dict[str, WornProfile]


def ways(program: Program, index: int, sliding: Strokes) -> Array:
    """Position of the surfaces along themselves at start and end of each stroke of a kind [mm].

    Shape (n, 2); one row if every stroke of the kind starts and ends at the same place.
    """
    moves = [math.copysign(stroke.travel, stroke.direction) for stroke in program.cycle]
    start, net = sum(moves[:index]), sum(moves)
    if net == 0:
        return np.array([[start, start + moves[index]]])
    cycles = np.floor(sliding.start / sliding.cycle + 1e-9) + np.arange(max(1, sliding.repeats))
    return start + net * cycles[:, None] + np.array([[0.0, moves[index]]])


def place(stage: Stage, counters: Counters, index: int, sliding: Strokes) -> None:
    """Put the worn surfaces where they are halfway through the first of the strokes."""
    for name, counter in counters.items():
        contact = stage.contacts[name]
        contact.counter = counter
        contact.turned = float(ways(stage.scene.program, index, sliding)[0].mean())


def worn(stage: Stage, counters: Counters, index: int, sliding: Strokes, shares: dict[str, Array]) -> Counters:
    """The surfaces after the strokes: each of their points loses ``k2 int p dx`` over the nodes that it passes.

    ``shares`` are slip over travel of a contact's nodes [-]; the loss is multiplied by them.
    """
    passes = ways(stage.scene.program, index, sliding)
    after = {}
    for spec in stage.scene.contacts:
        if spec.name in counters:
            contact = stage.contacts[spec.name]
            ends, pressure = contact.imprint()
            pressure = pressure * contact.wear_factor(pressure)
            wear = spec.counter_wear_rate * pressure * (sliding.repeats / len(passes))
            if spec.name in shares:
                wear = wear * shares[spec.name][contact.profile().edges]
            after[spec.name] = counters[spec.name].swept(ends - contact.turned, wear, passes)
    return after
