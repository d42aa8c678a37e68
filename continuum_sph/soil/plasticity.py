"""Stress of one element of soil after a small deformation: turned, strained elastically, brought back to yield.

In the plane a stress is p = (σ_xx + σ_yy)/2 and the vector (s, t) = ((σ_xx - σ_yy)/2, σ_xy) of length r, the radius of
Mohr's circle.  Turning the soil by θ turns (s, t) by 2θ.  Yield is r = p sin φ + c cos φ, flow takes volume with it as
sin ψ: dε_v = -sin ψ dγ.  The way back from a trial stress beyond yield is exact, not iterated: with
f = r - p sin φ - c cos φ,

    dγ = f/(G + B sin φ sin ψ),   r -= G dγ,   p += B sin ψ dγ

and along it (s, t) keeps its direction.  Tension: the smallest principal stress p - r is at least -T, by associated
flow, and its corner with the cone and its tip are points.  Soil that has come apart bears no stress until its opening
has closed again (Dunatunga & Kamrin, J. Fluid Mech. 779 (2015) 483); hypo-elasticity without that memory would push as
soon as things approach.  σ_zz changes with p as plane strain has it while nothing flows across the plane: 2ν dp.
Source: Bui, Fukagawa, Sako & Ohno, Int. J. Numer. Anal. Meth. Geomech. 32 (2008) 1537 (there Drucker-Prager, scaled
back); Jaumann's rate: eq. 45 of Maeda & Sakai 2004.

Where friction grows with the rate of shear (`material`), r - p sin φ - c cos φ is not zero after the step but
p (sin φ∞ - sin φ) γ'/(γ' + γ0), γ' = dγ/dt, γ0 = √p I0/(d √ρs): with p of the trial in γ0 that is a quadratic in dγ, of
which one root is positive, so the way back is as exact as without (Dunatunga & Kamrin iterate).

Where strength softens (`material`), all of it is that of the plastic shear strain before the step, the sum of dγ: first
order in a step, of which dγ/γs is 1e-3 where soil shears fast.

The p of the yield criterion alone is the mean of the particle's surroundings, p̄ = p + ``excess`` of `momentum`.  Noise
in p that yields by itself is cut off on one side, where r > p sin φ: soil weakens, the more the finer it is.
"""

import numpy as np

from continuum_sph.soil.material import (
    ACROSS,
    AREA,
    COHESION_INTERCEPT,
    EXPONENT,
    RATE_PACE,
    RATE_STRENGTH,
    SHEAR,
    SIN_DILATANCY,
    SIN_FRICTION,
    SOFTENED_COHESION,
    SOFTENED_FRICTION,
    SOFTENED_STRAIN,
    TENSION,
    YIELDS,
    stiffness_share,
)
from porescale.common.compiled.jit import inline


@inline
def sheared(beyond, softer, p, dilating, step, row):
    """Plastic shear strain of a ``step`` (s) by which a trial stress ``beyond`` (Pa) yield comes back to it.

    softer: by what (Pa) that falls for a strain of 1;  p: mean of the surroundings, Pa, of whose friction a share grows
    with the rate of shear;  dilating: by what (Pa) p grows for a strain of 1;  row: the material's.
    """
    growth = row[RATE_STRENGTH]
    if growth == 0.0:
        return beyond / softer
    bearing = max(p, 0.0)
    pace = row[RATE_PACE] * np.sqrt(bearing) * step  # strain of a step at which half of the growth is there
    a = softer + dilating * growth
    b = softer * pace + growth * bearing - beyond
    root = np.sqrt(b * b + 4.0 * a * beyond * pace)
    return 2.0 * beyond * pace / (root + b) if b > 0.0 else 0.5 * (root - b) / a


@inline
def strength(plastic, row):
    """(sin φ, c cos φ Pa, sin ψ, T Pa) after a ``plastic`` shear strain of a soil of the material's ``row``."""
    slope = row[SIN_FRICTION]
    cohesion = row[COHESION_INTERCEPT]
    dilatancy = row[SIN_DILATANCY]
    tension = row[TENSION]
    if row[SOFTENED_STRAIN] > 0.0:
        lost = 1.0 - np.exp(-plastic / row[SOFTENED_STRAIN])
        left = 1.0
        if cohesion > 0.0:
            left = 1.0 - lost * row[SOFTENED_COHESION] / cohesion
        slope -= lost * row[SOFTENED_FRICTION]
        cohesion *= left
        dilatancy *= 1.0 - lost
        tension *= left  # stays within c cot φ, as φ falls
    return slope, cohesion, dilatancy, tension


