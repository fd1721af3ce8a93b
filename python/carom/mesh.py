"""Meshes from arrays, meshio or PyVista, as a file that a case names."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

# number of the kind in Gmsh's format, nodes, and facets by their local nodes; order of nodes as in VTK and meshio
_KINDS: dict[str, tuple[int, int, str, list[list[int]]]] = {
    "vertex": (15, 1, "", []),
    "line": (1, 2, "vertex", [[0], [1]]),
    "line3": (8, 3, "vertex", [[0], [1]]),
    "triangle": (2, 3, "line", [[0, 1], [1, 2], [2, 0]]),
    "triangle6": (9, 6, "line3", [[0, 1, 3], [1, 2, 4], [2, 0, 5]]),
    "quad": (3, 4, "line", [[0, 1], [1, 2], [2, 3], [3, 0]]),
    "quad8": (16, 8, "line3", [[0, 1, 4], [1, 2, 5], [2, 3, 6], [3, 0, 7]]),
    "tetra": (4, 4, "triangle", [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]),
    "hexahedron": (
        5,
        8,
        "quad",
        [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]],
    ),
}
_DIMENSION = {"vertex": 0, "line": 1, "line3": 1, "triangle": 2, "triangle6": 2, "quad": 2, "quad8": 2}
# kinds of VTK
_VTK = {1: "vertex", 3: "line", 21: "line3", 5: "triangle", 22: "triangle6", 9: "quad", 23: "quad8", 10: "tetra", 12: "hexahedron"}

Cells = Mapping[str, ArrayLike]


def write(
    path: str | os.PathLike[str],
    points: ArrayLike,
    groups: Mapping[str, Cells],
    *,
    nodes: Mapping[str, ArrayLike] | None = None,
    sides: Mapping[str, ArrayLike] | None = None,
) -> Path:
    """Writes a mesh in Gmsh's format 2.2, for `mesh.file` of a case.

    Args:
        path: file to write, `.msh`.
        points: places of the nodes, shape (nodes, 1 to 3), in the unit that `mesh.unit` of the case names, m by default.
        groups: cells of each group by their kind, of bodies or sides: `{"beam": {"triangle6": array of nodes from 0}}`.
            Kinds: vertex, line, line3, triangle, triangle6, quad, quad8, tetra, hexahedron, with the order of nodes of VTK.
        nodes: groups of single nodes, such as the end of a stop.
        sides: groups of boundary facets: those of which all nodes are among the given ones.

    Raises:
        ValueError: a kind that is not known, nodes that are not there, a group of sides without a facet.
    """
    places = np.asarray(points, dtype=float)
    places = np.pad(places, ((0, 0), (0, 3 - places.shape[1])))
    blocks: list[tuple[str, str, NDArray[np.intp]]] = []
    for name, cells in groups.items():
        blocks.extend((name, kind, _cells(name, kind, array, len(places))) for kind, array in cells.items())
    bodies = list(blocks)
    for name, chosen in (sides or {}).items():
        found = _facets(bodies, np.asarray(chosen))
        if not found:
            raise ValueError(f"sides `{name}`: no facet of the boundary has all of its nodes among the given ones")
        blocks.extend((name, kind, array) for kind, array in found)
    for name, chosen in (nodes or {}).items():
        blocks.append((name, "vertex", _cells(name, "vertex", np.atleast_1d(chosen).reshape(-1, 1), len(places))))
    _save(Path(path), places, blocks)
    return Path(path)


def _cells(name: str, kind: str, array: ArrayLike, count: int) -> NDArray[np.intp]:
    if kind not in _KINDS:
        raise ValueError(f"group `{name}`: cells of the kind `{kind}`; accepted: {', '.join(_KINDS)}")
    cells = np.asarray(array, dtype=np.intp)
    if cells.ndim != 2 or cells.shape[1] != _KINDS[kind][1]:
        raise ValueError(f"group `{name}`: an array of the shape {cells.shape}; accepted: (cells, {_KINDS[kind][1]})")
    if cells.size and (cells.min() < 0 or cells.max() >= count):
        raise ValueError(f"group `{name}`: a node that is not there; accepted: 0 to {count - 1}")
    return cells


def _facets(bodies: list[tuple[str, str, Any]], chosen: NDArray[Any]) -> list[tuple[str, NDArray[np.intp]]]:
    """Facets of one cell alone that have all their nodes among the chosen ones, by kind."""
    inside = set(np.flatnonzero(chosen).tolist() if chosen.dtype == bool else chosen.tolist())
    largest = max((_DIMENSION.get(kind, 3) for _, kind, _ in bodies), default=0)
    seen: dict[tuple[int, ...], tuple[str, list[int]] | None] = {}
    for _, kind, cells in bodies:
        if _DIMENSION.get(kind, 3) < largest:
            continue
        facet = _KINDS[kind][2]
        for cell in cells.tolist():
            for local in _KINDS[kind][3]:
                own = [cell[k] for k in local]
                key = tuple(sorted(own))
                seen[key] = None if key in seen else (facet, own)
    by_kind: dict[str, list[list[int]]] = {}
    for found in seen.values():
        if found is not None and inside.issuperset(found[1]):
            by_kind.setdefault(found[0], []).append(found[1])
    return [(kind, np.array(cells)) for kind, cells in by_kind.items()]


def _save(path: Path, places: NDArray[np.float64], blocks: list[tuple[str, str, NDArray[np.intp]]]) -> None:
    tags: dict[tuple[str, int], int] = {}
    for name, kind, _ in blocks:
        tags.setdefault((name, _DIMENSION.get(kind, 3)), len(tags) + 1)
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(tags))]
    lines += [f'{dimension} {tag} "{name}"' for (name, dimension), tag in tags.items()]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(places))]
    lines += [f"{k + 1} {x!r} {y!r} {z!r}" for k, (x, y, z) in enumerate(places.tolist())]
    lines += ["$EndNodes", "$Elements", str(sum(len(cells) for _, _, cells in blocks))]
    number = 0
    for name, kind, cells in blocks:
        tag = tags[name, _DIMENSION.get(kind, 3)]
        for cell in (cells + 1).tolist():
            number += 1
            lines.append(f"{number} {_KINDS[kind][0]} 2 {tag} {tag} " + " ".join(map(str, cell)))
    lines += ["$EndElements", ""]
    path.write_text("\n".join(lines), encoding="ascii")


def from_meshio(path: str | os.PathLike[str], mesh: Any, **others: Any) -> Path:
    """Writes a `meshio.Mesh`: its cell sets are the groups; without any all cells of the largest dimension are the group `body`.
    `others`: as `nodes` and `sides` of `write`."""
    groups: dict[str, dict[str, list[Any]]] = {}
    for name, per_block in mesh.cell_sets.items():
        for block, chosen in zip(mesh.cells, per_block):
            if chosen is not None and len(chosen):
                groups.setdefault(name, {}).setdefault(block.type, []).append(block.data[chosen])
    if not groups:
        largest = max(_DIMENSION.get(block.type, 3) for block in mesh.cells)
        for block in mesh.cells:
            if _DIMENSION.get(block.type, 3) == largest:
                groups.setdefault("body", {}).setdefault(block.type, []).append(block.data)
    whole = {name: {kind: np.concatenate(parts) for kind, parts in cells.items()} for name, cells in groups.items()}
    return write(path, mesh.points, whole, **others)


def from_pyvista(path: str | os.PathLike[str], grid: Any, *, group: str | None = None, **others: Any) -> Path:
    """Writes an unstructured grid of PyVista. `group`: a field of the cells whose values name their groups; without it all cells are
    the group `body`. `others`: as `nodes` and `sides` of `write`."""
    grid = grid.cast_to_unstructured_grid()
    names = np.full(grid.n_cells, "body") if group is None else np.asarray(grid.cell_data[group]).astype(str)
    groups: dict[str, dict[str, Any]] = {}
    for number, cells in grid.cells_dict.items():
        if number not in _VTK:
            raise ValueError(f"cells of VTK's kind {number}; accepted: {', '.join(_KINDS)}")
        own = names[grid.celltypes == number]
        for name in np.unique(own):
            groups.setdefault(str(name), {})[_VTK[number]] = cells[own == name]
    return write(path, np.asarray(grid.points, dtype=float), groups, **others)
