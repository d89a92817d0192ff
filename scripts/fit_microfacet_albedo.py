#!/usr/bin/env python3
"""Fits the constants of shaders/bsdf/microfacet_albedo.glsl.

The directional albedo of a GGX reflector (Smith, height-correlated) is integrated for a grid of cosines and alphas over the
density of visible normals; polynomials are fitted to it for a small largest error (Lawson's weighted least squares) and
printed as GLSL, with their errors. Needs numpy.
"""

import numpy as np

POINTS = 256  # of the quadrature, in each direction
ROUGHNESS = np.concatenate([[np.sqrt(1e-3)], np.linspace(0.05, 1, 39)])
COSINE = np.concatenate([[1e-4, 1e-3, 3e-3, 0.01], np.linspace(0.02, 1, 50)])


def directional_albedo(cosine, alpha):
    """The albedo for F = 1, and for F = (1 - cos)^5."""
    u, v = np.meshgrid((np.arange(POINTS) + 0.5) / POINTS, (np.arange(POINTS) + 0.5) / POINTS)
    sine = np.sqrt(1 - cosine * cosine)
    stretched = np.array([alpha * sine, 0, cosine])
    stretched /= np.linalg.norm(stretched)
    down = v * (1 + stretched[2])
    radius = np.sqrt(np.maximum(down * (2 - down), 0))
    half = np.stack([
        alpha * (radius * np.cos(2 * np.pi * u) + stretched[0]), alpha * radius * np.sin(2 * np.pi * u),
        1 - down + stretched[2]
    ])
    half /= np.sqrt((half * half).sum(0))
    along = sine * half[0] + cosine * half[2]
    out = 2 * along * half[2] - cosine
    valid = out > 0
    out = np.where(valid, out, 1)
    slant_o = np.sqrt(alpha**2 + (1 - alpha**2) * cosine**2)
    slant_i = np.sqrt(alpha**2 + (1 - alpha**2) * out**2)
    weight = np.where(valid, out * (cosine + slant_o) / (cosine * slant_i + out * slant_o), 0)
    return weight.mean(), (weight * (1 - np.minimum(along, 1))**5).mean()


def fit(basis, values, weights=1.0, rounds=80):
    """Coefficients whose largest weighted error is nearly as small as can be, and that error."""
    matrix = np.stack([np.broadcast_to(b * weights, values.shape).ravel() for b in basis], 1)
    target = (values * weights).ravel()
    importance = np.ones_like(target)
    best = None
    for _ in range(rounds):
        root = np.sqrt(importance)
        coefficients = np.linalg.lstsq(matrix * root[:, None], target * root, rcond=None)[0]
        error = np.abs(matrix @ coefficients - target)
        if best is None or error.max() < best[1]:
            best = (coefficients, error.max())
        importance *= error + 1e-6
        importance /= importance.mean()
    return best


def loss(coefficients, cosine, alpha):
    x = cosine / (cosine + alpha)
    terms = [x * (1 - x)**2 * x**i * alpha**j for i in range(5) for j in range(4)]
    return np.clip(sum(c * t for c, t in zip(coefficients, terms)), 0, 1)


def grazing(coefficients, cosine, alpha):
    x = cosine / (cosine + alpha)
    roughness = np.sqrt(alpha)
    terms = [(1 - cosine)**5 * x**i * roughness**j / (1 + 3 * alpha) for i in range(5) for j in range(4)]
    return np.clip(sum(c * t for c, t in zip(coefficients, terms)), 0, 1 - loss_of(cosine, alpha))


def mean(function, alpha):
    """2 * integral of function(cosine) * cosine, with points crowded towards grazing angles."""
    t = (np.arange(20000) + 0.5) / 20000
    cosine = t**4
    return (2 * function(cosine, alpha) * cosine * 4 * t**3).mean()


def horner(coefficients, variable):
    text = "%.6g" % coefficients[-1]
    for c in coefficients[-2::-1]:
        text = "%.6g + %s * (%s)" % (c, variable, text) if " " in text else "%.6g + %s * %s" % (c, variable, text)
    return text


def show(title, error, coefficients, rows, variable):
    print("%s; largest error %.4f" % (title, error))
    for row in np.reshape(coefficients, (rows, -1)):
        print("  " + horner(row, variable))


grid = np.array([[directional_albedo(c, r * r) for c in COSINE] for r in ROUGHNESS])
r, c = np.meshgrid(ROUGHNESS, COSINE, indexing="ij")
a = r * r
x = c / (c + a)
loss_coefficients, error = fit([x * (1 - x)**2 * x**i * a**j for i in range(5) for j in range(4)], 1 - grid[:, :, 0])
show("loss, a line for each power of x", error, loss_coefficients, 5, "alpha")


def loss_of(cosine, alpha):
    return loss(loss_coefficients, cosine, alpha)


grazing_coefficients, error = fit([(1 - c)**5 * x**i * r**j / (1 + 3 * a) for i in range(5) for j in range(4)],
                                  grid[:, :, 1])
show("grazing, a line for each power of x", error, grazing_coefficients, 5, "r")

alphas = np.linspace(np.sqrt(1e-3), 1, 200)**2
mean_loss = np.array([mean(loss_of, alpha) for alpha in alphas])
# An error of the mean is one of the energy by as much as is lost.
largest_loss = np.array([loss_of(COSINE, alpha).max() for alpha in alphas])
coefficients, error = fit([np.sqrt(alphas)**i for i in range(6)], mean_loss / alphas**2,
                          alphas**2 / mean_loss * largest_loss)
show("mean loss over alpha^2; of the energy", error, coefficients, 1, "r")
mean_grazing = np.array([mean(lambda m, s: grazing(grazing_coefficients, m, s), alpha) for alpha in alphas])
coefficients, error = fit([np.sqrt(alphas)**i for i in range(5)], mean_grazing)
show("mean grazing", error, coefficients, 1, "r")
