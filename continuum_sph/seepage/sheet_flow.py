"""Confined flow around a sheet in level ground, and what a pile of some thickness, and kernels, make of it.

A sheet without thickness, s deep in ground of depth T on an impervious base without ends, under a head h across it has

    q/(k h) = K(1 - m)/2K(m),   i_E T/h = π/{4 K(m) √m},   m = sin²(πs/2T)

K of the parameter m (Harr 1962, from Muskat); q its discharge, i_E the exit gradient beside it.

A slab of thickness t that ends square a little above the tip stands for the sheet.  It is longer than it looks, as its
thickness takes away ground, and by ε t in all if the discharge is to be the same.  z = (t/π) {w √(w² - 1) - arcosh w}
maps the end of a slab, from which (t/2π) {1 + ln(4πR/t)} of it follow up to a distance R from the tip.  Ground farther
off has the flow of the sheet: to cut its line x = 0 below the tip and part its halves by t costs t ∫ q_x² of the
conductance, and ∫ q_x² dy = C ln(R/ρ) from a distance ρ on, C that of a tip (q_x² = C/ρ), R = (2T/π) sin(πs/T) for
ground without ends.  So

    ε = {1 + ln(8 (T/t) sin(πs/T))}/2π

within 0.01 of finite volumes.  The exit gradient weighs the same displacement by that of Green's function of the exit,
1 + (K/E) {m/sin²(πy/2T) - 1}, and is that of a sheet that is shorter, by κ t,

    κ = (K/E) cos²(πs/2T)/π.

Kernels round off the root of the tip: the flow is that of a sheet that is longer still, by so many spacings
(`ROUNDED`).
"""

import numpy as np

ROUNDED = 0.31, 0.3
"""Spacings at s/T = 0 and how many fewer at 1: to 0.02, by discharges and by exit gradients, for s/T of 0.2 to 0.9 with
20 and 40 rows, h of 1.3 spacings (`continuum_sph.validation.seepage.sheet_pile`)."""


def modulus(share: float) -> float:
    """Parameter m of the elliptic integrals for a sheet to the depth ``share`` = s/T, 0 to 1."""
    return float(np.sin(0.5 * np.pi * share) ** 2)


def discharge(share: float) -> float:
    """q/(k h) under a sheet to the depth ``share`` = s/T."""
    from scipy.special import ellipk  # takes longer to import than a scene to be judged

    m = modulus(share)
    return float(ellipk(1.0 - m) / (2.0 * ellipk(m)))


def exit_gradient(share: float) -> float:
    """i_E T/h beside a sheet to the depth ``share`` = s/T."""
    from scipy.special import ellipk

    m = modulus(share)
    return float(np.pi / (4.0 * ellipk(m) * m**0.5))


def slab(share: float, rows: float) -> float:
    """How much longer than itself a slab one spacing thick is for the flow, in spacings, ε;  ``share`` = s/T;  rows :
    T over the spacing."""
    return float((1.0 + np.log(8.0 * rows * np.sin(np.pi * share))) / (2.0 * np.pi))


def longer(share: float, rows: float) -> float:
    """How much longer such a slab is with what kernels round off, in spacings;  as in `slab`."""
    return slab(share, rows) + ROUNDED[0] - ROUNDED[1] * share


def shorter(share: float) -> float:
    """By how much less that is for the exit gradient, in spacings, κ."""
    from scipy.special import ellipe, ellipk

    m = modulus(share)
    return float(ellipk(m) / ellipe(m) * (1.0 - m) / np.pi)


def thickness_at_exit(share: float, rows: float) -> float:
    """Exit gradient beside a slab one spacing thick over that of the sheet it stands for; its limit, 1, of a sheet that
    reaches the base, beside which both vanish."""
    return exit_gradient(max(0.0, share - shorter(share) / rows)) / exit_gradient(share) if 0.0 < share < 1.0 else 1.0
