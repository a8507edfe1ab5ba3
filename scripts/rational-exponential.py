#!/usr/bin/env python3
"""Makes spectral/src/heat/rational_exponential_table.hpp: near-best rational
approximations of exp(-x) on [0, infinity) in partial fractions.

Poles by the Caratheodory-Fejer method (Trefethen, Weideman and Schmelzer,
"Talbot quadratures and rational approximations", 2006), residues by a
minimax fit for those poles (Lawson's iteration), errors measured on a fine
grid. Needs numpy.

usage: scripts/rational-exponential.py > spectral/src/heat/rational_exponential_table.hpp
"""
import numpy as np

DEGREES = range(4, 14)
SCALE = 9.0


def caratheodory_fejer_poles(degree, terms=75, points=1024):
    """Poles of the near-best degree-n approximation of exp(-x), x >= 0."""
    w = np.exp(2j * np.pi * np.arange(points) / points)
    t = w.real
    values = np.exp(SCALE * (t - 1) / (t + 1 + 1e-16))
    coefficients = np.fft.fft(values).real[: terms + 1] / points
    hankel = np.zeros((terms, terms))
    for i in range(terms):
        hankel[i, : terms - i] = coefficients[1 + i : terms + 1]
    _, _, v = np.linalg.svd(hankel)
    roots = np.roots(v[degree])
    roots = roots[np.abs(roots) > 1][:degree]
    assert len(roots) == degree
    z = SCALE * (roots - 1) ** 2 / (roots + 1) ** 2  # poles of exp(z), z <= 0
    return -z  # exp(-x) has its poles at x = -z


def basis(x, upper, real):
    """Columns of the real model: 1, Re and Im parts of 1 / (x - pole)."""
    columns = [np.ones_like(x)]
    for pole in real:
        columns.append(1.0 / (x - pole))
    for pole in upper:
        column = 1.0 / (x - pole)
        columns += [2 * column.real, -2 * column.imag]
    return np.array(columns).T


def fit(degree):
    poles = caratheodory_fejer_poles(degree)
    real = sorted(p.real for p in poles if abs(p.imag) < 1e-8)
    upper = sorted((p for p in poles if p.imag > 1e-8), key=lambda p: p.imag)
    grid = SCALE * (1 - np.cos(np.linspace(0, np.pi, 4001)[:-1])) / (
        1 + np.cos(np.linspace(0, np.pi, 4001)[:-1]))
    matrix = basis(grid, upper, real)
    target = np.exp(-grid)
    size = np.linalg.norm(matrix, axis=0)
    weights = np.ones_like(grid) / len(grid)
    best = (np.inf, None)
    for _ in range(300):
        root = np.sqrt(weights)[:, None]
        solution = np.linalg.lstsq(root * matrix / size, root[:, 0] * target, rcond=None)[0] / size
        error = np.abs(matrix @ solution - target)
        if error.max() < best[0]:
            best = (error.max(), solution)
        weights = weights * (error + 0.02 * error.max())
        weights /= weights.sum()
    solution = best[1]
    fine = np.concatenate([[0.0], np.logspace(-6, 9, 400001)])
    measured = np.abs(basis(fine, upper, real) @ solution - np.exp(-fine)).max()
    constant = solution[0]
    measured = max(measured, abs(constant))
    real_terms = list(zip(real, solution[1 : 1 + len(real)]))
    rest = solution[1 + len(real) :].reshape(-1, 2)
    complex_terms = [(p, a + 1j * b) for p, (a, b) in zip(upper, rest)]
    return constant, real_terms, complex_terms, measured


def main():
    print("""#pragma once

// Made by scripts/rational-exponential.py; see there for the method.

#include <array>
#include <complex>
#include <span>

namespace isotherm::spectral::detail {

/// One term residue / (x + shift); complex ones stand for a conjugate pair.
struct PartialFraction {
  std::complex<double> shift;
  std::complex<double> residue;
};

inline bool is_real(const PartialFraction& term) { return term.shift.imag() == 0.0; }

/// Norm of (A + shift)^-1 for any positive semidefinite A, at most.
inline double resolvent_norm(const PartialFraction& term) {
  const bool right = term.shift.real() >= 0.0;
  return 1.0 / (right ? std::abs(term.shift) : std::abs(term.shift.imag()));
}

/// exp(-x) = constant + sum of the terms, for x >= 0, to within `error`.
struct RationalExponential {
  double error;
  double constant;
  std::span<const PartialFraction> terms;
};
""")
    rows = []
    for degree in DEGREES:
        constant, real, pairs, error = fit(degree)
        terms = [(complex(-p), complex(r)) for p, r in real + pairs]
        print(f"inline constexpr std::array<PartialFraction, {len(terms)}> kFractions{degree} = {{{{")
        for shift, residue in terms:
            print(f"    {{{{{shift.real!r}, {shift.imag!r}}}, {{{residue.real!r}, {residue.imag!r}}}}},")
        print("}};")
        # Room for evaluation in double precision and for the grid's spacing.
        rows.append((degree, 1.02 * error + 1e-15 * sum(abs(r) for _, r in terms), constant))
    print()
    print("/// By ascending degree, hence descending error.")
    print(f"inline constexpr std::array<RationalExponential, {len(rows)}> kRationalExponentials = {{{{")
    for degree, error, constant in rows:
        print(f"    {{{error:.3e}, {float(constant)!r}, kFractions{degree}}},")
    print("}};")
    print("""
}  // namespace isotherm::spectral::detail""")


if __name__ == "__main__":
    main()
