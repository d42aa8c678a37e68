"""Moduli of a packing by brute force: the energy of its springs, contact by contact, and its minimum."""

import numpy as np


def moduli(position, radius, box, law):
    """The moduli (3, 3), Pa, of discs at ``position`` (n, 2) m with ``radius`` (n,) m in a periodic ``box``, m."""
    n, box = len(position), np.asarray(box)
    stiffness = (law.stiffness, law.tangential_stiffness, law.rolling_stiffness)

    def energy(moved):
        """J/m of displacements (m) and rotations (rad) of all discs, and the strains xx, yy, 2 xy, (3 n + 3,)."""
        move, strain = moved[: 3 * n].reshape(n, 3), moved[3 * n :]
        stretched, whole = np.array([[strain[0], 0.5 * strain[2]], [0.5 * strain[2], strain[1]]]), 0.0
        for i in range(n):
            for j in range(i):
                way = position[j] - position[i]
                way -= box * np.round(way / box)
                distance = np.hypot(*way)
                if distance >= radius[i] + radius[j]:
                    continue
                normal = way / distance
                across = np.array([-normal[1], normal[0]])
                first = 0.5 * (distance + (radius[i] ** 2 - radius[j] ** 2) / distance)
                apart = move[j, :2] - move[i, :2] + stretched @ way
                slip = apart @ across - move[i, 2] * first - move[j, 2] * (distance - first)
                roll = radius[i] * radius[j] / (radius[i] + radius[j]) * (move[i, 2] - move[j, 2])
                lengths = np.array([apart @ normal, slip, roll])
                whole += 0.5 * np.sum(stiffness * lengths**2)
        return whole

    unit = np.eye(3 * n + 3)
    alone = [energy(row) for row in unit]
    matrix = np.array(
        [
            [energy(unit[a] + unit[b]) - alone[a] - alone[b] if a != b else 2.0 * alone[a] for b in range(len(unit))]
            for a in range(len(unit))
        ]
    )
    inner, mixed, outer = matrix[: 3 * n, : 3 * n], matrix[: 3 * n, 3 * n :], matrix[3 * n :, 3 * n :]
    return (outer - mixed.T @ np.linalg.pinv(inner, rcond=1e-10) @ mixed) / box.prod()
