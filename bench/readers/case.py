"""A case: a small mesh file, and what it holds by the specification of its format."""

import dataclasses

# a tetrahedron of volume 1, whose bounds tell x, y and z apart
CORNERS = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, 3.0)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]


@dataclasses.dataclass
class Facts:
    """What is compared: counts after exact welding, signed volume, bounds."""

    vertices: int
    triangles: int
    volume: float
    low: tuple
    high: tuple


TETRAHEDRON = Facts(4, 4, 1.0, (0, 0, 0), (1, 2, 3))
# the file must be refused: it is damaged, ambiguous, or needs what no reader here has
REFUSED = None


@dataclasses.dataclass
class Case:
    """`rule` says what the specification says where readers differ; `sides` holds the side files."""

    name: str
    extension: str
    content: bytes
    expected: Facts | None = dataclasses.field(default_factory=lambda: TETRAHEDRON)
    rule: str = ""
    sides: dict = dataclasses.field(default_factory=dict)


def moved(shift, factor=1.0):
    """The tetrahedron, scaled and then moved."""
    low = tuple(float(s) for s in shift)
    high = tuple(s + factor * size for s, size in zip(shift, (1.0, 2.0, 3.0)))
    return Facts(4, 4, factor**3, low, high)
