"""The smallest statement of a step of soil: one material in a periodic box, without walls; dense numpy.

It is what the manual shows and what tests hold the fast kernels against.  Left out: corrections at free surfaces,
damping, diffusion of stress and volume, what keeps particles apart, tension, and the stress across the plane.
"""

from typing import NamedTuple

import numpy as np

from continuum_sph.soil.material import Material
from porescale.common.core.types import Floats


class Ground(NamedTuple):
    """Particles of soil: x (n, 2) m, v (n, 2) m/s, acceleration (n, 2) m/s², mass (n,) kg/m, density (n,) kg/m³,
    stress (n, 2, 2) Pa, compression positive, and excess (n,) Pa, mean p of the surroundings less p.  A step overwrites
    all but the mass."""

    x: Floats
    v: Floats
    acceleration: Floats
    mass: Floats
    density: Floats
    stress: Floats
    excess: Floats


def kernel_slopes(x: Floats, side: float, h: float) -> tuple[Floats, Floats]:
    """x_j - x_i (n, n, 2) m to the nearest image in a box of ``side`` (m), and -(1/r) W' (n, n) 1/m⁴ of Wendland's
    kernel C2 of the smoothing length ``h`` (m): ∇_i W is the product of both."""
    apart = x[None, :] - x[:, None]
    apart -= side * np.rint(apart / side)
    rest = np.maximum(1.0 - 0.5 * np.hypot(apart[..., 0], apart[..., 1]) / h, 0.0)
    return apart, 35.0 / (4.0 * np.pi * h**4) * rest**3


def new_stress(stress: Floats, excess: float, gradient: Floats, step: float, material: Material) -> Floats:
    """Stress (2, 2) Pa of an element after ``step`` (s) at a velocity gradient (2, 2) 1/s: turned, strained elastically
    and brought back to Mohr-Coulomb's yield surface r = (p + excess) sin φ + c cos φ."""
    bulk, shear = (it * material.stiffness for it in (material.area_modulus, material.shear_modulus))
    turned = 2.0 * np.arctan(0.25 * (gradient[1, 0] - gradient[0, 1]) * step)
    cosine, sine = np.cos(turned), np.sin(turned)
    quarter = np.array([[cosine, -sine], [sine, cosine]])
    stress = quarter @ stress @ quarter.T
    p = 0.5 * np.trace(stress) - bulk * np.trace(gradient) * step
    s = 0.5 * (stress[0, 0] - stress[1, 1]) - shear * (gradient[0, 0] - gradient[1, 1]) * step
    t = stress[0, 1] - shear * (gradient[0, 1] + gradient[1, 0]) * step
    r = np.hypot(s, t)
    beyond = r - (p + excess) * material.sin_friction - material.cohesion_intercept
    if material.yields and beyond > 0.0:
        flow = beyond / (shear + bulk * material.sin_friction * material.sin_dilatancy)
        p += bulk * material.sin_dilatancy * flow
        s, t = (it * (r - shear * flow) / r for it in (s, t))
    return np.array([[p + s, t], [t, p - s]])


def soil_step(ground: Ground, material: Material, side: float, h: float, step: float) -> None:
    """One step (s): half kick, drift, strain, push, half kick.  ``side`` of the box, ``h``: m."""
    x, v, a, mass, density, stress, excess = ground
    v += 0.5 * step * a
    x += step * v
    volume = mass / density
    apart, weight = kernel_slopes(x, side, h)
    slope = weight[..., None] * apart
    correction = np.linalg.inv(np.einsum("j,ija,ijb->iab", volume, apart, slope))
    gradient = np.einsum("j,ija,ijb->iab", volume, v[None, :] - v[:, None], slope) @ correction
    unit = np.eye(2)
    for i, at_end in enumerate(gradient):
        middle = at_end @ np.linalg.inv(unit - 0.5 * step * at_end)
        stress[i] = new_stress(stress[i], excess[i], middle, step, material)
        density[i] *= np.linalg.det(unit - step * at_end)
    pushing = stress @ correction
    both = pushing[:, None] + pushing[None, :]
    p = 0.5 * np.trace(stress, axis1=1, axis2=2)
    excess[:] = np.einsum("j,ij,ij->i", volume, weight, p[None, :] - p[:, None]) * h**2 / 3.5
    a[:] = -np.einsum("i,j,ijab,ijb->ia", volume / mass, volume, both, slope)
    v += 0.5 * step * a
