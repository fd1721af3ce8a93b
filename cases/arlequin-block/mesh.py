"""Writes block.msh (MSH 4.1): a coarse block of 10 x 10 x 10 hexahedra, and a zone of 16 x 16 x 8 four times finer
under its middle. Groups: rest; tip, of which shell is the part without the core; core.bottom, where the sphere hits."""

N, FINER = 10, 4
h = 1.0 / N
nodes, cells = [], {"core": [], "shell": [], "rest": []}
faces = []


def grid(origin, count, size, name_of):
    first = len(nodes)
    nx, ny, nz = count
    for k in range(nz + 1):
        for j in range(ny + 1):
            for i in range(nx + 1):
                nodes.append([origin[0] + i * size, origin[1] + j * size, origin[2] + k * size])
    at = lambda i, j, k: first + 1 + i + (nx + 1) * (j + (ny + 1) * k)
    for k in range(nz):
        for j in range(ny):
            for i in range(nx):
                name = name_of(i, j, k)
                cells[name].append([at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k),
                                    at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)])
                if name == "core" and k == 0:
                    faces.append([at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0)])


def part(i, j, k):
    inside = FINER <= i < 3 * FINER and FINER <= j < 3 * FINER and k < FINER
    return "core" if inside else "shell"


grid((0.0, 0.0, 0.0), (N, N, N), h, lambda i, j, k: "rest")
low = (N // 2 - 2) * h
grid((low, low, 0.0), (4 * FINER, 4 * FINER, 2 * FINER), h / FINER, part)

box = "0 0 0 1 1 1"
volumes = {"core": (1, [2]), "shell": (2, [2, 3]), "rest": (3, [1])}
out = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", "4",
       '2 4 "core.bottom"', '3 1 "rest"', '3 2 "tip"', '3 3 "shell"', "$EndPhysicalNames", "$Entities", "0 0 1 3",
       f"1 {box} 1 4 0"]
for tag, groups in volumes.values():
    out.append(f"{tag} {box} {len(groups)} {' '.join(map(str, groups))} 0")
out += ["$EndEntities", "$Nodes", f"1 {len(nodes)} 1 {len(nodes)}", f"3 1 0 {len(nodes)}"]
out += [str(i + 1) for i in range(len(nodes))]
out += [" ".join(f"{c:.12g}" for c in node) for node in nodes]
total = sum(map(len, cells.values())) + len(faces)
out += ["$EndNodes", "$Elements", f"4 {total} 1 {total}", f"2 1 3 {len(faces)}"]
number = 1
for face in faces:
    out.append(f"{number} " + " ".join(map(str, face)))
    number += 1
for name, (tag, _) in volumes.items():
    out.append(f"3 {tag} 5 {len(cells[name])}")
    for cell in cells[name]:
        out.append(f"{number} " + " ".join(map(str, cell)))
        number += 1
out.append("$EndElements")
open("block.msh", "w").write("\n".join(out) + "\n")
