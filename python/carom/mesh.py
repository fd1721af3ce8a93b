"""Meshes from arrays, meshio or PyVista, as a file that a case names."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .kinds import BY_VTK, KINDS, VTK_WEDGE, upright

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
            Kinds and the order of their nodes are those of meshio: vertex, line, line3, triangle, triangle6, quad, quad8, quad9, tetra,
            tetra10, pyramid, wedge, wedge15, hexahedron, hexahedron20, hexahedron27. Solid cells that are inside out are turned, and those of
            plane meshes that run clockwise.
        nodes: groups of single nodes, such as the end of a stop.
        sides: groups of boundary facets: those of which all nodes are among the given ones.

    Raises:
        ValueError: a kind that is not known, nodes that are not there, a group of sides without a facet.
    """
    places = np.asarray(points, dtype=float)
    places = np.pad(places, ((0, 0), (0, 3 - places.shape[1])))
    blocks: list[tuple[str, str, NDArray[np.intp]]] = []
    plane = not places[:, 2].any()
    for name, given in groups.items():
        for kind, array in given.items():
            cells = _cells(name, kind, array, len(places))
            blocks.append((name, kind, upright(kind, cells, places) if KINDS[kind].dimension == 3 or plane else cells))
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
    if kind not in KINDS:
        raise ValueError(f"group `{name}`: cells of the kind `{kind}`; accepted: {', '.join(KINDS)}")
    cells = np.asarray(array, dtype=np.intp)
    if cells.ndim != 2 or cells.shape[1] != KINDS[kind].nodes:
        raise ValueError(f"group `{name}`: an array of the shape {cells.shape}; accepted: (cells, {KINDS[kind].nodes})")
    if cells.size and (cells.min() < 0 or cells.max() >= count):
        raise ValueError(f"group `{name}`: a node that is not there; accepted: 0 to {count - 1}")
    return cells


def _facets(bodies: list[tuple[str, str, Any]], chosen: NDArray[Any]) -> list[tuple[str, NDArray[np.intp]]]:
    """Facets of one cell alone that have all their nodes among the chosen ones, by kind."""
    inside = set(np.flatnonzero(chosen).tolist() if chosen.dtype == bool else chosen.tolist())
    largest = max((KINDS[kind].dimension for _, kind, _ in bodies), default=0)
    seen: dict[tuple[int, ...], tuple[str, list[int]] | None] = {}
    for _, kind, cells in bodies:
        if KINDS[kind].dimension < largest:
            continue
        for cell in cells.tolist():
            for facet, local in KINDS[kind].facets:
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
        tags.setdefault((name, KINDS[kind].dimension), len(tags) + 1)
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(tags))]
    lines += [f'{dimension} {tag} "{name}"' for (name, dimension), tag in tags.items()]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(places))]
    lines += [f"{k + 1} {x!r} {y!r} {z!r}" for k, (x, y, z) in enumerate(places.tolist())]
    lines += ["$EndNodes", "$Elements", str(sum(len(cells) for _, _, cells in blocks))]
    number = 0
    for name, kind, cells in blocks:
        tag = tags[name, KINDS[kind].dimension]
        for cell in (KINDS[kind].to_gmsh(cells) + 1).tolist():
            number += 1
            lines.append(f"{number} {KINDS[kind].gmsh} 2 {tag} {tag} " + " ".join(map(str, cell)))
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
        # cells of a kind that is not known are kept, so that `write` refuses them
        dimensions = [KINDS[block.type].dimension if block.type in KINDS else 3 for block in mesh.cells]
        for block, dimension in zip(mesh.cells, dimensions):
            if dimension == max(dimensions):
                groups.setdefault("body", {}).setdefault(block.type, []).append(block.data)
    whole = {name: {kind: np.concatenate(parts) for kind, parts in cells.items()} for name, cells in groups.items()}
    return write(path, mesh.points, whole, **others)


def from_pyvista(path: str | os.PathLike[str], grid: Any, *, group: str | None = None, **others: Any) -> Path:
    """Writes an unstructured grid of PyVista. `group`: a field of the cells whose values name their groups; without it all cells are
    the group `body`. `others`: as `nodes` and `sides` of `write`."""
    grid = grid.cast_to_unstructured_grid()
    names = np.full(grid.n_cells, "body") if group is None else np.asarray(grid.cell_data[group]).astype(str)
    groups: dict[str, dict[str, list[Any]]] = {}
    for number, cells in grid.cells_dict.items():
        own = names[grid.celltypes == number]
        kind, order = _of_vtk(number)
        for name in np.unique(own):
            groups.setdefault(str(name), {}).setdefault(kind, []).append(cells[own == name][:, order])
    whole = {name: {kind: np.concatenate(parts) for kind, parts in cells.items()} for name, cells in groups.items()}
    return write(path, np.asarray(grid.points, dtype=float), whole, **others)


def _of_vtk(number: int) -> tuple[str, Any]:
    """The kind of a number of VTK, and the order of nodes that takes its cells to it."""
    if number in (8, 11):
        # the cells of images: corners in rows
        return ("quad", [0, 1, 3, 2]) if number == 8 else ("hexahedron", [0, 1, 3, 2, 4, 5, 7, 6])
    if number not in BY_VTK:
        raise ValueError(f"cells of VTK's kind {number}; accepted: {', '.join(KINDS)}")
    return BY_VTK[number], VTK_WEDGE if number == 13 else slice(None)
