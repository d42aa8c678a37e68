"""Segments and corners, slow and obvious, from the potential itself: every distance of a point to a segment, clamped,
and every distance of a point to a corner, which is taken off as often as segments end there, less one.  Nothing cancels
by design, no weights.  Also moments of polygons by a fan of triangles.
"""

import itertools
import math

import numpy as np


def distance(point, a, b):
    """Of a point to the segment a-b, and its closest point."""
    way = b - a
    share = min(max(float((point - a) @ way) / float(way @ way), 0.0), 1.0)
    return float(np.hypot(*(a + share * way - point))), a + share * way


def terms(position, group, ends):
    """Terms (factor, disc, disc or segment, whether a segment) of the potential of all bodies, -1 for free discs."""
    beside = {i: [e for e, both in enumerate(ends) if i in both] for i in range(len(position))}
    found = []
    for i, e in itertools.product(range(len(position)), range(len(ends))):
        if group[i] < 0 or group[i] != group[ends[e][0]]:
            found.append((1, i, e, True))
    for i, j in itertools.combinations(range(len(position)), 2):
        if group[i] < 0 or group[i] != group[j]:
            found.append((1 - len(beside[i]) - len(beside[j]), i, j, False))
    return found


def potential(position, radius, group, ends, stiffness):
    """Sum of k d^2/2 over all terms, J/m."""
    total = 0.0
    for factor, i, other, sided in terms(position, group, ends):
        if sided:
            a, b = ends[other]
            away, reach = distance(position[i], position[a], position[b])[0], radius[i] + radius[a]
        else:
            away, reach = math.hypot(*(position[other] - position[i])), radius[i] + radius[other]
        total += 0.5 * factor * stiffness * max(reach - away, 0.0) ** 2
    return total


def forces(position, radius, group, ends, stiffness, moved):
    """Force and torque about its centroid on each body of ``moved`` [(discs, centroid)], from the same sum."""
    load = np.zeros((len(position), 2))
    moment = np.zeros(len(position))  # about the origin
    for factor, i, other, sided in terms(position, group, ends):
        if sided:
            a, b = ends[other]
            away, touched = distance(position[i], position[a], position[b])
            reach = radius[i] + radius[a]
        else:
            a, touched = other, position[other]
            away, reach = math.hypot(*(touched - position[i])), radius[i] + radius[other]
        if away < reach:
            push = factor * stiffness * (reach - away) * (position[i] - touched) / away
            for disc, force in ((i, push), (a, -push)):
                load[disc] += force
                moment[disc] += position[i][0] * force[1] - position[i][1] * force[0]
    found = []
    for discs, (x, y) in moved:
        fx, fy = load[discs].sum(axis=0)
        found.append((fx, fy, moment[discs].sum() - x * fy + y * fx))
    return np.array(found)


def polygon_by_triangles(corners):
    """Area, centroid and polar second moment about it: signed triangles from the first corner, parallel axes."""
    parts = []
    for p, q in itertools.pairwise(corners[1:]):
        u, v = np.subtract(p, corners[0]), np.subtract(q, corners[0])
        area = 0.5 * (u[0] * v[1] - u[1] * v[0])
        own = area * (u @ u + v @ v + (v - u) @ (v - u)) / 36.0
        parts.append((area, np.mean([corners[0], p, q], axis=0), own))
    area = sum(part[0] for part in parts)
    centroid = sum(part[0] * part[1] for part in parts) / area
    second = sum(own + a * float((c - centroid) @ (c - centroid)) for a, c, own in parts)
    return abs(area), centroid, second * math.copysign(1.0, area)