@inline
def returned(p, r, excess, moduli, step, bears, row):
    """(p, r, dγ, opened): a trial stress (Pa) brought back to yield, shear strain that did not come back and share of
    the volume that came apart;  excess: mean p of the surroundings less p, Pa, never below -p where p > 0;
    moduli: (B, G), Pa;  step: s;  bears: of `strength`;  row: the material's."""
    area, shear = moduli
    slope, cohesion, dilatancy, tension = bears
    cohesion += slope * max(excess, -max(p, 0.0))
    new_p = p
    new_r = r
    if r > slope * p + cohesion:
        beyond = r - slope * p - cohesion
        flow = sheared(beyond, shear + slope * area * dilatancy, p + excess, area * dilatancy, step, row)
        new_r = r - shear * flow
        new_p = p + area * dilatancy * flow
        if new_r < 0.0:  # beyond the tip; or by round-off, where the surroundings bear nothing
            new_r = 0.0
            new_p = -tension if p < 0.0 else new_p
    opened = 0.0
    if new_p - new_r < -tension or (new_r == 0.0 and new_p <= -tension and p < new_p):
        flow = max(0.0, (r - p - tension) / (shear + area))
        new_r = r - shear * flow
        new_p = p + area * flow
        if new_r < 0.0:
            new_r = 0.0
            new_p = -tension
        elif new_r > slope * new_p + cohesion:  # the corner of both
            new_p = (cohesion - tension) / (1.0 - slope)
            new_r = new_p + tension
        opened = max(0.0, (new_p - p) / area)
    return new_p, new_r, max(0.0, r - new_r) / shear, opened


@inline
def new_stress(stress, excess, gradient, step, opening, plastic, row):
    """(σ_xx, σ_yy, σ_xy, σ_zz, opening, dγ) after ``step`` (s);  stresses in Pa.

    stress: (σ_xx, σ_yy, σ_xy, σ_zz);  excess: mean p of the surroundings less p, Pa;  gradient of the velocity:
    (∂v_x/∂x, ∂v_x/∂y, ∂v_y/∂x, ∂v_y/∂y), 1/s;  opening: share of the volume by which the element has come apart;
    plastic: shear strain that did not come back before;  row: the material's line of the table.
    """
    xx, yy, xy, zz = stress
    gxx, gxy, gyx, gyy = gradient
    p = 0.5 * (xx + yy)
    half = 0.25 * (gyx - gxy) * step  # tan θ/2 where the gradient is that of the middle of a rigid turn
    turn = 2.0 * half / (1.0 - half * half)  # tan θ
    shorter = 1.0 / (1.0 + turn * turn)
    cosine = (1.0 - turn * turn) * shorter
    sine = 2.0 * turn * shorter
    s = 0.5 * (xx - yy) * cosine - xy * sine
    t = 0.5 * (xx - yy) * sine + xy * cosine
    closing = -(gxx + gyy) * step
    closed = min(opening, max(0.0, closing))
    opening -= closed
    soft = stiffness_share(p, row)
    if row[EXPONENT] > 0.0:  # stiffness of half the way: the second order in a step
        soft = stiffness_share(p + 0.5 * row[AREA] * soft * (closing - closed), row)
    area = row[AREA] * soft
    shear = row[SHEAR] * soft
    new_p = p + area * (closing - closed)
    s -= shear * (gxx - gyy) * step
    t -= shear * (gxy + gyx) * step
    flow = 0.0
    if row[YIELDS] > 0.0:
        r = np.sqrt(s * s + t * t)
        new_p, new_r, flow, opened = returned(new_p, r, excess, (area, shear), step, strength(plastic, row), row)
        if new_r < r:
            s *= new_r / r
            t *= new_r / r
        opening += opened
    zz += row[ACROSS] * (new_p - p)
    return new_p + s, new_p - s, t, zz, opening, flow
