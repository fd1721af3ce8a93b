"""Kinds of cells: their numbers in other programs, their facets, and the order of their nodes, which is that of meshio."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

# VTK's linear wedge has its first triangle outward, that of the others inward
VTK_WEDGE = [0, 2, 1, 3, 5, 4]


@dataclass(frozen=True)
class Kind:
    """A kind of cells.

    Attributes:
        dimension: of the cell.
        gmsh: number in Gmsh's format.
        vtk: number in VTK.
        nodes: number of nodes.
        facets: kind and local nodes of each, outward.
        mirror: local nodes of the cell turned inside out.
        order: entry of each node in the list of Gmsh; empty where that is the same.
    """

    dimension: int
    gmsh: int
    vtk: int
    nodes: int
    facets: Sequence[tuple[str, list[int]]] = ()
    mirror: Sequence[int] = ()
    order: Sequence[int] = ()

    def to_gmsh(self, cells: NDArray[np.intp]) -> NDArray[np.intp]:
        """The nodes of cells in the order of Gmsh."""
        return cells[:, np.argsort(self.order)] if self.order else cells


def _all(kind: str, facets: list[list[int]]) -> list[tuple[str, list[int]]]:
    return [(kind, nodes) for nodes in facets]


_HEXAHEDRON = [
    [0, 3, 2, 1, 11, 10, 9, 8, 24],
    [4, 5, 6, 7, 12, 13, 14, 15, 25],
    [0, 1, 5, 4, 8, 17, 12, 16, 22],
    [1, 2, 6, 5, 9, 18, 13, 17, 21],
    [2, 3, 7, 6, 10, 19, 14, 18, 23],
    [3, 0, 4, 7, 11, 16, 15, 19, 20],
]
_MIRRORED = [0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17, 22, 23, 20, 21, 24, 25, 26]
_GMSH = [0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26]
_TETRAHEDRON = [[0, 2, 1, 6, 5, 4], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [0, 3, 2, 7, 9, 6]]
_TRIANGLES = [[0, 2, 1, 8, 7, 6], [3, 4, 5, 9, 10, 11]]
_QUADRILATERALS = [[0, 1, 4, 3, 6, 13, 9, 12], [1, 2, 5, 4, 7, 14, 10, 13], [2, 0, 3, 5, 8, 12, 11, 14]]


def _first(count: int, facets: list[list[int]]) -> list[list[int]]:
    return [nodes[:count] for nodes in facets]


KINDS = {
    "vertex": Kind(0, 15, 1, 1),
    "line": Kind(1, 1, 3, 2, _all("vertex", [[0], [1]])),
    "line3": Kind(1, 8, 21, 3, _all("vertex", [[0], [1]])),
    "triangle": Kind(2, 2, 5, 3, _all("line", [[0, 1], [1, 2], [2, 0]]), [0, 2, 1]),
    "triangle6": Kind(2, 9, 22, 6, _all("line3", [[0, 1, 3], [1, 2, 4], [2, 0, 5]]), [0, 2, 1, 5, 4, 3]),
    "quad": Kind(2, 3, 9, 4, _all("line", [[0, 1], [1, 2], [2, 3], [3, 0]]), [0, 3, 2, 1]),
    "quad8": Kind(2, 16, 23, 8, _all("line3", [[0, 1, 4], [1, 2, 5], [2, 3, 6], [3, 0, 7]]), [0, 3, 2, 1, 7, 6, 5, 4]),
    "quad9": Kind(2, 10, 28, 9, _all("line3", [[0, 1, 4], [1, 2, 5], [2, 3, 6], [3, 0, 7]]), [0, 3, 2, 1, 7, 6, 5, 4, 8]),
    "tetra": Kind(3, 4, 10, 4, _all("triangle", _first(3, _TETRAHEDRON)), [0, 2, 1, 3]),
    "tetra10": Kind(
        3, 11, 24, 10, _all("triangle6", _TETRAHEDRON), [0, 2, 1, 3, 6, 5, 4, 7, 9, 8], [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]
    ),
    "pyramid": Kind(
        3, 7, 14, 5, [("quad", [0, 3, 2, 1]), *_all("triangle", [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])], [0, 3, 2, 1, 4]
    ),
    "wedge": Kind(
        3, 6, 13, 6, _all("triangle", _first(3, _TRIANGLES)) + _all("quad", _first(4, _QUADRILATERALS)), [0, 2, 1, 3, 5, 4]
    ),
    "wedge15": Kind(
        3,
        18,
        26,
        15,
        _all("triangle6", _TRIANGLES) + _all("quad8", _QUADRILATERALS),
        [0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13],
        [0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11],
    ),
    "hexahedron": Kind(3, 5, 12, 8, _all("quad", _first(4, _HEXAHEDRON)), _MIRRORED[:8]),
    "hexahedron20": Kind(3, 17, 25, 20, _all("quad8", _first(8, _HEXAHEDRON)), _MIRRORED[:20], _GMSH[:20]),
    "hexahedron27": Kind(3, 12, 29, 27, _all("quad9", _HEXAHEDRON), _MIRRORED, _GMSH),
}
BY_VTK = {kind.vtk: name for name, kind in KINDS.items()}

# corners of the unit cell, by their number and the dimension
_CORNERS = {
    (3, 2): [[0, 0], [1, 0], [0, 1]],
    (4, 2): [[0, 0], [1, 0], [1, 1], [0, 1]],
    (4, 3): [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    (5, 3): [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1]],
    (6, 3): [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]],
    (8, 3): [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
}
_COUNT = {"triangle": 3, "quad": 4, "tetra": 4, "pyramid": 5, "wedge": 6, "hexahedron": 8}


def upright(name: str, cells: NDArray[np.intp], places: NDArray[np.float64]) -> NDArray[np.intp]:
    """The cells, those that are inside out turned: in the plane those that run clockwise.

    Where a linear map from the unit cell is fitted to the corners of a cell, its determinant has the sign of the volume.
    """
    kind = KINDS[name]
    if kind.dimension < 2:
        return cells
    corners = _COUNT[name.rstrip("0123456789")]
    unit = np.array(_CORNERS[corners, kind.dimension], dtype=float)
    x = places[cells[:, :corners], : kind.dimension]
    volumes = np.linalg.det(np.einsum("cai,aj->cij", x, unit - unit.mean(axis=0)))
    return np.where(volumes[:, None] < 0.0, cells[:, kind.mirror], cells)
